"""Pictures as arrays, and as notebooks show them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy

from .exr import encode_exr, read_exr
from .png import decode_png, encode_png

Array = Any
_KINDS = {("f", 2), ("f", 4), ("f", 8), ("u", 1), ("u", 2)}


class Picture:
    """An array (h, w) or (h, w, 1 to 4), row 0 at the top. Floats are linear light, whole numbers
    (uint8, uint16) codes of sRGB. Notebooks show it; in a job it can be the file of a texture."""

    def __init__(self, array: Array) -> None:
        array = numpy.asarray(array)
        if array.ndim not in (2, 3) or array.shape[2:] not in ((), (1,), (2,), (3,), (4,)) or array.size == 0:
            raise ValueError(f"an array of the shape {array.shape} is no picture")
        if (array.dtype.kind, array.dtype.itemsize) not in _KINDS:
            raise ValueError(f"an array of {array.dtype} is no picture: expected floats, uint8 or uint16")
        self.array = array.astype(array.dtype.newbyteorder("="), copy=False)

    @classmethod
    def read(cls, path: str | os.PathLike[str], layer: str = "beauty") -> Picture:
        """An EXR (one layer of it) or PNG file. ValueError for others; KeyError: no such layer."""
        data = Path(path).read_bytes()
        if data.startswith(b"\x89PNG"):
            return cls(decode_png(data))
        return cls(read_exr(path)[layer])

    @property
    def codes(self) -> Array:
        """What a display shows: sRGB of 8 bits. Of light, what is above 1 is white."""
        if self.array.dtype == numpy.uint8:
            return self.array
        if self.array.dtype == numpy.uint16:
            return (self.array >> 8).astype(numpy.uint8)
        light = numpy.nan_to_num(self.array.astype(numpy.float64), nan=0.0, posinf=1.0, neginf=0.0)
        shown = srgb(numpy.clip(light, 0.0, 1.0))
        if light.ndim == 3 and light.shape[2] in (2, 4):
            shown[:, :, -1] = numpy.clip(light[:, :, -1], 0.0, 1.0)  # alpha is no light
        return (shown * 255.0 + 0.5).astype(numpy.uint8)

    def exposed(self, stops: float) -> Picture:
        """The same, brighter by so many stops. ValueError: these are codes, not light."""
        if self.array.dtype.kind != "f":
            raise ValueError(f"a picture of {self.array.dtype} has codes of sRGB: expected floats, which are light")
        return Picture(self.array * 2.0**stops)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes .png (8 bits, or 16 of uint16) or, of light, .exr (float32, or half of float16). ValueError: neither."""
        end = Path(path).suffix.lower()
        if end == ".png":
            data = self._repr_png_() if self.array.dtype != numpy.uint16 else encode_png(self.array)
        elif end == ".exr":
            if self.array.dtype.kind != "f":
                raise ValueError(f"{os.fspath(path)}: a picture of {self.array.dtype} has codes of sRGB: expected a file .png")
            data = encode_array(self.array)[0]
        else:
            raise ValueError(f"{os.fspath(path)}: expected a file .png or .exr")
        Path(path).write_bytes(data)

    def encode(self) -> tuple[bytes, str]:
        """As a file of a job."""
        return encode_array(self.array)

    def _repr_png_(self) -> bytes:
        return encode_png(self.codes)

    def __repr__(self) -> str:
        return f"Picture({self.array.shape[1]} x {self.array.shape[0]}, {self.array.dtype})"


def srgb(light: Array) -> Array:
    """Linear values 0 to 1 as sRGB has them (IEC 61966-2-1)."""
    return numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def encode_array(array: Array) -> tuple[bytes, str]:
    """The file that keeps an array whole: EXR of floats, PNG of uint8 and uint16; and its end."""
    array = numpy.asarray(array)
    if array.dtype in ("uint8", "uint16"):
        return encode_png(array), ".png"
    if array.dtype.kind != "f":
        raise ValueError(f"an array of {array.dtype} is no picture: expected floats, uint8 or uint16")
    return encode_exr({"beauty": array}, half=array.dtype == numpy.float16), ".exr"
