"""Where a frame is rendered: by the program on this machine, or by the farm. Both look alike to who waits for them."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import hyades
import numpy

from .render_process import RenderProcess
from .viewer import Viewer

_LOOKS_EVERY = 1.0  # seconds between two questions to the farm
_WAITS = 0.5  # seconds for the farm to hear of a cancel: Esc has to be answered within one


class LocalRun:
    """`hyades render` as a process of this machine."""

    def __init__(self, program: str, job: Path, options: Sequence[str], source: Any) -> None:
        """What it writes goes beside `job`. `source`: see RenderProcess."""
        self._viewer = Viewer()
        self._seen = 0
        self._progress: dict[str, Any] = {}
        try:
            shown = ["--display", self._viewer.address]
            self._process = RenderProcess(program, job, job.parent, [*shown, *options], source)
        except BaseException:
            self._viewer.close()
            raise

    def running(self) -> bool:
        return self._process.running()

    def progress(self) -> dict[str, Any]:
        """The newest of `hyades render --json`; empty: none yet."""
        for event in self._process.events():
            if event["event"] == "progress":
                self._progress = event
        return self._progress

    def picture(self) -> numpy.ndarray | None:
        """Light and coverage (h, w, 4) where they have changed since the last call."""
        if self._viewer.changes() == self._seen:
            return None
        self._seen = self._viewer.changes()
        return self._viewer.pixels()

    def error(self) -> hyades.HyadesError | None:
        """After its end: what went wrong."""
        return self._process.ending_error()

    def close(self) -> None:
        """Ends it, at once where it has not ended."""
        self._process.stop()
        self._viewer.close()


class FarmRun:
    """A job of one frame on the farm, from a thread of its own."""

    def __init__(self, farm: hyades.Farm, program: str, job: Path, frame: int, **options: Any) -> None:
        """Its files are fetched into the folder of `job`. `options`: of Farm.submit()."""
        self._farm = farm
        self._job: Any = None
        self._error: hyades.HyadesError | None = None
        self._progress: dict[str, Any] = {}
        self._picture: numpy.ndarray | None = None
        self._stopped = threading.Event()
        self._thread = threading.Thread(
            target=self._run, args=(program, job, frame, options), name="hyades-farm-run", daemon=True
        )
        self._thread.start()

    def running(self) -> bool:
        return self._thread.is_alive()

    def progress(self) -> dict[str, Any]:
        """As LocalRun's."""
        return self._progress

    def picture(self) -> numpy.ndarray | None:
        """As LocalRun's."""
        picture, self._picture = self._picture, None
        return picture

    def error(self) -> hyades.HyadesError | None:
        """As LocalRun's."""
        return self._error

    def close(self) -> None:
        """Cancels the job where it has not ended; waits a moment for that."""
        self._stopped.set()
        self._thread.join(_WAITS)

    def _run(self, program: str, job: Path, frame: int, options: dict[str, Any]) -> None:
        try:
            self._job = self._farm.submit(job, program=program, on_warning=print, **options)
            samples = -1
            while not self._job.ended:
                if self._stopped.wait(_LOOKS_EVERY):
                    self._farm.cancel(self._job)
                    return
                self._job = self._farm.job(self._job)
                self._tell()
                if self._job.samples_done != samples and not self._job.ended:
                    samples = self._job.samples_done
                    self._look(frame)
            if self._job.state != "done":
                reason = self._job.reason or next((f.reason for f in self._farm.frames(self._job) if f.reason), "")
                raise hyades.HyadesError(f"the farm's job {self._job.id} is {self._job.state}: {reason}")
            self._farm.fetch(self._job, job.parent)
        except (hyades.HyadesError, OSError, ValueError) as error:
            self._error = error if isinstance(error, hyades.HyadesError) else hyades.HyadesError(str(error))

    def _tell(self) -> None:
        state = self._job
        progress = {"samples": state.samples, "samples_done": state.samples_done, "seconds_left": state.seconds_left}
        if state.noise is not None:
            progress["noise"] = state.noise
        self._progress = progress

    def _look(self, frame: int) -> None:
        try:
            layers = [self._farm.film(self._job, frame, name).array for name in ("beauty", "alpha")]
        except hyades.HyadesError:
            return  # nothing is to be seen yet
        self._picture = numpy.dstack(layers).astype(numpy.float32)
