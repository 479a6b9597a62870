"""The shader of hair, which strands have."""

from __future__ import annotations

import math
from typing import Any

import numpy
from hyades import materials

from . import values
from .closures import Closure, shader
from .graph import Output
from .translator import Translator
from .values import held

_EUMELANIN = numpy.array([0.506, 0.841, 1.653])
_PHEOMELANIN = numpy.array([0.343, 0.733, 1.924])
"""What Cycles has hair's pigments absorb."""
_RANDOM = ("Random Color", "Random Roughness")


@shader("BSDF_HAIR_PRINCIPLED")
def principled_hair(translator: Translator, output: Output) -> Closure:
    if not translator.is_of_strands:
        translator.complain(output.node, "it is for hair; matt grey is used")
        return Closure(materials.Lambert(color=0.5))
    if getattr(output.node, "model", "CHIANG") != "CHIANG":
        translator.complain(output.node, "only Chiang's model is supported: it is used")
    roughness = held(translator.number(output.input("Roughness"), 0.3))
    radial = held(translator.number(output.input("Radial Roughness"), 0.3))
    made = materials.Hair(roughness=roughness, radial_roughness=radial)
    made.ior = held(translator.constant(output.input("IOR"), 1.55), 1.0, 100.0)
    made.tilt = math.degrees(values.number(translator.constant(output.input("Offset"), math.radians(2))))
    if not values.is_constant(translator.constant(output.input("Coat"), 0.0), 0):
        translator.complain(output.node, "its first reflection is as rough as the others: Coat is left out")
    for name in _RANDOM:
        if not values.is_constant(translator.constant(output.input(name), 0.0), 0):
            translator.complain(output.node, f"all strands are alike: {name} is left out")
    kind = output.node.parametrization
    if kind == "COLOR":
        made.color = translator.color(output.input("Color"))
    elif kind == "ABSORPTION":
        made.absorption = held(translator.constant(output.input("Absorption Coefficient")), 0.0, 1e18)
    else:
        made.absorption = _pigments(translator, output, radial)
    return Closure(made)


def _pigments(translator: Translator, output: Output, radial: Any) -> list[float]:
    amount = values.number(translator.constant(output.input("Melanin"), 0.8))
    share = min(max(values.number(translator.constant(output.input("Melanin Redness"), 1.0)), 0.0), 1.0)
    tint = numpy.clip(values.color(translator.constant(output.input("Tint"), (1.0, 1.0, 1.0))), 1e-4, 1)
    concentration = -math.log(max(1 - min(max(amount, 0.0), 1.0), 1e-4))
    n = values.number(radial) if not values.is_texture(radial) else 0.3
    # Chiang et al. 2016, section 4.2.
    fit = 5.969 - 0.215 * n + 2.532 * n**2 - 10.73 * n**3 + 5.574 * n**4 + 0.245 * n**5
    of_tint = (numpy.log(tint) / fit) ** 2
    absorption = concentration * ((1 - share) * _EUMELANIN + share * _PHEOMELANIN) + of_tint
    return [float(part) for part in absorption]
