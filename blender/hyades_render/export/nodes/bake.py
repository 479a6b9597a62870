"""Graphs that no texture of the job means, computed and kept as a picture in which every triangle has a place of its own."""

from __future__ import annotations

from typing import Any

import numpy
from hyades import textures

from ..meshes import across
from . import values
from .evaluate import Evaluator
from .graph import Input
from .surface import PartOfSurface, PartPoints
from .translator import Inexpressible, Translator, default_of

Array = Any
DEFAULT_SIDE = 1024
_EDGE = 1.5  # texels between a triangle and the end of its square
_LEAST = 4  # texels along a square
_LARGEST = 4096
_AT_ONCE = 1 << 16


def texture_of(translator: Translator, end: Input, reason: Inexpressible) -> values.Value:
    """The graph behind an input as a baked picture; its default, with a complaint, where that cannot be."""
    part = translator.surface
    if part is None:
        translator.complain(reason.node, f"{reason.why}; '{end.socket.name}' of {end.socket.node.name} keeps its default")
        return default_of(end.socket)
    translator.is_of_surface = True
    if not translator.context.setting("bake", True):
        translator.complain(reason.node, f"{reason.why}, and nothing is to be baked; the mean is used")
        return mean_of(translator, end)
    try:
        if part.atlas is None:
            part.atlas = Atlas(part, int(translator.context.setting("bake_size", DEFAULT_SIDE)))
        picture = part.atlas.picture(translator, end)
    except Inexpressible as why:
        translator.complain(why.node, f"{why.why}; '{end.socket.name}' of {end.socket.node.name} keeps its default")
        return default_of(end.socket)
    except AtlasTooLarge as why:
        translator.complain(reason.node, f"{reason.why}, and {why}; the mean is used")
        return mean_of(translator, end)
    translator.baked = True
    return textures.Image(file=picture, color_space="linear", wrap="clamp", filter="bilinear", mapping="uv1")


def mean_of(translator: Translator, end: Input) -> values.Value:
    """The mean of a graph over the surface's area; the input's default where that cannot be computed."""
    part = translator.surface
    translator.is_of_surface = True
    if part is None or not len(part.triangles):
        return default_of(end.socket)
    corners = part.corners()
    area = numpy.linalg.norm(across(corners), axis=1)
    random = numpy.random.default_rng(1)
    chosen = random.choice(len(area), 4096, p=area / area.sum()) if area.sum() > 0 else numpy.zeros(1, int)
    u, v = numpy.sqrt(random.random(len(chosen))), random.random(len(chosen))
    weights = numpy.stack([1 - u, u * (1 - v), u * v], axis=1)
    try:
        value = Evaluator(translator, PartPoints(part, chosen, weights)).input(end)
    except Inexpressible as why:
        translator.complain(why.node, f"{why.why}; '{end.socket.name}' keeps its default")
        return default_of(end.socket)
    if end.socket.type == "VALUE":
        return float(value.mean())
    return values.color(value.reshape(-1, 3).mean(axis=0))


class AtlasTooLarge(Exception):
    """A mesh has too many triangles for a picture."""


