"""Nodes Math, Clamp, Map Range and Float Curve."""

from __future__ import annotations

from typing import Any

import numpy

from ..graph import Output
from ..translator import Inexpressible
from .evaluator import Evaluator, computes

Array = Any


def _safe(function: Any) -> Any:
    """0 where the function has no value."""

    def computed(*arguments: Array) -> Array:
        with numpy.errstate(all="ignore"):
            return numpy.nan_to_num(function(*arguments), nan=0.0, posinf=0.0, neginf=0.0)

    return computed


def _wrap(a: Array, high: Array, low: Array) -> Array:
    span = high - low
    return numpy.where(span != 0, a - span * numpy.floor((a - low) / numpy.where(span == 0, 1, span)), low)


def _ping_pong(a: Array, scale: Array) -> Array:
    s = numpy.where(scale == 0, 1, scale)
    return numpy.where(scale == 0, 0, numpy.abs(((a - s) / (s * 2) - numpy.floor((a - s) / (s * 2)) - 0.5) * 2 * s))


def _smooth_min(a: Array, b: Array, width: Array) -> Array:
    w = numpy.where(width == 0, 1, width)
    h = numpy.maximum(w - numpy.abs(a - b), 0) / w
    return numpy.where(width == 0, numpy.minimum(a, b), numpy.minimum(a, b) - h * h * h * w / 6)


OPERATIONS: dict[str, Any] = {
    "ADD": lambda a, b, c: a + b,
    "SUBTRACT": lambda a, b, c: a - b,
    "MULTIPLY": lambda a, b, c: a * b,
    "DIVIDE": _safe(lambda a, b, c: a / b),
    "MULTIPLY_ADD": lambda a, b, c: a * b + c,
    "POWER": _safe(lambda a, b, c: numpy.power(a, b)),
    "LOGARITHM": _safe(lambda a, b, c: numpy.log(a) / numpy.log(b)),
    "SQRT": lambda a, b, c: numpy.sqrt(numpy.maximum(a, 0)),
    "INVERSE_SQRT": _safe(lambda a, b, c: 1 / numpy.sqrt(a)),
    "ABSOLUTE": lambda a, b, c: numpy.abs(a),
    "EXPONENT": lambda a, b, c: numpy.exp(a),
    "MINIMUM": lambda a, b, c: numpy.minimum(a, b),
    "MAXIMUM": lambda a, b, c: numpy.maximum(a, b),
    "LESS_THAN": lambda a, b, c: (a < b) * 1.0,
    "GREATER_THAN": lambda a, b, c: (a > b) * 1.0,
    "SIGN": lambda a, b, c: numpy.sign(a),
    "COMPARE": lambda a, b, c: (numpy.abs(a - b) <= numpy.maximum(c, 1e-5)) * 1.0,
    "SMOOTH_MIN": _smooth_min,
    "SMOOTH_MAX": lambda a, b, c: -_smooth_min(-a, -b, c),
    "ROUND": lambda a, b, c: numpy.floor(a + 0.5),
    "FLOOR": lambda a, b, c: numpy.floor(a),
    "CEIL": lambda a, b, c: numpy.ceil(a),
    "TRUNC": lambda a, b, c: numpy.trunc(a),
    "FRACT": lambda a, b, c: a - numpy.floor(a),
    "MODULO": _safe(lambda a, b, c: numpy.fmod(a, b)),
    "FLOORED_MODULO": _safe(lambda a, b, c: numpy.mod(a, b)),
    "WRAP": _wrap,
    "SNAP": _safe(lambda a, b, c: numpy.floor(a / b) * b),
    "PINGPONG": lambda a, b, c: _ping_pong(a, b),
    "SINE": lambda a, b, c: numpy.sin(a),
    "COSINE": lambda a, b, c: numpy.cos(a),
    "TANGENT": lambda a, b, c: numpy.tan(a),
    "ARCSINE": lambda a, b, c: numpy.arcsin(numpy.clip(a, -1, 1)),
    "ARCCOSINE": lambda a, b, c: numpy.arccos(numpy.clip(a, -1, 1)),
    "ARCTANGENT": lambda a, b, c: numpy.arctan(a),
    "ARCTAN2": lambda a, b, c: numpy.arctan2(a, b),
    "SINH": lambda a, b, c: numpy.sinh(a),
    "COSH": lambda a, b, c: numpy.cosh(a),
    "TANH": lambda a, b, c: numpy.tanh(a),
    "RADIANS": lambda a, b, c: numpy.radians(a),
    "DEGREES": lambda a, b, c: numpy.degrees(a),
}


@computes("MATH")
def math(at: Evaluator, output: Output) -> Array:
    node = output.node
    operation = OPERATIONS.get(node.operation)
    if operation is None:
        raise Inexpressible(output, f"the operation {node.operation.lower()} is not supported")
    # The three inputs have the same name; identifiers tell them apart.
    a, b, c = (at.number(output, name) for name in ("Value", "Value_001", "Value_002"))
    result = operation(a, b, c)
    return numpy.clip(result, 0, 1) if node.use_clamp else result


@computes("CLAMP")
def clamp(at: Evaluator, output: Output) -> Array:
    low, high = at.number(output, "Min"), at.number(output, "Max")
    if output.node.clamp_type == "RANGE":
        low, high = numpy.minimum(low, high), numpy.maximum(low, high)
    return numpy.minimum(numpy.maximum(at.number(output, "Value"), low), high)


@computes("MAP_RANGE")
def map_range(at: Evaluator, output: Output) -> Array:
    node = output.node
    is_vector = getattr(node, "data_type", "FLOAT") == "FLOAT_VECTOR"
    get = at.vector if is_vector else at.number
    # Of inputs with the same name only those of the node's data type are enabled.
    names = ("Vector", "From_Min_FLOAT3", "From_Max_FLOAT3", "To_Min_FLOAT3", "To_Max_FLOAT3") if is_vector else (
        "Value", "From Min", "From Max", "To Min", "To Max")
    value, low, high, to_low, to_high = (get(output, name) for name in names)
    span = high - low
    share = numpy.where(span != 0, (value - low) / numpy.where(span == 0, 1, span), 0.0)
    kind = node.interpolation_type
    if kind == "STEPPED":
        count = get(output, "Steps_FLOAT3" if is_vector else "Steps", default=4.0)
        share = numpy.where(count > 0, numpy.floor(share * (count + 1)) / numpy.where(count > 0, count, 1), 0.0)
    elif kind in ("SMOOTHSTEP", "SMOOTHERSTEP"):
        share = numpy.clip(share, 0, 1)
        smooth = share * share * (3 - 2 * share)
        share = smooth if kind == "SMOOTHSTEP" else share**3 * (share * (share * 6 - 15) + 10)
    result = to_low + share * (to_high - to_low)
    if node.clamp and kind in ("LINEAR", "STEPPED"):
        result = numpy.clip(result, numpy.minimum(to_low, to_high), numpy.maximum(to_low, to_high))
    return result


@computes("CURVE_FLOAT")
def float_curve(at: Evaluator, output: Output) -> Array:
    from .colors import curve_at

    value = at.number(output, "Value")
    mapping = output.node.mapping
    mapping.initialize()
    return value + (curve_at(mapping, 0, value) - value) * at.number(output, "Factor", "Fac", default=1.0)
