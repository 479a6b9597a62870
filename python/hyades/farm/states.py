"""What a coordinator tells: as coordinator/web/api/openapi.yaml describes it, whose names these are.

Times are milliseconds since 1970 (UTC). Fields that a later coordinator adds are left out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, TypeVar, cast

from ..errors import FarmError

_State = TypeVar("_State")

ENDED = ("done", "failed", "cancelled")

_PLAIN: dict[str, tuple[type, ...]] = {"int": (int,), "float": (int, float), "bool": (bool,), "str": (str,)}

_WHOLE_END = 1 << 64  # coordinators count with 64 bits; of numbers without end nobody can make a float


def read_state(kind: type[_State], row: Any) -> _State:
    """A row of an answer as one of the classes below; FarmError where it is none."""
    known = {field.name: str(field.type) for field in fields(cast(Any, kind))}
    told = row if isinstance(row, dict) else {}
    values = {name: tuple(v) if isinstance(v, list) else v for name, v in told.items() if name in known}
    odd = [name for name, value in values.items() if not _is(known[name], value)]
    try:
        if not odd:
            return kind(**values)
    except TypeError as error:  # one that must be there is not
        odd = [str(error)]
    raise FarmError("unknown", f"the coordinator's answer has no {kind.__name__} where one was expected: {odd}")


def _is(hint: str, value: Any) -> bool:
    """Whether a value is of the type that a field's hint names."""
    if isinstance(value, tuple):
        inner = str if hint == "tuple[str, ...]" else dict
        return hint.startswith("tuple") and all(isinstance(item, inner) for item in value)
    if value is None:
        return hint.endswith("| None")
    if isinstance(value, int) and abs(value) >= _WHOLE_END:
        return False
    if isinstance(value, float) and not math.isfinite(value):
        return False
    return isinstance(value, _PLAIN.get(hint.removesuffix(" | None"), ()))


@dataclass(frozen=True, kw_only=True)
class JobState:
    """A job on the farm."""

    id: int
    name: str
    state: str
    """running, paused, done, failed or cancelled; of one that is running `waiting` says whether somebody renders it."""
    owner: str = ""
    owner_proven: bool = False
    """Whether a token has shown who the owner is."""
    priority: int = 0
    frames: int = 0
    frames_done: int = 0
    frames_failed: int = 0
    frames_finishing: int = 0
    """Rendered, and their outputs are being made."""
    samples: int = 0
    samples_done: int = 0
    leased: int = 0
    """Units that are out with workers."""
    samples_per_second: float = 0.0
    seconds_left: float = -1.0
    """-1: unknown."""
    submitted_ms: int = 0
    begun_ms: int = 0
    """When its first unit was leased; 0: not yet, or not known."""
    ended_ms: int = 0
    """0: not yet."""
    reason: str = ""
    max_workers: int = 0
    tags: tuple[str, ...] = ()
    memory_bytes: int = 0
    max_attempts: int = 0
    redundancy: int = 0
    frame_order: str = ""
    core_seconds: float = 0.0
    cost: float = 0.0
    preview_frame: int | None = None
    """That best stands for the job; None: nothing is to be seen yet."""
    noise_aim: float = 0.0
    noise: float | None = None
    busy_seconds: float = 0.0
    """In which it was worked on: waiting does not count."""
    frame_rate: float = 0.0
    """At which its frames are a video in real time; 0: not known."""
    waiting: bool = False
    """It is running and has something left to render, of which no worker has any, and no frame is being
    finished: tables call its state waiting."""

    @property
    def ended(self) -> bool:
        return self.state in ENDED

    @property
    def share(self) -> float:
        """0 to 1 of all samples."""
        return self.samples_done / self.samples if self.samples else 0.0


@dataclass(frozen=True, kw_only=True)
class FrameState:
    """A frame of a job; `id` is its number."""

    id: int
    state: str
    """waiting, rendering, finishing, done or failed."""
    samples: int = 0
    samples_done: int = 0
    reason: str = ""
    worker_class: str = ""
    restarts: int = 0
    doubtful: bool = False
    black: bool = False
    """It is done, and no light reaches what the camera sees."""
    noise: float | None = None


@dataclass(frozen=True, kw_only=True)
class WorkerState:
    """Who renders."""

    id: int
    name: str
    state: str
    """active, draining, quarantined or gone."""
    host: str = ""
    worker_class: str = ""
    build: str = ""
    threads: int = 0
    reason: str = ""
    leased: int = 0
    units_done: int = 0
    units_failed: int = 0
    samples_done: int = 0
    joined_ms: int = 0
    heard_ms: int = 0
    memory_bytes: int = 0
    memory_limit_bytes: int = 0
    tags: tuple[str, ...] = ()
    work: tuple[Mapping[str, int], ...] = ()
    """Jobs, frames and how many units of them are out with it."""
    cache_bytes: int = 0
    cache_limit_bytes: int = 0
    cache_hits: int = 0
    cache_misses: int = 0
    samples_per_second: float = 0.0
    portable_class: str = ""
    """As worker_class, of the portable class; empty: it renders nothing in that."""


@dataclass(frozen=True, kw_only=True)
class OutputFile:
    """A finished file; `id` is its path below the job's outputs."""

    id: str
    frame: int
    size: int
    sha256: str


@dataclass(frozen=True, kw_only=True)
class LogLine:
    """What has happened to a job."""

    id: int
    time_ms: int
    level: str
    text: str
    worker: str = ""
    frame: int | None = None


@dataclass(frozen=True)
class Change:
    """A job as it is now, and those of its frames that have changed."""

    job: JobState
    frames: tuple[FrameState, ...]
