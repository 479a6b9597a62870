"""Nodes Image Texture and Environment Texture: pictures looked up bilinearly."""

from __future__ import annotations

from typing import Any

import numpy

from ..graph import Output
from ..pixels import pixels_of
from ..translator import Inexpressible
from .evaluator import Evaluator, computes

Array = Any


def looked_up(pixels: Array, u: Array, v: Array, extension: str, interpolation: str) -> Array:
    """Colours (n, 4) at (u, v), (0, 0) being the lower left corner."""
    height, width = pixels.shape[:2]
    if interpolation == "Closest":
        x, y = numpy.floor(u * width).astype(int), numpy.floor(v * height).astype(int)
        return _texel(pixels, x, y, extension)
    x, y = u * width - 0.5, v * height - 0.5
    left, low = numpy.floor(x).astype(int), numpy.floor(y).astype(int)
    fx, fy = (x - left)[:, None], (y - low)[:, None]
    rows = [_texel(pixels, left, low + dy, extension) * (1 - fx) + _texel(pixels, left + 1, low + dy, extension) * fx
            for dy in (0, 1)]
    return rows[0] * (1 - fy) + rows[1] * fy


def _texel(pixels: Array, x: Array, y: Array, extension: str) -> Array:
    height, width = pixels.shape[:2]
    if extension == "REPEAT":
        return pixels[y % height, x % width]
    if extension == "MIRROR":
        x, y = x % (2 * width), y % (2 * height)
        return pixels[numpy.where(y < height, y, 2 * height - 1 - y), numpy.where(x < width, x, 2 * width - 1 - x)]
    found = pixels[numpy.clip(y, 0, height - 1), numpy.clip(x, 0, width - 1)]
    outside = (x < 0) | (x >= width) | (y < 0) | (y >= height)
    return numpy.where(outside[:, None] & (extension == "CLIP"), 0, found)


def _projected(at: Evaluator, node: Any, place: Array) -> list[tuple[Array, Array, Array]]:
    """Where a node looks up its image for places (n, 3): shares, u and v."""
    all_of_it = numpy.ones(len(place))
    if node.projection == "BOX":
        normal = at.points.normal()
        x, y, z = place.T
        shares = _box_shares(numpy.abs(normal), node.projection_blend)
        sides = ((normal[:, 0] < 0, y, z), (normal[:, 1] > 0, x, z), (normal[:, 2] > 0, y, x))
        return [(share, numpy.where(mirrored, 1 - u, u), v) for share, (mirrored, u, v) in zip(shares.T, sides)]
    if node.projection == "FLAT":
        return [(all_of_it, place[:, 0], place[:, 1])]
    x, y, z = (2 * place - 1).T
    u = (1 - numpy.arctan2(x, y) / numpy.pi) / 2
    if node.projection == "TUBE":
        return [(all_of_it, u, (z + 1) / 2)]
    length = numpy.maximum(numpy.sqrt(x * x + y * y + z * z), 1e-20)
    return [(all_of_it, u, 1 - numpy.arccos(numpy.clip(z / length, -1, 1)) / numpy.pi)]


def _box_shares(normal: Array, blend: float) -> Array:
    """(n, 3): how much the sides of a box across x, y and z give where normals (n, 3), without signs, point; as Cycles
    blends them."""
    normal = normal / numpy.maximum(normal.sum(axis=1, keepdims=True), 1e-20)
    limit = 0.5 * (1 + blend)
    shares = numpy.zeros_like(normal)
    left = numpy.ones(len(normal), bool)
    for side in range(3):
        others = [normal[:, side] + normal[:, other] for other in range(3) if other != side]
        alone = left & (normal[:, side] > limit * others[0]) & (normal[:, side] > limit * others[1])
        shares[alone, side] = 1
        left &= ~alone
    if blend <= 0:
        shares[left, 0] = 1
        return shares
    for first, second, third in ((0, 1, 2), (1, 2, 0), (0, 2, 1)):
        two = left & (normal[:, third] < (1 - limit) * (normal[:, first] + normal[:, second]))
        share = normal[two, first] / (normal[two, first] + normal[two, second])
        shares[two, first] = numpy.clip((share - 0.5 * (1 - blend)) / blend, 0, 1)
        shares[two, second] = 1 - shares[two, first]
        left &= ~two
    shares[left] = ((2 - limit) * normal[left] + limit - 1) / (2 * limit - 1)
    return shares


@computes("TEX_IMAGE")
def image_texture(at: Evaluator, output: Output) -> Array:
    node = output.node
    if node.image is None:
        raise Inexpressible(output, "there is no image")
    if node.image.source not in ("FILE", "GENERATED"):
        raise Inexpressible(output, f"images of source {node.image.source.lower()} cannot be computed")
    if output.socket.identifier == "Alpha" and node.image.alpha_mode == "NONE":
        return numpy.asarray(1.0)
    place = numpy.atleast_2d(at.place(output, "uv"))
    pixels = pixels_of(output, at.translator.context)
    found = sum(
        share[:, None] * looked_up(pixels, u, v, node.extension, node.interpolation)
        for share, u, v in _projected(at, node, place)
    )
    if output.socket.identifier == "Alpha":
        return found[:, 3]
    return found[:, :3]


@computes("TEX_ENVIRONMENT")
def environment_texture(at: Evaluator, output: Output) -> Array:
    node = output.node
    if node.image is None:
        raise Inexpressible(output, "there is no image")
    if node.projection != "EQUIRECTANGULAR":
        raise Inexpressible(output, "mirror balls are not supported")
    direction = numpy.atleast_2d(at.place(output, "position"))
    direction = direction / numpy.maximum(numpy.linalg.norm(direction, axis=1, keepdims=True), 1e-20)
    u = -numpy.arctan2(direction[:, 1], direction[:, 0]) / (2 * numpy.pi) + 0.5
    v = numpy.arcsin(numpy.clip(direction[:, 2], -1, 1)) / numpy.pi + 0.5
    pixels = pixels_of(output, at.translator.context)
    return looked_up(pixels, u, v, "REPEAT", node.interpolation)[:, :3]
