"""The scene's camera: perspective, orthographic or a panorama, with its shift and lens."""

from __future__ import annotations

import math
from typing import Any

import numpy
from hyades import cameras

from . import axes
from .context import Context
from .film import picture_size


def add_camera(context: Context, camera: Any) -> None:
    """Says the camera of the job. Without one (None) the job keeps its default, with a complaint. ValueError: a final
    render by what is no camera."""
    if camera is None:
        context.complain("scene", "there is no camera")
        return
    if camera.type != "CAMERA":
        words = f"the scene's camera '{camera.name}' is of type {camera.type.lower()}, expected a camera"
        if context.depsgraph.mode == "RENDER":
            raise ValueError(words)
        context.complain("scene", words)  # viewports have one of their own
        return
    if context.scene.render.use_multiview:
        context.complain("scene", "stereo and multiple views are not supported: the camera's own view is rendered")
    context.job.camera = translated(context, camera)


def translated(context: Context, camera: Any) -> cameras.Camera:
    """An object of type CAMERA as the job's camera."""
    data, where = camera.data, f"camera '{camera.name}'"
    pose = Pose(camera.matrix_world)
    if camera.matrix_world.is_negative:
        context.complain(where, "its scale mirrors the picture, which is rendered as it is without")
    if pose.is_sheared:
        context.complain(where, "what it is parented to shears it; it sees as if it were upright")
    placed = {"look_from": pose.place, "look_at": pose.ahead, "up": pose.up}
    if data.type == "PANO":
        kind = panorama_type(context, data)
        if kind != "EQUIRECTANGULAR":
            context.complain(where, f"panoramas of type {kind.lower()} are not supported; equirectangular is used")
        elif _is_part(data):
            context.complain(where, "a panorama shows all around: its limits are left out")
        if data.dof.use_dof:
            context.complain(where, "panoramas are sharp everywhere: its depth of field is left out")
        return cameras.Equirectangular(**placed)
    frame = Frame(context.scene.render, data)
    lens = _lens(context, camera, pose)
    if data.type == "ORTHO":
        # All rays are parallel: a shift of the picture is one of the camera.
        placed |= pose.moved(data.shift_x * data.ortho_scale, data.shift_y * data.ortho_scale)
        return cameras.Orthographic(height=data.ortho_scale * frame.height, **placed, **lens)
    fov = math.degrees(2 * math.atan(frame.sensor * frame.height / (2 * data.lens)))
    return cameras.Perspective(fov=fov, shift=frame.shift, **placed, **lens)


class Pose:
    """Where a camera stands and looks, in the job's world."""

    def __init__(self, matrix: Any) -> None:
        matrix = axes.placed(matrix)
        forward = -matrix[:3, 2] / numpy.linalg.norm(matrix[:3, 2])
        self.forward, self.right = forward, matrix[:3, 0] / numpy.linalg.norm(matrix[:3, 0])
        self.place = axes.numbers(matrix[:3, 3])
        self.ahead = axes.numbers(matrix[:3, 3] + forward)
        self.up = axes.numbers(matrix[:3, 1] / numpy.linalg.norm(matrix[:3, 1]))
        columns = matrix[:3, :3] / numpy.linalg.norm(matrix[:3, :3], axis=0)
        self.is_sheared = numpy.abs(columns.T @ columns - numpy.eye(3)).max() > 1e-3

    def moved(self, right: float, up: float) -> dict[str, list[float]]:
        """Where a camera stands and looks that is moved in its picture's plane."""
        step = right * self.right + up * numpy.array(self.up)
        return {"look_from": axes.numbers(self.place + step), "look_at": axes.numbers(self.ahead + step)}


class Frame:
    """What the picture shows, in parts of the side that the sensor is fitted to."""

    def __init__(self, render: Any, data: Any) -> None:
        width, height = picture_size(render)
        fit = data.sensor_fit
        if fit == "AUTO":
            fit = "HORIZONTAL" if width >= height else "VERTICAL"
        fitted = width if fit == "HORIZONTAL" else height
        self.height = height / fitted
        # In AUTO the sensor's width counts, whichever side it is fitted to.
        self.sensor = data.sensor_height if data.sensor_fit == "VERTICAL" else data.sensor_width
        self.shift = [data.shift_x * fitted / width, data.shift_y * fitted / height]


def panorama_type(context: Context, data: Any) -> str:
    """Which panorama a camera takes: a key of Cycles until 4.x moved it to the camera itself."""
    if hasattr(data, "panorama_type"):
        return data.panorama_type
    return getattr(getattr(data, "cycles", None), "panorama_type", "EQUIRECTANGULAR")


def _is_part(data: Any) -> bool:
    """Whether a panorama is kept within some latitudes and longitudes."""
    owner = data if hasattr(data, "latitude_min") else data.cycles
    whole = {"latitude_min": -math.pi / 2, "latitude_max": math.pi / 2, "longitude_min": -math.pi, "longitude_max": math.pi}
    return any(abs(getattr(owner, name) - angle) > 1e-5 for name, angle in whole.items())


def _lens(context: Context, camera: Any, pose: Pose) -> dict[str, Any]:
    """Aperture and focus; nothing where all is sharp."""
    data = camera.data
    dof = data.dof
    if not dof.use_dof:
        return {}
    # Cycles: the focal length in metres over twice the f-stop; of an orthographic camera 1 over it.
    length = data.lens / 1000 if data.type == "PERSP" else 1.0
    aperture = cameras.Aperture(radius=length / (2 * max(dof.aperture_fstop, 1e-6)))
    if dof.aperture_blades >= 3:
        aperture.blades = min(dof.aperture_blades, 64)
        aperture.rotation = math.degrees(dof.aperture_rotation)
    if dof.aperture_ratio != 1:
        context.complain(f"camera '{camera.name}'", "apertures are round or regular; the ratio is left out")
    distance = dof.focus_distance
    if dof.focus_object is not None:
        there = axes.placed(dof.focus_object.matrix_world)[:3, 3]
        distance = abs(float(numpy.dot(there - numpy.array(pose.place), pose.forward)))
    return {"aperture": aperture, "focus": max(distance, 1e-6)}
