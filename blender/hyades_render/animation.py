"""A scene as one job: its current frame, or all frames of its range, with the files that its output properties name."""

from __future__ import annotations

import os
import re
from collections.abc import Generator
from pathlib import Path
from typing import Any

import bpy
import hyades
from hyades import outputs

from . import capture, joined_frames, movement, passes, scene_job
from .export import Complaint, Exported, Names, export_job
from .export.film import exposure_stops, film_exposure
from .moving import Moments

_TONE_MAPS = {"Standard": "srgb", "Raw": "linear"}  # views that need no configuration of OpenColorIO
_LOOKS = 5  # frames that tell whether anything moves, mostly
_VIDEOS = {
    "MPEG4": (outputs.Video, ".mp4", "H264"),
    "QUICKTIME": (outputs.Video, ".mov", "H264"),
    "WEBM": (outputs.Webm, ".webm", "WEBM"),
}
"""By Blender's format: the output of a job, how its file ends, and its codec as Blender calls it (WEBM is VP9)."""
_PLAIN_COMPOSITE = {"R_LAYERS", "COMPOSITE", "VIEWER", "SPLITVIEWER", "FRAME", "REROUTE"}
_NOT_CHOSEN = ("", "/tmp/", "/tmp\\")
"""Output paths that Blender comes with."""
_EXR = ("OPEN_EXR", "OPEN_EXR_MULTILAYER")


def job_of(scene: Any, *, frames: range | None, name: str) -> Exported:
    """The job of a scene as a final render sees it: of `frames`, or as one picture of the current one. For the
    main thread, while nothing is rendered. ValueError where it cannot be said."""
    *_, last = steps(scene, frames=frames, name=name)
    return last


def steps(scene: Any, *, frames: range | None, name: str) -> Generator[Any, None, None]:
    """The same, frame by frame: yields texts that tell how far it is, and the Exported in the end."""
    chosen = range(scene.frame_current, scene.frame_current + 1) if frames is None else frames
    if len(chosen) == 0 or chosen[0] < 0:
        raise ValueError(f"frames {text_of(chosen)}: expected at least one, from 0 on")
    return _steps(scene, chosen, frames is not None, name)


def all_frames(scene: Any) -> range:
    """The frames that Blender renders of an animation."""
    return range(scene.frame_start, scene.frame_end + 1, scene.frame_step)


