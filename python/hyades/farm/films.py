"""Pictures of frames as a coordinator sends them to programs: half floats, plane by plane."""

from __future__ import annotations

import http.client
from dataclasses import dataclass
from typing import Any

import numpy

from ..errors import FarmError
from ..picture import Picture
from .answers import decoded, part, read_bounded, too_much

_MOST_HEAD = 1 << 20  # bytes of the line that tells what follows
_BYTES_PER_VALUE = 6  # a half float, and the float that is made of it


@dataclass(frozen=True)
class FilmLayer:
    """A layer of a frame as it is now, also in mid-render."""

    array: Any
    """float32 (h, w) or (h, w, channels), row 0 at the top; light is linear Rec.709."""
    layer: str
    channels: tuple[str, ...]
    layers: tuple[str, ...]
    """What else can be had."""
    samples: int
    """Done so far."""
    exact: bool
    """False where a finished file of 8 bits is all that there is."""

    @property
    def picture(self) -> Picture:
        return Picture(self.array)

    def _repr_png_(self) -> bytes:
        return self.picture._repr_png_()


def read_film(answer: http.client.HTTPResponse, most: int) -> FilmLayer:
    """What `format=half` of a frame's picture answers, where it takes at most `most` bytes of memory. FarmError."""
    line = answer.readline(_MOST_HEAD)
    if not line:
        raise http.client.IncompleteRead(b"")
    head = decoded(line)
    channels, layers = (_texts(head, name) for name in ("channels", "layers"))
    height, width = part(head, "height", int), part(head, "width", int)
    if not channels or height < 1 or width < 1:
        raise FarmError("unknown", f"the coordinator sends a picture of {width} x {height} pixels, expected some")
    count = len(channels) * height * width
    if count * _BYTES_PER_VALUE > most:
        raise too_much(f"a picture of {width} x {height} pixels, which takes memory", most)
    planes = read_bounded(answer, 2 * count)
    if len(planes) < 2 * count:
        raise FarmError("unknown", f"the coordinator sends {len(planes)} bytes of a picture, expected {2 * count}")
    halves = numpy.frombuffer(planes, "<f2").reshape(len(channels), height, width)
    array = halves.astype(numpy.float32).transpose(1, 2, 0)
    return FilmLayer(
        array[:, :, 0] if len(channels) == 1 else array,
        part(head, "layer", str),
        channels,
        layers,
        part(head, "samples", int),
        part(head, "exact", bool),
    )


def _texts(head: object, name: str) -> tuple[str, ...]:
    texts = part(head, name, list)
    if not all(isinstance(text, str) for text in texts):
        raise FarmError("unknown", f"the coordinator's picture has '{name}' that are no texts")
    return tuple(texts)
