"""Nodes that make and change colours."""

from __future__ import annotations

from typing import Any

import numpy

from ..graph import Output
from ..translator import Inexpressible
from .blend import blended
from .evaluator import LUMINANCE, Evaluator, as_type, computes, stacked

Array = Any


@computes("RGB")
def rgb(at: Evaluator, output: Output) -> Array:
    return numpy.array(output.socket.default_value[:3])


@computes("VALUE")
def value(at: Evaluator, output: Output) -> Array:
    return numpy.asarray(float(output.socket.default_value))


@computes("VALTORGB")
def ramp(at: Evaluator, output: Output) -> Array:
    table = ramp_table(output.node.color_ramp)
    place = numpy.clip(at.number(output, "Fac"), 0, 1) * (len(table) - 1)
    if output.node.color_ramp.interpolation == "CONSTANT":
        found = table[numpy.floor(place).astype(int)]
    else:
        low = numpy.minimum(numpy.floor(place).astype(int), len(table) - 2)
        share = (place - low)[..., None]
        found = table[low] * (1 - share) + table[low + 1] * share
    return found[..., 3] if output.socket.identifier == "Alpha" else found[..., :3]


def ramp_table(color_ramp: Any, count: int = 257) -> Array:
    """Colours (count, 4) of a ramp at even steps from 0 to 1."""
    return numpy.array([tuple(color_ramp.evaluate(i / (count - 1))) for i in range(count)])


@computes("MIX_RGB")
def mix_rgb(at: Evaluator, output: Output) -> Array:
    node = output.node
    a, b = at.color(output, "Color1"), at.color(output, "Color2")
    amount = numpy.clip(at.number(output, "Fac"), 0, 1)
    result = _blend(output, node.blend_type, a, b, amount)
    return numpy.clip(result, 0, 1) if node.use_clamp else result


@computes("MIX")
def mix(at: Evaluator, output: Output) -> Array:
    node = output.node
    kind = node.data_type
    vector_amount = kind == "VECTOR" and node.factor_mode == "NON_UNIFORM"
    amount = at.vector(output, "Factor_Vector") if vector_amount else at.number(output, "Factor_Float")
    if node.clamp_factor:
        amount = numpy.clip(amount, 0, 1)
    if kind == "FLOAT":
        a, b = at.number(output, "A_Float"), at.number(output, "B_Float")
        return a + (b - a) * amount
    if kind == "VECTOR":
        a, b = at.vector(output, "A_Vector"), at.vector(output, "B_Vector")
        return a + (b - a) * (amount if vector_amount else amount[..., None])
    if kind != "RGBA":
        raise Inexpressible(output, "this kind of data is not supported")
    result = _blend(output, node.blend_type, at.color(output, "A_Color"), at.color(output, "B_Color"), amount)
    return numpy.clip(result, 0, 1) if node.clamp_result else result


def _blend(output: Output, kind: str, a: Array, b: Array, amount: Array) -> Array:
    result = blended(kind, a, b, numpy.asarray(amount)[..., None])
    if result is None:
        raise Inexpressible(output, f"the blend type {kind.lower()} is not supported")
    return result


@computes("INVERT")
def invert(at: Evaluator, output: Output) -> Array:
    color, amount = at.color(output, "Color"), at.number(output, "Fac")[..., None]
    return color + (1 - 2 * color) * amount


@computes("GAMMA")
def gamma(at: Evaluator, output: Output) -> Array:
    color, exponent = at.color(output, "Color"), at.number(output, "Gamma")[..., None]
    return numpy.where(color > 0, numpy.power(numpy.maximum(color, 1e-30), exponent), color)


@computes("BRIGHTCONTRAST")
def bright_contrast(at: Evaluator, output: Output) -> Array:
    bright, contrast = at.number(output, "Bright")[..., None], at.number(output, "Contrast")[..., None]
    return numpy.maximum((1 + contrast) * at.color(output, "Color") + bright - contrast * 0.5, 0)


