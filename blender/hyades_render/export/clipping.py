"""What Blender's camera would cut off, near by or far away, and jobs show."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy
from hyades import MeshData, cameras, objects

from .context import Context
from .places import MatrixPlaces

Array = Any
_UNCHANGED = numpy.eye(4).ravel().tolist()
_MOST_LOOKED_AT = 200  # copies of one thing whose boxes are cut
# Corners of a box by the bits of their numbers: x, y, z.
_FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def tell_of_clipping(context: Context) -> None:
    """Complains where the box of something that the camera sees reaches out of its clipping."""
    camera, made = context.scene.camera, context.job.camera
    if camera is None or not isinstance(made, (cameras.Perspective, cameras.Orthographic)):
        return
    view, sides = _view(made), _sides(context, made)
    start, end = camera.data.clip_start, camera.data.clip_end
    near = [(0.0, 0.0, 1.0, -1e-4 * start), (0.0, 0.0, -1.0, start * (1 - 1e-4))]
    cuts = [
        (f"nearer than its clip start of {start:g} m", [*sides, *near]),
        (f"farther away than its clip end of {end:g} m", [*sides, (0.0, 0.0, 1.0, -end * (1 + 1e-4))]),
    ]
    for names, box, matrices in _boxes(context):
        found, boxes = _candidates(view @ matrices, box, start, end)
        for at, corners in zip(found, boxes):
            for what, planes in list(cuts):
                if any(_is_left(corners[list(face)], planes) for face in _FACES):
                    name = names[min(at, len(names) - 1)]
                    thing = context.names.objects.get(name, name)
                    context.complain(f"camera '{camera.name}'", f"jobs clip nothing: '{thing}' is seen, {what}")
                    cuts.remove((what, planes))
        if not cuts:
            return


def _view(made: Any) -> Array:
    """(4, 4) from the job's world: right, up, and how far ahead."""
    place = numpy.array(made.look_from)
    forward = numpy.array(made.look_at) - place
    right = numpy.cross(forward, made.up)
    turn = numpy.stack([right / numpy.linalg.norm(right), numpy.cross(right, forward), forward])
    turn /= numpy.linalg.norm(turn, axis=1, keepdims=True)
    view = numpy.eye(4)
    view[:3, :3], view[:3, 3] = turn, -turn @ place
    return view


def _sides(context: Context, made: Any) -> list[tuple[float, ...]]:
    """Planes a x + b y + c z + d >= 0 of what is in the picture."""
    width, height = context.job.film.size
    if isinstance(made, cameras.Orthographic):
        y = made.height / 2
        x = y * width / height
        return [(1, 0, 0, x), (-1, 0, 0, x), (0, 1, 0, y), (0, -1, 0, y)]
    y = math.tan(math.radians(made.fov) / 2)
    x = y * width / height
    right, up = (2 * part for part in (made.shift or (0, 0)))
    return [(1, 0, x * (1 - right), 0), (-1, 0, x * (1 + right), 0), (0, 1, y * (1 - up), 0), (0, -1, y * (1 + up), 0)]


def _boxes(context: Context) -> Iterator[tuple[list[str], Array, Array]]:
    """What the camera sees: names (of copies one), corners (8, 4) and where each stands (n, 4, 4)."""
    placed: dict[int, tuple[Any, list[str], list[Any]]] = {}  # many objects may have one mesh
    for name, body in context.job.objects.items():
        if isinstance(body, objects.Mesh) and isinstance(body.mesh, MeshData) and body.visible_to_camera:
            _, names, rows = placed.setdefault(id(body.mesh), (body.mesh, [], []))
            names.append(name)
            rows.append(body.transform[0].matrix if body.transform else _UNCHANGED)
        elif isinstance(body, objects.Instance) and isinstance(body.places, MatrixPlaces):
            for inner in filter(lambda one: one.visible_to_camera, body.instance.objects.values()):
                yield [name], _corners(inner.mesh), body.places.matrices
    for mesh, names, rows in placed.values():
        if len(mesh.positions):
            yield names, _corners(mesh), numpy.array(rows).reshape(-1, 4, 4)


def _corners(mesh: MeshData) -> Array:
    """(8, 4) of its box."""
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    return numpy.array([[(low, high)[n >> axis & 1][axis] for axis in range(3)] + [1.0] for n in range(8)], float)


def _candidates(views: Array, box: Array, start: float, end: float) -> tuple[Array, Array]:
    """Those that are neither wholly within its clipping nor behind it, and their boxes (n, 8, 3) as the camera has them."""
    depths = numpy.einsum("nj,cj->nc", views[:, 2], box)
    nearest, farthest = depths.min(axis=1), depths.max(axis=1)
    found = numpy.flatnonzero((farthest > 0) & ((nearest < start) | (farthest > end)))[:_MOST_LOOKED_AT]
    return found, numpy.einsum("nij,cj->nci", views[found], box)[:, :, :3]


def _is_left(polygon: Array, planes: list[tuple[float, ...]]) -> bool:
    """Whether anything of a polygon (n, 3) is on the right side of all planes (Sutherland and Hodgman 1974)."""
    for a, b, c, d in planes:
        sides = polygon @ numpy.array([a, b, c]) + d
        kept = []
        for at in range(len(polygon)):
            here, before = sides[at], sides[at - 1]
            if (here >= 0) != (before >= 0):
                kept.append(polygon[at - 1] + (polygon[at] - polygon[at - 1]) * (before / (before - here)))
            if here >= 0:
                kept.append(polygon[at])
        if not kept:
            return False
        polygon = numpy.array(kept)
    return True
