"""Small files of OpenVDB: grids of one box of 8 voxels a side."""

import pathlib
import struct
from collections.abc import Mapping

import numpy

_SIDE = 8
_PLACES = {"upper": 32**3, "lower": 16**3}
_ALL_VALUES = b"\x06"  # of a node follow


def write(path: pathlib.Path, grids: Mapping[str, numpy.ndarray], voxel: float = 0.25) -> pathlib.Path:
    """`grids`: numbers (8, 8, 8) or colours (8, 8, 8, 3) by x, y and z; voxels of value 0 are not active. Uncompressed, as
    version 224 of the format has it (openvdb.org, io/Archive.h), from the origin on."""
    data = struct.pack("<qIIIB", 0x56444220, 224, 10, 0, 1) + b"00000000-0000-0000-0000-000000000000"
    data += struct.pack("<Ii", 0, len(grids))
    for name, values in grids.items():
        kind = "Tree_vec3s_5_4_3" if values.ndim == 4 else "Tree_float_5_4_3"
        data += _text(name) + _text(kind) + _text("")
        begin, body = len(data) + 24, _grid(name, values.astype("<f4"), voxel)
        data += struct.pack("<qqq", begin, begin + len(body), begin + len(body)) + body
    path.write_bytes(data)
    return path


def _text(text: str) -> bytes:
    return struct.pack("<I", len(text)) + text.encode()


def _grid(name: str, values: numpy.ndarray, voxel: float) -> bytes:
    zero = bytes(4 * values[0, 0, 0].size)
    body = struct.pack("<II", 0, 2)  # not compressed; metadata
    for key, word in (("class", "fog volume"), ("name", name)):
        body += _text(key) + _text("string") + _text(word)
    body += _text("ScaleTranslateMap")
    for number in (0.0, voxel, voxel, 1 / voxel, 1 / voxel**2, 0.5 / voxel):
        body += struct.pack("<ddd", *[number] * 3)
    body += struct.pack("<I", 1) + zero + struct.pack("<II", 0, 1) + struct.pack("<iii", 0, 0, 0)
    for places in _PLACES.values():  # nodes whose first child alone is there
        body += b"\x01" + bytes(places // 8 - 1) + bytes(places // 8) + _ALL_VALUES + zero * places
    active = values.reshape(_SIDE**3, -1).any(axis=1)
    mask = numpy.packbits(active, bitorder="little").tobytes()
    return body + mask + mask + _ALL_VALUES + values.tobytes()
