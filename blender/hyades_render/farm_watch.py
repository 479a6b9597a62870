"""What the farm is doing, watched by a thread: Blender's window never waits for the network."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import hyades
import numpy
from hyades.farm.states import JobState

MOST_JOBS = 50
_EVERY = 2.0  # seconds between two looks
_THUMBNAIL = 96  # pixels across
_MOST_BYTES = 1 << 20  # of a thumbnail as it is read: the coordinator may send another than was asked for


@dataclass(frozen=True)
class Thumbnail:
    """A small picture of a job as displays show it."""

    samples: int
    """Of the frame when it was made: another number, another picture."""
    pixels: Any
    """(height, width, 4) of sRGB codes 0 to 1, the bottom row first."""


@dataclass(frozen=True)
class Seen:
    """The farm at one moment."""

    jobs: tuple[JobState, ...] = ()
    thumbnails: dict[int, Thumbnail] = field(default_factory=dict)
    error: str = ""


class FarmWatch:
    """Looks at the jobs of a farm every two seconds, the newest first, until it is closed."""

    def __init__(self, farm: hyades.Farm) -> None:
        self._farm = farm
        self._wake = threading.Event()
        self._closed = False
        self.seen = Seen()
        """The newest look; replaced as a whole by the thread."""
        self._thread = threading.Thread(target=self._run, name="hyades-farm", daemon=True)
        self._thread.start()

    def look(self) -> None:
        """Looks now, not after two seconds."""
        self._wake.set()

    def close(self) -> None:
        """Ends after the call that is on its way; does not wait for it."""
        self._closed = True
        self._wake.set()

    def _run(self) -> None:
        while not self._closed:
            try:
                jobs = tuple(itertools.islice(self._farm.jobs(ended=True), MOST_JOBS))
                self.seen = Seen(jobs, {job.id: t for job in jobs if (t := self._thumbnail(job)) is not None})
            except (hyades.HyadesError, OSError, ValueError) as error:
                self.seen = Seen(self.seen.jobs, self.seen.thumbnails, str(error))
            self._wake.wait(_EVERY)
            self._wake.clear()

    def _thumbnail(self, job: JobState) -> Thumbnail | None:
        """That of the frame which stands for a job; the same as before where nothing has come."""
        before = self.seen.thumbnails.get(job.id)
        if self._closed or job.preview_frame is None or (before and before.samples == job.samples_done):
            return before
        try:
            film = self._farm.film(job, job.preview_frame, width=_THUMBNAIL, most_bytes=_MOST_BYTES)
        except (hyades.HyadesError, OSError, ValueError):
            return before  # the frame may be between its film and its file
        return Thumbnail(job.samples_done, _display(film.array))


def _display(light: numpy.ndarray) -> numpy.ndarray:
    """Linear light as sRGB codes, with the alpha that pictures in panels need."""
    if light.ndim == 2:
        light = numpy.repeat(light[:, :, None], 3, axis=2)
    light = numpy.clip(numpy.nan_to_num(light[::-1, :, :3]), 0, 1)
    codes = numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return numpy.concatenate([codes, numpy.ones_like(codes[:, :, :1])], axis=2).astype(numpy.float32)


class Task:
    """Something that takes long, done by a thread."""

    def __init__(self, what: str, do: Callable[[Task], str], after: Callable[[], None] = lambda: None) -> None:
        """`what`: what is done, in words. `do` returns what people are told in the end; `after` is called by
        the main thread, when it notices the end."""
        self.what = what
        self.words = ""
        """How far it is; set by `do`."""
        self.result = ""
        self.error = ""
        self.after = after
        self.done = False
        self._do = do
        self._thread = threading.Thread(target=self._run, name="hyades-task", daemon=True)
        self._thread.start()

    def wait(self) -> None:
        """Until it has ended: for runs without a window."""
        self._thread.join()

    def _run(self) -> None:
        try:
            self.result = self._do(self)
        except (hyades.HyadesError, OSError, ValueError) as error:
            self.error = str(error)
        except Exception as error:  # a fault of ours: told, not lost with the thread
            self.error = f"{type(error).__name__}: {error}"
        self.done = True
