"""EXR files as Hyades writes them (and as jobs read them): scan lines, without compression or with ZIP.

After "OpenEXR File Layout" and the documentation of ZIP's predictor at openexr.com.
"""

from __future__ import annotations

import os
import struct
import zlib
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy

from .exr_header import Channel, Header, read_headers
from .machine import usable_memory

Array = Any
Window: TypeAlias = tuple[int, int, int, int]

_LINES = {0: 1, 2: 1, 3: 16}  # of a chunk, by compression: none, ZIPS, ZIP
_ORDER = "RGBAXYZuvNID"


@dataclass(eq=False)
class Layers(dict[str, Array]):
    """Arrays of one EXR by layer: (h, w) of one channel, else (h, w, channels); row 0 is the top.

    `R G B` is layer "beauty" and `A` layer "alpha", as in docs/job.md; others are called by what
    stands before the dot of their channels. Light is linear Rec.709; values are float32 (ids: uint32).
    """

    attributes: dict[str, Any] = field(default_factory=dict)
    """What the file says of itself: "hyades.samples" and others."""
    data_window: Window = (0, 0, 0, 0)
    """Which pixels of the frame are there: x0, y0, x1, y1; x1 and y1 are not included."""
    display_window: Window = (0, 0, 0, 0)
    """The whole frame."""


def read_exr(path: str | os.PathLike[str], part: int = 0) -> Layers:
    """The layers of an EXR file, of a film's those of its picture. ValueError where it is none."""
    with open(path, "rb") as file:
        data = file.read()
    try:
        return decode_exr(data, part)
    except (struct.error, IndexError, zlib.error, ValueError) as error:
        raise ValueError(f"{os.fspath(path)}: {error}") from None


def decode_exr(data: bytes, part: int = 0) -> Layers:
    headers, at = read_headers(data)
    if not 0 <= part < len(headers):
        raise ValueError(f"there is no part {part}, the file has {len(headers)}")
    header = headers[part]
    if header.compression not in _LINES:
        raise ValueError("it is compressed in another way than Hyades does it")
    x0, y0, x1, y1 = header.data_window
    wanted = 8 * (x1 - x0) * (y1 - y0) * len(header.channels)  # as it is read, and as it is returned
    if wanted > usable_memory() // 2:
        raise ValueError(f"its pixels would take {wanted / (1 << 30):.1f} GiB of memory, more than half of what there is")
    at += 8 * sum(_chunk_count(other) for other in headers[:part])
    offsets = struct.unpack_from(f"<{_chunk_count(header)}Q", data, at)
    planes = _read_planes(data, header, offsets, len(headers) > 1)
    layers = Layers(header.attributes, header.data_window, header.display_window)
    layers.update(_grouped(planes))
    return layers


def encode_exr(layers: dict[str, Array], half: bool = False) -> bytes:
    """One part without compression: of each layer (h, w) or (h, w, c); "beauty" becomes R G B (A)."""
    planes = {name: plane for layer, array in layers.items() for name, plane in _split(layer, array)}
    height, width = next(iter(planes.values())).shape
    kind = "<f2" if half else "<f4"
    rows = numpy.stack([planes[name] for name in sorted(planes)], axis=1).astype(kind)  # (h, c, w)
    if rows.shape[0] != height or rows.shape[2] != width:
        raise ValueError("all layers have to be of one size")
    head = Header.written(sorted(planes), 1 if half else 2, width, height)
    size = rows.shape[1] * width * rows.dtype.itemsize
    first = len(head) + 8 * height
    table = b"".join(struct.pack("<Q", first + y * (8 + size)) for y in range(height))
    lines = (struct.pack("<ii", y, size) + rows[y].tobytes() for y in range(height))
    return head + table + b"".join(lines)


def write_exr(path: str | os.PathLike[str], layers: dict[str, Array], half: bool = False) -> None:
    """Writes arrays as the layers of an EXR file, as read_exr gives them."""
    with open(path, "wb") as file:
        file.write(encode_exr(layers, half))


def _chunk_count(header: Header) -> int:
    lines = _LINES.get(header.compression, 1)
    return -(-(header.data_window[3] - header.data_window[1]) // lines)


def _read_planes(data: bytes, header: Header, offsets: Any, several_parts: bool) -> dict[str, Array]:
    x0, y0, x1, y1 = header.data_window
    width, height = x1 - x0, y1 - y0
    planes = {c.name: numpy.zeros((height, width), c.dtype) for c in header.channels}
    for offset in offsets:
        at = offset + 4 * several_parts
        y, size = struct.unpack_from("<ii", data, at)
        lines = min(_LINES[header.compression], y1 - y)
        raw = sum(c.dtype.itemsize for c in header.channels) * width * lines
        if not y0 <= y < y1 or size < 0 or at + 8 + size > len(data):
            raise ValueError("it is damaged or cut short")
        packed = data[at + 8 : at + 8 + size]
        _spread(_unpacked(packed, raw, header.compression), header.channels, planes, y - y0, lines)
    return planes


def _spread(raw: bytes, channels: list[Channel], planes: dict[str, Array], y: int, lines: int) -> None:
    at = 0
    for line in range(y, y + lines):
        for channel in channels:
            row = planes[channel.name][line]
            row[:] = numpy.frombuffer(raw, channel.dtype, len(row), at)
            at += row.nbytes


def _unpacked(packed: bytes, size: int, compression: int) -> bytes:
    if compression == 0 or len(packed) == size:  # what would have grown is left as it is
        raw = packed
    else:
        codes = numpy.frombuffer(zlib.decompressobj().decompress(packed, size), numpy.uint8).copy()
        codes[1:] -= 128
        halves = codes.cumsum(dtype=numpy.uint8)
        mixed = numpy.empty_like(halves)
        middle = (len(halves) + 1) // 2
        mixed[0::2], mixed[1::2] = halves[:middle], halves[middle:]
        raw = mixed.tobytes()
    if len(raw) != size:
        raise ValueError("it is damaged or cut short")
    return raw


def _grouped(planes: dict[str, Array]) -> dict[str, Array]:
    """Channels by layer, in the order in which people name them."""
    groups: dict[str, list[tuple[int, str]]] = {}
    for name in planes:
        layer, _, channel = name.rpartition(".")
        if not layer:
            layer = "alpha" if channel == "A" else "beauty"
        groups.setdefault(layer, []).append((_ORDER.find(channel[:1]), name))
    result = {}
    for layer, members in groups.items():
        arrays = [planes[name] for _, name in sorted(members)]
        stacked = arrays[0] if len(arrays) == 1 else numpy.stack(arrays, axis=2)
        result[layer] = stacked if stacked.dtype == numpy.uint32 else stacked.astype(numpy.float32)
    return result


def _split(layer: str, array: Array) -> list[tuple[str, Array]]:
    """A layer's channels with their names in the file."""
    array = numpy.asarray(array)
    if array.ndim not in (2, 3) or 0 in array.shape or (array.ndim == 3 and array.shape[2] > 4):
        raise ValueError(f"layer {layer} has the shape {array.shape}, expected (h, w) or (h, w, 1 to 4)")
    before = "" if layer in ("beauty", "alpha") else layer + "."
    if array.ndim == 2 or array.shape[2] == 1:
        return [(before + ("A" if layer == "alpha" else "Y"), array.reshape(array.shape[:2]))]
    names = "YA" if array.shape[2] == 2 else "RGBA"
    return [(before + names[c], array[:, :, c]) for c in range(array.shape[2])]
