"""Everything that the depsgraph lists: meshes, their instances, and lamps."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from copy import copy
from typing import Any, NamedTuple, Optional

import numpy
from hyades import objects

from . import axes
from .context import Context, free_name
from .hair import add_curves, add_hair, has_hair
from .lights import PlacedLight, add_light
from .materials import Made, material_of
from .meshes import Origin, Surface, leaning, part
from .nodes import values
from .nodes.displacement import displaced
from .nodes.evaluate.noise import hashed
from .nodes.surface import PartOfSurface
from .places import MatrixPlaces
from .soft_lamps import Nearness
from .visibility import LayerFlags, Seen, Shown, add_seen, say, seen_by
from .volumes import add_volume

_BECOME_MESHES = {"CURVE", "SURFACE", "META", "FONT"}
"""Types of objects that are listed once more, as instances of their own, as the mesh that they are."""
_WITHOUT = {"CAMERA", "EMPTY", "LATTICE", "ARMATURE", "SPEAKER", "LIGHT_PROBE", "GPENCIL", "GREASEPENCIL"}


_MOST_LEANING = 0.25
"""Of a mesh, from which on pictures were seen to differ (docs/blender.md)."""
_MOST_OWN = 64
"""Copies of one thing that may look different each: each may bring a picture of its own."""


class Piece(NamedTuple):
    """A part of an object that has one material, ready to be placed."""

    body: objects.Mesh
    made: Made
    is_of_object: bool = False
    """Whether it looks so for this object at this place alone."""

    def object(self) -> objects.Mesh:
        """The part as an object of its own. Thousands may share a piece: keys that hold are not checked again."""
        body = copy(self.body)
        if body.emit is not None:
            body.emit = copy(body.emit)
        return body


class _Copies(NamedTuple):
    """What is instanced, and where."""

    name: str
    pieces: list[Piece]
    seen: Seen
    matrices: list[tuple[float, ...]]
    """Three rows each."""
    ids: list[Any]
    """Where what is exported moves: what tells copies apart at other moments, too."""
    others: list[tuple[tuple[float, ...], list[Piece]]]
    """Copies that look different: where they are, and what they are made of."""

    @property
    def looks_differ(self) -> bool:
        """Whether shading depends on the place, or on the object."""
        return any(piece.is_of_object for piece in self.pieces)


def add_objects(context: Context) -> None:
    """Adds what has a surface, and the lamps, to the job."""
    copies: dict[Any, _Copies] = {}
    context.names.links.collect(context.depsgraph, context.integrator)
    flags, nearness = LayerFlags(context), Nearness()
    some_become_meshes = False  # of millions of copies each question takes its time
    for instance in context.depsgraph.object_instances:
        # Blender may give the object of an instance for this step alone: all is taken from it here.
        object = instance.object
        if object.type in _BECOME_MESHES:
            some_become_meshes = True
            continue
        is_copy = instance.is_instance and not (some_become_meshes and _is_own_mesh(instance))
        if is_copy:  # there may be millions
            data = object.data
            known = copies.get(_kind(object, flags.shown(instance, True))) if data is not None else None
            if known is not None and not (known.looks_differ and _add_another(context, known, instance, object)):
                first, second, third, _ = instance.matrix_world
                known.matrices.append(first[:] + second[:] + third[:])
                if context.moves:
                    known.ids.append(_id(instance))
            if known is not None:
                continue
        if instance.show_particles and has_hair(object):
            _add_hair_of(context, instance, object, flags.shown(instance, is_copy))
        if instance.show_self:
            _add(context, copies, instance, object, is_copy, flags.shown(instance, is_copy))
            if not is_copy:
                nearness.add(object, instance.matrix_world)
    nearness.tell(context)
    for one in copies.values():
        _place(context, one)


def _is_own_mesh(instance: Any) -> bool:
    """Whether an instance is the mesh that a curve, say, is itself."""
    parent = instance.parent
    return (
        parent.type in _BECOME_MESHES
        and parent.original == instance.object.original
        and parent.matrix_world == instance.matrix_world
    )


def _add(
    context: Context, copies: dict[Any, _Copies], instance: Any, object: Any, is_copy: bool, shown: Shown
) -> None:
    """One object, or the first of many copies."""
    kind, matrix = object.type, instance.matrix_world
    _tell_of_settings(context, object)
    if kind == "MESH" and is_copy:
        pieces = pieces_of(context, object, matrix, _origin(instance))
        rows = tuple(axes.array(matrix)[:3].reshape(-1))
        ids = [_id(instance)] if context.moves else []
        seen = seen_by(context, object, shown)
        copies[_kind(object, shown)] = _Copies(object.name, pieces, seen, [rows], ids, [])
    elif kind == "MESH":
        seen = seen_by(context, object, shown)
        for piece in pieces_of(context, object, matrix, _origin(instance)):
            _add_piece(context, object.name, piece, axes.steps_to_world(matrix), seen)
    elif kind == "LIGHT":
        add_light(context, PlacedLight(object.name, object, axes.placed(matrix)))
    elif kind == "CURVES":
        add_curves(context, object, matrix, seen_by(context, object, shown))
    elif kind == "VOLUME":
        add_volume(context, object, axes.array(matrix), seen_by(context, object, shown))
    elif kind not in _WITHOUT:
        context.complain(f"object '{object.name}'", f"objects of type {kind.lower()} are not supported yet")


def _add_hair_of(context: Context, instance: Any, object: Any, shown: Shown) -> None:
    if instance.is_instance:
        context.complain(f"object '{object.name}'", "the hair of copies is left out")
        return
    add_hair(context, object, instance.matrix_world, seen_by(context, object, shown))


def _tell_of_settings(context: Context, object: Any) -> None:
    """Complains where an object is to stay sharp though it moves, or has shadows of its own."""
    cycles = getattr(object, "cycles", None)
    if context.scene.render.use_motion_blur and not getattr(cycles, "use_motion_blur", True):
        context.complain(f"object '{object.name}'", "motion blur is for all: it is blurred where it moves")
    elif context.scene.render.use_motion_blur and not getattr(cycles, "use_deform_motion", True):
        context.complain(f"object '{object.name}'", "motion blur is for all: it is blurred where it changes its shape")
    if getattr(cycles, "shadow_terminator_offset", 0.0) > 0:
        context.complain(f"object '{object.name}'", "its Shadow Terminator offset is left out: edges of shadows have another remedy")
    if object.type == "MESH" and _is_culled(context.scene, cycles):
        context.complain(f"object '{object.name}'", "it is there wherever it is: Simplify's culling leaves it out where it is far or unseen")
    if _is_cut_finer(context.scene, object):
        what = "Adaptive Subdivision is left out: it is as fine as its Subdivision Surface is with Levels Render"
        context.complain(f"object '{object.name}'", what)


def _is_culled(scene: Any, cycles: Any) -> bool:
    """Whether Cycles may leave out an object, of which `cycles` are its properties, as it is far or not in the picture."""
    kinds = ("use_camera_cull", "use_distance_cull")
    settings = getattr(scene, "cycles", None)
    return scene.render.use_simplify and any(getattr(settings, kind, False) and getattr(cycles, kind, False) for kind in kinds)


def _is_cut_finer(scene: Any, object: Any) -> bool:
    """Whether Cycles cuts its faces as small as pixels."""
    last = object.modifiers[-1] if len(object.modifiers) else None
    if last is None or last.type != "SUBSURF" or not last.show_render:
        return False
    is_tried = getattr(getattr(scene, "cycles", None), "feature_set", "") == "EXPERIMENTAL"
    return is_tried and bool(getattr(getattr(object, "cycles", None), "use_adaptive_subdivision", False))


def _add_another(context: Context, copies: _Copies, instance: Any, object: Any) -> bool:
    """One more copy, with pieces of its own. Whether there is room for it: else it looks like the first."""
    if len(copies.others) + 1 >= _MOST_OWN:
        what = f"its looks depend on where it is, or on the object: copies beyond {_MOST_OWN} look like the first"
        context.complain(f"object '{copies.name}'", what)
        return False
    matrix = instance.matrix_world
    rows = tuple(axes.array(matrix)[:3].reshape(-1))
    copies.others.append((rows, pieces_of(context, object, matrix, _origin(instance))))
    return True


def _kind(object: Any, shown: Shown) -> tuple[int, int, Shown]:
    """What is the same for all copies of one thing. The object of an instance is one for this step alone, whose address the
    next one may have, too; the object that it stands for stays."""
    return object.original.as_pointer(), object.data.as_pointer(), shown


def _id(instance: Any) -> tuple[int, ...]:
    """A copy's, which it has at all moments."""
    return (instance.parent.original.as_pointer(), *instance.persistent_id)


