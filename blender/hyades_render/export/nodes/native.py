"""Nodes that a texture of the job means as well."""

from __future__ import annotations

from typing import Any

import numpy
from hyades import textures

from . import values
from .coordinates import coordinates_of
from .evaluate.colors import ramp_table
from .graph import Input, Output
from .images import image_file
from .translator import Inexpressible, Translator, native
from .values import Value, held, is_texture

_BELOW = "textures of the job know no numbers below 0"
_WRAPS = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "black", "MIRROR": "mirror"}


def _input(translator: Translator, output: Output, *names: str) -> Value:
    end = output.input(*names)
    if end is None:
        raise Inexpressible(output, f"it has no input {names[0]}")
    return translator.native_value(end)


def _constant(translator: Translator, output: Output, *names: str) -> float:
    value = _input(translator, output, *names)
    if is_texture(value):
        raise Inexpressible(output, f"input {names[0]} changes from place to place")
    return float(values.number(value))


@native("TEX_IMAGE")
def image(translator: Translator, output: Output) -> Value:
    node = output.node
    if node.image is None:
        return (1.0, 0.0, 1.0) if output.socket.identifier != "Alpha" else 1.0
    if output.socket.identifier == "Alpha" and node.image.alpha_mode == "NONE":
        return 1.0
    if node.projection != "FLAT":
        raise Inexpressible(output, f"the projection {node.projection.lower()} is not supported")
    found = image_file(translator, node, output)
    place = coordinates_of(translator, output, "uv")
    made = textures.Image(file=found.file, color_space=found.color_space, mapping=place.mapping())
    if not found.is_tiled:
        made.wrap = _WRAPS[node.extension]
    if node.interpolation == "Closest":
        made.filter = "nearest"
    if output.socket.identifier == "Alpha":
        made.channel = "alpha"
    return made if node.image.is_float else values.bounded(made, 1.0)


@native("VERTEX_COLOR")
def vertex_color(translator: Translator, output: Output) -> Value:
    return _color_attribute(translator, output, output.node.layer_name)


@native("ATTRIBUTE")
def attribute(translator: Translator, output: Output) -> Value:
    node = output.node
    part = translator.surface
    if node.attribute_type != "GEOMETRY" or part is None:
        raise Inexpressible(output, "no texture of the job means this attribute")
    translator.is_of_surface = True
    if node.attribute_name not in part.surface.mesh.color_attributes:
        raise Inexpressible(output, "no texture of the job means this attribute")
    return _color_attribute(translator, output, node.attribute_name)


def _color_attribute(translator: Translator, output: Output, name: str) -> Value:
    translator.is_of_surface = True
    colors = translator.surface.surface.color(name) if translator.surface is not None else None
    if colors is None:
        return 0.0  # as Cycles has it
    if translator.color_attribute not in (None, name):
        raise Inexpressible(output, "this is the second colour attribute of one material")
    translator.color_attribute = name
    kind = output.socket.identifier
    if kind == "Fac":  # of the node Attribute: the mean of the three
        whole = values.bounded(textures.VertexColor(), float(colors[:, :3].max(initial=0.0)))
        parts = [textures.Channel(input=whole, channel=name) for name in ("red", "green", "blue")]
        return values.product(values.total(values.total(parts[0], parts[1]), parts[2]), 1 / 3)
    channel = slice(3, 4) if kind == "Alpha" else slice(3)
    made = textures.VertexColor(channel="alpha" if kind == "Alpha" else "color")
    return values.bounded(made, float(colors[:, channel].max(initial=0.0)))


@native("TEX_CHECKER")
def checker(translator: Translator, output: Output) -> Value:
    place = coordinates_of(translator, output, "generated")
    scale = _constant(translator, output, "Scale")
    if output.socket.type == "VALUE":
        first, second = 1.0, 0.0
    else:
        first, second = _input(translator, output, "Color1"), _input(translator, output, "Color2")
    if place.space == "uv" and numpy.abs(place.matrix[2, [0, 1, 3]]).max() > 1e-9:
        raise Inexpressible(output, "UV coordinates of the job have two parts, and the mapping makes a third of them")
    # Blender nudges places away from whole numbers, which for the zeros of flat things matters: 0 lies in cell 0.
    nudge = [0.000001 * 0.999999] * 3
    if not (_positive(first) and _positive(second)):
        raise Inexpressible(output, _BELOW)
    return textures.Checker(a=held(second, 0, 1e18), b=held(first, 0, 1e18), scale=[scale * 0.999999] * 3, offset=nudge, mapping=place.mapping())


@native("VALTORGB")
def ramp(translator: Translator, output: Output) -> Value:
    amount = _input(translator, output, "Fac")
    color_ramp = output.node.color_ramp
    alpha = output.socket.identifier == "Alpha"

    def color(rgba: Any) -> Any:
        return float(rgba[3]) if alpha else [max(float(part), 0.0) for part in rgba[:3]]

    simple = color_ramp.color_mode == "RGB" and color_ramp.interpolation in ("LINEAR", "CONSTANT", "EASE")
    places = [element.position for element in color_ramp.elements]
    if simple and len(places) > 1 and len(set(places)) == len(places):
        stops = {float(element.position): color(element.color) for element in color_ramp.elements}
        between = {"LINEAR": "linear", "CONSTANT": "steps", "EASE": "smooth"}[color_ramp.interpolation]
    else:
        table = ramp_table(color_ramp, 65)
        stops = {i / 64: color(rgba) for i, rgba in enumerate(table)}
        between = "linear"
    return textures.Ramp(input=amount, stops=stops, between=between)


