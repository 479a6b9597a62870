"""Nodes Texture Coordinate, UV Map and Geometry."""

from __future__ import annotations

from typing import Any

import numpy

from ...axes import array
from ..graph import Output
from ..translator import Inexpressible
from .evaluator import Evaluator, computes, with_zero
from .points import transformed, turned

Array = Any


@computes("TEX_COORD")
def texture_coordinate(at: Evaluator, output: Output) -> Array:
    kind = output.socket.identifier
    _refuse_instancer(output)
    if kind == "Generated":
        return at.points.generated()
    if kind == "UV":
        return with_zero(at.points.uv(""))
    if kind == "Normal":
        return at.points.normal()
    if kind == "Object":
        other = output.node.object
        if other is None:
            return at.points.position()
        world = transformed(at.points.matrix(), at.points.position())
        there = numpy.linalg.inv(array(other.evaluated_get(at.translator.context.depsgraph).matrix_world))
        return transformed(there, world)
    raise Inexpressible(output, f"coordinates by {kind.lower()} are not supported")


@computes("UVMAP")
def uv_map(at: Evaluator, output: Output) -> Array:
    _refuse_instancer(output)
    return with_zero(at.points.uv(output.node.uv_map))


def _refuse_instancer(output: Output) -> None:
    if output.node.from_instancer:
        raise Inexpressible(output, "coordinates of what instances an object are not supported")


@computes("NEW_GEOMETRY")
def geometry(at: Evaluator, output: Output) -> Array:
    kind = output.socket.identifier
    if kind == "Position":
        return transformed(at.points.matrix(), at.points.position())
    if kind == "Normal":
        return turned(at.points.matrix(), at.points.normal())
    if kind == "True Normal":
        return turned(at.points.matrix(), at.points.true_normal())
    if kind == "Backfacing":
        raise Inexpressible(output, "which side is seen is not known while it is computed")
    raise Inexpressible(output, f"'{output.socket.name}' is not supported")
