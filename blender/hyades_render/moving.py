"""Frames with their shutter: the scene is exported when it opens, at the frame's own time and when it closes, for the pass
Vector also a frame later, and joined to one job. A moment of the job is when its shutter has been open for so long."""

from __future__ import annotations

import itertools
from typing import Any

import hyades

from . import joined_frames, moving_copies
from .export import Complaint, Exported, Names, export_job

_POSITIONS = {"START": 0.0, "CENTER": -0.5, "END": -1.0}


class Moments:
    """What was exported so far, of one frame or many."""

    def __init__(self, *, many: bool = False) -> None:
        """`many`: there will be more frames than one."""
        self._many = many
        self._times: list[float] = []
        self._of_frames: list[int | None] = []
        self._jobs: list[hyades.Job] = []
        self._of_moments: list[list[Complaint]] = []
        self._complaints: list[Complaint] = []  # of all moments together
        self._names = Names()
        self._shutter = 0.0

    def export(self, engine: Any, depsgraph: Any) -> None:
        """The frame at which `depsgraph` stands. For render() of an engine: only engines may look at other times."""
        scene = depsgraph.scene
        frame, camera = scene.frame_current, scene.camera
        position, self._shutter = shutter(scene)
        own = -position * self._shutter
        times = {0.0, own, self._shutter}
        if depsgraph.view_layer_eval.use_pass_vector:
            times.add(1.0)  # the layer is the way to the next frame
        if times == {0.0}:
            self._add(frame, depsgraph, self._many, frame)
            return
        try:
            for time in sorted(times):
                _set_time(engine, frame if time == own else frame - own + time)
                self._add(frame + time, depsgraph, True, frame if time == own else None, camera)
        finally:
            _set_time(engine, frame)
        if scene.render.motion_blur_shutter > 1:
            self._complain("render", "the shutter is open for one frame at most; more is left out")

    def job(self, frames: str | int) -> Exported:
        """All that was exported, as a job of these frames. ValueError where no job says what moves."""
        job, complaints = self._jobs[0], []
        if len(self._jobs) > 1:
            self._tell_of_copies(moving_copies.spread(self._jobs, self._names))
            job, complaints = joined_frames.join(self._times, self._of_frames, self._jobs)
        for where, what in self._names.links.write(job, self._names.objects):
            self._complain(where, what)
        job.frames = hyades.Frames(range=frames, fps=job.frames.fps, shutter=self._shutter)
        # While the shutter is open nothing else is there than at the frame's own time.
        own = [found for found, frame in zip(self._of_moments, self._of_frames) if frame is not None]
        for complaint in itertools.chain(*own, complaints):
            self._complain(complaint.where, complaint.what)
        return Exported(job, list(self._complaints), self._names)

    def _tell_of_copies(self, too_many: list[str]) -> None:
        for what in too_many:
            if self._many:
                raise ValueError(f"{what}: more than one job can say: render its frames one by one")
            self._complain("motion blur", f"{what}: too many; they stand still")

    def _add(self, time: float, depsgraph: Any, moves: bool, of_frame: int | None, camera: Any = None) -> None:
        """`of_frame`: the frame whose own time it is. `camera`: through which it is seen, though a marker changes it between
        two frames; None: the scene's."""
        if time in self._times:  # the end of one frame is the beginning of the next
            if of_frame is not None:
                self._of_frames[self._times.index(time)] = of_frame
            return
        exported = export_job(depsgraph, settings=depsgraph.scene.hyades, moves=moves, camera=camera)
        if self._jobs:
            joined_frames.share(self._jobs[-1], exported.job)
        self._times.append(time)
        self._of_frames.append(of_frame)
        self._jobs.append(exported.job)
        self._names.objects |= exported.names.objects
        self._names.materials |= exported.names.materials
        self._names.links.merge(exported.names.links)
        self._of_moments.append(exported.complaints)

    def _complain(self, where: str, what: str) -> None:
        complaint = Complaint(where, what)
        if complaint not in self._complaints:
            self._complaints.append(complaint)


def shutter(scene: Any) -> tuple[float, float]:
    """When the shutter opens, in parts of its time before the frame (0 to -1), and for how long [frames]."""
    render = scene.render
    if not render.use_motion_blur:
        return 0.0, 0.0
    # Blender 4.2 made one property of what Cycles and Eevee had each.
    position = getattr(render, "motion_blur_position", None) or getattr(
        getattr(scene, "cycles", None), "motion_blur_position", "CENTER"
    )
    return _POSITIONS[position], min(render.motion_blur_shutter, 1.0)


def _set_time(engine: Any, time: float) -> None:
    frame = int(time // 1)
    engine.frame_set(frame, time - frame)
