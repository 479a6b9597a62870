"""A scene as one job: its current frame, or all frames of its range."""

from __future__ import annotations

from typing import Any

from hyades import outputs

from . import capture, export, scene_job


def job_of(scene: Any, *, whole: bool, name: str) -> export.Exported:
    """The job of a scene as a final render sees it; `whole`: of all its frames. For the main thread, while
    nothing is rendered. ValueError where it cannot be said."""
    exported = export_frames(scene) if whole else capture.look_at_final(scene, _export_one)
    exported.job.name = scene_job.job_name(name)
    scene_job.apply_settings(exported.job, scene.hyades)
    exported.job.outputs = _outputs(scene, exported.job.name, whole)
    return exported


def export_frames(scene: Any) -> export.Exported:
    """All frames of the scene's range."""
    raise ValueError("animations are not exported yet")


def _export_one(depsgraph: Any) -> export.Exported:
    return export.export_job(depsgraph, settings=depsgraph.scene.hyades)


def _outputs(scene: Any, name: str, whole: bool) -> list[outputs.Output]:
    """An EXR with the passes of the scene's first view layer, and the picture as displays show it."""
    from . import passes

    number = ".####" if whole else ""
    layer = next(layer for layer in scene.view_layers if layer.use)
    layers = passes.layers_for(passes.asked_for(scene, layer))
    picture = outputs.Png(file=f"{name}{number}.png", exposure=scene.view_settings.exposure)
    picture.transparent = scene.render.film_transparent
    picture.tone_map = _TONE_MAPS.get(scene.view_settings.view_transform, "srgb")
    return [outputs.Exr(file=f"{name}{number}.exr", layers=layers), picture]


_TONE_MAPS = {"Standard": "srgb", "Filmic": "filmic", "AgX": "agx", "Raw": "linear"}
