"""Renders what a viewport shows, from a thread of its own: a coarse picture first, then all samples."""

from __future__ import annotations

import os
import shutil
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import hyades
import numpy

from .render_process import RenderProcess, refusal
from .viewer import Viewer

_CHANNELS = ("R", "G", "B", "A", "samples.N")
_COARSE_SAMPLES = 4
_COARSE_SCALE = 0.25
_PATIENCE = 1.0  # seconds that a coarse picture gets though the view has changed, so that a moving view shows something
_LOOKS_EVERY = 0.02
_SHOWS_EVERY = 0.2


@dataclass(frozen=True)
class View:
    """What is to be seen, and how well."""

    camera: hyades.cameras.Camera
    width: int
    height: int
    samples: int


class Refiner:
    """One viewport's renders. Its methods are called by the main thread and never wait for a render."""

    def __init__(self, program: str, folder: str | None, threads: int | None, on_news: Callable[[], None]) -> None:
        """`folder`: where a temporary one is made. `on_news` is called from the thread when there is
        something new to be seen or read."""
        self._program = program
        self._folder = Path(tempfile.mkdtemp(prefix="hyades-view-", dir=folder))
        self._threads = [] if threads is None else ["--threads", str(threads)]
        self._on_news = on_news
        self._wake = threading.Condition()
        self._job: hyades.Job | None = None
        self._view: View | None = None
        self._asked = 0  # how often something was asked for
        self._ended = 0  # which of those was rendered, or refused, last
        self._closed = False
        self._picture: numpy.ndarray | None = None
        self._number = 0
        self._words = ""
        self._thread = threading.Thread(target=self._run, name="hyades-viewport", daemon=True)
        self._thread.start()

    def show(self, job: hyades.Job | None, view: View) -> None:
        """Renders this view from now on; `job`: another scene, None: the same one."""
        with self._wake:
            if job is not None:
                self._job = job
            self._view = view
            self._asked += 1
            self._wake.notify()

    def picture(self) -> tuple[int, numpy.ndarray | None]:
        """The newest picture (height, width, 4), row 0 at the top, and its number."""
        with self._wake:
            return self._number, self._picture

    def is_done(self) -> bool:
        """Whether what was asked for last has all samples, or was refused."""
        with self._wake:
            return self._ended == self._asked

    def words(self) -> str:
        """How it gets on."""
        return self._words

    def close(self) -> None:
        """Ends the render and the thread."""
        with self._wake:
            self._closed = True
            self._wake.notify()
        self._thread.join()

    def _run(self) -> None:
        done = 0
        written: hyades.Job | None = None
        try:
            while True:
                with self._wake:
                    self._wake.wait_for(lambda: self._closed or self._asked != done)
                    if self._closed:
                        return
                    done, job, view = self._asked, self._job, self._view
                try:
                    if job is not written:
                        self._write_scene(job)
                        written = job
                    self._render(job, view, done)
                except (hyades.HyadesError, OSError, ValueError) as error:
                    self._say(str(error))
                with self._wake:
                    self._ended = done
        finally:
            shutil.rmtree(self._folder, ignore_errors=True)

    def _write_scene(self, job: Any) -> None:
        """Everything but how it is looked at. Files of what has not changed are there already."""
        self._say("Writing the scene")
        document = job.document(self._folder)
        document.write(self._folder / "scene.yaml")
        for path in (self._folder / "assets").glob("*"):
            if f"assets/{path.name}" not in document.files.made:
                os.unlink(path)

    def _render(self, job: Any, view: Any, asked: int) -> None:
        sampling = hyades.Sampling(samples=view.samples)
        film = hyades.Film(size=[view.width, view.height])
        shown = hyades.Job(name="view", include=self._folder / "scene.yaml", camera=view.camera, film=film)
        shown.sampling = sampling
        shown.outputs = [hyades.outputs.Exr(file="view.exr")]
        path = shown.write(self._folder / "view.yaml")
        coarse = ["--scale", str(_COARSE_SCALE), "--samples", str(min(_COARSE_SAMPLES, view.samples))]
        if min(view.width, view.height) * _COARSE_SCALE >= 8 and not self._step(path, asked, coarse, _PATIENCE):
            return
        self._step(path, asked, [], 0.0)

    def _step(self, path: Path, asked: int, options: list[str], patience: float) -> bool:
        """One run; whether it came to its end and is still what is asked for."""
        with Viewer() as viewer:
            process = RenderProcess(
                self._program, path, self._folder, ["--display", viewer.address, *self._threads, *options]
            )
            try:
                seen, next_time, began = 0, 0.0, time.monotonic()
                while process.running():
                    now = time.monotonic()
                    if self._closed or (self._asked != asked and now - began >= patience):
                        return False
                    for event in process.events():
                        if event["event"] == "progress":
                            self._progress(event)
                    if now >= next_time and viewer.changes() != seen:
                        seen, next_time = viewer.changes(), now + _SHOWS_EVERY
                        # A coarse run's first parts would be smaller news than what is there.
                        if not options:
                            self._take(viewer.pixels(_CHANNELS))
                    time.sleep(_LOOKS_EVERY)
                error = process.ending_error()
                if error is not None:
                    raise hyades.HyadesError(refusal(error))
                viewer.wait_for_rest(1.0)
                self._take(viewer.pixels(_CHANNELS))
            finally:
                process.stop()
        return self._asked == asked and not self._closed

    def _progress(self, event: dict[str, Any]) -> None:
        share = event["samples_done"] / max(event["samples"], 1)
        noise = f", noise {event['noise']:.3f}" if "noise" in event else ""
        self._say(f"{share:.0%}{noise}")

    def _take(self, picture: numpy.ndarray | None) -> None:
        """A new picture, with the number of samples as its fifth channel; what has none yet stays as it was."""
        if picture is None:
            return
        seen = picture[:, :, 4:] > 0
        picture = picture[:, :, :4]
        if self._picture is not None and not seen.all():
            picture = numpy.where(seen, picture, _resized(self._picture, *picture.shape[:2]))
        with self._wake:
            self._picture = numpy.ascontiguousarray(picture)
            self._number += 1
        self._on_news()

    def _say(self, words: str) -> None:
        if words != self._words:
            self._words = words
            self._on_news()


def _resized(picture: numpy.ndarray, height: int, width: int) -> numpy.ndarray:
    """To the nearest pixel."""
    rows = numpy.arange(height) * picture.shape[0] // height
    columns = numpy.arange(width) * picture.shape[1] // width
    return picture[rows[:, None], columns[None, :]]
