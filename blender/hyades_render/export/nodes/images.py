"""Pictures of Blender as files of the job."""

from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy

from .evaluate.images import pixels_of
from .graph import Output
from .translator import Inexpressible, Translator

_READ = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", ".hdr", ".tga", ".bmp", ".qoi", ".ppm", ".pgm", ".pfm"}
_LINEAR = {"Linear", "Linear Rec.709", "Non-Color", "Raw", "Generic Data"}


class PackedFile:
    """A file that Blender keeps in its own, as the bytes that it was."""

    def __init__(self, data: bytes, end: str) -> None:
        self.data, self.end = data, end

    def encode(self) -> tuple[bytes, str]:
        return self.data, self.end


class ImageFile(NamedTuple):
    """What a texture reads."""

    file: Any
    """A path, bytes or an array."""
    color_space: str
    is_tiled: bool


def image_file(translator: Translator, node: Any, output: Output) -> ImageFile:
    """The picture of a node. Inexpressible: it is a film, or its file is missing."""
    image = node.image
    space = "linear" if image.colorspace_settings.name in _LINEAR else "srgb"
    if image.colorspace_settings.name not in _LINEAR | {"sRGB"}:
        translator.complain(node, f"the colour space {image.colorspace_settings.name} is read as sRGB")
    path = os.path.abspath(_path(image))
    end = os.path.splitext(path)[1].lower()
    if image.source == "TILED":
        return ImageFile(path, space, True)
    if image.source not in ("FILE", "GENERATED"):
        raise Inexpressible(output, f"images of source {image.source.lower()} are not supported")
    if image.is_dirty or image.source == "GENERATED":
        return ImageFile(_array(translator, image), "linear", False)
    if image.packed_file is not None:
        end = end if end in _READ else _end_of(image.packed_file.data)
        return ImageFile(PackedFile(bytes(image.packed_file.data), end), space, False)
    if not os.path.exists(path):
        raise Inexpressible(output, f"the file {image.filepath} is not there")
    if end not in _READ:
        return ImageFile(_array(translator, image), "linear", False)
    return ImageFile(path, space, False)


def _path(image: Any) -> str:
    import bpy

    return bpy.path.abspath(image.filepath, library=image.library)


def _array(translator: Translator, image: Any) -> numpy.ndarray:
    """Light (h, w, 4), row 0 at the top."""
    return pixels_of(image, translator.context)[::-1].astype("float16" if not image.is_float else "float32")


def _end_of(data: bytes) -> str:
    starts = {b"\x89PNG": ".png", b"\xff\xd8": ".jpg", b"v/1\x01": ".exr", b"#?": ".hdr", b"BM": ".bmp"}
    return next((end for start, end in starts.items() if bytes(data[:4]).startswith(start)), ".tga")
