"""Pictures of frames as a coordinator sends them to programs: half floats, plane by plane."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy

from ..picture import Picture


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


def read_film(data: bytes) -> FilmLayer:
    """What `format=half` of a frame's picture answers."""
    line, _, planes = data.partition(b"\n")
    head = json.loads(line)
    channels, height, width = tuple(head["channels"]), int(head["height"]), int(head["width"])
    count = len(channels) * height * width
    halves = numpy.frombuffer(planes, "<f2", count).reshape(len(channels), height, width)
    array = halves.astype(numpy.float32).transpose(1, 2, 0)
    return FilmLayer(
        array[:, :, 0] if len(channels) == 1 else array,
        str(head["layer"]),
        channels,
        tuple(head["layers"]),
        int(head["samples"]),
        bool(head["exact"]),
    )
