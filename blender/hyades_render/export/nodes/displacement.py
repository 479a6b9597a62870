"""Input "Displacement" of a material: as bumps, or by moving the vertices that the mesh has, as Cycles does."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy
from hyades import materials

from ..meshes import Surface, across
from . import graph, values
from .evaluate import Evaluator
from .graph import Output
from .surface import PartOfSurface, PartPoints
from .translator import Inexpressible, Translator

Array = Any


class Displacement(NamedTuple):
    """How far the surface moves along its normal: (height - midlevel) * scale."""

    translator: Translator
    node: Output
    is_real: bool
    """It moves; otherwise it only looks like that."""

    def offsets(self, part: PartOfSurface) -> Array:
        """(t * 3,) for the corners of a part. Inexpressible: it cannot be computed."""
        count = len(part.triangles)
        points = PartPoints(part, numpy.repeat(numpy.arange(count), 3), numpy.tile(numpy.eye(3), (count, 1)))
        at = Evaluator(self.translator, points)
        height, middle, scale = (at.number(self.node, name) for name in ("Height", "Midlevel", "Scale"))
        return numpy.broadcast_to((height - middle) * scale, (count * 3,))


def displacement_of(translator: Translator, data: Any, output: Any) -> Optional[Displacement]:
    """What is linked to the output's input; None: nothing, or what is not supported."""
    end = graph.find_input(output, (), "Displacement")
    found = graph.source(end) if end is not None else None
    if not isinstance(found, Output):
        return None
    if found.node.type != "DISPLACEMENT":
        translator.complain(found.node, "only a node Displacement displaces; the surface stays where it is")
        return None
    if found.node.space != "OBJECT":
        translator.complain(found.node, "distances are in the object's space, not the world's")
    normal = found.input("Normal")
    if normal is not None and normal.socket.is_linked:
        translator.complain(found.node, "its normal is left out: the surface moves along its own")
    # The key moved from Cycles' to the material's own in 4.1.
    method = getattr(data, "displacement_method", None) or getattr(data.cycles, "displacement_method", "BUMP")
    if method == "BOTH":
        translator.complain(found.node, "vertices are moved; what is finer than the mesh is left out")
    return Displacement(translator, found, method != "BUMP")


def add_bump(displacement: Displacement, material: Any) -> None:
    """Lets all parts of a material that have no bump of their own look displaced."""
    translator, node = displacement.translator, displacement.node
    height = translator.value(node.input("Height"))
    if not values.is_texture(height):
        return
    scale = values.number(translator.constant(node.input("Scale"), 1.0))
    for one in _parts(material):
        if "bump" in one.keys() and one.bump is None:
            one.bump = materials.Bump(texture=height, height=scale)


def _parts(material: Any) -> list[Any]:
    if isinstance(material, materials.Mix):
        return _parts(material.first) + _parts(material.second)
    if isinstance(material, materials.TwoSided):
        return _parts(material.front) + _parts(material.back)
    return [material] if isinstance(material, materials.Material) else []


def displaced(displacement: Displacement, part: PartOfSurface) -> PartOfSurface:
    """The part with its vertices moved along their smooth normals."""
    surface = part.surface
    try:
        offsets = displacement.offsets(part)
    except Inexpressible as why:
        displacement.translator.complain(why.node, f"{why.why}; the surface stays where it is")
        return part
    points, positions = _points(surface)
    normals = _smooth_normals(positions, points[surface.triangles])
    far = numpy.zeros(len(positions))
    far[points[part.triangles.reshape(-1)]] = offsets
    moved = (positions + normals * far[:, None]).astype("float32")
    result = PartOfSurface(_Moved(surface, points, moved), part.chosen)
    result.atlas, result.is_of_object = part.atlas, part.is_of_object
    return result


def _points(surface: Surface) -> tuple[Array, Array]:
    """(c,): which point each corner is, and (p, 3): where they are. They are the vertices; but Cycles tears meshes apart
    that are smooth in parts, along the edges that are not."""
    vertices = surface.corner_vertices
    if not _is_torn(surface):
        return vertices, surface.positions
    rows = numpy.concatenate([vertices[:, None], numpy.round(surface.corner_normals() * 1000)], axis=1).astype("int64")
    _, first, points = numpy.unique(rows, axis=0, return_index=True, return_inverse=True)
    return points.reshape(-1), surface.positions[vertices[first]]


def _is_torn(surface: Surface) -> bool:
    """Until Blender 4 auto smooth tears, since then edges that are marked as sharp."""
    mesh = surface.mesh
    if hasattr(mesh, "use_auto_smooth"):
        return bool(mesh.use_auto_smooth)
    sharp = numpy.empty(len(mesh.edges), bool)
    mesh.edges.foreach_get("use_edge_sharp", sharp)
    return surface.shading()[0] == "corner" and bool(sharp.any())


class _Moved(Surface):
    """A surface whose vertices are elsewhere, and may be more."""

    def __init__(self, surface: Surface, points: Array, positions: Array) -> None:
        self.mesh, self.object, self.matrix, self.origin = surface.mesh, surface.object, surface.matrix, surface.origin
        self._whole = surface
        self._read = dict(surface._read)
        triangles = points[surface.triangles]
        self._read |= {"positions": positions, "corner_vertices": points, "vertex_triangles": triangles}
        if surface.shading()[0] != "face":
            normals = _smooth_normals(positions, triangles).astype("float32")
            self._read["shading"] = self._shaded(normals)

    def _on_corners(self, attribute: Any, values: Array) -> Array:
        return self._whole._on_corners(attribute, values)  # which knows the mesh's own vertices

    def _shaded(self, normals: Array) -> tuple[str, Array]:
        """As smooth as the mesh's faces were."""
        smooth = numpy.empty(len(self.mesh.polygons), bool)
        self.mesh.polygons.foreach_get("use_smooth", smooth)
        if smooth.all():
            return "point", normals
        counts = self._array("face_sizes", self.mesh.polygons, "loop_total", 1, "int32")
        faces = self._array("triangle_faces", self.mesh.loop_triangles, "polygon_index", 1, "int32")
        directions = across(self.positions[self.vertex_triangles].astype("float64"))
        own = numpy.stack([numpy.bincount(faces, column, len(smooth)) for column in directions.T], axis=1)
        own /= numpy.maximum(numpy.linalg.norm(own, axis=1, keepdims=True), 1e-30)
        is_smooth = numpy.repeat(smooth, counts)[:, None]
        at_corners = numpy.where(is_smooth, normals[self.corner_vertices], numpy.repeat(own, counts, axis=0))
        return "corner", at_corners.astype("float32")


def _smooth_normals(positions: Array, triangles: Array) -> Array:
    """(v, 3): the mean of the triangles around each vertex, by their angles."""
    corners = positions[triangles].astype("float64")
    result = numpy.zeros((len(positions), 3))
    face = across(corners)
    face /= numpy.maximum(numpy.linalg.norm(face, axis=1, keepdims=True), 1e-30)
    for i in range(3):
        a, b = corners[:, (i + 1) % 3] - corners[:, i], corners[:, (i + 2) % 3] - corners[:, i]
        size = numpy.linalg.norm(a, axis=1) * numpy.linalg.norm(b, axis=1)
        angle = numpy.arccos(numpy.clip((a * b).sum(axis=1) / numpy.maximum(size, 1e-30), -1, 1))
        for axis in range(3):
            result[:, axis] += numpy.bincount(triangles[:, i], face[:, axis] * angle, len(positions))
    return result / numpy.maximum(numpy.linalg.norm(result, axis=1, keepdims=True), 1e-30)
