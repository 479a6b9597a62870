"""The camera of a viewport, out of the matrices that Blender draws it with."""

from __future__ import annotations

import math
from typing import Any

import numpy
from hyades import cameras

from .export import axes


def camera_of(view_matrix: Any, window_matrix: Any, distance: float) -> cameras.Camera:
    """A camera that sees what a viewport with these matrices (world to view, view to clip space) shows.

    distance: how far what is looked at is; parallel rays begin far behind the viewport, which sees that too.
    """
    pose = numpy.linalg.inv(axes.array(view_matrix))
    placed = axes.TO_JOB @ pose
    right, up, back = (placed[:3, i] / numpy.linalg.norm(placed[:3, i]) for i in range(3))
    clip = axes.array(window_matrix)
    at = placed[:3, 3]
    if clip[3, 3] == 0:
        shift = [clip[0, 2] / 2, clip[1, 2] / 2]
        fov = math.degrees(2 * math.atan(1 / clip[1, 1]))
        pose_keys = _pose(at, back, up)
        return cameras.Perspective(fov=min(fov, 179.9), shift=_bounded(shift), **pose_keys)
    at = at - right * clip[0, 3] / clip[0, 0] - up * clip[1, 3] / clip[1, 1] + back * max(20 * distance, 100.0)
    return cameras.Orthographic(height=2 / clip[1, 1], **_pose(at, back, up))


def _pose(at: numpy.ndarray, back: numpy.ndarray, up: numpy.ndarray) -> dict[str, list[float]]:
    return {"look_from": axes.numbers(at), "look_at": axes.numbers(at - back), "up": axes.numbers(up)}


def _bounded(shift: list[float]) -> list[float]:
    return [min(max(float(part), -100.0), 100.0) for part in shift]
