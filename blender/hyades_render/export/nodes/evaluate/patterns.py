"""Nodes Checker, Gradient, Wave, Magic and Brick Texture."""

from __future__ import annotations

from typing import Any

import numpy

from ..graph import Output
from .evaluator import Evaluator, computes, stacked
from .noise import fractal

Array = Any


def _scaled(at: Evaluator, output: Output) -> Array:
    return numpy.atleast_2d(at.place(output)) * numpy.atleast_1d(at.number(output, "Scale", default=1.0))[:, None]


def _nudged(place: Array) -> Array:
    """Away from whole numbers, where what is next to them would decide."""
    return (place + 0.000001) * 0.999999


@computes("TEX_CHECKER")
def checker(at: Evaluator, output: Output) -> Array:
    cell = numpy.floor(_nudged(_scaled(at, output))).astype("int64")
    first = (cell.sum(axis=1) & 1) == 1
    if output.socket.type == "VALUE":
        return first * 1.0
    return numpy.where(first[:, None], at.color(output, "Color1"), at.color(output, "Color2"))


@computes("TEX_GRADIENT")
def gradient(at: Evaluator, output: Output) -> Array:
    place = numpy.atleast_2d(at.place(output))
    x, y = place[:, 0], place[:, 1]
    kind = output.node.gradient_type
    if kind == "LINEAR":
        value = x
    elif kind == "QUADRATIC":
        value = numpy.maximum(x, 0) ** 2
    elif kind == "EASING":
        held = numpy.clip(x, 0, 1)
        value = held * held * (3 - 2 * held)
    elif kind == "DIAGONAL":
        value = (x + y) / 2
    elif kind == "RADIAL":
        value = numpy.arctan2(y, x) / (2 * numpy.pi) + 0.5
    else:
        value = numpy.maximum(0.999999 - numpy.sqrt((place**2).sum(axis=1)), 0)
        value = value if kind == "SPHERICAL" else value**2
    value = numpy.clip(value, 0, 1)
    return value if output.socket.type == "VALUE" else stacked(value, value, value)


@computes("TEX_WAVE")
def wave(at: Evaluator, output: Output) -> Array:
    node = output.node
    place = _nudged(_scaled(at, output))
    if node.wave_type == "BANDS":
        turns = place.sum(axis=1) * 10 if node.bands_direction == "DIAGONAL" else (
            place[:, "XYZ".index(node.bands_direction)] * 20)
    else:
        ring = place.copy()
        if node.rings_direction != "SPHERICAL":
            ring[:, "XYZ".index(node.rings_direction)] = 0
        turns = numpy.sqrt((ring**2).sum(axis=1)) * 20
    turns = turns + at.number(output, "Phase Offset", default=0.0)
    distortion = at.number(output, "Distortion")
    if numpy.any(distortion != 0):
        finer = place * numpy.atleast_1d(at.number(output, "Detail Scale"))[:, None]
        noise = fractal(finer, at.number(output, "Detail"), at.number(output, "Detail Roughness", default=0.5))
        turns = turns + distortion * (noise * 2 - 1)
    if node.wave_profile == "SIN":
        value = 0.5 + 0.5 * numpy.sin(turns - numpy.pi / 2)
    else:
        turns = turns / (2 * numpy.pi)
        saw = turns - numpy.floor(turns)
        value = saw if node.wave_profile == "SAW" else numpy.abs(turns - numpy.floor(turns + 0.5)) * 2
    return value if output.socket.type == "VALUE" else stacked(value, value, value)


@computes("TEX_MAGIC")
def magic(at: Evaluator, output: Output) -> Array:
    place = numpy.fmod(_scaled(at, output), 2 * numpy.pi)
    px, py, pz = place[:, 0], place[:, 1], place[:, 2]
    bend = at.number(output, "Distortion")
    x, y = numpy.sin((px + py + pz) * 5), numpy.cos((-px + py - pz) * 5)
    z = -numpy.cos((-px - py + pz) * 5)
    depth = output.node.turbulence_depth
    if depth > 0:
        x, y, z = x * bend, y * bend, z * bend
        y = -numpy.cos(x - y + z) * bend
    # Each depth bends one of the three by all of them: which, by what function, and the signs of x, y and z.
    rounds = (("x", numpy.cos, 1, (1, -1, -1)), ("z", numpy.sin, 1, (-1, -1, -1)), ("x", numpy.cos, -1, (-1, 1, -1)),
              ("y", numpy.sin, -1, (-1, 1, 1)), ("y", numpy.cos, -1, (-1, 1, 1)), ("x", numpy.cos, 1, (1, 1, 1)),
              ("z", numpy.sin, 1, (1, 1, -1)), ("x", numpy.cos, -1, (-1, -1, 1)), ("y", numpy.sin, -1, (1, -1, 1)))
    for which, function, sign, (sx, sy, sz) in rounds[: max(depth - 1, 0)]:
        value = sign * function(sx * x + sy * y + sz * z) * bend
        x, y, z = (value if which == name else old for name, old in zip("xyz", (x, y, z)))
    twice = numpy.where(bend != 0, bend * 2, 1)
    color = stacked(*(0.5 - numpy.where(bend != 0, part / twice, part) for part in (x, y, z)))
    return color.mean(axis=1) if output.socket.type == "VALUE" else color


def _integer_noise(n: Array) -> Array:
    """A random number 0..1 of whole ones."""
    mask = numpy.int64(0x7FFFFFFF)
    with numpy.errstate(over="ignore"):
        s = (n + 1013) & mask
        s = (s >> 13) ^ s
        square = (s * s) & 0xFFFFFFFF
        inner = (square * 60493 + 19990303) & 0xFFFFFFFF
        s = (s * inner + 1376312589) & mask
    return 0.5 * (s / 1073741824.0)


@computes("TEX_BRICK")
def brick(at: Evaluator, output: Output) -> Array:
    node = output.node
    place = _scaled(at, output)
    x, y = place[:, 0], place[:, 1]
    width, height = at.number(output, "Brick Width"), at.number(output, "Row Height")
    row = numpy.floor(y / height)
    shift = numpy.zeros_like(x)
    if node.offset_frequency and node.squash_frequency:
        width = width * numpy.where(row % node.squash_frequency == 0, node.squash, 1.0)
        shift = numpy.where(row % node.offset_frequency == 0, width * node.offset, 0.0)
    number = numpy.floor((x + shift) / width)
    dx, dy = x + shift - width * number, y - height * row
    key = (row.astype("int64") << 16) + (number.astype("int64") & 0xFFFF)
    tint = numpy.clip(_integer_noise(key) + at.number(output, "Bias"), 0, 1)
    far = numpy.minimum(numpy.minimum(dx, dy), numpy.minimum(width - dx, height - dy))
    size, smooth = at.number(output, "Mortar Size"), at.number(output, "Mortar Smooth", default=0.0)
    deep = 1 - far / numpy.where(size == 0, 1, size)
    share = numpy.clip(deep / numpy.where(smooth == 0, 1, smooth), 0, 1)
    mortar = numpy.where(smooth == 0, 1.0, share * share * (3 - 2 * share))
    mortar = numpy.where(far >= size, 0.0, mortar)
    if output.socket.type == "VALUE":
        return mortar
    t, m = tint[:, None], mortar[:, None]
    body = at.color(output, "Color1") * (1 - t) + at.color(output, "Color2") * t
    return body * (1 - m) + at.color(output, "Mortar") * m
