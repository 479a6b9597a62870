"""Evaluated meshes as arrays."""

from __future__ import annotations

from typing import Any

import hyades
import numpy

from .context import Context


def mesh_parts(context: Context, object: Any) -> list[tuple[int, hyades.MeshData]]:
    """The evaluated mesh of an object, a part for each material slot that has faces."""
    mesh = object.to_mesh()
    if mesh is None or not mesh.polygons:
        return []
    mesh.calc_loop_triangles()
    triangles = numpy.empty(len(mesh.loop_triangles) * 3, "int32")
    mesh.loop_triangles.foreach_get("vertices", triangles)
    positions = numpy.empty(len(mesh.vertices) * 3, "float32")
    mesh.vertices.foreach_get("co", positions)
    object.to_mesh_clear()
    return [(0, hyades.MeshData(positions.reshape(-1, 3), triangles.reshape(-1, 3)))]
