"""What Blender's camera would cut off, near by or far away, and jobs show."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy
from hyades import MeshData, cameras, objects

from .camera import Pose
from .context import Context
from .places import MatrixPlaces

Array = Any
_MOST_LOOKED_AT = 200  # copies of one thing whose boxes are cut
# Corners of a box by the bits of their numbers: x, y, z.
_FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def tell_of_clipping(context: Context) -> None:
    """Complains where the box of something that the camera sees reaches out of its clipping."""
    camera, made = context.scene.camera, context.job.camera
    if camera is None or not isinstance(made, (cameras.Perspective, cameras.Orthographic)):
        return
    view, sides = _view(camera), _sides(context, made)
    start, end = camera.data.clip_start, camera.data.clip_end
    if isinstance(made, cameras.Orthographic):
        in_front = []
    else:
        in_front = [(0.0, 0.0, 1.0, -1e-4 * start)]
    cuts = [
        (f"nearer than its clip start of {start:g} m", [*sides, *in_front, (0.0, 0.0, -1.0, start * (1 - 1e-4))]),
        (f"farther away than its clip end of {end:g} m", [*sides, (0.0, 0.0, 1.0, -end * (1 + 1e-4))]),
    ]
    for name, box, matrices in _boxes(context):
        for far in _candidates(view @ matrices, box, start, end):
            for what, planes in list(cuts):
                if any(_is_left(far[list(face)], planes) for face in _FACES):
                    thing = context.names.objects.get(name, name)
                    context.complain(f"camera '{camera.name}'", f"jobs clip nothing: '{thing}' is seen, {what}")
                    cuts.remove((what, planes))
        if not cuts:
            return


def _view(camera: Any) -> Array:
    """(4, 4) from the job's world: right, up, and how far ahead."""
    pose = Pose(camera.matrix_world)
    turn = numpy.stack([pose.right, numpy.array(pose.up), pose.forward])
    view = numpy.eye(4)
    view[:3, :3], view[:3, 3] = turn, -turn @ numpy.array(pose.place)
    return view


def _sides(context: Context, made: Any) -> list[tuple[float, ...]]:
    """Planes a x + b y + c z + d >= 0 of what is in the picture."""
    width, height = context.job.film.size
    if isinstance(made, cameras.Orthographic):
        # Its pose is where the camera was before the picture was shifted: half a picture more is looked at.
        y = made.height
        x = y * width / height
        return [(1, 0, 0, x), (-1, 0, 0, x), (0, 1, 0, y), (0, -1, 0, y)]
    y = math.tan(math.radians(made.fov) / 2)
    x = y * width / height
    right, up = (2 * part for part in (made.shift or (0, 0)))
    return [(1, 0, x * (1 - right), 0), (-1, 0, x * (1 + right), 0), (0, 1, y * (1 - up), 0), (0, -1, y * (1 + up), 0)]


def _boxes(context: Context) -> Iterator[tuple[str, Array, Array]]:
    """What the camera sees: its name, corners (8, 4) and where it stands (n, 4, 4)."""
    known: dict[int, Array] = {}

    def corners(mesh: Any) -> Array:
        if id(mesh) not in known:
            low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
            rows = [[(low, high)[n >> axis & 1][axis] for axis in range(3)] + [1.0] for n in range(8)]
            known[id(mesh)] = numpy.array(rows, float)
        return known[id(mesh)]

    for name, body in context.job.objects.items():
        if not body.visible_to_camera:
            continue
        if isinstance(body, objects.Mesh) and isinstance(body.mesh, MeshData) and len(body.mesh.positions):
            matrix = numpy.array(body.transform[0].matrix).reshape(1, 4, 4) if body.transform else numpy.eye(4)[None]
            yield name, corners(body.mesh), matrix
        elif isinstance(body, objects.Instance) and isinstance(body.places, MatrixPlaces):
            for inner in body.instance.objects.values():
                yield name, corners(inner.mesh), body.places.matrices


def _candidates(views: Array, box: Array, start: float, end: float) -> Array:
    """Boxes (n, 8, 3) as the camera has them, of those that are neither wholly within its clipping nor behind it."""
    depths = numpy.einsum("nj,cj->nc", views[:, 2], box)
    nearest, farthest = depths.min(axis=1), depths.max(axis=1)
    found = numpy.flatnonzero((farthest > 0) & ((nearest < start) | (farthest > end)))[:_MOST_LOOKED_AT]
    return numpy.einsum("nij,cj->nci", views[found], box)[:, :, :3]


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
