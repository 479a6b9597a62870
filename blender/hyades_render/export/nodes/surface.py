"""A part of a mesh as the places where graphs are computed."""

from __future__ import annotations

from typing import Any

import numpy

from ..meshes import Surface, across
from .evaluate.points import Points, Varies

Array = Any


class PartOfSurface:
    """The triangles of a surface that have one material.

    `atlas`: where baked pictures have them, once one is made. `is_of_object`: something of it depends on the object or
    its place, not on its mesh alone.
    """

    def __init__(self, surface: Surface, chosen: Any) -> None:
        """`chosen`: an index or slice of the surface's triangles."""
        self.surface = surface
        self.chosen = chosen
        self.atlas: Any = None
        self.is_of_object = False

    @property
    def triangles(self) -> Array:
        """(t, 3): corners of the triangles."""
        return self.surface.triangles[self.chosen]

    def corners(self) -> Array:
        """(t, 3, 3): positions of the corners."""
        return self.surface.positions[self.surface.vertex_triangles[self.chosen]]


class PartPoints(Points):
    """Places on a part: triangles (n,) and their barycentric coordinates (n, 3), which may lie a little outside."""

    def __init__(self, part: PartOfSurface, triangles: Array, weights: Array) -> None:
        self.part, self.weights = part, weights
        self.corner = part.triangles[triangles]  # (n, 3)

    def _of_corners(self, values: Any) -> Array:
        if values is None:
            return None
        found = values[self.corner].astype("float64")
        return (found * self.weights[:, :, None]).sum(axis=1)

    def _of_vertices(self, values: Array) -> Array:
        found = values[self.part.surface.corner_vertices[self.corner]].astype("float64")
        return (found * self.weights[:, :, None]).sum(axis=1)

    def _zeros(self, width: int) -> Array:
        return numpy.zeros((len(self.corner), width))

    def position(self) -> Array:
        return self._of_vertices(self.part.surface.positions)

    def normal(self) -> Array:
        found = self._of_corners(self.part.surface.corner_normals())
        return found / numpy.maximum(numpy.linalg.norm(found, axis=1, keepdims=True), 1e-20)

    def true_normal(self) -> Array:
        surface = self.part.surface
        corners = surface.positions[surface.corner_vertices[self.corner]].astype("float64")
        found = across(corners)
        return found / numpy.maximum(numpy.linalg.norm(found, axis=1, keepdims=True), 1e-30)

    def generated(self) -> Array:
        return self._of_vertices(self.part.surface.generated())

    def uv(self, name: str) -> Array:
        found = self._of_corners(self.part.surface.uv(name))
        return self._zeros(2) if found is None else found

    def color(self, name: str) -> Array:
        found = self._of_corners(self.part.surface.color(name))
        return self._zeros(4) if found is None else found

    def attribute(self, name: str) -> Array:
        uv = self.part.surface.uv(name) if name else None
        if uv is not None:
            return numpy.concatenate([self._of_corners(uv), self._zeros(1)], axis=1)
        found = self._of_corners(self.part.surface.attribute(name))
        return self._zeros(3) if found is None else found

    def alpha(self, name: str) -> Array:
        found = self._of_corners(self.part.surface.color(name)) if name else None
        return self._zeros(4)[:, 0] + 1 if found is None else found[:, 3]

    def matrix(self) -> Array:
        self.part.is_of_object = True
        return self.part.surface.matrix

    def object(self) -> Any:
        self.part.is_of_object = True
        return self.part.surface.object

    def origin(self) -> Any:
        self.part.is_of_object = True
        return self.part.surface.origin


__all__ = ["PartOfSurface", "PartPoints", "Varies"]
