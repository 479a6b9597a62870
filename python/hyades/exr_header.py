"""What stands at the beginning of an EXR file."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy

_MAGIC = 20000630
_LONG_NAMES, _PARTS = 0x400, 0x1000
_MOST_PIXELS = 1 << 28
_TYPES = [numpy.dtype("<u4"), numpy.dtype("<f2"), numpy.dtype("<f4")]


@dataclass
class Channel:
    name: str
    dtype: Any


@dataclass
class Header:
    """Of one part. Windows are x0, y0, x1, y1, without x1 and y1."""

    attributes: dict[str, Any]
    channels: list[Channel]
    compression: int
    data_window: tuple[int, int, int, int]
    display_window: tuple[int, int, int, int]

    @staticmethod
    def written(channels: list[str], kind: int, width: int, height: int) -> bytes:
        """The head of a file of one part, up to the table of its lines."""
        rows = b"".join(name.encode() + b"\0" + struct.pack("<iIii", kind, 0, 1, 1) for name in channels)
        window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
        attributes = [
            ("channels", "chlist", rows + b"\0"),
            ("compression", "compression", b"\0"),
            ("dataWindow", "box2i", window),
            ("displayWindow", "box2i", window),
            ("lineOrder", "lineOrder", b"\0"),
            ("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
            ("screenWindowCenter", "v2f", struct.pack("<ff", 0.0, 0.0)),
            ("screenWindowWidth", "float", struct.pack("<f", 1.0)),
        ]
        long = _LONG_NAMES if any(len(name) > 31 for name in channels) else 0
        parts = [struct.pack("<ii", _MAGIC, 2 | long)]
        for name, of_type, data in attributes:
            parts.append(f"{name}\0{of_type}\0".encode() + struct.pack("<i", len(data)) + data)
        return b"".join(parts) + b"\0"


def read_headers(data: bytes) -> tuple[list[Header], int]:
    """The headers of all parts, and where the tables of their chunks begin."""
    magic, version = struct.unpack_from("<ii", data, 0)
    if magic != _MAGIC:
        raise ValueError("it is no EXR file")
    if version & ~(_LONG_NAMES | _PARTS | 0xFF) or version & 0xFF != 2:
        raise ValueError("it has tiles or deep pixels, which Hyades does not write")
    headers, at = [], 8
    while True:
        attributes, at = _attributes(data, at)
        headers.append(_header(attributes))
        if not version & _PARTS:
            return headers, at
        if data[at] == 0:
            return headers, at + 1


def _text(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode("utf-8", "replace"), end + 1


def _attributes(data: bytes, at: int) -> tuple[dict[str, Any], int]:
    found: dict[str, Any] = {}
    while data[at] != 0:
        name, at = _text(data, at)
        kind, at = _text(data, at)
        size = struct.unpack_from("<i", data, at)[0]
        if not 0 <= size <= len(data) - at - 4:
            raise ValueError("it is damaged or cut short")
        raw = data[at + 4 : at + 4 + size]
        if kind in _READERS:
            found[name] = _READERS[kind](raw)
        at += 4 + size
    return found, at + 1


def _channels(raw: bytes) -> list[Channel]:
    channels, at = [], 0
    while raw[at] != 0:
        name, at = _text(raw, at)
        kind, _, x, y = struct.unpack_from("<iIii", raw, at)
        if kind not in (0, 1, 2) or (x, y) != (1, 1):
            raise ValueError(f"channel {name} is of another kind than Hyades writes")
        channels.append(Channel(name, _TYPES[kind]))
        at += 16
    return channels


def _box(raw: bytes) -> tuple[int, int, int, int]:
    x0, y0, x1, y1 = struct.unpack("<iiii", raw)
    return x0, y0, x1 + 1, y1 + 1


_READERS: dict[str, Callable[[bytes], Any]] = {
    "chlist": _channels,
    "box2i": _box,
    "compression": lambda raw: raw[0],
    "string": lambda raw: raw.decode("utf-8", "replace"),
    "int": lambda raw: struct.unpack("<i", raw)[0],
    "float": lambda raw: struct.unpack("<f", raw)[0],
}


def _header(attributes: dict[str, Any]) -> Header:
    missing = {"channels", "compression", "dataWindow", "displayWindow"} - attributes.keys()
    if missing:
        raise ValueError(f"it has no {', '.join(sorted(missing))}")
    x0, y0, x1, y1 = attributes["dataWindow"]
    if x1 <= x0 or y1 <= y0 or (x1 - x0) * (y1 - y0) > _MOST_PIXELS:
        raise ValueError(f"its window {x0} {y0} {x1} {y1} is no picture's")
    shown = {k: v for k, v in attributes.items() if isinstance(v, (str, int, float))}
    return Header(
        shown,
        attributes["channels"],
        attributes["compression"],
        (x0, y0, x1, y1),
        attributes["displayWindow"],
    )
