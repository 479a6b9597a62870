"""Pictures of Blender as files of the job."""

from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy

from ..files import may_be_sent
from .graph import Output
from .pixels import LINEAR, asks_for_alpha, has_alpha, is_as_in_file, pixels_of
from .translator import Inexpressible, Translator

_READ = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr", ".hdr", ".tga", ".bmp", ".qoi", ".ppm", ".pgm", ".pfm"}
_MARK = "<UDIM>"
_TILES = range(1001, 1101)  # that a job has


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
    """The picture of a node. Inexpressible: it is a film, or its file is missing or no picture."""
    image = node.image
    space = "linear" if image.colorspace_settings.name in LINEAR else "srgb"
    if image.colorspace_settings.name not in LINEAR | {"sRGB"}:
        translator.complain(node, f"the colour space {image.colorspace_settings.name} is read as sRGB")
    path = os.path.abspath(_path(image))
    if image.source in ("TILED", "SEQUENCE") and has_alpha(image) and not asks_for_alpha(output):
        translator.complain(node, "the colours of its files are taken as they are, not times alpha")
    if image.source == "TILED":
        _check_tiles(translator, output, path)
        return ImageFile(path, space, True)
    if image.source == "SEQUENCE":
        path = os.path.abspath(_path(image, image.filepath_from_user(image_user=output.node.image_user)))
        if not may_be_sent(path, _READ):
            raise Inexpressible(output, f"there is no picture {path} of the sequence")
        return ImageFile(path, space, False)
    if image.source not in ("FILE", "GENERATED"):
        raise Inexpressible(output, f"images of source {image.source.lower()} are not supported")
    if not is_as_in_file(output, translator.context):
        return ImageFile(_array(translator, output), "linear", False)
    if image.packed_file is not None:
        end = os.path.splitext(path)[1].lower()
        end = end if end in _READ else _end_of(image.packed_file.data)
        return ImageFile(PackedFile(bytes(image.packed_file.data), end), space, False)
    # Of all other files goes what Blender sees in them; the mark would name files that nobody has looked at.
    if _MARK in path or not may_be_sent(path, _READ):
        return ImageFile(_array(translator, output), "linear", False)
    return ImageFile(path, space, False)


def _check_tiles(translator: Translator, output: Output, path: str) -> None:
    """Looks at all files that a pattern stands for. Inexpressible, with a complaint: they may not go to a farm."""
    folder, name = os.path.split(path)
    tiles = [tile for number in _TILES if os.path.exists(tile := path.replace(_MARK, str(number)))]
    if _MARK in folder or name.count(_MARK) != 1 or not tiles:
        why = f"expected {_MARK} once in the name, and a file for a tile"
    elif not all(may_be_sent(tile, _READ) for tile in tiles):
        why = "not all of them are pictures, or links to pictures"
    else:
        return
    # Told here, as tiles are not computed either, which is all that would be told of them.
    why = f"the tiles {output.node.image.filepath} are not taken: {why}"
    translator.complain(output.node, why)
    raise Inexpressible(output, why)


def _path(image: Any, path: str = "") -> str:
    import bpy

    return bpy.path.abspath(path or image.filepath, library=image.library)


def _array(translator: Translator, output: Output) -> numpy.ndarray:
    """Light (h, w, 3 or 4), row 0 at the top; with alpha where that is asked for: beside it colours are no more times alpha
    for the job, which filters them so."""
    channels = 4 if asks_for_alpha(output) else 3
    kind = "float32" if output.node.image.is_float else "float16"
    return pixels_of(output, translator.context)[::-1, :, :channels].astype(kind)


def _end_of(data: bytes) -> str:
    starts = {b"\x89PNG": ".png", b"\xff\xd8": ".jpg", b"v/1\x01": ".exr", b"#?": ".hdr", b"BM": ".bmp"}
    return next((end for start, end in starts.items() if bytes(data[:4]).startswith(start)), ".tga")