def moving_frames(scene: Any) -> range | None:
    """All frames of a scene, None where they are alike: it is a picture. A few are looked at; all, where something is
    animated, driven or simulated that may move between those."""
    frames = all_frames(scene)
    some = sorted({frames[len(frames) * part // (_LOOKS - 1) - (part == _LOOKS - 1)] for part in range(_LOOKS)})
    before = scene.frame_current, scene.frame_subframe
    try:
        scene.frame_set(some[0])
        first, may_move = capture.look_at_final(scene, _looked_at)
        rest = [frame for frame in frames if frame not in some] if may_move else []
        for frame in [*some[1:], *rest]:
            scene.frame_set(frame)
            if not joined_frames.alike(first, capture.look_at_final(scene, _looked_at)[0]):
                return frames
    finally:
        scene.frame_set(before[0], subframe=before[1])
    return None


def still_note(scene: Any) -> str:
    """What is told of a scene in which nothing moves; empty where it has one frame."""
    frames = all_frames(scene)
    if len(frames) < 2:
        return ""
    still = f"nothing moves in frames {text_of(frames)}"
    return f"scene '{scene.name}': {still}: one picture of frame {scene.frame_current} is made"


def text_of(frames: range) -> str:
    """As the job says frames: 1-10x2."""
    if len(frames) == 1:
        return str(frames[0])
    return f"{frames.start}-{frames.stop - 1}" + (f"x{frames.step}" if frames.step > 1 else "")


def _looked_at(_engine: Any, depsgraph: Any) -> tuple[hyades.Job, bool]:
    """The scene at one frame, which the job does not say; whether it may be another one at others."""
    job = export_job(depsgraph, settings=depsgraph.scene.hyades).job
    job.frames = None
    job.outputs = [outputs.Png(file="looked-at.png", exposure=_exposure(depsgraph.scene))]
    return job, movement.may_move(depsgraph)


def _exposure(scene: Any) -> float:
    return min(max(exposure_stops(scene), -64.0), 64.0)


def _steps(scene: Any, frames: range, numbered: bool, name: str) -> Generator[Any, None, None]:
    moments, exposures = Moments(many=len(frames) > 1), set()
    before = scene.frame_current, scene.frame_subframe
    try:
        for number, frame in enumerate(frames, start=1):
            yield f"exporting frame {number} of {len(frames)}"
            scene.frame_set(frame)
            capture.look_at_final(scene, moments.export)
            exposures.add(_exposure(scene))
    finally:
        scene.frame_set(before[0], subframe=before[1])
    exported = moments.job(text_of(frames) if len(frames) > 1 else frames[0])
    job = exported.job
    job.name = scene_job.job_name(name)
    scene_job.apply_settings(job, scene.hyades)
    job.outputs, more = _outputs(scene, job, numbered)
    more += _of_mattes(job.outputs[0], exported.names)
    more += _of_drawings(scene)
    if len(exposures) > 1:
        words = f"the exposure moves; all frames have that of frame {scene.frame_current}"
        more.append(Complaint("color management", words))
    yield Exported(job, [*exported.complaints, *more], exported.names)


def _of_drawings(scene: Any) -> list[Complaint]:
    """Of grease pencil, which Blender itself draws over what F12 renders."""
    drawn = [one for one in scene.objects if one.type in ("GPENCIL", "GREASEPENCIL") and not one.hide_render]
    return [Complaint(f"object '{one.name}'", "grease pencil is drawn by Blender alone; it is left out") for one in drawn]


def output_folder(scene: Any) -> Path:
    """Where the scene's output goes, as an absolute path."""
    path = bpy.path.abspath(scene.render.filepath)
    return Path(path if path.endswith(("/", "\\")) else Path(path).parent).absolute()


def _outputs(scene: Any, job: hyades.Job, numbered: bool) -> tuple[list[outputs.Output], list[Complaint]]:
    """What the scene's output properties ask for, below the folder that they name."""
    image, found = scene.render.image_settings, []
    kind = image.file_format
    stem = _stem(scene, job.name, numbered and kind != "FFMPEG")
    shown: dict[str, Any] = {"exposure": _exposure(scene)}
    job.color = view_of(scene) if kind not in _EXR else None
    if job.color is None:
        shown["tone_map"] = _TONE_MAPS.get(scene.view_settings.view_transform, "srgb")
    found += _of_view(scene.view_settings) if kind not in _EXR else []
    see_through = scene.render.film_transparent and image.color_mode == "RGBA"
    if kind in _EXR:
        if film_exposure(scene) != 1:
            found.append(Complaint("film", "files of type EXR keep the light as it is: the exposure is left out"))
        layer = next(layer for layer in scene.view_layers if layer.use)
        wanted = passes.asked_for(scene, layer) if kind == "OPEN_EXR_MULTILAYER" else []
        layers = passes.layers_for(wanted)
        if not scene.render.film_transparent:
            layers.remove("alpha")
        made: outputs.Output = outputs.Exr(file=stem + ".exr", layers=layers, half=image.color_depth == "16")
        found += _of_axes(layers) + (passes.not_there(layer) if kind == "OPEN_EXR_MULTILAYER" else [])
    elif kind == "JPEG":
        made = outputs.Jpg(file=stem + ".jpg", quality=max(image.quality, 1), **shown)
    elif kind == "TIFF":
        made = outputs.Tiff(file=stem + ".tif", transparent=see_through, bits=_bits(image), **shown)
    elif kind == "FFMPEG" and numbered:
        video, end, codec = _VIDEOS.get(scene.render.ffmpeg.format, (outputs.Video, ".mp4", "H264"))
        found += _of_video(scene.render.ffmpeg, codec)
        made = video(file=stem + end, **shown)
    else:
        if kind == "FFMPEG":
            found.append(Complaint("output", "one picture is no video: PNG is written"))
        elif kind != "PNG":
            found.append(Complaint("output", f"files of type {kind} are not written; PNG is"))
        made = outputs.Png(file=stem + ".png", transparent=see_through, bits=_bits(image), **shown)
    if image.color_mode == "BW":
        found.append(Complaint("output", "pictures are written in colour, not in black and white"))
    return [made], found + _after_render(scene)


def _of_video(video: Any, codec: str) -> list[Complaint]:
    """What a video has not."""
    found = []
    if video.format not in _VIDEOS:
        found.append(Complaint("output", f"videos of format {video.format} are not written; MPEG4 is"))
    elif video.codec != codec:
        found.append(Complaint("output", f"videos of codec {video.codec} are not written; {codec} is"))
    if video.audio_codec != "NONE":
        found.append(Complaint("output", "videos have no sound"))
    return found


def _after_render(scene: Any) -> list[Complaint]:
    """What Blender would make of a scene besides the picture of its first view layer."""
    render, found = scene.render, []
    layers = [layer.name for layer in scene.view_layers if layer.use]
    if len(layers) > 1:
        others = ", ".join(f"'{name}'" for name in layers[1:])
        found.append(Complaint("output", f"view layer '{layers[0]}' is rendered, not {others}"))
    tree = getattr(scene, "node_tree", None) or getattr(scene, "compositing_node_group", None)  # since Blender 5
    nodes = tree.nodes if scene.use_nodes and tree is not None else ()
    if render.use_compositing and any(node.type not in _PLAIN_COMPOSITE and not node.mute for node in nodes):
        found.append(Complaint("output", "nodes of the compositor are left out"))
    editor = scene.sequence_editor
    strips = getattr(editor, "strips", None) or getattr(editor, "sequences", ())  # since Blender 4.4, and before
    if render.use_sequencer and len(strips):
        found.append(Complaint("output", "strips of the sequencer are left out: the scene is rendered"))
    if render.use_freestyle and scene.view_layers[layers[0]].use_freestyle:
        found.append(Complaint("output", "the lines of Freestyle are left out"))
    if render.use_border and not render.use_crop_to_border:
        words = "pictures have the size of the render region: what Blender leaves black around it is not there"
        found.append(Complaint("output", words))
    if render.use_stamp:
        found.append(Complaint("output", "nothing is burned into the picture: metadata are left out"))
    if render.use_multiview:
        found.append(Complaint("output", "stereo and multiple views are left out: the camera's own view is rendered"))
    if not render.use_file_extension:
        found.append(Complaint("output", "names of files end with their extension"))
    return found


def _of_mattes(made: outputs.Output, names: Names) -> list[Complaint]:
    """Whether Cryptomattes of a file are called otherwise than in Blender."""
    found = []
    for layer, known in (("crypto_object", names.objects), ("crypto_material", names.materials)):
        other = next((f"'{name}' is '{ours}'" for ours, name in known.items() if ours != name), None)
        if other is not None and isinstance(made, outputs.Exr) and layer in made.layers:
            found.append(Complaint("output", f"{layer} of EXR files has the job's names: {other}"))
    return found


def _of_axes(layers: list[str]) -> list[Complaint]:
    """What of an EXR differs from that of F12, which is turned when it comes to Blender."""
    found = []
    turned = [name for name in ("position", "normal") if name in layers]
    if turned:
        words = f"{' and '.join(turned)} of EXR files are those of the job, where y is up: x, z, -y of Blender's"
        found.append(Complaint("output", words))
    if "depth" in layers:
        found.append(Complaint("output", "depth of EXR files is infinite where there is nothing, not 1e10"))
    return found


def view_of(scene: Any) -> hyades.ColorManagement | None:
    """How the scene's view shows light, by Blender's own configuration of OpenColorIO (or what OCIO names); None where
    that is plain sRGB, or light as it is."""
    view = scene.view_settings
    if view.look == "None" and view.view_transform in _TONE_MAPS and scene.display_settings.display_device == "sRGB":
        return None
    folder = bpy.utils.system_resource("DATAFILES", path="colormanagement")
    config = Path(os.environ.get("OCIO") or Path(folder) / "config.ocio")
    made = hyades.ColorManagement(config=config, display=scene.display_settings.display_device, view=view.view_transform)
    if view.look != "None":
        made.look = view.look
    return made


def _of_view(view: Any) -> list[Complaint]:
    """What of a view the job has not."""
    found = []
    if view.gamma != 1:
        found.append(Complaint("color management", "the gamma of the view is left out"))
    if view.use_curve_mapping:
        found.append(Complaint("color management", "the curves of the view are left out"))
    return found


def _bits(image: Any) -> int:
    return 16 if image.color_depth == "16" else 8


def _stem(scene: Any, name: str, numbered: bool) -> str:
    """The name of files without its end: that of the output path, else the job's; `####` stands for the frame. Where
    the path names a folder, frames are called by their numbers, as in Blender; but for the one that it comes with."""
    path = scene.render.filepath
    base = "" if path.endswith(("/", "\\")) else Path(bpy.path.abspath(path)).name
    base = re.sub(r"\.(png|jpe?g|tiff?|exr|mp4|mov|webm|mkv|avi)$", "", base, flags=re.IGNORECASE)
    if not numbered:
        return base.replace("#", "") or name
    if "#" in base:  # the last run is the frame's; others stay in Blender, as themselves
        head, run = re.fullmatch(r"(.*?)(#+[^#]*)", base).groups()
        return head.replace("#", "_") + run
    return f"{base or ('' if path not in _NOT_CHOSEN else name + '.')}####"
