"""The viewport in rendered mode: exports what has changed, asks a Refiner for pictures and draws the newest."""

from __future__ import annotations

import weakref
from typing import Any

import bpy
import hyades
import numpy

from . import complaints, preferences, scene_job
from .export import export_job
from .export.film import film_exposure
from .refiner import Refiner, View
from .view_camera import camera_of

_open: weakref.WeakSet[Any] = weakref.WeakSet()


def close_all() -> None:
    """Ends the renders of all viewports."""
    for viewport in list(_open):
        viewport.close()


class Viewport:
    """One viewport that shows Hyades' picture."""

    def __init__(self, engine: Any) -> None:
        self._engine = weakref.ref(engine)
        self._refiner: Refiner | None = None
        self._seen: Any = None  # what is asked for, to notice changes
        self._texture: Any = None
        self._texture_number = -1
        _open.add(self)

    def close(self) -> None:
        """Ends its render."""
        refiner, self._refiner = self._refiner, None
        if refiner is not None:
            refiner.close()

    def update(self, context: Any, depsgraph: Any) -> None:
        """The scene has changed: it is exported again. What is alike in it is not written again."""
        engine = self._engine()
        try:
            exported = export_job(depsgraph, settings=depsgraph.scene.hyades)
            job = exported.job
            scene_job.apply_settings(job, depsgraph.scene.hyades)
            job.sampling = job.film = job.camera = None
            job.denoise = False
            complaints.keep(depsgraph.scene, exported.complaints)
            self._ask(context, depsgraph, job)
        except (hyades.HyadesError, OSError, ValueError) as error:
            engine.update_stats("Hyades", str(error))

    def draw(self, context: Any, depsgraph: Any) -> None:
        """Draws the newest picture; asks for another where the viewport looks elsewhere now."""
        try:
            self._ask(context, depsgraph, None)
        except (hyades.HyadesError, OSError, ValueError) as error:
            self._engine().update_stats("Hyades", str(error))
            return
        if self._refiner is None:
            return
        self._engine().update_stats("Hyades", self._refiner.words())
        number, picture = self._refiner.picture()
        if picture is not None:
            self._draw_picture(context, depsgraph.scene, number, picture)

    def _ask(self, context: Any, depsgraph: Any, job: Any) -> None:
        region, space = context.region, context.region_data
        scene = depsgraph.scene
        pixel = max(int(self._engine().get_preview_pixel_size(scene)), 1)
        width, height = max(region.width // pixel, 1), max(region.height // pixel, 1)
        samples = scene.hyades.preview_samples
        matrices = (space.view_matrix, space.window_matrix)
        seen = (width, height, samples, *(number for matrix in matrices for row in matrix for number in row))
        if job is None and (self._refiner is None or seen == self._seen):
            return
        self._seen = seen
        if self._refiner is None:
            self._refiner = Refiner(
                preferences.find_program(), bpy.app.tempdir or None, preferences.threads(), self._redraw
            )
        self._refiner.show(job, View(camera_of(*matrices, space.view_distance), width, height, samples))

    def _redraw(self) -> None:
        """Called by the Refiner's thread."""
        engine = self._engine()
        if engine is not None:
            try:
                engine.tag_redraw()
            except ReferenceError:
                pass  # Blender has freed it

    def _draw_picture(self, context: Any, scene: Any, number: int, picture: numpy.ndarray) -> None:
        import gpu
        from gpu_extras.presets import draw_texture_2d

        if number != self._texture_number:
            picture = picture.copy()
            picture[:, :, :3] *= film_exposure(scene)
            if not scene.render.film_transparent:
                picture[:, :, 3] = 1
            height, width = picture.shape[:2]
            pixels = numpy.ascontiguousarray(picture[::-1], numpy.float32).reshape(-1)
            buffer = gpu.types.Buffer("FLOAT", len(pixels), pixels)
            self._texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=buffer)
            self._texture_number = number
        engine = self._engine()
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        draw_texture_2d(self._texture, (0, 0), context.region.width, context.region.height)
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")
