"""Shaders of volumes as media that are the same everywhere."""

from __future__ import annotations

import math
from typing import NamedTuple, Optional

import numpy
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
        self.phases: set[str] = set()


def medium_of(translator: Translator, end: Optional[Input]) -> Optional[media.Medium]:
    """The medium that is linked to input "Volume"; None: there is none."""
    found = graph.source(end) if end is not None else None
    if not isinstance(found, Output):
        return None
    return medium_of_node(translator, found)


def medium_of_node(translator: Translator, found: Output, share: float = 1.0, is_hot: bool = True) -> media.Medium:
    """What a shader of volumes, or a sum of them, fills a body with. `share`: how much of it. `is_hot`: with what it shines
    as a black body of one temperature."""
    total = _Sum()
    _add(translator, found, share, total, is_hot)
    keys = {"absorption": total.absorption, "scattering": total.scattering, "emission": total.emission}
    made = media.Medium(**{name: list(value) for name, value in keys.items() if any(value)})
    if len(total.phases) > 1:
        translator.complain(found.node, "what is added up scatters light in one way: with Henyey and Greenstein's phase")
    elif total.phases == {"rayleigh"}:
        made.phase = "rayleigh"
    if total.g:
        made.g = values.held(total.g / max(total.weight, 1e-20), -0.99, 0.99)
    return made


def _color(translator: Translator, output: Output, name: str, default: float = 0.0) -> tuple[float, float, float]:
    return values.color(translator.constant(output.input(name), default))


def _number(translator: Translator, output: Output, name: str, default: float = 0.0) -> float:
    return float(values.number(translator.constant(output.input(name), default)))


def _scaled(color, factor: float, tint=(1.0, 1.0, 1.0)):
    return tuple(float(max(part, 0.0) * factor * other) for part, other in zip(color, tint))


def _plus(a, b):
    return tuple(x + y for x, y in zip(a, b))


def _add(translator: Translator, output: Output, share: float, total: _Sum, is_hot: bool) -> None:
    node = output.node
    if node.type in ("ADD_SHADER", "MIX_SHADER"):
        amount = _number(translator, output, "Fac") if node.type == "MIX_SHADER" else None
        inputs = node.inputs[-2:]
        shares = (share, share) if amount is None else (share * (1 - amount), share * amount)
        for socket, part in zip(inputs, shares):
            found = graph.source(Input(socket, output.groups))
            if isinstance(found, Output) and part > 0:
                _add(translator, found, part, total, is_hot)
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
    phase, g = _phase(translator, output)
    if max(scattering) > 0:
        total.phases.add(phase)
    total.g += g * max(scattering)
    total.weight += max(scattering)
    if node.type == "PRINCIPLED_VOLUME":
        swallowed = [max(1 - math.sqrt(max(part, 0.0)), 0.0) for part in _color(translator, output, "Absorption Color")]
        rest = [max(1 - part, 0.0) * other for part, other in zip(color, swallowed)]
        total.absorption = _plus(total.absorption, _scaled(rest, density))
        strength = share * _number(translator, output, "Emission Strength")
        total.emission = _plus(total.emission, _scaled(_color(translator, output, "Emission Color"), strength))
        if is_hot:
            heat = heat_of(translator, output)
            total.emission = _plus(total.emission, _scaled(color_of(heat.kelvin), share * heat.strength(heat.kelvin), heat.tint))


def _phase(translator: Translator, output: Output) -> tuple[str, float]:
    """Where light goes that is scattered: by which phase function of the job, and the mean of its cosine."""
    kind = getattr(output.node, "phase", "HENYEY_GREENSTEIN")  # since Blender 4.3
    g = _number(translator, output, "Anisotropy")
    if kind == "RAYLEIGH":
        return "rayleigh", 0.0
    if kind == "DRAINE":
        g = _mean_of_draine(g, _number(translator, output, "Alpha", 0.5))
    elif kind == "MIE":
        g = _mean_of_mie(_number(translator, output, "Diameter", 20.0))
    elif kind == "FOURNIER_FORAND":
        g = _of_backscatter(_number(translator, output, "Backscatter", 0.1))
    if kind != "HENYEY_GREENSTEIN":
        name = kind.replace("_", " ").title()
        translator.complain(output.node, f"jobs have no phase function {name}: Henyey and Greenstein's, of g = {g:.2f}, is used")
    return "henyey-greenstein", g


def _mean_of_draine(g: float, alpha: float) -> float:
    """The mean cosine by Draine (2003), equation 7."""
    return g * (1 + alpha * (3 + 2 * g * g) / 5) / (1 + alpha * (1 + 2 * g * g) / 3)


def _mean_of_mie(diameter: float) -> float:
    """The mean cosine of fog of droplets [micrometres], by the fit of Jendersie and d'Eon (2023) for 5 to 50 of them."""
    d = min(max(diameter, 5.0), 50.0)
    far = math.exp(-0.0990567 / (d - 1.67154))
    near = math.exp(-2.20679 / (d + 3.91029) - 0.428934)
    alpha = math.exp(3.62489 - 8.29288 / (d + 5.52825))
    share = math.exp(-0.599085 / (d - 0.641583) - 0.665888)
    return (1 - share) * far + share * _mean_of_draine(near, alpha)


def _of_backscatter(share: float) -> float:
    """Which g of Henyey and Greenstein (1941) throws this share of light back, 0 to half of it."""
    g = numpy.linspace(0.01, 0.99, 99)
    back = (1 - g) / (2 * g) * ((1 + g) / numpy.sqrt(1 + g * g) - 1)
    return float(numpy.interp(share, back[::-1], g[::-1]))


class Heat(NamedTuple):
    """What a Principled Volume gives off as a black body."""

    share: float
    kelvin: float
    tint: tuple[float, float, float]

    def strength(self, kelvin: float) -> float:
        """Per metre at a temperature: the law of Stefan and Boltzmann in units of Cycles' own, a millionth. Between none
        and all of it there is 1."""
        return STEFAN * 1e-6 / math.pi * (1 - self.share + self.share * kelvin**4) if self.share > 0 else 0.0


def heat_of(translator: Translator, output: Output) -> Heat:
    """Its share is 0 where nothing is hot."""
    share = _number(translator, output, "Blackbody Intensity")
    if share <= 0:
        return Heat(0.0, 0.0, (0.0, 0.0, 0.0))
    kelvin = max(_number(translator, output, "Temperature", 1000.0), 0.0)
    return Heat(share, kelvin, _color(translator, output, "Blackbody Tint", 1.0))
