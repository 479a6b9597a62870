"""Meshes, places of copies and strands out of arrays, as the PLY and HAIR files that jobs read (docs/job.md)."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Any

import numpy

Array = Any
"""An array of numpy, or nested lists."""


class MeshData:
    """Triangles between points.

    positions (n, 3): points, in units of the job. triangles (m, 3): three points of each,
    counter-clockwise seen from outside. Per point, where given: normals (n, 3), uvs and second_uvs
    (n, 2), colors (n, 3 or 4), linear, for textures of type vertex-color, and tangents (n, 4), whose
    fourth number is the sign of the bitangent.
    """

    def __init__(
        self,
        positions: Array,
        triangles: Array,
        *,
        normals: Array = None,
        uvs: Array = None,
        second_uvs: Array = None,
        colors: Array = None,
        tangents: Array = None,
    ) -> None:
        self.positions = _columns("positions", positions, None, (3,))
        count = len(self.positions)
        self.triangles = numpy.asarray(triangles)
        if self.triangles.ndim != 2 or self.triangles.shape[1] != 3 or self.triangles.dtype.kind not in "iu":
            raise ValueError(f"triangles have the shape {self.triangles.shape}, expected whole numbers (m, 3)")
        if self.triangles.size and not 0 <= self.triangles.min() <= self.triangles.max() < count:
            raise ValueError(f"triangles name points outside of 0 to {count - 1}")
        self.normals = _columns("normals", normals, count, (3,))
        self.uvs = _columns("uvs", uvs, count, (2,))
        self.second_uvs = _columns("second_uvs", second_uvs, count, (2,))
        given = numpy.asarray(0 if colors is None else colors)
        if given.dtype.kind in "iu" and given.max(initial=0) > 1:
            raise ValueError("colors are whole numbers beyond 1; if they go from 0 to 255, divide by 255")
        self.colors = _columns("colors", colors, count, (3, 4))
        self.tangents = _columns("tangents", tangents, count, (4,))

    def __repr__(self) -> str:
        return f"MeshData({len(self.positions)} points, {len(self.triangles)} triangles)"

    def encode(self) -> tuple[bytes, str]:
        """The bytes of a binary PLY file."""
        given = [
            (self.positions, ("x", "y", "z")),
            (self.normals, ("nx", "ny", "nz")),
            (self.uvs, ("u", "v")),
            (self.second_uvs, ("u1", "v1")),
            (self.colors, ("red", "green", "blue", "alpha")),
            (self.tangents, ("tx", "ty", "tz", "tw")),
        ]
        faces = numpy.empty(len(self.triangles), [("count", "u1"), ("points", "<u4", 3)])
        faces["count"] = 3
        faces["points"] = self.triangles
        more = f"element face {len(faces)}\nproperty list uchar uint vertex_indices\n"
        return _ply(given, more) + faces.tobytes(), ".ply"


class Places:
    """Where the copies of an instance stand: for `places` of hyades.objects.Instance.

    positions (n, 3). Where given, scale (n) or (n, 3), and rotations (n, 4), quaternions x, y, z, w:
    each copy is scaled, then turned, then moved.
    """

    def __init__(self, positions: Array, *, scale: Array = None, rotations: Array = None) -> None:
        self.positions = _columns("positions", positions, None, (3,))
        count = len(self.positions)
        if scale is not None and numpy.ndim(scale) == 1:
            scale = numpy.reshape(scale, (-1, 1))
        self.scale = _columns("scale", scale, count, (1, 3))
        self.rotations = _columns("rotations", rotations, count, (4,))

    def encode(self) -> tuple[bytes, str]:
        """The bytes of a binary PLY file."""
        one = self.scale is not None and self.scale.shape[1] == 1
        scales = ("scale",) if one else ("scale_x", "scale_y", "scale_z")
        given = [
            (self.positions, ("x", "y", "z")),
            (self.scale, scales),
            (self.rotations, ("qx", "qy", "qz", "qw")),
        ]
        return _ply(given, ""), ".ply"


class Strands:
    """Hair, fur or grass: for `curves` of hyades.objects.Curves.

    points (n, m, 3) of n strands of m points each, or a list of arrays (m, 3) of any lengths. widths,
    the diameters: a number for all, a pair of them at the roots and the tips, or an array (n, m) or a list
    of such as points are. Where given, colors (n, 3), linear, one for each strand.
    """

    def __init__(self, points: Any, widths: Any, *, colors: Array = None) -> None:
        self.points = [_columns("points", strand, None, (3,)) for strand in points]
        if not self.points:
            raise ValueError("points has no strands, expected one at least")
        for strand in self.points:
            if not 2 <= len(strand) <= 65536:
                raise ValueError(f"a strand has {len(strand)} points, expected 2 to 65536")
        self.widths = [self._widths(widths, i) for i in range(len(self.points))]
        self.colors = _columns("colors", colors, len(self.points), (3,))
        if self.colors is not None and not ((self.colors >= 0) & (self.colors <= 1)).all():
            raise ValueError("colors are not from 0 to 1; if they go from 0 to 255, divide by 255")

    def _widths(self, widths: Any, index: int) -> Any:
        count = len(self.points[index])
        given: Any  # newer hints of numpy's tell apart how many axes each of these has
        if numpy.ndim(widths) == 0:
            given = numpy.full(count, widths, "<f4")
        elif isinstance(widths, (tuple, list)) and len(widths) == 2 and numpy.ndim(widths[0]) == 0:
            given = numpy.linspace(widths[0], widths[1], count, dtype="<f4")
        else:
            given = numpy.asarray(widths[index], "<f4")
        if given.shape != (count,) or not (numpy.isfinite(given) & (given >= 0)).all():
            raise ValueError(f"the widths of strand {index} are not {count} finite numbers from 0 on")
        return given

    def encode(self) -> tuple[bytes, str]:
        """The bytes of a HAIR file."""
        sizes = [len(strand) for strand in self.points]
        arrays = 1 | 2 | 4 | (0 if self.colors is None else 16)
        head = struct.pack("<4s4I5f88x", b"HAIR", len(sizes), sum(sizes), arrays, 0, 1, 0, 1, 1, 1)
        parts = [
            numpy.asarray([size - 1 for size in sizes], "<u2"),
            numpy.concatenate(self.points),
            numpy.concatenate(self.widths),
        ]
        if self.colors is not None:
            parts.append(numpy.repeat(self.colors, sizes, axis=0))
        return head + b"".join(part.tobytes() for part in parts), ".hair"


def _columns(name: str, values: Array, count: int | None, widths: Sequence[int]) -> Any:
    """`values` as floats (count, one of widths), or None."""
    if values is None:
        return None
    array = numpy.asarray(values, dtype="<f4")
    good = array.ndim == 2 and array.shape[1] in widths and count in (None, len(array))
    if not good:
        expected = " or ".join(f"({'n' if count is None else count}, {width})" for width in widths)
        raise ValueError(f"{name} have the shape {array.shape}, expected {expected}")
    if not numpy.isfinite(array).all():
        raise ValueError(f"{name} have numbers that are not finite")
    return array


def _ply(given: Sequence[tuple[Any, Sequence[str]]], more: str) -> bytes:
    """The head of a PLY file, `more` in it, and its vertices."""
    there = [(array, names) for array, names in given if array is not None]
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(there[0][0])}\n"
    for array, names in there:
        head += "".join(f"property float {name}\n" for name in names[: array.shape[1]])
    rows = numpy.concatenate([array for array, _ in there], axis=1)
    return bytes((head + more + "end_header\n").encode() + rows.astype("<f4").tobytes())
