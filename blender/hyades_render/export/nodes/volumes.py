"""Shaders of volumes as media that are the same everywhere."""

from __future__ import annotations

import math
from typing import Any, Optional

from hyades import media

from . import graph, values
from .evaluate.blackbody import STEFAN, color_of
from .graph import Input, Output
from .translator import Translator


class _Sum:
    """Coefficients [1/m] of what is added up."""

    def __init__(self) -> None:
        self.absorption = self.scattering = self.emission = (0.0, 0.0, 0.0)
        self.g = self.weight = 0.0


def medium_of(translator: Translator, end: Optional[Input]) -> Optional[media.Medium]:
    """The medium that is linked to input "Volume"; None: there is none."""
    found = graph.source(end) if end is not None else None
    if not isinstance(found, Output):
        return None
    return medium_of_node(translator, found)


def medium_of_node(translator: Translator, found: Output) -> media.Medium:
    """What a shader of volumes, or a sum of them, fills a body with."""
    total = _Sum()
    _add(translator, found, 1.0, total)
    keys = {"absorption": total.absorption, "scattering": total.scattering, "emission": total.emission}
    made = media.Medium(**{name: list(value) for name, value in keys.items() if any(value)})
    if total.g:
        made.g = values.held(total.g / max(total.weight, 1e-20), -0.99, 0.99)
    return made


def _color(translator: Translator, output: Output, name: str, default: float = 0.0) -> tuple[float, float, float]:
    return values.color(translator.constant(output.input(name), default))


def _number(translator: Translator, output: Output, name: str, default: float = 0.0) -> float:
    return float(values.number(translator.constant(output.input(name), default)))


def _scaled(color, factor: float):
    return tuple(max(part, 0.0) * factor for part in color)


def _plus(a, b):
    return tuple(x + y for x, y in zip(a, b))


def _add(translator: Translator, output: Output, share: float, total: _Sum) -> None:
    node = output.node
    if node.type in ("ADD_SHADER", "MIX_SHADER"):
        amount = _number(translator, output, "Fac") if node.type == "MIX_SHADER" else None
        inputs = node.inputs[-2:]
        shares = (share, share) if amount is None else (share * (1 - amount), share * amount)
        for socket, part in zip(inputs, shares):
            found = graph.source(Input(socket, output.groups))
            if isinstance(found, Output) and part > 0:
                _add(translator, found, part, total)
        return
    if node.type == "EMISSION":
        strength = _number(translator, output, "Strength")
        total.emission = _plus(total.emission, _scaled(_color(translator, output, "Color"), share * strength))
        return
    density = share * _number(translator, output, "Density")
    color = _color(translator, output, "Color")
    if node.type == "VOLUME_ABSORPTION":
        total.absorption = _plus(total.absorption, _scaled([1 - part for part in color], density))
        return
    if node.type not in ("VOLUME_SCATTER", "PRINCIPLED_VOLUME"):
        translator.complain(node, "this shader of volumes is not supported; it is left out")
        return
    scattering = _scaled(color, density)
    total.scattering = _plus(total.scattering, scattering)
    total.g += _number(translator, output, "Anisotropy") * max(scattering)
    total.weight += max(scattering)
    if node.type == "PRINCIPLED_VOLUME":
        swallowed = [max(1 - math.sqrt(max(part, 0.0)), 0.0) for part in _color(translator, output, "Absorption Color")]
        rest = [max(1 - part, 0.0) * other for part, other in zip(color, swallowed)]
        total.absorption = _plus(total.absorption, _scaled(rest, density))
        strength = share * _number(translator, output, "Emission Strength")
        total.emission = _plus(total.emission, _scaled(_color(translator, output, "Emission Color"), strength))
        total.emission = _plus(total.emission, _scaled(_heat(translator, output), share))


def _heat(translator: Translator, output: Output) -> Any:
    """What a Principled Volume gives off as a black body, of one temperature, per metre."""
    share = _number(translator, output, "Blackbody Intensity")
    if share <= 0:
        return (0.0, 0.0, 0.0)
    kelvin = max(_number(translator, output, "Temperature", 1000.0), 0.0)
    # The law of Stefan and Boltzmann, in units of Cycles' own: a millionth. Between none and all of it there is 1.
    strength = STEFAN * 1e-6 / math.pi * (1 - share + share * kelvin**4)
    tint = _color(translator, output, "Blackbody Tint", 1.0)
    return tuple(float(strength * part * light) for part, light in zip(tint, color_of(kelvin)))
