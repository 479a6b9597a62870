"""Pixels of Blender's images as Cycles sees them.

Where a colour space is none of plain numbers, Cycles keeps colours times alpha: it multiplies those of files that have
them apart (all but EXR), bytes in their codes, and divides them again where a node's alpha is asked for. What Blender
keeps itself (packed, generated) it takes as Blender holds it: bytes apart, floats times alpha, by what the image says
that its file is.
"""

from __future__ import annotations

from typing import Any

import numpy

from . import graph
from .graph import Output
from .translator import Inexpressible

Array = Any
LINEAR = {"Linear", "Linear Rec.709", "Non-Color", "Raw", "Generic Data"}


def pixels_of(output: Output, context: Any) -> Array:
    """Linear light (h, w, 4), float32, of a node's image, row 0 at the bottom, with alpha. Kept for the export.
    Inexpressible: its file is missing, or no picture."""
    image = output.node.image
    key = ("pixels", image.name_full, asks_for_alpha(output))
    if key not in context.materials:
        found = _kept(output)
        color, alpha = found[..., :3], found[..., 3:4]
        is_codes = not image.is_float
        if has_alpha(image):
            if _are_codes_in_file(image):
                color, is_codes = _encoded(_times(color, alpha, -1)), True
            color = _times(color, alpha, _power(output, is_codes))
        if is_codes:
            color = _decoded(image, color, context)
        context.materials[key] = numpy.concatenate([color, alpha], axis=2)
    return context.materials[key]


def asks_for_alpha(output: Output) -> bool:
    """Whether something takes the alpha of a node."""
    alpha = next((socket for socket in output.node.outputs if socket.identifier == "Alpha"), None)
    return alpha is not None and alpha.is_linked and graph.is_taken(Output(output.node, alpha, output.groups))


def is_as_in_file(output: Output, context: Any) -> bool:
    """Whether the node's image has a file that Cycles sees the colours of."""
    image = output.node.image
    if image.is_dirty or image.source == "GENERATED":
        return False
    if not has_alpha(image):
        return True
    other = "STRAIGHT" if _is_exr(image) else "PREMUL"
    if asks_for_alpha(output) != _is_exr(image) and not (_is_kept_by_blender(image) and image.alpha_mode == other):
        return True
    key = ("opaque", image.name_full)
    if key not in context.materials:
        context.materials[key] = bool((_kept(output)[..., 3] == 1).all())
    return context.materials[key]


def _kept(output: Output) -> Array:
    """What Blender holds (h, w, 4): of files of bytes their codes."""
    image = output.node.image
    width, height = image.size
    if not width * height:
        raise Inexpressible(output, f"Blender reads no picture from the file {image.filepath}")
    flat = numpy.empty(width * height * image.channels, "float32")
    image.pixels.foreach_get(flat)
    found = flat.reshape(height, width, image.channels)
    if image.channels == 4:
        return found
    color = found if image.channels == 3 else numpy.repeat(found[..., :1], 3, axis=2)
    return numpy.concatenate([color, numpy.ones((height, width, 1), "float32")], axis=2)


def _decoded(image: Any, codes: Array, context: Any) -> Array:
    space = image.colorspace_settings.name
    if space in LINEAR:
        return codes
    if space != "sRGB":
        context.complain(f"image '{image.name}'", f"the colour space {space} is read as sRGB")
    return numpy.where(codes <= 0.04045, codes / 12.92, (numpy.maximum(codes + 0.055, 0) / 1.055) ** 2.4)


def _encoded(light: Array) -> Array:
    return numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * numpy.maximum(light, 0.0031308) ** (1 / 2.4) - 0.055)


def _power(output: Output, is_codes: bool) -> int:
    """Of alpha: with it as a factor, what Blender holds is what Cycles sees."""
    image, asked = output.node.image, asks_for_alpha(output)
    is_straight, is_kept = image.alpha_mode == "STRAIGHT", _is_kept_by_blender(image)
    if is_codes:  # apart in Blender
        in_file = 0 if is_straight or is_kept else 1
        return in_file + (0 if asked else 1)
    in_file = -1 if is_straight and not is_kept else 0
    by_cycles = 0 if is_kept or _is_exr(image) else 1
    return in_file + by_cycles - (1 if asked else 0)


def _times(color: Array, alpha: Array, power: int) -> Array:
    """Colours times alpha to some power; where alpha is 0 they are as they are, or black."""
    return color * numpy.where(alpha > 0, numpy.maximum(alpha, 1e-20) ** power, 1 if power <= 0 else 0)


def has_alpha(image: Any) -> bool:
    """Whether there is alpha, and has to do with colours."""
    is_of_colors = image.alpha_mode in ("STRAIGHT", "PREMUL") and not image.colorspace_settings.is_data
    is_there = image.channels == 4 and image.depth not in (8, 24, 96) and image.file_format != "HDR"
    return is_of_colors and is_there


def _are_codes_in_file(image: Any) -> bool:
    """Whether Blender made light of a file that holds codes of more than eight bits, which Cycles reads by itself."""
    space = image.colorspace_settings.name
    return image.is_float and not _is_exr(image) and space not in LINEAR and not _is_kept_by_blender(image)


def _is_kept_by_blender(image: Any) -> bool:
    return image.packed_file is not None or image.source == "GENERATED" or image.is_dirty


def _is_exr(image: Any) -> bool:
    return image.file_format in ("OPEN_EXR", "OPEN_EXR_MULTILAYER")
