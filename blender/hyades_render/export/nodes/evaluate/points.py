"""Where a graph is computed."""

from __future__ import annotations

from typing import Any

import numpy

Array = Any


class Varies(Exception):
    """A node asks for a place where a constant was expected."""


class Points:
    """Places on a surface (or directions of a world), all in Blender's axes. Subclasses know more."""

    def position(self) -> Array:
        """(n, 3), in the object's own space."""
        raise Varies

    def normal(self) -> Array:
        """(n, 3), shading normals in the object's own space."""
        raise Varies

    def true_normal(self) -> Array:
        """(n, 3), normals of the faces in the object's own space."""
        raise Varies

    def generated(self) -> Array:
        """(n, 3), as Blender's texture space has them."""
        raise Varies

    def uv(self, name: str) -> Array:
        """(n, 2) of the UV map of that name, "" for the active one."""
        raise Varies

    def color(self, name: str) -> Array:
        """(n, 4) of the colour attribute of that name, "" for the active one."""
        raise Varies

    def attribute(self, name: str) -> Array:
        """(n, 3) of any attribute."""
        raise Varies

    def alpha(self, name: str) -> Array:
        """(n,) of the colour attribute of that name; 1 where there is none."""
        raise Varies

    def matrix(self) -> Array:
        """(4, 4) from the object's space to Blender's world."""
        raise Varies

    def object(self) -> Any:
        """The object, for what it says of itself."""
        raise Varies

    def origin(self) -> Any:
        """The object's Origin: whose copy it is, and its random number."""
        raise Varies


NOWHERE = Points()
"""Whatever asks for a place, Varies."""


def transformed(matrix: Array, points: Array) -> Array:
    """Points moved by a matrix (4, 4)."""
    return points @ numpy.asarray(matrix)[:3, :3].T + numpy.asarray(matrix)[:3, 3]


def turned(matrix: Array, normals: Array) -> Array:
    """Normals under a matrix (4, 4), of unit length."""
    moved = normals @ numpy.linalg.inv(numpy.asarray(matrix)[:3, :3])
    return moved / numpy.maximum(numpy.linalg.norm(moved, axis=-1, keepdims=True), 1e-20)
