"""Renders jobs on this machine, by the program."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .exr import Layers, read_exr
from .job import Job
from .picture import Picture
from .program import PathLike, run_program, set_options, written


@dataclass(frozen=True)
class Progress:
    """How far a rendering is."""

    share: float
    """0 to 1 of all samples."""
    frames: int
    """How many there are."""
    frames_done: int
    samples_per_second: float
    seconds_left: float
    """-1: cannot be told yet."""


@dataclass(frozen=True)
class Rendering:
    """What a run has written. Notebooks show its first picture."""

    job: Path
    """The file of the job."""
    files: dict[int, list[Path]] = field(default_factory=dict)
    """By frame, in the order of the job's outputs."""
    videos: list[Path] = field(default_factory=list)

    def layers(self, frame: int | None = None) -> Layers:
        """The layers of a frame's first EXR; without a number, of the first frame.
        FileNotFoundError where it has none."""
        return read_exr(self._file(frame, (".exr",)))

    def picture(self, frame: int | None = None) -> Picture:
        """A frame's picture: its light where there is an EXR, else the codes of its PNG."""
        return Picture.read(self._file(frame, (".exr", ".png")))

    def _file(self, frame: int | None, ends: Sequence[str]) -> Path:
        number = min(self.files, default=0) if frame is None else frame
        for end in ends:
            for path in self.files.get(number, []):
                if path.suffix == end and not path.name.endswith(".film.exr"):
                    return path
        raise FileNotFoundError(f"of frame {number} no file {' or '.join(ends)} was written")

    def _repr_png_(self) -> bytes:
        return Picture.read(self._file(None, (".png", ".exr")))._repr_png_()


def render(
    job: Job | PathLike,
    output: PathLike = ".",
    *,
    frames: str | int | range | None = None,
    samples: int | None = None,
    threads: int | None = None,
    crop: Sequence[int] | None = None,
    preview: int | None = None,
    resume: bool = False,
    film: bool = False,
    overwrite: bool = False,
    set: Mapping[str, object] | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    program: PathLike | None = None,
) -> Rendering:
    """Renders `job` (a Job, or the path of a job or scene) into the folder `output`.

    frames, samples, threads, crop (x0, y0, x1, y1), preview (pixels across), resume, film and
    overwrite are the options of `hyades render`; `set` are the parameters of a script (`.lua`). A
    Job is written into the folder too, as NAME.yaml. `on_progress` is called five times a second at
    most. JobError: mistakes in the job; ProgramError: frames failed
    or the program is not there. Ctrl-C ends the run; `resume` goes on with it.
    """
    options = ["--json", "--output", str(output)]
    options += _options(frames, samples, threads, crop)
    options += [f"--preview={preview}"] * (preview is not None)
    options += ["--resume"] * resume + ["--film"] * film
    options += ["--overwrite"] * overwrite
    options += set_options(set)
    files: dict[int, list[Path]] = {}
    videos: list[Path] = []

    def take(line: str) -> None:
        event = json.loads(line)
        if event["event"] == "written":
            paths = [Path(path) for path in event["files"]]
            files.setdefault(event["frame"], paths) if "frame" in event else videos.extend(paths)
        elif on_progress is not None:
            on_progress(_progress(event))

    with written(job, Path(output)) as path:
        run_program(["render", str(path), *options], program, take)
    return Rendering(path, files, videos)


def _options(
    frames: str | int | range | None,
    samples: int | None,
    threads: int | None,
    crop: Sequence[int] | None,
) -> list[str]:
    if isinstance(frames, range):
        frames = f"{frames[0]}-{frames[-1]}" + (f"x{frames.step}" if frames.step > 1 else "")
    edges = None if crop is None else ",".join(str(int(edge)) for edge in crop)
    given = {"--frames": frames, "--samples": samples, "--threads": threads, "--crop": edges}
    return [word for name, value in given.items() if value is not None for word in (name, str(value))]


def _progress(event: dict[str, Any]) -> Progress:
    share = event["samples_done"] / event["samples"] if event["samples"] else 0.0
    return Progress(
        share,
        event["frames"],
        event["frames_done"],
        event["samples_per_second"],
        event["seconds_left"],
    )
