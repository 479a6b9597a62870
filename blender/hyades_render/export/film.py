"""The picture: its size, border and filter, samples, depth of paths, frames, and how light is shown."""

from __future__ import annotations

import math

import hyades
import numpy
from hyades import integrators

from .context import Context

_FILTERS = {"BOX": "box", "GAUSSIAN": "gaussian", "BLACKMAN_HARRIS": "blackman-harris"}
_BLUR = 1.0
"""Filter Glossy as every scene of Blender has it, which is hardly seen."""


def add_film(context: Context) -> None:
    """Says film, sampling, integrator and frames of the job."""
    render = context.scene.render
    size = picture_size(render)
    film = hyades.Film(size=size, filter=_filter(context))
    if render.use_border:
        film.crop = _crop(render, size)
    context.job.film = film
    _tell_of_settings(context)
    context.job.sampling = hyades.Sampling(samples=int(context.setting("samples", 64)))
    if context.setting("noise", 0) > 0:
        context.job.sampling.noise = context.setting("noise", 0)
    context.job.integrator = integrators.Path(max_depth=int(context.setting("max_depth", 32)))
    fps = render.fps / render.fps_base
    context.job.frames = hyades.Frames(range=max(context.scene.frame_current, 0), fps=fps)


def _tell_of_settings(context: Context) -> None:
    """Complains of switches of the render and its view layer that the job has not, where they are not as they come."""
    render, cycles = context.scene.render, getattr(context.scene, "cycles", None)
    layer = context.depsgraph.view_layer_eval
    if getattr(cycles, "use_fast_gi", False):
        context.complain("render", "Fast GI Approximation is left out: all light is rendered")
    off = [kind for kind in ("reflective", "refractive") if not getattr(cycles, f"caustics_{kind}", True)]
    if off:
        context.complain("render", f"caustics are there, {' and '.join(off)} ones too: Light Paths switches them off in Cycles")
    if getattr(cycles, "blur_glossy", 0.0) > _BLUR:
        context.complain("render", "Filter Glossy is left out: what is seen by way of rough things stays as sharp as it is")
    if render.pixel_aspect_x != render.pixel_aspect_y:
        context.complain("output", "pixels that are not square are not supported; square ones are used")
    if render.film_transparent and getattr(cycles, "film_transparent_glass", False):
        context.complain("film", "Transparent Glass is left out: glass is there")
    if render.use_motion_blur and getattr(cycles, "rolling_shutter_type", "NONE") != "NONE":
        context.complain("render", "the rolling shutter is left out: all rows are seen at once")
    points = [tuple(point.location) for point in render.motion_blur_shutter_curve.curves[0].points]
    if render.use_motion_blur and any(y < 0.99 for x, y in points if 0.02 < x < 0.98):
        context.complain("render", "the curve of the shutter is left out: it opens and closes at once")
    if not layer.use_solid:
        context.complain("output", f"view layer '{layer.name}' is to have no surfaces; they are there")


def picture_size(render) -> list[int]:
    """Width and height of the whole picture [pixels], as Blender counts them."""
    share = render.resolution_percentage
    return [max(int(render.resolution_x * share / 100), 1), max(int(render.resolution_y * share / 100), 1)]


def film_exposure(scene) -> float:
    """By how much Film > Exposure makes light brighter, in files of light too."""
    return float(getattr(getattr(scene, "cycles", None), "film_exposure", 1.0))


def exposure_stops(scene) -> float:
    """By how many stops pictures for displays are brighter than the light."""
    return float(scene.view_settings.exposure) + math.log2(max(film_exposure(scene), 1e-9))


def _filter(context: Context) -> hyades.Filter:
    cycles = getattr(context.scene, "cycles", None)
    kind = _FILTERS[getattr(cycles, "pixel_filter_type", "BLACKMAN_HARRIS")]
    if kind == "box":
        return hyades.Filter(type="box", radius=0.5)
    width = getattr(cycles, "filter_width", context.scene.render.filter_size)
    return hyades.Filter(type=kind, radius=max(width / 2, 0.01))


def _crop(render, size: list[int]) -> list[int]:
    """The border in pixels, with row 0 at the top; cut to whole ones as Blender does, in single precision."""
    width, height = size
    x0, x1 = (int(numpy.float32(edge) * numpy.float32(width)) for edge in (render.border_min_x, render.border_max_x))
    low, high = (int(numpy.float32(edge) * numpy.float32(height)) for edge in (render.border_min_y, render.border_max_y))
    return [x0, height - high, max(x1, x0 + 1), max(height - low, height - high + 1)]
