"""Nodes Image Texture and Environment Texture: pictures looked up bilinearly."""

from __future__ import annotations

from typing import Any

import numpy

from ..graph import Output
from ..translator import Inexpressible
from .evaluator import Evaluator, computes

Array = Any
DARKER = 2.2
"""Light that a share of an sRGB code is, as an exponent of the share."""


def pixels_of(output: Output, context: Any) -> Array:
    """Linear light (h, w, 4) of a node's image, row 0 at the bottom, straight alpha. Kept for the export.
    Inexpressible: its file is missing, or no picture."""
    image = output.node.image
    key = ("pixels", image.name_full)
    if key not in context.materials:
        width, height = image.size
        if not width * height:
            raise Inexpressible(output, f"Blender reads no picture from the file {image.filepath}")
        flat = numpy.empty(width * height * image.channels, "float32")
        image.pixels.foreach_get(flat)
        found = flat.reshape(height, width, image.channels).astype("float64")
        if image.channels < 4:
            found = numpy.concatenate([found[..., :1]] * (3 if image.channels == 1 else 1) + (
                [found[..., 1:3]] if image.channels == 3 else []) + [numpy.ones((height, width, 1))], axis=2)
        # Files of bytes come as their codes.
        if not image.is_float and image.colorspace_settings.name == "sRGB":
            color = found[..., :3]
            linear = numpy.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)
            found = numpy.concatenate([linear, found[..., 3:4]], axis=2)
        context.materials[key] = found
    return context.materials[key]


def is_darkened(output: Output, context: Any) -> bool:
    """Whether the colour of a node is one times its alpha: while nobody asks for alpha, Cycles leaves it in there, of
    files of bytes in their codes. (Files of floats hold such colours themselves.)"""
    image = output.node.image
    alpha = next((socket for socket in output.node.outputs if socket.identifier == "Alpha"), None)
    if alpha is None or alpha.is_linked or output.socket.identifier == "Alpha":
        return False
    if image.source not in ("FILE", "GENERATED"):
        return False
    if image.alpha_mode not in ("STRAIGHT", "PREMUL") or image.colorspace_settings.is_data or image.channels < 4 or image.is_float:
        return False
    key = ("sees through", image.name_full)
    if key not in context.materials:
        flat = numpy.empty(image.size[0] * image.size[1] * 4, "float32")
        image.pixels.foreach_get(flat)
        context.materials[key] = bool((flat[3::4] < 1).any())
    return context.materials[key]


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


@computes("TEX_IMAGE")
def image_texture(at: Evaluator, output: Output) -> Array:
    node = output.node
    if node.image is None:
        raise Inexpressible(output, "there is no image")
    if node.image.source not in ("FILE", "GENERATED"):
        raise Inexpressible(output, f"images of source {node.image.source.lower()} cannot be computed")
    if output.socket.identifier == "Alpha" and node.image.alpha_mode == "NONE":
        return numpy.asarray(1.0)
    place = numpy.atleast_2d(at.place(output, uv=True))
    if node.projection != "FLAT":
        raise Inexpressible(output, f"the projection {node.projection.lower()} is not supported here")
    found = looked_up(pixels_of(output, at.translator.context), place[:, 0], place[:, 1], node.extension,
                      node.interpolation)
    if output.socket.identifier == "Alpha":
        return found[:, 3]
    darkened = is_darkened(output, at.translator.context)
    return found[:, :3] * (found[:, 3:4] ** DARKER if darkened else 1)


@computes("TEX_ENVIRONMENT")
def environment_texture(at: Evaluator, output: Output) -> Array:
    node = output.node
    if node.image is None:
        raise Inexpressible(output, "there is no image")
    if node.projection != "EQUIRECTANGULAR":
        raise Inexpressible(output, "mirror balls are not supported")
    direction = numpy.atleast_2d(at.place(output))
    direction = direction / numpy.maximum(numpy.linalg.norm(direction, axis=1, keepdims=True), 1e-20)
    u = -numpy.arctan2(direction[:, 1], direction[:, 0]) / (2 * numpy.pi) + 0.5
    v = numpy.arcsin(numpy.clip(direction[:, 2], -1, 1)) / numpy.pi + 0.5
    pixels = pixels_of(output, at.translator.context)
    return looked_up(pixels, u, v, "REPEAT", node.interpolation)[:, :3]
