"""Nodes Attribute, Color Attribute and Object Info."""

from __future__ import annotations

from typing import Any

import numpy

from ..graph import Output
from ..translator import Inexpressible
from .evaluator import Evaluator, computes

Array = Any


@computes("VERTEX_COLOR")
def color_attribute(at: Evaluator, output: Output) -> Array:
    color = at.points.color(output.node.layer_name)
    return color[:, 3] if output.socket.identifier == "Alpha" else color[:, :3]


@computes("ATTRIBUTE")
def attribute(at: Evaluator, output: Output) -> Array:
    node = output.node
    if node.attribute_type != "GEOMETRY":
        return _of_object(at, output)
    if output.socket.identifier == "Alpha":
        return at.points.alpha(node.attribute_name)
    value = at.points.attribute(node.attribute_name)
    return value.mean(axis=-1) if output.socket.identifier == "Fac" else value


def _of_object(at: Evaluator, output: Output) -> Array:
    """A property of the object, or of its data; or first of what instances it."""
    object, name = at.points.object(), output.node.attribute_name
    if output.node.attribute_type not in ("OBJECT", "INSTANCER"):
        raise Inexpressible(output, "attributes of the view layer are not supported")
    instancer = at.points.origin().instancer if output.node.attribute_type == "INSTANCER" else None
    owners = [] if instancer is None else [instancer, instancer.data]
    for owner in (*owners, object, object.data):
        found = owner.get(name, getattr(owner, name, None)) if owner is not None else None
        if found is not None:
            value = numpy.atleast_1d(numpy.array(found, float))
            value = numpy.repeat(value, 3)[:3] if len(value) == 1 else value[:3]
            return value.mean() if output.socket.identifier == "Fac" else value
    if instancer is not None:
        raise Inexpressible(output, f"attributes that geometry nodes give to instances ('{name}') are not supported")
    return numpy.zeros(3) if output.socket.identifier != "Fac" else numpy.zeros(())


@computes("OBJECT_INFO")
def object_info(at: Evaluator, output: Output) -> Array:
    object, kind = at.points.object(), output.socket.identifier
    if kind == "Location":
        return numpy.asarray(at.points.matrix())[:3, 3]  # of a copy: where that is
    if kind == "Color":
        return numpy.array(object.color[:3])
    if kind == "Alpha":
        return numpy.asarray(object.color[3])
    if kind == "Random":
        return numpy.asarray(at.points.origin().random)
    if kind == "Object Index":
        return numpy.asarray(float(object.pass_index))
    if kind == "Material Index":
        return numpy.asarray(float(at.translator.material.pass_index))
    raise Inexpressible(output, f"'{output.socket.name}' is not supported")


@computes("LIGHT_PATH")
def light_path(at: Evaluator, output: Output) -> Array:
    """One answer for all rays: what is met is the same however it is met."""
    is_camera = output.socket.identifier == "Is Camera Ray" and not at.translator.where.startswith("world")
    what = "a camera's ray" if not at.translator.where.startswith("world") else "light that falls on the scene"
    at.translator.complain(output.node, f"the answer is the same for all rays, that for {what}")
    return numpy.asarray(1.0 if is_camera or output.socket.identifier == "Ray Length" else 0.0)
