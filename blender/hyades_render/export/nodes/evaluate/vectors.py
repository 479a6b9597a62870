"""Nodes Vector Math, Mapping, Vector Rotate and Normal."""

from __future__ import annotations

from typing import Any

import numpy

from ..graph import Output
from ..mappings import rotation
from ..translator import Inexpressible
from .evaluator import Evaluator, computes, stacked
from .maths import OPERATIONS

Array = Any


def dot(a: Array, b: Array) -> Array:
    return (a * b).sum(axis=-1)


def length(a: Array) -> Array:
    return numpy.sqrt(dot(a, a))


def normalized(a: Array) -> Array:
    return a / numpy.maximum(length(a), 1e-30)[..., None]


def _project(a: Array, b: Array) -> Array:
    square = dot(b, b)
    return numpy.where(square == 0, 0, dot(a, b) / numpy.where(square == 0, 1, square))[..., None] * b


def _refract(a: Array, b: Array, ior: Array) -> Array:
    normal = normalized(b)
    cosine = dot(normal, a)
    k = 1 - ior * ior * (1 - cosine * cosine)
    bent = ior[..., None] * a - (ior * cosine + numpy.sqrt(numpy.maximum(k, 0)))[..., None] * normal
    return numpy.where((k < 0)[..., None], 0, bent)


_SAME_AS_NUMBERS = {"ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MULTIPLY_ADD", "MINIMUM", "MAXIMUM", "FLOOR", "CEIL",
                    "MODULO", "WRAP", "SNAP", "SINE", "COSINE", "TANGENT", "POWER", "SIGN"}


@computes("VECT_MATH")
def vector_math(at: Evaluator, output: Output) -> Array:
    kind = output.node.operation
    a, b, c = (at.vector(output, name) for name in ("Vector", "Vector_001", "Vector_002"))
    if kind in _SAME_AS_NUMBERS:
        return OPERATIONS[kind](a, b, c)
    if kind == "ABSOLUTE":
        return numpy.abs(a)
    if kind == "FRACTION":
        return a - numpy.floor(a)
    if kind == "CROSS_PRODUCT":
        return numpy.cross(a, b)
    if kind == "DOT_PRODUCT":
        return dot(a, b)
    if kind == "LENGTH":
        return length(a)
    if kind == "DISTANCE":
        return length(a - b)
    if kind == "NORMALIZE":
        return normalized(a)
    if kind == "SCALE":
        return a * at.number(output, "Scale")[..., None]
    if kind == "PROJECT":
        return _project(a, b)
    if kind == "REFLECT":
        normal = normalized(b)
        return a - 2 * normal * dot(a, normal)[..., None]
    if kind == "REFRACT":
        return _refract(a, b, at.number(output, "Scale"))
    if kind == "FACEFORWARD":
        return numpy.where((dot(c, b) < 0)[..., None], a, -a)
    raise Inexpressible(output, f"the operation {kind.lower()} is not supported")


@computes("MAPPING")
def mapping(at: Evaluator, output: Output) -> Array:
    kind = output.node.vector_type
    vector, scale = at.vector(output, "Vector"), at.vector(output, "Scale")
    angles, location = at.vector(output, "Rotation"), at.vector(output, "Location")
    if angles.ndim != 1:
        raise Inexpressible(output, "a rotation that changes from place to place is not supported")
    turn = rotation(angles)
    safe = numpy.where(scale == 0, 1, scale)
    if kind == "POINT":
        return (vector * scale) @ turn.T + location
    if kind == "TEXTURE":
        return numpy.where(scale == 0, 0, ((vector - location) @ turn) / safe)
    if kind == "VECTOR":
        return (vector * scale) @ turn.T
    return normalized(numpy.where(scale == 0, 0, vector / safe) @ turn.T)


@computes("VECTOR_ROTATE")
def vector_rotate(at: Evaluator, output: Output) -> Array:
    node = output.node
    vector, centre = at.vector(output, "Vector"), at.vector(output, "Center")
    sign = -1.0 if node.invert else 1.0
    if node.rotation_type == "EULER_XYZ":
        turn = rotation(at.vector(output, "Rotation").reshape(-1, 3)[0])
        return (vector - centre) @ (turn if node.invert else turn.T) + centre
    fixed = {"X_AXIS": (1, 0, 0), "Y_AXIS": (0, 1, 0), "Z_AXIS": (0, 0, 1)}.get(node.rotation_type)
    axis = normalized(at.vector(output, "Axis") if fixed is None else numpy.array(fixed, float))
    angle = sign * at.number(output, "Angle")
    cosine, sine = numpy.cos(angle)[..., None], numpy.sin(angle)[..., None]
    arm = vector - centre
    return arm * cosine + numpy.cross(axis, arm) * sine + axis * dot(axis, arm)[..., None] * (1 - cosine) + centre


@computes("NORMAL")
def normal(at: Evaluator, output: Output) -> Array:
    axis = normalized(numpy.array(output.node.outputs["Normal"].default_value))
    return axis if output.socket.identifier == "Normal" else dot(axis, normalized(at.vector(output, "Normal")))


@computes("VECT_TRANSFORM")
def vector_transform(at: Evaluator, output: Output) -> Array:
    node = output.node
    vector = at.vector(output, "Vector")
    spaces = (node.convert_from, node.convert_to)
    if spaces[0] == spaces[1]:
        return vector
    if "CAMERA" in spaces:
        raise Inexpressible(output, "the camera's space is not supported")
    matrix = at.points.matrix()
    matrix = matrix if spaces == ("OBJECT", "WORLD") else numpy.linalg.inv(matrix)
    if node.vector_type == "NORMAL":
        return normalized(vector @ numpy.linalg.inv(matrix[:3, :3]))
    moved = vector @ matrix[:3, :3].T
    return moved + matrix[:3, 3] if node.vector_type == "POINT" else moved


__all__ = ["dot", "length", "normalized", "rotation", "stacked"]