@native("MIX_RGB")
def mix_rgb(translator: Translator, output: Output) -> Value:
    node = output.node
    a, b = _input(translator, output, "Color1"), _input(translator, output, "Color2")
    return _mixed(output, node.blend_type, a, b, _input(translator, output, "Fac"), node.use_clamp)


@native("MIX")
def mix(translator: Translator, output: Output) -> Value:
    node = output.node
    if node.data_type not in ("FLOAT", "RGBA"):
        raise Inexpressible(output, "no texture of the job mixes vectors")
    end = "Float" if node.data_type == "FLOAT" else "Color"
    a, b = _input(translator, output, f"A_{end}"), _input(translator, output, f"B_{end}")
    blend = "MIX" if node.data_type == "FLOAT" else node.blend_type
    clamp = node.data_type == "RGBA" and node.clamp_result
    amount = _input(translator, output, "Factor_Float")
    if not node.clamp_factor and (is_texture(amount) or not 0 <= values.number(amount) <= 1):
        raise Inexpressible(output, "no texture of the job mixes beyond both")
    return _mixed(output, blend, a, b, amount, clamp)


def _mixed(output: Output, blend: str, a: Value, b: Value, amount: Value, clamp: bool) -> Value:
    amount = amount if is_texture(amount) else held(values.number(amount))
    if any(map(is_texture, (a, b, amount))) and not (_positive(a) and _positive(b)):
        raise Inexpressible(output, _BELOW)
    if blend == "MIX":
        result = values.mixed(a, b, amount)
    elif blend == "MULTIPLY":
        result = values.product(a, values.mixed(1.0, b, amount))
    elif blend == "ADD":
        result = values.total(a, values.product(b, amount))
    elif blend in ("DARKEN", "LIGHTEN"):
        kind = textures.Min if blend == "DARKEN" else textures.Max
        result = values.mixed(a, kind(a=held(a, 0, 1e18), b=held(b, 0, 1e18)), amount)
    else:
        raise Inexpressible(output, f"no texture of the job means the blend type {blend.lower()}")
    return textures.Min(a=result, b=1) if clamp else result


@native("INVERT")
def invert(translator: Translator, output: Output) -> Value:
    if _constant(translator, output, "Fac") != 1:
        raise Inexpressible(output, "the job inverts as a whole only")
    return _inverted(output, _input(translator, output, "Color"))


@native("GAMMA")
def gamma(translator: Translator, output: Output) -> Value:
    exponent = _constant(translator, output, "Gamma")
    return textures.Power(input=_input(translator, output, "Color"), exponent=max(exponent, 0.0))


@native("HUE_SAT")
def hue_saturation(translator: Translator, output: Output) -> Value:
    hue, saturation, value, amount = (
        _constant(translator, output, name) for name in ("Hue", "Saturation", "Value", "Fac")
    )
    color = _input(translator, output, "Color")
    if amount != 1 or hue != 0.5 or saturation != 1:
        raise Inexpressible(output, "the job turns hues in another way")
    return values.product(color, max(value, 0.0))


@native("SEPRGB", "SEPARATE_COLOR")
def separate(translator: Translator, output: Output) -> Value:
    if getattr(output.node, "mode", "RGB") != "RGB":
        raise Inexpressible(output, "no texture of the job means this colour model")
    channel = ("red", "green", "blue")[list(output.node.outputs).index(output.socket)]
    return textures.Channel(input=_input(translator, output, "Color", "Image"), channel=channel)


@native("RGBTOBW")
def to_grey(translator: Translator, output: Output) -> Value:
    return textures.Channel(input=_input(translator, output, "Color"), channel="luminance")


@native("MATH")
def math(translator: Translator, output: Output) -> Value:
    node = output.node
    a, b = (_input(translator, output, name) for name in ("Value", "Value_001"))
    if node.operation == "MULTIPLY" and _positive(a) and _positive(b):
        result = values.product(a, b)
    elif node.operation == "ADD" and _positive(a) and _positive(b):
        result = values.total(a, b)
    elif node.operation == "SUBTRACT" and values.is_constant(a, 1):
        result = _inverted(output, b)
    elif node.operation == "POWER" and not is_texture(b) and _positive(b):
        result = textures.Power(input=a, exponent=values.number(b))
    elif node.operation in ("MINIMUM", "MAXIMUM") and _positive(a) and _positive(b):
        kind = textures.Min if node.operation == "MINIMUM" else textures.Max
        result = kind(a=a, b=b)
    else:
        raise Inexpressible(output, f"no texture of the job means the operation {node.operation.lower()}")
    return textures.Min(a=result, b=1) if node.use_clamp and is_texture(result) else result


def _positive(value: Value) -> bool:
    return is_texture(value) or min(values.color(value)) >= 0


def _inverted(output: Output, value: Value) -> Value:
    """1 - value."""
    if is_texture(value) and values.most(value) > 1:
        raise Inexpressible(output, _BELOW)
    return values.rest(value)


__all__ = ["Input"]