def _origin(instance: Any) -> Origin:
    if instance.is_instance:
        return Origin(instance.parent, (instance.random_id & 0xFFFFFFFF) / 0xFFFFFFFF)
    # As Cycles: by the name.
    number = 0
    for byte in instance.object.name.encode():
        number = (37 * number + byte) & 0xFFFFFFFF
    return Origin(None, float(hashed(number, 0)[0]) / 0xFFFFFFFF)


@contextmanager
def evaluated_mesh(object: Any) -> Iterator[Any]:
    """The mesh that an object has after its modifiers; None: it has none."""
    if object.mode != "EDIT":
        # That of the evaluated object, without a copy.
        yield object.data if len(object.data.polygons) else None
        return
    mesh = object.to_mesh()
    try:
        yield mesh if mesh is not None and len(mesh.polygons) else None
    finally:
        object.to_mesh_clear()


def pieces_of(context: Context, object: Any, matrix: Any, origin: Origin) -> list[Piece]:
    """The parts of an object's evaluated mesh, one for each material; `matrix`, Blender's, leads into its world."""
    slotted = tuple(slot.material.name_full if slot.material else "" for slot in object.material_slots)
    key = (object.data.as_pointer(), slotted)
    if key in context.pieces:
        return context.pieces[key]
    with evaluated_mesh(object) as mesh:
        if mesh is None:
            return []
        surface = Surface(mesh, object, axes.array(matrix), origin)
        if leaning(surface) > _MOST_LEANING:
            what = "its normals lean far from its faces: Cycles loses light there, Hyades none (10 to 30 % of a block, more on cards)"
            context.complain(f"object '{object.name}'", what)
        slots = surface.slots
        kinds = numpy.unique(slots)
        parts = [PartOfSurface(surface, slots == slot if len(kinds) > 1 else slice(None)) for slot in kinds]
        try:
            found = [_piece(context, one, _material_in(context, object, int(slot))) for one, slot in zip(parts, kinds)]
        except ValueError as error:  # of a mesh that the job refuses: it has numbers that are none, say
            context.complain(f"object '{object.name}'", f"its mesh is left out: {error}")
            return []
    if not any(one.is_of_object for one in parts):
        context.pieces[key] = found  # objects without modifiers of their own share their mesh
    return found


