"""What of the farm Blender shows: the watch, tasks that run, and a timer that brings their news to the panels."""

from __future__ import annotations

from typing import Any

import bpy
import bpy.utils.previews
from hyades.printable import printable_lines

from . import preferences
from .farm_watch import FarmWatch, Task

_MOST_WHOLE = 2**31 - 1

_EVERY = 0.5  # seconds

watch: FarmWatch | None = None
tasks: list[Task] = []
submission: Any = None
"""What is exported at the moment, frame by frame."""
message = ""
"""What the last task came to."""
message_is_error = False
_previews: Any = None
_shown: dict[int, int] = {}  # samples of the thumbnails that the panel has
_last: Any = None


def start_watch() -> None:
    """Looks at the farm of the preferences from now on. FarmError, OSError, ValueError: they are wrong."""
    global watch
    stop_watch()
    watch = FarmWatch(preferences.farm(patience=3.0))
    _start_timer()


def stop_watch() -> None:
    """Looks no longer."""
    global watch
    if watch is not None:
        watch.close()
    watch = None


def begin(task: Task) -> None:
    """Shows a task until it has ended; without a window it is waited for."""
    tasks.append(task)
    if bpy.app.background:
        task.wait()
        take_news()
    else:
        _start_timer()


def tell(text: str, is_error: bool = False) -> None:
    """What the panel says, and without a window standard output."""
    global message, message_is_error
    message, message_is_error = text, is_error
    _redraw()
    if bpy.app.background and text:
        print(f"Hyades: {'error: ' if is_error else ''}{text}", flush=True)


def icon_of(job: int) -> int:
    """The icon of a job's thumbnail; 0 where it has none."""
    key = str(job)
    return _previews[key].icon_id if _previews is not None and key in _previews else 0


def _start_timer() -> None:
    if not bpy.app.background and not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=_EVERY)


def _tick() -> float | None:
    take_news()
    return _EVERY if tasks or watch is not None else None


def take_news() -> None:
    """By the main thread: never waits."""
    global _last
    for task in [task for task in tasks if task.done]:
        tasks.remove(task)
        tell(task.error or task.result, bool(task.error))
        task.after()
        if watch is not None:
            watch.look()
    seen = watch.seen if watch is not None else None
    if seen is not None and seen is not _last:
        _take_jobs(seen)
    now = (seen, message, tuple((task.what, task.words) for task in tasks))
    if now != (_last, *_told):
        _redraw()
    _last, _told[:] = seen, now[1:]


_told: list[Any] = ["", ()]


def _take_jobs(seen: Any) -> None:
    rows = bpy.context.window_manager.hyades_jobs
    while len(rows) > len(seen.jobs):
        rows.remove(len(rows) - 1)
    while len(rows) < len(seen.jobs):
        rows.add()
    for row, job in zip(rows, seen.jobs):
        # A coordinator may say anything, Blender's properties take no more than this.
        row.job_id, row.share = str(job.id), max(0.0, min(job.share, 1.0))
        state = "waiting" if job.waiting else job.state
        row.name, row.state, row.reason = (printable_lines(text)[:200] for text in (job.name, state, job.reason))
        row.frames, row.frames_done, row.frames_failed, row.frames_finishing, row.seconds_left = (
            max(-_MOST_WHOLE, min(number, _MOST_WHOLE))
            for number in (job.frames, job.frames_done, job.frames_failed, job.frames_finishing, job.seconds_left)
        )
        row.noise = -1.0 if job.noise is None else min(job.noise, 1e30)
    if _previews is None or bpy.app.background:
        return
    for gone in _shown.keys() - seen.thumbnails.keys():
        del _shown[gone], _previews[str(gone)]
    for job, thumbnail in seen.thumbnails.items():
        if _shown.get(job) == thumbnail.samples:
            continue
        _shown[job] = thumbnail.samples
        key = str(job)
        picture = _previews[key] if key in _previews else _previews.new(key)
        height, width = thumbnail.pixels.shape[:2]
        for kind in ("image", "icon"):
            setattr(picture, f"{kind}_size", (width, height))
            getattr(picture, f"{kind}_pixels_float").foreach_set(thumbnail.pixels.reshape(-1))


def _redraw() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()


class HyadesFarmJob(bpy.types.PropertyGroup):
    """A job of the farm, as the list shows it."""

    job_id: bpy.props.StringProperty()
    state: bpy.props.StringProperty()
    share: bpy.props.FloatProperty(subtype="FACTOR", min=0, max=1)
    frames: bpy.props.IntProperty()
    frames_done: bpy.props.IntProperty()
    frames_failed: bpy.props.IntProperty()
    frames_finishing: bpy.props.IntProperty()
    seconds_left: bpy.props.FloatProperty()
    noise: bpy.props.FloatProperty()
    reason: bpy.props.StringProperty()


def register() -> None:
    global _previews
    bpy.utils.register_class(HyadesFarmJob)
    bpy.types.WindowManager.hyades_jobs = bpy.props.CollectionProperty(type=HyadesFarmJob)
    bpy.types.WindowManager.hyades_job = bpy.props.IntProperty(name="Job")
    _previews = bpy.utils.previews.new()


def unregister() -> None:
    global _previews
    stop_watch()
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    bpy.utils.previews.remove(_previews)
    _previews = None
    _shown.clear()
    del bpy.types.WindowManager.hyades_job
    del bpy.types.WindowManager.hyades_jobs
    bpy.utils.unregister_class(HyadesFarmJob)
