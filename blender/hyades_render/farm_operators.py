"""What can be done with the farm: submit, watch, fetch, cancel, look."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Generator
from pathlib import Path
from typing import Any

import bpy
import hyades

from . import animation, complaints, farm_state, preferences, scene_job
from .farm_watch import Task

_WRONG = (hyades.HyadesError, OSError, ValueError)


class _FarmOperator:
    bl_options = {"INTERNAL"}

    def refuse(self, error: Exception) -> set[str]:
        """Tells why nothing was done."""
        self.report({"ERROR"}, f"Hyades: {error}")
        return {"CANCELLED"}


class HYADES_OT_submit(_FarmOperator, bpy.types.Operator):
    """Gives the scene to the farm, which renders it while you go on"""

    bl_idname = "hyades.submit"
    bl_label = "Render Animation on the Farm"
    whole: bpy.props.BoolProperty(name="Animation", description="All frames, or the current one", default=True)

    @classmethod
    def poll(cls, context: Any) -> bool:
        return farm_state.submission is None

    def execute(self, context: Any) -> set[str]:
        scene = context.scene
        try:
            farm = preferences.farm()
            program = preferences.find_program()
            frames = animation.all_frames(scene) if self.whole else None
            steps = animation.steps(scene, frames=frames, name=scene_job.name_of(scene))
        except _WRONG as error:
            return self.refuse(error)
        submission = farm_state.submission = _Submission(scene, farm, program, steps)
        if bpy.app.background:
            while submission.step() is not None:
                pass
            return {"FINISHED"} if submission.submitted else {"CANCELLED"}
        bpy.app.timers.register(submission.step)
        return {"FINISHED"}


class _Submission:
    """The scene frame by frame, a step of a timer each, so that the window stays alive; then a task that uploads."""

    def __init__(self, scene: Any, farm: hyades.Farm, program: str, steps: Generator[Any, None, None]) -> None:
        self._scene = scene
        self._farm = farm
        self._program = program
        self._steps = steps
        self.stopped = False
        """Set to end it before the next frame."""
        self.submitted: Any = None

    def step(self) -> float | None:
        """Seconds until the next one; None: that was the last."""
        try:
            if self.stopped:
                self._steps.close()
                return self._end("stopped exporting")
            news = next(self._steps)
        except _WRONG as error:
            return self._end(str(error), is_error=True)
        except Exception:
            farm_state.submission = None
            raise
        if isinstance(news, str):
            farm_state.tell(news)
            return 0.01
        complaints.keep(self._scene, news.complaints)
        complaints.print_all(news.complaints)
        options = {"name": news.job.name, **scene_job.farm_options(self._scene.hyades)}
        self._end("")
        farm_state.begin(Task(f"Submitting {news.job.name}", lambda task: self._submit(task, news.job, options)))
        if not bpy.app.background and farm_state.watch is None:
            farm_state.start_watch()
        return None

    def _end(self, text: str, is_error: bool = False) -> None:
        farm_state.submission = None
        farm_state.tell(text, is_error)

    def _submit(self, task: Task, job: hyades.Job, options: dict[str, Any]) -> str:
        """By the task's thread."""
        folder = Path(tempfile.mkdtemp(prefix="hyades-submit-"))

        def on_bytes(sent: int, total: int) -> None:
            task.words = f"{sent / max(total, 1):.0%} of {total / 1e6:.1f} MB"

        warnings: list[str] = []
        try:
            path = job.write(folder / "job.yaml")
            self.submitted = self._farm.submit(
                path, program=self._program, on_bytes=on_bytes, on_warning=warnings.append, **options
            )
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        done = f"submitted job {self.submitted.id}, {self.submitted.name}, {self.submitted.frames} frames"
        return "; warning: ".join([done, *warnings])


class HYADES_OT_stop_submission(_FarmOperator, bpy.types.Operator):
    """Exports no further frame, and submits nothing"""

    bl_idname = "hyades.stop_submission"
    bl_label = "Stop"

    def execute(self, context: Any) -> set[str]:
        if farm_state.submission is not None:
            farm_state.submission.stopped = True
        return {"FINISHED"}


