"""Evaluated meshes as arrays, and parts of them as meshes of the job."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional

import hyades
import numpy

Array = Any
_KINDS = {"FLOAT": ("value", 1, "float32"), "INT": ("value", 1, "int32"), "INT8": ("value", 1, "int8"),
          "BOOLEAN": ("value", 1, "bool"), "FLOAT_VECTOR": ("vector", 3, "float32"), "FLOAT2": ("vector", 2, "float32"),
          "QUATERNION": ("value", 4, "float32")}
"""Of attributes, by Blender's type: how it calls a value, of how many numbers, of which kind."""
_SOME = 1 << 16
_FAR = 0.766
"""The cosine of 40 degrees."""


class Origin(NamedTuple):
    """What the depsgraph says of one thing that it lists, besides the object."""

    instancer: Any
    """The object whose copy it is; None: it is the object itself."""
    random: float
    """0..1, its own."""


class Surface:
    """The evaluated mesh of an object, while Blender keeps it. Arrays are read when they are asked for."""

    def __init__(self, mesh: Any, object: Any, matrix: Array, origin: Origin) -> None:
        """`matrix`: from the object's space to Blender's world."""
        self.mesh, self.object, self.matrix, self.origin = mesh, object, matrix, origin
        self._read: dict[str, Array] = {}
        mesh.calc_loop_triangles()

    def _array(self, name: str, items: Any, key: str, width: int, kind: str = "float32") -> Array:
        if name not in self._read:
            flat = numpy.empty(len(items) * width, kind)
            items.foreach_get(key, flat)
            self._read[name] = flat.reshape(-1, width) if width > 1 else flat
        return self._read[name]

    @property
    def positions(self) -> Array:
        """(v, 3) of the vertices."""
        return self._array("positions", self.mesh.vertices, "co", 3)

    @property
    def undeformed(self) -> Array:
        """(v, 3): the vertices before they were deformed, by which generated coordinates go."""
        return self._array("undeformed", self.mesh.vertices, "undeformed_co", 3)

    @property
    def corner_vertices(self) -> Array:
        """(c,): the vertex of each corner of a face."""
        return self._array("corner_vertices", self.mesh.loops, "vertex_index", 1, "int32")

    @property
    def triangles(self) -> Array:
        """(t, 3): corners of the triangles."""
        return self._array("triangles", self.mesh.loop_triangles, "loops", 3, "int32")

    @property
    def vertex_triangles(self) -> Array:
        """(t, 3): vertices of the triangles."""
        return self._array("vertex_triangles", self.mesh.loop_triangles, "vertices", 3, "int32")

    @property
    def slots(self) -> Array:
        """(t,): the material slot of each triangle."""
        if len(self.mesh.materials) < 2 and len(self.object.material_slots) < 2:
            return numpy.zeros(len(self.mesh.loop_triangles), "int32")
        return self._array("slots", self.mesh.loop_triangles, "material_index", 1, "int32")

    def shading(self) -> tuple[str, Optional[Array]]:
        """What normals belong to: ("face", None), ("point", (v, 3)) or ("corner", (c, 3))."""
        if "shading" not in self._read:
            self._read["shading"] = _shading(self.mesh)
        return self._read["shading"]

    def corner_normals(self) -> Array:
        """(c, 3), whatever they belong to."""
        domain, normals = self.shading()
        if domain == "corner":
            return normals
        if domain == "point":
            return normals[self.corner_vertices]
        faces = self._array("face_normals", self.mesh.polygons, "normal", 3)
        counts = self._array("face_sizes", self.mesh.polygons, "loop_total", 1, "int32")
        return numpy.repeat(faces, counts, axis=0)

    def uv(self, name: str) -> Optional[Array]:
        """(c, 2) of a UV map, "" being the one that is rendered; None: there is none of that name."""
        layers = self.mesh.uv_layers
        layer = next((one for one in layers if one.active_render), None) if not name else layers.get(name)
        if layer is None:
            return None
        if bpy_version() >= (3, 5):
            return self._array(f"uv {layer.name}", layer.uv, "vector", 2)
        return self._array(f"uv {layer.name}", layer.data, "uv", 2)

    def color(self, name: str) -> Optional[Array]:
        """(c, 4), linear, of a colour attribute, "" being the one that is rendered; None: there is none."""
        attributes = self.mesh.color_attributes
        attribute = attributes.get(name) if name else attributes.active_color
        if not name and len(attributes) and 0 <= attributes.render_color_index < len(attributes):
            attribute = attributes[attributes.render_color_index]
        if attribute is None:
            return None
        return self._on_corners(attribute, self._array(f"color {attribute.name}", attribute.data, "color", 4))

    def attribute(self, name: str) -> Optional[Array]:
        """(c, 3) of any attribute; None: there is none of that name, or of a kind that is no number."""
        attribute = self.mesh.attributes.get(name)
        if attribute is None:
            return None  # Cycles knows no groups of vertices either
        if attribute.data_type in ("FLOAT_COLOR", "BYTE_COLOR"):
            return self._on_corners(attribute, self._array(f"color {name}", attribute.data, "color", 4))[:, :3]
        if attribute.data_type not in _KINDS or (attribute.data_type == "INT8" and bpy_version() < (4, 0, 0)):
            return None
        key, width, kind = _KINDS[attribute.data_type]
        found = self._array(f"attribute {name}", attribute.data, key, width, kind).reshape(-1, width).astype("float64")
        found = numpy.repeat(found, 3, axis=1) if width == 1 else found
        found = numpy.concatenate([found, numpy.zeros((len(found), 1))], axis=1) if width == 2 else found
        return self._on_corners(attribute, found[:, :3])

    def _on_corners(self, attribute: Any, values: Array) -> Array:
        if attribute.domain == "CORNER":
            return values
        if attribute.domain == "POINT":
            return values[self.corner_vertices]
        if attribute.domain == "FACE":
            return numpy.repeat(values, self._array("face_sizes", self.mesh.polygons, "loop_total", 1, "int32"), axis=0)
        return self._of_edges(attribute, values)[self.corner_vertices]

    def _of_edges(self, attribute: Any, values: Array) -> Array:
        """(v, n): what vertices have of their edges' values: the mean. From Blender 4 on whole numbers stay whole, and
        switches are on where one of them is."""
        ends = self._array("edges", self.mesh.edges, "vertices", 2, "int32").reshape(-1)
        count = len(self.mesh.vertices)
        number = numpy.maximum(numpy.bincount(ends, minlength=count), 1)
        columns = [numpy.bincount(ends, numpy.repeat(column, 2), count) / number for column in values.T]
        means = numpy.stack(columns, axis=1)
        if bpy_version() < (4, 0, 0):
            return means
        if attribute.data_type == "BOOLEAN":
            return (means > 0) * 1.0
        return numpy.floor(means + 0.5) if attribute.data_type in ("INT", "INT8") else means

    def generated(self) -> Array:
        """(v, 3): 0 to 1 over the bounds of the mesh, as Blender's texture space has them."""
        middle = numpy.array(self.mesh.texspace_location)
        half = numpy.array(self.mesh.texspace_size)
        return (self.undeformed - middle) / numpy.where(half == 0, 1, 2 * half) + 0.5


