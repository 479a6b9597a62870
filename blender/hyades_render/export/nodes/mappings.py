"""Mappings of places, as matrices: of nodes Mapping, and that of each texture's own (Texture Mapping in its sidebar)."""

from __future__ import annotations

from typing import Any, Optional

import numpy

from .graph import Output
from .translator import Inexpressible

Array = Any


def rotation(angles: Array) -> Array:
    """Matrix (3, 3) of turns about x, then y, then z [radians]."""
    (sx, sy, sz), (cx, cy, cz) = numpy.sin(angles), numpy.cos(angles)
    about_x = numpy.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = numpy.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = numpy.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def matrix_of(output: Output, kind: str, scale: Array, angles: Array, location: Array) -> Array:
    """Matrix (4, 4) of a mapping of type POINT, TEXTURE or VECTOR. Inexpressible: it has none."""
    if kind == "NORMAL":
        raise Inexpressible(output, "no mapping of the job means that of normals")
    matrix = numpy.eye(4)
    matrix[:3, :3] = rotation(angles) @ numpy.diag(scale)
    if kind != "VECTOR":
        matrix[:3, 3] = location
    if kind != "TEXTURE":
        return matrix
    if not numpy.all(scale):
        raise Inexpressible(output, "a scale of 0 has no inverse")
    return numpy.linalg.inv(matrix)


def own_matrix(output: Output) -> Optional[Array]:
    """Matrix (4, 4) of a texture node's own mapping; None: it changes nothing. Inexpressible: no matrix says it."""
    own = getattr(output.node, "texture_mapping", None)
    if own is None:
        return None
    if own.use_min or own.use_max:
        raise Inexpressible(output, "the limits of its Texture Mapping are not supported")
    axes = numpy.zeros((4, 4))
    axes[3, 3] = 1
    for row, to in enumerate((own.mapping_x, own.mapping_y, own.mapping_z)):
        if to != "NONE":
            axes[row, "XYZ".index(to)] = 1
    scale, angles, location = (numpy.array(part) for part in (own.scale, own.rotation, own.translation))
    matrix = matrix_of(output, own.vector_type, scale, angles, location) @ axes
    return None if numpy.array_equal(matrix, numpy.eye(4)) else matrix
