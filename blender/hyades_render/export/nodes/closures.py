"""Shaders as materials."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Callable, Optional

from hyades import materials, media

from . import graph, values
from .graph import Input, Output
from .translator import Translator
from .values import Value, held


@dataclass
class Closure:
    """What a shader does to light."""

    material: Optional[materials.Material] = None
    """None: swallows it."""
    emission: Value = 0.0
    """Radiance [W/(m² sr)], as much as leaves, whatever is there."""
    opacity: Value = 1.0
    """The share that is there. It is not in the material yet."""
    medium: Optional[media.Medium] = None
    is_one_sided: bool = False
    """It shines to where its surface faces, not to both sides."""
    mixed_opacity: bool = field(default=False)
    """Its parts have opacities of their own; `opacity` is their mean."""


SHADERS: dict[str, Callable[[Translator, Output], Closure]] = {}
"""By type of node."""


def shader(*types: str) -> Callable[[Any], Any]:
    """Marks the function for shaders of these types."""

    def mark(make: Any) -> Any:
        SHADERS.update(dict.fromkeys(types, make))
        return make

    return mark


def closure_of(translator: Translator, end: Optional[Input]) -> Closure:
    """What is linked to an input for shaders. Nothing: swallows all light."""
    found = graph.source(end) if end is not None else None
    if not isinstance(found, Output):
        return Closure()
    make = SHADERS.get(found.node.type)
    if make is None:
        translator.complain(found.node, "this shader is not supported; matt grey is used")
        return Closure(materials.Lambert(color=0.5))
    return make(translator, found)


def with_opacity(closure: Closure) -> Optional[materials.Material]:
    """The material of a closure, with its opacity in it."""
    material = closure.material
    if closure.mixed_opacity or values.is_constant(closure.opacity, 1):
        return material
    material = materials.Black() if material is None else material
    material.opacity = held(values.number(closure.opacity))
    return material


@shader("MIX_SHADER")
def mix_shader(translator: Translator, output: Output) -> Closure:
    from .fresnel import mixed_by_angle

    first, second = (closure_of(translator, graph.Input(output.node.inputs[i], output.groups)) for i in (1, 2))
    end = output.input("Fac")
    by_angle = mixed_by_angle(translator, end, first, second)
    if by_angle is not None:
        return by_angle
    whole = translator.context.moves and _may_change(output)
    return _sided(translator, output, blend(first, second, held(translator.number(end, 0.5)), whole), first, second)


def _sided(translator: Translator, output: Output, whole: Closure, *parts: Closure) -> Closure:
    """`whole`, which shines to the sides to which its parts do."""
    if any(whole is one for one in parts):
        return whole
    sides = {one.is_one_sided for one in parts if not values.is_constant(one.emission, 0)}
    if len(sides) > 1:
        translator.complain(output.node, "what shines to one side and to both shines to both")
    whole.is_one_sided = sides == {True}
    return whole


def _may_change(output: Output) -> bool:
    """Whether the tree of a node, or one around it, is animated or driven."""
    trees = (output.node.id_data, *(group.id_data for group in output.groups))
    return any(tree.animation_data is not None for tree in trees)


def blend(first: Closure, second: Closure, amount: Value, whole: bool = False) -> Closure:
    """first where amount is 0, second where it is 1. `whole`: at other moments it is something between, so that both
    have to be there now."""
    if not whole and values.is_constant(amount, 0):
        return first
    if not whole and values.is_constant(amount, 1):
        return second
    result = Closure()
    result.emission = values.total(
        values.product(first.emission, values.rest(amount)), values.product(second.emission, amount)
    )
    if whole:
        result.emission = values.mixed(first.emission, second.emission, amount, whole)
    result.opacity = values.mixed(first.opacity, second.opacity, amount, whole)
    result.medium = first.medium or second.medium
    if values.is_constant(first.opacity, 0):
        result.material, result.mixed_opacity = second.material, False
        if second.mixed_opacity:
            result.material, result.mixed_opacity = _mix(first, second, amount), True
    elif values.is_constant(second.opacity, 0):
        result.material, result.mixed_opacity = first.material, False
        if first.mixed_opacity:
            result.material, result.mixed_opacity = _mix(first, second, amount), True
    elif values.is_constant(first.opacity, 1) and values.is_constant(second.opacity, 1):
        both_black = first.material is None and second.material is None
        result.material = None if both_black else _mix(first, second, amount)
    else:
        result.material, result.mixed_opacity = _mix(first, second, amount), True
    return result


def _mix(first: Closure, second: Closure, amount: Value) -> materials.Mix:
    return materials.Mix(
        first=with_opacity(first) or materials.Black(), second=with_opacity(second) or materials.Black(), amount=amount
    )


@shader("ADD_SHADER")
def add_shader(translator: Translator, output: Output) -> Closure:
    first, second = (closure_of(translator, graph.Input(output.node.inputs[i], output.groups)) for i in (0, 1))
    emission = values.total(first.emission, second.emission)
    medium = first.medium or second.medium
    only = [one for one in (first, second) if one.material is not None or not values.is_constant(one.opacity, 1)]
    if len(only) < 2:
        one = only[0] if only else Closure()
        shines = not all(values.is_constant(other.emission, 0) for other in (first, second) if other is not one)
        if shines and values.is_texture(one.opacity):
            translator.complain(output.node, "where all light goes straight through, it does not shine")
        made = Closure(one.material, emission, one.opacity, medium, mixed_opacity=one.mixed_opacity)
        return _sided(translator, output, made, first, second)
    if all(_doubled(one.material) for one in (first, second)):
        made = blend(first, second, 0.5)
        made.emission, made.medium = emission, medium
        return _sided(translator, output, made, first, second)
    translator.complain(output.node, "the sum of these shaders would be more than all light; their mean is used")
    made = blend(first, second, 0.5)
    made.emission, made.medium = emission, medium
    return _sided(translator, output, made, first, second)


def _doubled(material: Optional[materials.Material]) -> bool:
    """Makes a material twice as bright, where it can be."""
    keys = {materials.Lambert: "color", materials.Glossy: "color", materials.DiffuseTransmission: "transmitted"}
    key = keys.get(type(material))  # type: ignore[arg-type]
    if key is None:
        return False
    color = getattr(material, key)
    if values.is_texture(color) or max(values.color(color)) > 0.5:
        return False
    setattr(material, key, [2 * part for part in values.color(color)])
    return True


def bright(translator: Translator, output: Output, strength: Value) -> Value:
    """The strength of an emission, not below 0; complains where it is."""
    if not values.is_texture(strength) and values.number(strength) < 0:
        translator.complain(output.node, "light below 0 is left out")
    return held(strength, 0.0, 1e18)


@shader("EMISSION")
def emission(translator: Translator, output: Output) -> Closure:
    strength = bright(translator, output, translator.number(output.input("Strength")))
    return Closure(None, values.product(translator.value(output.input("Color")), strength))


@shader("BSDF_TRANSPARENT")
def transparent(translator: Translator, output: Output) -> Closure:
    end = output.input("Color")
    color = translator.value(end)
    found = graph.source(end) if end is not None else None
    if values.is_texture(color):
        is_coloured = isinstance(found, Output) and found.socket.type == "RGBA" and not graph.becomes_grey(end)
    else:
        is_coloured = len(set(values.color(color))) > 1
    if is_coloured:
        translator.complain(output.node, "what lets light straight through has no colour in the job; its luminance is used")
    return Closure(None, 0.0, values.rest(held(values.number(color))))


@shader("HOLDOUT")
def holdout(translator: Translator, output: Output) -> Closure:
    translator.complain(output.node, "a holdout is black, and not transparent")
    return Closure()