def _piece(context: Context, whole: PartOfSurface, data: Any) -> Piece:
    made = material_of(context, whole, data)
    piece = whole if made.displacement is None else displaced(made.displacement, whole)
    whole.is_of_object |= piece.is_of_object
    atlas = piece.atlas.uv() if made.is_baked and piece.atlas is not None else None
    mesh = part(piece.surface, piece.chosen, made.uv_map, made.color_attribute, atlas)
    body = objects.Mesh(mesh=mesh, material=made.material, interior=made.interior)
    if not values.is_constant(made.emission, 0):
        body.emit = objects.Emit(color=values.held(made.emission, 0.0, 1e18), radiance=1, two_sided=not made.is_one_sided)
    return Piece(body, made, whole.is_of_object)


def _material_in(context: Context, object: Any, slot: int) -> Optional[Any]:
    if context.override is not None:
        return context.override
    slots = object.material_slots
    # A slot that is not there stands for the last one.
    return slots[min(slot, len(slots) - 1)].material if len(slots) else None


def _add_piece(context: Context, name: str, piece: Piece, transform: Any, seen: Seen) -> None:
    body = piece.object()
    body.transform = transform
    add_seen(context, name, body, seen)


def _placed(rows: list[tuple[float, ...]]) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Matrices (n, 4, 4) into the job's world, and which rows those are."""
    matrices = numpy.zeros((len(rows), 4, 4))
    matrices[:, :3] = numpy.array(rows).reshape(-1, 3, 4)
    matrices[:, 3, 3] = 1
    placed = axes.TO_JOB @ matrices
    # What has no volume is not seen, and the job refuses it.
    there = numpy.flatnonzero(numpy.abs(numpy.linalg.det(placed[:, :3, :3])) > 1e-18)
    return placed[there], there


def _place(context: Context, copies: _Copies) -> None:
    """Copies as a group that is placed by a file; one by one where they are few, shine, or look different. Where they may
    move, a few are a group, too: there may be more at other moments."""
    placed, there = _placed(copies.matrices)
    shines = any(not values.is_constant(piece.made.emission, 0) for piece in copies.pieces)
    if shines or (len(placed) < 2 and (copies.looks_differ or not context.moves)):
        for matrix in placed:
            for piece in copies.pieces:
                _add_piece(context, copies.name, piece, axes.steps(matrix), copies.seen)
    elif copies.pieces and len(placed):
        ids = [copies.ids[at] for at in there] if context.moves else None
        _place_group(context, copies, MatrixPlaces(placed, ids))
    for rows, pieces in copies.others:
        for matrix in _placed([rows])[0]:
            for piece in pieces:
                _add_piece(context, copies.name, piece, axes.steps(matrix), copies.seen)


def _place_group(context: Context, copies: _Copies, places: MatrixPlaces) -> None:
    """Copies as a group, and a file of places."""
    bodies: dict[str, objects.Object] = {}
    for piece in copies.pieces:
        body = bodies[free_name(copies.name, bodies)] = piece.object()
        say(context, f"object '{copies.name}'", body, copies.seen.keys)  # each for itself: some may be filled
    group = objects.Group(objects=bodies)
    context.job.groups[free_name(copies.name, context.job.groups)] = group
    context.add_object(copies.name, objects.Instance(instance=group, places=places), copies.seen.owner)
