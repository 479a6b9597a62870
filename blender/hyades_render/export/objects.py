"""Everything that the depsgraph lists: meshes, their instances, and lamps."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple, Optional

import numpy
from hyades import objects

from . import axes
from .context import Context, free_name
from .lights import PlacedLight, add_light
from .materials import Made, material_of
from .meshes import Surface, part
from .nodes import values
from .nodes.displacement import displaced
from .nodes.surface import PartOfSurface
from .places import MatrixPlaces
from .volumes import add_volume

_WITH_SURFACE = {"MESH", "CURVE", "SURFACE", "META", "FONT"}
_WITHOUT = {"CAMERA", "EMPTY", "LATTICE", "ARMATURE", "SPEAKER", "LIGHT_PROBE", "GPENCIL", "GREASEPENCIL"}


class Piece(NamedTuple):
    """A part of an object that has one material, ready to be placed."""

    mesh: Any
    made: Made

    def object(self) -> objects.Mesh:
        body = objects.Mesh(mesh=self.mesh, material=self.made.material)
        if self.made.interior is not None:
            body.interior = self.made.interior
        if not values.is_constant(self.made.emission, 0):
            body.emit = objects.Emit(color=values.held(self.made.emission, 0.0, 1e18), radiance=1, two_sided=True)
        return body


class _Copies(NamedTuple):
    """What is instanced, and where."""

    name: str
    pieces: list[Piece]
    is_seen: bool
    matrices: list[list[float]]


def add_objects(context: Context) -> None:
    """Adds what has a surface, and the lamps, to the job."""
    copies: dict[Any, _Copies] = {}
    for instance in context.depsgraph.object_instances:
        if not instance.show_self:
            continue
        # Blender may give the object of an instance for this step alone: all is taken from it here.
        object = instance.object
        kind = object.type
        if kind in _WITH_SURFACE:
            if instance.is_instance:
                _add_copy(context, copies, object, instance.matrix_world)
            else:
                _add_one(context, object, axes.array(instance.matrix_world))
        elif kind == "LIGHT":
            add_light(context, PlacedLight(object.name, object, axes.placed(instance.matrix_world)))
        elif kind == "VOLUME":
            add_volume(context, object, axes.array(instance.matrix_world))
        elif kind not in _WITHOUT:
            context.complain(f"object '{object.name}'", f"objects of type {kind.lower()} are not supported yet")
    for one in copies.values():
        _place(context, one)


@contextmanager
def evaluated_mesh(object: Any) -> Iterator[Any]:
    """The mesh that an object has after its modifiers; None: it has none."""
    mesh = object.to_mesh()
    try:
        yield mesh if mesh is not None and len(mesh.polygons) else None
    finally:
        object.to_mesh_clear()


def pieces_of(context: Context, object: Any, matrix: Any) -> list[Piece]:
    """The parts of an object's evaluated mesh, one for each material; `matrix` leads into Blender's world."""
    with evaluated_mesh(object) as mesh:
        if mesh is None:
            return []
        surface = Surface(mesh, object, matrix)
        slots = surface.slots
        found = []
        for slot in numpy.unique(slots):
            triangles = surface.triangles if len(slots) == 0 or (slots == slot).all() else surface.triangles[slots == slot]
            found.append(_piece(context, PartOfSurface(surface, triangles), _material_in(object, int(slot))))
        return found


def _piece(context: Context, piece: PartOfSurface, data: Any) -> Piece:
    made = material_of(context, piece, data)
    if made.displacement is not None:
        piece = displaced(made.displacement, piece)
    atlas = piece.atlas.uv() if made.is_baked and piece.atlas is not None else None
    return Piece(part(piece.surface, piece.triangles, made.uv_map, made.color_attribute, atlas), made)


def _material_in(object: Any, slot: int) -> Optional[Any]:
    slots = object.material_slots
    # A slot that is not there stands for the last one.
    return slots[min(slot, len(slots) - 1)].material if len(slots) else None


def _add_one(context: Context, object: Any, matrix: Any) -> None:
    is_seen = _is_seen(context, object)
    for piece in pieces_of(context, object, matrix):
        _add_piece(context, object.name, piece, axes.placed(matrix), is_seen)


def _add_piece(context: Context, name: str, piece: Piece, matrix: Any, is_seen: bool) -> None:
    body = piece.object()
    body.transform = axes.steps(matrix)
    if not is_seen:
        body.visible_to_camera = False
    context.job.objects[free_name(name, context.job.objects)] = body


def _is_seen(context: Context, object: Any) -> bool:
    """Whether the camera sees an object; complains where other rays do not."""
    rays = ("diffuse", "glossy", "transmission", "volume_scatter", "shadow")
    hidden = [ray for ray in rays if not getattr(object, f"visible_{ray}")]
    if hidden:
        what = f"it is there for rays of {', '.join(hidden)} too: only the camera's can be kept from it"
        context.complain(f"object '{object.name}'", what)
    return bool(object.visible_camera)


def _add_copy(context: Context, copies: dict[Any, _Copies], object: Any, matrix: Any) -> None:
    data = object.data
    key = (object.name_full, data.name_full, data.as_pointer())
    known = copies.get(key)
    if known is None:
        pieces = pieces_of(context, object, axes.array(matrix))
        copies[key] = known = _Copies(object.name, pieces, _is_seen(context, object), [])
    known.matrices.append([number for row in matrix for number in row])


def _place(context: Context, copies: _Copies) -> None:
    """Copies as a group that is placed by a file; one by one where they are few, or shine."""
    placed = axes.TO_JOB @ numpy.array(copies.matrices).reshape(-1, 4, 4)
    # What has no volume is not seen, and the job refuses it.
    placed = placed[numpy.abs(numpy.linalg.det(placed[:, :3, :3])) > 1e-18]
    shines = any(not values.is_constant(piece.made.emission, 0) for piece in copies.pieces)
    if len(placed) < 2 or shines:
        for matrix in placed:
            for piece in copies.pieces:
                _add_piece(context, copies.name, piece, matrix, copies.is_seen)
        return
    if not copies.pieces:
        return
    bodies: dict[str, objects.Object] = {}
    for piece in copies.pieces:
        bodies[free_name(copies.name, bodies)] = piece.object()
    group = objects.Group(objects=bodies)
    context.job.groups[free_name(copies.name, context.job.groups)] = group
    instance = objects.Instance(instance=group, places=MatrixPlaces(placed))
    if not copies.is_seen:
        instance.visible_to_camera = False
    context.job.objects[free_name(copies.name, context.job.objects)] = instance