@computes("HUE_SAT")
def hue_saturation(at: Evaluator, output: Output) -> Array:
    color = at.color(output, "Color")
    hsv = to_hsv(color)
    hue = numpy.mod(hsv[..., 0] + at.number(output, "Hue") + 0.5, 1)
    saturation = numpy.clip(hsv[..., 1] * at.number(output, "Saturation"), 0, 1)
    changed = from_hsv(stacked(hue, saturation, hsv[..., 2] * at.number(output, "Value")))
    amount = at.number(output, "Fac")[..., None]
    return numpy.maximum(color + (changed - color) * amount, 0)


@computes("RGBTOBW")
def to_grey(at: Evaluator, output: Output) -> Array:
    return at.color(output, "Color") @ LUMINANCE


@computes("CURVE_RGB")
def rgb_curves(at: Evaluator, output: Output) -> Array:
    color = at.color(output, "Color")
    mapping = output.node.mapping
    mapping.initialize()
    # The curve of all (the fourth) comes first, then that of the channel.
    whole = [curve_at(mapping, 3, color[..., channel]) for channel in range(3)]
    changed = stacked(*(curve_at(mapping, channel, whole[channel]) for channel in range(3)))
    return color + (changed - color) * at.number(output, "Fac")[..., None]


def curve_at(mapping: Any, index: int, at: Array, count: int = 257) -> Array:
    """A curve of a mapping at numbers, by a table, going on beyond its ends as the mapping says."""
    curve = mapping.curves[index]
    low = min(point.location[0] for point in curve.points)
    high = max(point.location[0] for point in curve.points)
    steps = numpy.linspace(low, high, count)
    table = numpy.array([mapping.evaluate(curve, float(step)) for step in steps])
    inside = numpy.interp(at, steps, table)
    if mapping.extend == "EXTRAPOLATED" and high > low:
        step = steps[1] - steps[0]
        inside = numpy.where(at < low, table[0] + (at - low) * (table[1] - table[0]) / step, inside)
        inside = numpy.where(at > high, table[-1] + (at - high) * (table[-1] - table[-2]) / step, inside)
    return inside


@computes("SEPRGB", "SEPXYZ", "SEPARATE_COLOR", "SEPHSV")
def separate(at: Evaluator, output: Output) -> Array:
    value = at.vector(output, "Color", "Image", "Vector")
    if output.node.type == "SEPHSV" or getattr(output.node, "mode", "RGB") == "HSV":
        value = to_hsv(value)
    elif getattr(output.node, "mode", "RGB") != "RGB":
        raise Inexpressible(output, "this colour model is not supported")
    return value[..., list(output.node.outputs).index(output.socket)]


@computes("COMBRGB", "COMBXYZ", "COMBINE_COLOR", "COMBHSV")
def combine(at: Evaluator, output: Output) -> Array:
    parts = [at.number(output, socket.identifier) for socket in output.node.inputs]
    value = stacked(*parts[:3])
    if output.node.type == "COMBHSV" or getattr(output.node, "mode", "RGB") == "HSV":
        return from_hsv(value)
    if getattr(output.node, "mode", "RGB") != "RGB":
        raise Inexpressible(output, "this colour model is not supported")
    return value


@computes("BLACKBODY")
def blackbody(at: Evaluator, output: Output) -> Array:
    from .blackbody import color_of

    return as_type(color_of(at.number(output, "Temperature")), "RGBA", "RGBA")


def to_hsv(color: Array) -> Array:
    high, low = color.max(axis=-1), color.min(axis=-1)
    span = high - low
    safe = numpy.where(span == 0, 1, span)
    r, g, b = (color[..., i] for i in range(3))
    hue = numpy.where(r == high, (g - b) / safe, numpy.where(g == high, 2 + (b - r) / safe, 4 + (r - g) / safe))
    hue = numpy.where(span == 0, 0, numpy.mod(hue / 6, 1))
    return stacked(hue, numpy.where(high == 0, 0, span / numpy.where(high == 0, 1, high)), high)


def from_hsv(hsv: Array) -> Array:
    hue, saturation, high = (hsv[..., i] for i in range(3))
    parts = [numpy.clip(numpy.abs(numpy.mod(hue * 6 + turn, 6) - 3) - 1, 0, 1) for turn in (0, 4, 2)]
    return stacked(*(high * (1 - saturation + saturation * part) for part in parts))
