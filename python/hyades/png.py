"""PNG pictures to and from arrays (W3C, Portable Network Graphics, second edition)."""

from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy

Array = Any

_MAGIC = b"\x89PNG\r\n\x1a\n"
_COLOR_TYPES = {1: 0, 2: 4, 3: 2, 4: 6}
_CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}


def encode_png(pixels: Array) -> bytes:
    """Codes of 8 or 16 bits, (h, w) or (h, w, 1 to 4), sRGB."""
    array = numpy.asarray(pixels)
    array = array[:, :, None] if array.ndim == 2 else array
    if array.ndim != 3 or array.shape[2] not in _COLOR_TYPES or array.dtype not in ("uint8", "uint16"):
        raise ValueError(f"{array.dtype} of the shape {array.shape} is no picture of 8 or 16 bits")
    height, width, channels = array.shape
    bits = 8 * array.dtype.itemsize
    rows = array.astype(array.dtype.newbyteorder(">")).tobytes()
    stride = len(rows) // max(height, 1)
    filtered = b"".join(b"\0" + rows[y * stride : (y + 1) * stride] for y in range(height))
    head = struct.pack(">IIBBBBB", width, height, bits, _COLOR_TYPES[channels], 0, 0, 0)
    chunks = [(b"IHDR", head), (b"sRGB", b"\0"), (b"IDAT", zlib.compress(filtered, 6)), (b"IEND", b"")]
    return _MAGIC + b"".join(_chunk(kind, data) for kind, data in chunks)


def decode_png(data: bytes) -> Array:
    """Codes (h, w, channels) of 8 or 16 bits. Palettes and interlacing are refused."""
    head, packed = _chunks(data)
    width, height, bits, kind, _, _, interlaced = struct.unpack(">IIBBBBB", head)
    if bits not in (8, 16) or kind not in _CHANNELS or interlaced:
        raise ValueError("a PNG with a palette, interlacing or fewer than 8 bits is not read")
    channels = _CHANNELS[kind]
    step = channels * bits // 8
    stride = width * step
    raw = numpy.frombuffer(zlib.decompress(packed), numpy.uint8)
    if raw.size != height * (stride + 1):
        raise ValueError("the PNG is cut short")
    rows = _unfiltered(raw.reshape(height, stride + 1), step)
    codes = rows.tobytes()
    return numpy.frombuffer(codes, ">u2" if bits == 16 else "u1").reshape(height, width, channels)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def _chunks(data: bytes) -> tuple[bytes, bytes]:
    """What IHDR and all IDAT hold."""
    if not data.startswith(_MAGIC):
        raise ValueError("no PNG")
    head, packed, at = b"", [], len(_MAGIC)
    while at + 8 <= len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            head = body
        elif kind == b"IDAT":
            packed.append(body)
        at += size + 12
    if len(head) != 13:
        raise ValueError("a PNG without a head")
    return head, b"".join(packed)


def _unfiltered(rows: Array, step: int) -> Array:
    """Undoes the filter of each row, whose first byte names it."""
    result = numpy.zeros((rows.shape[0], rows.shape[1] - 1), numpy.uint8)
    above = numpy.zeros(rows.shape[1] - 1, numpy.uint8)
    for y, row in enumerate(rows):
        above = result[y] = _unfiltered_row(int(row[0]), row[1:], above, step)
    return result


def _unfiltered_row(kind: int, row: Array, above: Array, step: int) -> Array:
    if kind == 0:
        return row
    if kind == 1:
        return row.reshape(-1, step).cumsum(axis=0, dtype=numpy.uint8).reshape(-1)
    if kind == 2:
        return row + above
    if kind not in (3, 4):
        raise ValueError(f"the PNG has a filter {kind}")
    done = bytearray(step) + bytearray(row.tobytes())
    up = bytes(step) + above.tobytes()
    for i in range(step, len(done)):
        left = done[i - step]
        predicted = (left + up[i]) // 2 if kind == 3 else _paeth(left, up[i], up[i - step])
        done[i] = (done[i] + predicted) & 255
    return numpy.frombuffer(bytes(done[step:]), numpy.uint8)


def _paeth(left: int, up: int, corner: int) -> int:
    """Whichever of the three is nearest to left + up - corner."""
    by_left, by_up, by_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
    if by_left <= by_up and by_left <= by_corner:
        return left
    return up if by_up <= by_corner else corner
