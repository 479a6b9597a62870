"""A scene with the settings of the add-on as a job: what the exporter says, and how it is rendered."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import bpy
import hyades
from hyades import integrators, outputs

from .export import Exported
from .moving import Moments


def scene_job(engine: Any, depsgraph: Any, layers: list[str], name: str = "blender") -> Exported:
    """The job of a depsgraph's current frame, which writes one EXR with these layers: NAME.exr. For render()
    of an engine."""
    scene = depsgraph.scene
    moments = Moments()
    moments.export(engine, depsgraph)
    exported = moments.job(max(scene.frame_current, 0))
    job = exported.job
    job.name = name
    apply_settings(job, scene.hyades)
    job.outputs = [outputs.Exr(file=f"{name}.exr", layers=layers)]
    return exported


def apply_settings(job: hyades.Job, settings: Any) -> None:
    """Says sampling, integrator, class and denoising as `scene.hyades` has them."""
    job.sampling = hyades.Sampling(samples=settings.samples, seed=settings.seed)
    if settings.noise > 0:
        job.sampling.noise = settings.noise
        job.sampling.min_samples = min(settings.min_samples, settings.samples)
    depths = {"max_depth": settings.max_depth, "roulette_depth": settings.roulette_depth}
    if settings.integrator == "bdpt":
        job.integrator = integrators.Bdpt(**depths)
    elif settings.integrator == "mlt":
        job.integrator = integrators.Mlt(over=settings.mlt_over, large_step=settings.large_step, **depths)
    else:
        job.integrator = integrators.Path(clamp=settings.clamp, **depths)
    if settings.render_class != "native":
        job.render = hyades.Render(class_=settings.render_class)
    if settings.denoise != "none":
        job.denoise = True if settings.denoise == "true" else settings.denoise


def farm_options(settings: Any) -> dict[str, Any]:
    """What `scene.hyades` says to Farm.submit()."""
    tags = [tag.strip() for tag in settings.farm_tags.split(",") if tag.strip()]
    return {"priority": settings.farm_priority, "tags": tags}


def name_of(scene: Any) -> str:
    """What the scene's jobs are called on the farm."""
    return job_name(scene.hyades.farm_name or Path(bpy.data.filepath).stem or scene.name)


def job_name(text: str, default: str = "blender") -> str:
    """`text` as the name of a job: 1 to 100 letters, digits, _, -, . and inner spaces."""
    name = re.sub(r"[^A-Za-z0-9_\-. ]", "_", text).strip(" ").lstrip("-.")[:100].rstrip(" ")
    return name or default


def name_in_blender(job: hyades.Job, thing: Any) -> str | None:
    """What wrote a line of the job, by its name: "object 'Cube'". None where it has none."""
    sections = {"material": job.materials, "object": job.objects, "light": job.lights, "texture": job.textures}
    for kind, section in sections.items():
        for name, one in section.items():
            if one is thing:
                return f"{kind} '{name}'"
    return None