class Atlas:
    """A square for each triangle, in its lower left half, in a picture of 2^k texels along each side."""

    def __init__(self, part: PartOfSurface, side: int) -> None:
        self.part = part
        corners = part.corners().astype("float64")
        arms = corners[:, [1, 2, 0]] - corners
        longest = numpy.linalg.norm(arms, axis=2).max(axis=1)
        exponents, self.side = _sizes(longest, max(side, 64))
        self.exponents = exponents
        self.corner = _places(exponents)
        self.pictures: dict[Any, Array] = {}

    def uv(self) -> Array:
        """(t, 3, 2): where the corners of the triangles are in the picture, 0 to 1 from the lower left."""
        size = 2.0**self.exponents
        low, high = self.corner + _EDGE, self.corner + (size - _EDGE)[:, None]
        second = numpy.stack([high[:, 0], low[:, 1]], axis=1)
        third = numpy.stack([low[:, 0], high[:, 1]], axis=1)
        return numpy.stack([low, second, third], axis=1) / self.side

    def picture(self, translator: Translator, end: Input) -> Array:
        """Light (side, side, 3), row 0 at the top."""
        key = (end.socket.node.as_pointer(), end.socket.identifier, tuple(g.as_pointer() for g in end.groups))
        if key not in self.pictures:
            self.pictures[key] = self._computed(translator, end)
        return self.pictures[key]

    def _computed(self, translator: Translator, end: Input) -> Array:
        result = numpy.zeros((self.side, self.side, 3), "float32")
        for exponent in numpy.unique(self.exponents):
            chosen = numpy.flatnonzero(self.exponents == exponent)
            size = 1 << int(exponent)
            step = max(_AT_ONCE // (size * size), 1)
            for begin in range(0, len(chosen), step):
                self._fill(translator, end, chosen[begin : begin + step], size, result)
        return result[::-1]

    def _fill(self, translator: Translator, end: Input, chosen: Array, size: int, result: Array) -> None:
        y, x = (axis.reshape(-1) for axis in numpy.mgrid[0:size, 0:size])
        span = size - 2 * _EDGE
        b, c = (x + 0.5 - _EDGE) / span, (y + 0.5 - _EDGE) / span
        # A texel beyond each edge, from which pictures are interpolated; the rest is nobody's.
        needed = (b + c <= 1 + 2.5 / span) & (b >= -1.5 / span) & (c >= -1.5 / span)
        x, y, b, c = x[needed], y[needed], b[needed], c[needed]
        weights = numpy.stack([1 - b - c, b, c], axis=1)
        triangles = numpy.repeat(chosen, len(x))
        points = PartPoints(self.part, triangles, numpy.tile(weights, (len(chosen), 1)))
        value = Evaluator(translator, points).input(end)
        value = value[..., None] if end.socket.type == "VALUE" else value
        value = numpy.broadcast_to(value, (len(triangles), 3))
        px = (self.corner[chosen, 0][:, None] + x).reshape(-1)
        py = (self.corner[chosen, 1][:, None] + y).reshape(-1)
        result[py, px] = numpy.clip(numpy.nan_to_num(value), 0, 1e6)


def _sizes(longest: Array, side: int) -> tuple[Array, int]:
    """Exponents (t,) of the squares' sides, as `longest` edges want them, and the side of the picture."""
    least = int(numpy.log2(_LEAST))
    while side * side < len(longest) * _LEAST * _LEAST:
        side *= 2
        if side > _LARGEST:
            raise AtlasTooLarge(f"{len(longest)} triangles are too many to bake")
    side = 1 << int(numpy.ceil(numpy.log2(side)))
    relative = numpy.log2(numpy.maximum(longest / max(float(longest.max()), 1e-30), 1e-9))
    for most in range(int(numpy.log2(side)), least - 1, -1):
        exponents = numpy.maximum(numpy.round(most + relative), least).astype(int)
        if (4.0**exponents).sum() <= side * side:
            break
    return exponents, side


def _places(exponents: Array) -> Array:
    """Lower left corners (t, 2): squares in falling order along Morton's curve fit without a gap."""
    order = numpy.argsort(-exponents, kind="stable")
    areas = 4 ** exponents[order].astype("int64")
    along = numpy.concatenate([[0], numpy.cumsum(areas)[:-1]])
    places = numpy.empty((len(exponents), 2), int)
    places[order, 0], places[order, 1] = _every_other_bit(along), _every_other_bit(along >> 1)
    return places


def _every_other_bit(x: Array) -> Array:
    result = numpy.zeros_like(x)
    for bit in range(24):
        result |= ((x >> (2 * bit)) & 1) << bit
    return result
