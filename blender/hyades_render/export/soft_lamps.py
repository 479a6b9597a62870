"""Point and spot lamps with a radius near things: Cycles has disks that face whoever they light, jobs have balls."""

from __future__ import annotations

from typing import Any

import numpy

from . import axes
from .context import Context

_SHARE = 0.21
"""Of the distance to a thing: with a radius of so much pictures differ by 2 % (docs/blender.md)."""


class Nearness:
    """Lamps, and the bounds of what stands around them. Copies are left out, of which there may be millions."""

    def __init__(self) -> None:
        self._lamps: list[tuple[str, float, numpy.ndarray]] = []
        self._names: list[str] = []
        self._corners: list[Any] = []
        self._matrices: list[Any] = []

    def add(self, object: Any, matrix: Any) -> None:
        """Something that is there; `matrix` is where it stands in Blender's world."""
        if object.type == "LIGHT":
            data = object.data
            radius = getattr(data, "shadow_soft_size", 0.0)
            if data.type in ("POINT", "SPOT") and radius > 0 and getattr(data, "use_soft_falloff", True):
                self._lamps.append((object.name, float(radius), axes.array(matrix)[:3, 3]))
        elif object.type == "MESH":
            self._names.append(object.name)
            self._corners.append([corner[:] for corner in object.bound_box])
            self._matrices.append(axes.array(matrix))

    def tell(self, context: Context) -> None:
        """Complains of lamps that are near for their size. Bounds that they stand in tell nothing: it may be a room."""
        if not self._lamps or not self._names:
            return
        corners, matrices = numpy.array(self._corners, float), numpy.array(self._matrices)
        solid = numpy.abs(numpy.linalg.det(matrices[:, :3, :3])) > 1e-18
        matrices[~solid] = numpy.eye(4)
        low, high = corners.min(axis=1), corners.max(axis=1)
        inverses = numpy.linalg.inv(matrices)
        for name, radius, place in self._lamps:
            there = inverses[:, :3, :3] @ place + inverses[:, :3, 3]
            nearest = numpy.clip(there, low, high)
            way = numpy.einsum("nij,nj->ni", matrices[:, :3, :3], nearest - there)
            far = numpy.linalg.norm(way, axis=1)
            far[~solid | ~(far > 1e-9)] = numpy.inf
            at = int(numpy.argmin(far))
            if radius > _SHARE * far[at]:
                what = f"it is near '{self._names[at]}' for its radius, and a ball: those of Cycles are disks, darker there"
                context.complain(f"light '{name}'", what)
