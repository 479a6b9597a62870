"""What happens to a job, as it happens: server-sent events (WHATWG HTML, 9.2)."""

from __future__ import annotations

import http.client
import time
from collections.abc import Iterable, Iterator
from typing import Any

from ..errors import FarmError
from ..machine import usable_memory
from .answers import decoded, part, too_much
from .http import Http
from .states import Change, FrameState, JobState, read_state

_SILENCE = 60.0  # seconds; a coordinator says something every 15
_STREAM_ENDED = 0.5  # seconds; a coordinator that ends it in order is about to stop
# Bytes of an event, of which Python makes up to thirty times as many. The first tells all frames of a job.
_MOST_EVENT = max(8 << 20, usable_memory() // 64)
_MOST_FRAMES = 1_000_000  # that a job may have


def parse_events(lines: Iterable[bytes]) -> Iterator[tuple[str, Any]]:
    """Names and data of events as their lines come; of a line that is too long its beginning is enough.
    FarmError where an event is too long, or its data are no JSON."""
    name, data, size = "message", list[str](), 0
    for raw in lines:
        if size + len(raw) > _MOST_EVENT:
            raise too_much("an event", _MOST_EVENT)
        line = raw.decode("utf-8", "replace").rstrip("\r\n")
        field, _, value = line.partition(":")
        value = value.removeprefix(" ")
        if not line:
            if data:
                yield name, decoded("\n".join(data))
            name, data, size = "message", [], 0
        elif field == "event":
            name = value
        elif field == "data":
            data.append(value)
            size += len(raw)


class JobEvents:
    """The changes of one job until it has ended. Where the coordinator is away it is asked again,
    and tells everything anew; what has not changed meanwhile is not told twice."""

    def __init__(self, farm: Http, job: int) -> None:
        self._http = farm
        self._path = f"/api/v1/jobs/{job}/events"
        self._frames: dict[int, int] = {}  # hashes of what was told: the rows themselves may be of any size
        self._count = 0

    def __iter__(self) -> Iterator[Change]:
        while True:
            with self._http.patiently(self._connect, lambda: self._count) as stream:
                for name, data in self._until_it_breaks(stream):
                    self._count += 1
                    if name == "gone":
                        raise FarmError("not_found", "the job was deleted")
                    change = self._change(data)
                    yield change
                    if name == "end" or change.job.ended:
                        return
            time.sleep(_STREAM_ENDED)

    def _until_it_breaks(self, stream: _Stream) -> Iterator[tuple[str, Any]]:
        try:
            yield from parse_events(stream)
        except (OSError, http.client.HTTPException):
            pass  # it may be back soon

    def _connect(self) -> _Stream:
        return _Stream(self._http, self._path)

    def _change(self, data: Any) -> Change:
        rows = [read_state(FrameState, row) for row in part(data, "frames", list)]
        new = tuple(frame for frame in rows if self._frames.get(frame.id) != hash(frame))
        self._frames.update((frame.id, hash(frame)) for frame in new)
        if len(self._frames) > _MOST_FRAMES:
            raise FarmError("resource_exhausted", f"the coordinator tells of more than {_MOST_FRAMES} frames of a job")
        return Change(read_state(JobState, part(data, "job", dict)), new)


class _Stream:
    """An answer that goes on and on, read line by line."""

    def __init__(self, farm: Http, path: str) -> None:
        self._context = farm.open("GET", path, timeout=_SILENCE)
        self._answer = self._context.__enter__()

    def __enter__(self) -> _Stream:
        return self

    def __exit__(self, *_: object) -> None:
        self._context.__exit__(None, None, None)

    def __iter__(self) -> Iterator[bytes]:
        while line := self._answer.readline(_MOST_EVENT + 1):
            yield line