def bpy_version() -> tuple[int, int, int]:
    import bpy

    return bpy.app.version


def _shading(mesh: Any) -> tuple[str, Optional[Array]]:
    if hasattr(mesh, "normals_domain"):  # Blender 4.1 and later
        domain = {"FACE": "face", "POINT": "point"}.get(mesh.normals_domain, "corner")
        if domain == "face":
            return "face", None
        items, key = (mesh.vertex_normals, "vector") if domain == "point" else (mesh.corner_normals, "vector")
    else:
        smooth = numpy.empty(len(mesh.polygons), bool)
        mesh.polygons.foreach_get("use_smooth", smooth)
        if not smooth.any() and not mesh.has_custom_normals:
            return "face", None
        domain = "point" if smooth.all() and not mesh.use_auto_smooth and not mesh.has_custom_normals else "corner"
        if domain == "corner":
            mesh.calc_normals_split()
        items, key = (mesh.vertices, "normal") if domain == "point" else (mesh.loops, "normal")
    flat = numpy.empty(len(items) * 3, "float32")
    items.foreach_get(key, flat)
    if domain == "corner" and hasattr(mesh, "free_normals_split"):
        mesh.free_normals_split()
    return domain, flat.reshape(-1, 3)


def across(corners: Array) -> Array:
    """(t, 3): along the normals of triangles (t, 3, 3), as long as they are large."""
    return numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def leaning(surface: Surface) -> float:
    """The share of the area where shading normals lean far from their triangles, of many triangles by some of them."""
    domain, normals = surface.shading()
    if domain == "face":
        return 0.0
    every = slice(None, None, len(surface.vertex_triangles) // _SOME + 1)
    vertices = surface.vertex_triangles[every]
    corners = surface.positions[vertices].astype("float64")
    directions = across(corners)
    leant = normals[vertices if domain == "point" else surface.triangles[every]]
    size = numpy.linalg.norm(directions, axis=1)
    is_far = (leant * directions[:, None]).sum(axis=2) < _FAR * size[:, None]
    return float((is_far.mean(axis=1) * size).sum() / max(float(size.sum()), 1e-30))


def part(surface: Surface, chosen: Any, uv_map: Optional[str], color: Optional[str], atlas: Any) -> hyades.MeshData:
    """Triangles of a surface, chosen by an index or slice, as a mesh of the job.

    uv_map, color: the UV map and colour attribute that textures look at; None: none does. atlas (t, 3, 2): second
    coordinates, which baked pictures have; None: there are none.
    """
    domain, normals = surface.shading()
    uvs = None if uv_map is None else surface.uv(uv_map)
    colors = None if color is None else surface.color(color)
    by_corner = [array for array in (normals if domain == "corner" else None, uvs, colors) if array is not None]
    if atlas is None and not by_corner:
        used, faces = _compact(surface.vertex_triangles[chosen], len(surface.positions))
        at_points = normals[used] if domain == "point" else None
        return hyades.MeshData(surface.positions[used], faces, normals=at_points)
    vertices, triangles = surface.corner_vertices, surface.triangles[chosen]
    if atlas is not None:
        corners = triangles.reshape(-1)
        faces = numpy.arange(len(corners), dtype="int32").reshape(-1, 3)
    else:
        corners, faces = _shared(vertices, triangles, by_corner)
    if domain == "point":
        normals = normals[vertices[corners]]
    elif domain == "corner":
        normals = normals[corners]
    return hyades.MeshData(
        surface.positions[vertices[corners]],
        faces,
        normals=normals,
        uvs=None if uvs is None else uvs[corners],
        second_uvs=None if atlas is None else atlas.reshape(-1, 2),
        colors=None if colors is None else colors[corners],
    )


def _compact(indices: Array, count: int) -> tuple[Any, Array]:
    """Which of `count` things are named, as an index, and the indices among those."""
    named = numpy.zeros(count, bool)
    named[indices.reshape(-1)] = True
    if named.all():
        return slice(None), indices
    used = numpy.flatnonzero(named)
    place = numpy.cumsum(named, dtype="int32") - 1
    return used, place[indices]


def _shared(vertices: Array, triangles: Array, by_corner: list[Array]) -> tuple[Array, Array]:
    """Corners that stand for all, and triangles of those: corners of a vertex that are like its first one are one."""
    first = numpy.zeros(int(vertices.max(initial=-1)) + 1, "int32")
    first[vertices[::-1]] = numpy.arange(len(vertices) - 1, -1, -1, dtype="int32")
    like = first[vertices]
    same = numpy.ones(len(vertices), bool)
    for array in by_corner:
        same &= (array == array[like]).all(axis=1)
    stands = numpy.where(same, like, numpy.arange(len(vertices), dtype="int32"))
    return _compact(stands[triangles], len(vertices))
