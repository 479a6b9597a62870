"""Renders the current scene of Blender by Cycles and, through the exporter, by Hyades."""

import os
import pathlib

import bpy
import hyades
import numpy

from hyades_render import export


class Exporting(bpy.types.RenderEngine):
    """Not a renderer: gets the depsgraph of a final render, and exports it."""

    bl_idname = "HYADES_TRUTH"
    bl_label = "Exported for a test"
    exported = None

    def render(self, depsgraph) -> None:
        try:
            Exporting.exported = export.export_job(depsgraph)
        except Exception as error:  # Blender would print it and go on
            Exporting.exported = error


def exported() -> export.Exported:
    """What the exporter makes of the scene as a final render sees it."""
    Exporting.exported = None
    bpy.context.scene.render.engine = "HYADES_TRUTH"
    bpy.ops.render.render()
    if isinstance(Exporting.exported, Exception):
        raise Exporting.exported
    return Exporting.exported


def by_hyades(made: export.Exported, folder: pathlib.Path, samples: int) -> numpy.ndarray:
    """Light (h, w, 3)."""
    made.job.sampling.samples = samples
    made.job.outputs = [hyades.outputs.Exr(file="hyades.exr")]
    return hyades.render(made.job, folder).picture().array[:, :, :3].astype(float)


def by_cycles(folder: pathlib.Path, samples: int) -> numpy.ndarray:
    """Light (h, w, 3), without anything that is biased."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples = "CPU", samples
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = cycles.light_sampling_threshold = 0
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = 32
    cycles.transmission_bounces = cycles.transparent_max_bounces = cycles.volume_bounces = 32
    image = scene.render.image_settings
    image.file_format, image.color_depth, image.color_mode = "OPEN_EXR", "32", "RGB"
    scene.render.filepath = str(folder / "cycles.exr")
    bpy.ops.render.render(write_still=True)
    return pixels(folder / "cycles.exr")


def pixels(path: os.PathLike) -> numpy.ndarray:
    """A picture's light (h, w, 3), row 0 at the top."""
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Linear" if bpy.app.version < (4, 0) else "Linear Rec.709"
    light = numpy.empty(len(image.pixels), "float32")
    image.pixels.foreach_get(light)
    width, height = image.size
    bpy.data.images.remove(image)
    return light.reshape(height, width, -1)[::-1, :, :3].astype(float)
