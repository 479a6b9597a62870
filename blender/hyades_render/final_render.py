"""One frame by F12: the job is written, the program renders it, and Blender's window shows how it refines."""

from __future__ import annotations

import shutil
import tempfile
import time
from pathlib import Path
from typing import Any

import bpy
import hyades
import numpy
from hyades import read_exr

from . import complaints, cryptomatte, passes, preferences, scene_job
from .export import Names
from .export.film import film_exposure
from .render_process import refusal
from .runs import FarmRun, LocalRun

_LOOKS_EVERY = 0.05  # seconds: how soon Esc is noticed
_SHOWS_EVERY = 0.3  # seconds between two pictures; more where showing one takes long
_PREVIEW_SAMPLES = 32


class FinalRender:
    """The render of one view layer of one frame. Runs in the thread that Blender renders in."""

    def __init__(self, engine: Any, depsgraph: Any) -> None:
        self._engine = engine
        self._depsgraph = depsgraph
        self._scene = depsgraph.scene
        self._layer = depsgraph.view_layer_eval
        self._passes = passes.asked_for(self._scene, self._layer)
        self._transparent = self._scene.render.film_transparent
        self._exposure = film_exposure(self._scene)
        self._result: Any = None
        self._told: Any = {}
        self._names = Names()
        self._finished = False

    def run(self) -> None:
        """Renders until all is done, or Esc. HyadesError, OSError, ValueError where that fails."""
        program = preferences.find_program()
        self._tell("Exporting")
        exported = self._export()
        folder = Path(tempfile.mkdtemp(prefix="hyades-", dir=bpy.app.tempdir or None))
        try:
            self._tell("Writing the job")
            document = exported.job.document(folder)
            path = document.write(folder / "blender.yaml")
            if self.stopped():
                return
            self._begin(exported.job)
            self._follow(self._run(program, path, document), exported.job)
            if not self.stopped():
                self._finish(folder / "blender.exr")
        finally:
            if self._result is not None:
                self._engine.end_result(self._result, cancel=not self._finished)
            if not preferences.keeps_jobs():
                shutil.rmtree(folder, ignore_errors=True)

    def stopped(self) -> bool:
        """Whether Esc was pressed."""
        return bool(self._engine.test_break())

    def _export(self) -> Any:
        exported = scene_job.scene_job(self._engine, self._depsgraph, passes.layers_for(self._passes))
        self._names = exported.names
        if self._engine.is_preview:
            exported.job.sampling = hyades.Sampling(samples=_PREVIEW_SAMPLES)
            exported.job.integrator = None
        else:
            found = [*exported.complaints, *passes.not_there(self._layer)]
            complaints.keep(self._scene, found)
            complaints.tell(self._engine, found)
        return exported

    def _options(self) -> list[str]:
        threads = 1 if self._engine.is_preview else preferences.threads() or self._scene_threads()
        return ["--threads", str(threads)] if threads else []

    def _scene_threads(self) -> int | None:
        render = self._scene.render
        return render.threads if render.threads_mode == "FIXED" else None

    def _begin(self, job: hyades.Job) -> None:
        """Makes room for the picture, with all its passes."""
        width, height = job.film.size
        if job.film.crop is not None:
            x0, y0, x1, y1 = job.film.crop
            width, height = x1 - x0, y1 - y0
        for one in self._passes[1:]:
            self._engine.add_pass(one.name, len(one.channels), one.channels, layer=self._layer.name)
        self._result = self._engine.begin_result(0, 0, width, height, layer=self._layer.name)

    def _run(self, program: str, path: Path, document: Any) -> LocalRun | FarmRun:
        """Where the scene says that it is rendered."""
        settings = self._scene.hyades
        if settings.render_on == "farm" and not self._engine.is_preview:
            name = scene_job.name_of(self._scene)
            frame = max(self._scene.frame_current, 0)
            return FarmRun(preferences.farm(), program, path, frame, name=name, **scene_job.farm_options(settings))
        return LocalRun(program, path, self._options(), document.text.source_of)

    def _follow(self, run: LocalRun | FarmRun, job: hyades.Job) -> None:
        """Shows how it gets on, until it ends or Esc is pressed."""
        next_time = 0.0
        try:
            while run.running():
                if self.stopped():
                    return
                self._progress(run.progress())
                began = time.monotonic()
                if not bpy.app.background and began >= next_time and (picture := run.picture()) is not None:
                    self._show(picture)
                    next_time = time.monotonic() + max(_SHOWS_EVERY, 4 * (time.monotonic() - began))
                time.sleep(_LOOKS_EVERY)
            error = run.error()
            if error is not None:
                raise hyades.HyadesError(refusal(error, lambda thing: scene_job.name_in_blender(job, thing)))
        finally:
            run.close()

    def _progress(self, event: dict[str, Any]) -> None:
        if event == self._told:
            return
        self._told = event
        share = event["samples_done"] / max(event["samples"], 1)
        words = [f"{share:.0%}"]
        if event["seconds_left"] >= 0:
            words.append(f"{_clock(event['seconds_left'])} left")
        if "noise" in event:
            aim = self._scene.hyades.noise
            words.append(f"noise {event['noise']:.3f}" + (f" (aim {aim:.3g})" if aim > 0 else ""))
        self._engine.update_progress(share)
        self._tell(", ".join(words))

    def _show(self, picture: numpy.ndarray) -> None:
        picture[:, :, :3] *= self._exposure
        if not self._transparent:
            picture[:, :, 3] = 1
        self._fill("Combined", passes.as_pixels(picture, 4))
        self._engine.update_result(self._result)

    def _finish(self, path: Path) -> None:
        """The exact pixels of all passes."""
        layers = read_exr(path)
        cryptomatte.rename(layers, self._names)
        for one in self._passes:
            pixels = passes.values(one, layers, self._transparent, self._exposure)
            if pixels is not None:
                self._fill(one.name, pixels)
        for field, text in cryptomatte.fields(layers, self._layer.name, passes.cryptomattes(self._passes)).items():
            self._engine.get_result().stamp_data_add_field(field, text)
        self._finished = True
        self._engine.update_progress(1.0)
        self._tell("Done")

    def _fill(self, name: str, pixels: Any) -> None:
        for one in self._result.layers[0].passes:
            if one.name == name:
                passes.fill(one, pixels)

    def _tell(self, text: str) -> None:
        self._engine.update_stats("Hyades", text)


def _clock(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}" if hours else f"{minutes}:{seconds:02}"