class HYADES_OT_watch_farm(_FarmOperator, bpy.types.Operator):
    """Shows the jobs of the farm that the preferences name"""

    bl_idname = "hyades.watch_farm"
    bl_label = "Show Jobs"

    def execute(self, context: Any) -> set[str]:
        if farm_state.watch is not None:
            farm_state.stop_watch()
            return {"FINISHED"}
        try:
            farm_state.start_watch()
        except _WRONG as error:
            return self.refuse(error)
        return {"FINISHED"}


class HYADES_OT_test_farm(_FarmOperator, bpy.types.Operator):
    """Asks the farm for its version, and whether it knows you"""

    bl_idname = "hyades.test_farm"
    bl_label = "Test the Connection"

    def execute(self, context: Any) -> set[str]:
        try:
            farm = preferences.farm(patience=3.0)
        except _WRONG as error:
            return self.refuse(error)

        def ask(_task: Task) -> str:
            workers = sum(worker.state == "active" for worker in farm.workers())
            return f"the farm answers: {workers} workers"

        farm_state.begin(Task("Asking the farm", ask))
        return {"FINISHED"}


class _JobOperator(_FarmOperator):
    job: bpy.props.IntProperty(name="Job", options={"SKIP_SAVE"})

    def begin(self, what: str, do: Any) -> set[str]:
        """Does it by a task, with the farm and the number of the job."""
        try:
            farm = preferences.farm()
        except _WRONG as error:
            return self.refuse(error)
        job = self.job
        farm_state.begin(Task(what, lambda task: do(task, farm, job)))
        return {"FINISHED"}


class HYADES_OT_fetch(_JobOperator, bpy.types.Operator):
    """Brings what is finished into the scene's output folder, and goes on until the job has ended"""

    bl_idname = "hyades.fetch"
    bl_label = "Fetch"
    folder: bpy.props.StringProperty(
        name="Folder", description="Where to; empty: the folder of the scene's output", subtype="DIR_PATH",
        options={"SKIP_SAVE"},
    )
    follow: bpy.props.BoolProperty(name="Until It Has Ended", default=True, options={"SKIP_SAVE"})

    def execute(self, context: Any) -> set[str]:
        folder = Path(bpy.path.abspath(self.folder)) if self.folder else animation.output_folder(context.scene)
        follow = self.follow

        def fetch(task: Task, farm: hyades.Farm, job: int) -> str:
            folder.mkdir(parents=True, exist_ok=True)
            fetched = [0]

            def on_bytes(count: int) -> None:
                fetched[0] += count
                task.words = f"{fetched[0] / 1e6:.1f} MB"

            files = farm.fetch(job, folder, follow=follow, on_bytes=on_bytes)
            return f"fetched {len(files)} files of job {job} into {folder}"

        return self.begin(f"Fetching job {self.job}", fetch)


class HYADES_OT_cancel(_JobOperator, bpy.types.Operator):
    """Ends the job; finished frames stay"""

    bl_idname = "hyades.cancel"
    bl_label = "Cancel"

    def invoke(self, context: Any, event: Any) -> set[str]:
        return context.window_manager.invoke_confirm(self, event)

    def execute(self, context: Any) -> set[str]:
        def cancel(_task: Task, farm: hyades.Farm, job: int) -> str:
            farm.cancel(job)
            return f"cancelled job {job}"

        return self.begin(f"Cancelling job {self.job}", cancel)


class HYADES_OT_open_dashboard(_JobOperator, bpy.types.Operator):
    """Opens the job's page of the farm's dashboard"""

    bl_idname = "hyades.open_dashboard"
    bl_label = "Open in the Dashboard"

    def execute(self, context: Any) -> set[str]:
        try:
            bpy.ops.wm.url_open(url=preferences.dashboard(self.job))
        except _WRONG as error:
            return self.refuse(error)
        return {"FINISHED"}


_CLASSES = (
    HYADES_OT_submit,
    HYADES_OT_stop_submission,
    HYADES_OT_watch_farm,
    HYADES_OT_test_farm,
    HYADES_OT_fetch,
    HYADES_OT_cancel,
    HYADES_OT_open_dashboard,
)


def register() -> None:
    for one in _CLASSES:
        bpy.utils.register_class(one)


def unregister() -> None:
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
