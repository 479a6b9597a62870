"""What lies over the body of a Principled BSDF of Blender 4: a coat and fuzz, and what they leave of what is below."""

from __future__ import annotations

import numpy
from hyades import materials

from . import values
from .evaluate.angles import mean_reflection
from .graph import Output
from .translator import Translator
from .values import Value, held

_FUZZ = (0.2, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8)
"""Sheen Roughness of Cycles, which has fuzz of Zeltner, Burley and Chiang (2022); and as measured with balls below an even
sky (Cycles 4.3), of the job's, which is that of Estevez and Kulla, what is most like it:"""
_JOB_ROUGHNESS = (0.3, 0.3, 0.3, 0.3, 0.36, 0.43, 0.505, 0.585, 0.67, 0.765, 0.885, 1.0)
_JOB_WEIGHT = (0.057, 0.381, 0.647, 0.954, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0)
_ROUGHEST = 0.85
_ALBEDO = ((0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0),
           (0.0, 0.0055, 0.0238, 0.0574, 0.1052, 0.1646, 0.232, 0.3028, 0.3731, 0.4393))
"""What it reflects of an even sky, by its roughness."""


def fuzz_like(translator: Translator, output: Output, weight: Value, roughness: Value) -> tuple[Value, Value]:
    """Weight and roughness of the job's fuzz that is most like Cycles'."""
    if values.is_texture(roughness):
        return weight, roughness
    if values.number(roughness) > _ROUGHEST:
        translator.complain(output.node, "its fuzz (sheen) is less rough, and up to a third darker: it has that of roughness 0.8")
    share = float(numpy.interp(values.number(roughness), (0.1, *_FUZZ), (0.0, *_JOB_WEIGHT)))
    return values.product(weight, share), float(numpy.interp(values.number(roughness), _FUZZ, _JOB_ROUGHNESS))


def add_fuzz(translator: Translator, output: Output, made: materials.Principled) -> None:
    """Its sheen, if it has some."""
    weight = held(translator.number(output.input("Sheen Weight")))
    if values.is_constant(weight, 0):
        return
    roughness = held(translator.number(output.input("Sheen Roughness"), 0.5))
    translator.complain(output.node, "fuzz (sheen) is that of Estevez and Kulla, another model, about as bright")
    made.sheen, made.sheen_roughness = fuzz_like(translator, output, weight, roughness)
    made.sheen_tint = held(translator.value(output.input("Sheen Tint"), 1.0))


def add_coat(translator: Translator, output: Output, made: materials.Principled) -> None:
    """Its coat, if it has one. The job's has no colour: what is below has it, as on average over light from all sides."""
    coat = held(translator.number(output.input("Coat Weight")))
    if values.is_constant(coat, 0):
        return
    made.coat = coat
    made.coat_roughness = held(translator.number(output.input("Coat Roughness"), 0.03))
    made.coat_ior = held(values.number(translator.constant(output.input("Coat IOR"), 1.5)), 1.0, 100.0)
    color = _color_of_coat(translator, output, made)
    if not values.is_constant(color, 1):
        translator.complain(output.node, "what the tint of its coat takes does not depend on the angle of view")
        made.base_color = held(values.product(made.base_color, color))
        made.specular_tint = held(values.product(made.specular_tint, color))


def _color_of_coat(translator: Translator, output: Output, made: materials.Principled) -> Value:
    """What gets through a coat's tint: its power by how long the way is, weighted by the cosine."""
    tint = held(translator.constant(output.input("Coat Tint"), 1.0))
    if values.is_constant(tint, 1):
        return 1.0
    squares = (numpy.arange(64) + 0.5) / 64  # of cosines
    way = 1 / numpy.sqrt(1 - (1 - squares) / float(made.coat_ior) ** 2)
    through = tuple(float((max(part, 1e-6) ** way).mean()) for part in values.color(tint))
    return values.mixed(1.0, through, made.coat)


def left_of_emission(translator: Translator, output: Output, made: materials.Principled) -> Value:
    """What comes out of the light below coat and fuzz, as on average over all sides: Cycles dims it by what they reflect."""
    coat = values.product(made.coat, float(mean_reflection(float(made.coat_ior))))
    left = values.product(values.rest(coat), _color_of_coat(translator, output, made) if not values.is_constant(coat, 0) else 1.0)
    fuzz = held(translator.number(output.input("Sheen Weight")))
    if values.is_constant(fuzz, 0):
        return left
    roughness = translator.constant(output.input("Sheen Roughness"), 0.5)
    tint = max(values.color(translator.constant(output.input("Sheen Tint"), 1.0)))
    albedo = float(numpy.interp(values.number(roughness), *_ALBEDO)) * min(max(tint, 0.0), 1.0)
    return values.product(left, values.rest(values.product(fuzz, albedo)))
