"""The farm as people see it."""

from __future__ import annotations

import getpass
import itertools
import secrets
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from operator import index
from pathlib import Path
from typing import Any, Literal, TypeAlias

from ..checks import frames as frames_text
from ..described import Key
from ..errors import FarmError
from ..exr import Layers
from ..job import Job
from ..machine import usable_memory
from ..printable import printable_lines
from ..program import PathLike
from .answers import no_end, part
from .events import JobEvents
from .fetch import Fetcher
from .films import FilmLayer, read_film
from .http import Http
from .states import Change, FrameState, JobState, LogLine, OutputFile, WorkerState, read_state
from .upload import OnBytes, packed, submit

JobId: TypeAlias = "int | JobState"
WorkerId: TypeAlias = "int | WorkerState"


class Farm:
    """A coordinator, by its HTTP API: `Farm("https://farm.example:8080", token="...", ca="ca.pem")`.

    address: http(s)://HOST:PORT of its dashboard; of several coordinators that stand by for one another all, with
    commas between: the one that leads is found. Without it, the environment variable HYADES_HTTP; without
    that, port 8080 of the machines that HYADES_COORDINATOR names, or of this one.
    token: without it, what stands in the file that HYADES_TOKEN_FILE names.
    ca: certificate (PEM) of who signed the coordinator's (HYADES_TLS_CA); turns TLS on.
    certificate: files (PEM) of a certificate and its key (HYADES_TLS_CERT, HYADES_TLS_KEY).
    insecure: send plain text also beyond this machine.
    patience: seconds to go on trying when a coordinator that was there is gone.

    Methods raise FarmError. A job is its id or its JobState.
    """

    def __init__(
        self,
        address: str | None = None,
        *,
        token: str | None = None,
        ca: PathLike | None = None,
        certificate: tuple[str, str] | None = None,
        insecure: bool = False,
        patience: float = 300.0,
    ) -> None:
        self._http = Http(address, token, ca, certificate, insecure, patience)

    def __repr__(self) -> str:
        return f"Farm({self._http.place})"

    def dashboard(self, job: JobId | None = None) -> str:
        """The address of its dashboard, or of a job's page there, for people."""
        place = self._http.place
        host = f"[{place.host}]" if ":" in place.host else place.host
        page = f"{'https' if place.secure else 'http'}://{host}:{place.port}/"
        return page if job is None else f"{page}#/jobs/{_id(job)}"

    # Jobs.

    def submit(
        self,
        job: Job | PathLike,
        *,
        name: str = "",
        frames: str | int | range | None = None,
        samples: int = 0,
        priority: int = 0,
        owner: str | None = None,
        max_workers: int = 0,
        tags: Sequence[str] = (),
        memory_bytes: int = 0,
        max_attempts: int = 3,
        redundancy: int = 0,
        frame_order: Literal["sequential", "progressive"] = "sequential",
        set: Mapping[str, object] | None = None,
        on_bytes: OnBytes | None = None,
        on_warning: Callable[[str], object] | None = None,
        program: PathLike | None = None,
    ) -> JobState:
        """Uploads what the coordinator lacks of a job's files and submits the job, once, however
        often an answer is lost. Options are those of `hyades submit` (docs/client.md); `set` are the parameters of a script; `on_bytes` is
        told the bytes that were sent and their total, `on_warning` each thing that is likely not meant in
        the job, that nothing gives light, say (without it: warnings of Python's). JobError: the job has mistakes."""
        message: dict[str, Any] = {
            "name": name,
            "samples": samples,
            "priority": priority,
            "owner": self._owner() if owner is None else owner,
            "max_workers": max_workers,
            "tags": list(tags),
            "memory_bytes": memory_bytes,
            "max_attempts": max_attempts,
            "redundancy": redundancy,
            "frame_order": frame_order,
            "idempotency_key": secrets.token_hex(16),
        }
        if frames is not None:
            message["frames"] = [_frame_range(frames)]
        with packed(job, program, set) as package:
            answer = submit(self._http, package, message, on_bytes)
        state = read_state(JobState, part(answer, "job", dict))
        told = answer.get("warnings")  # older coordinators have none
        for warning in told if isinstance(told, list) else []:
            text = printable_lines(str(warning))
            if on_warning is None:
                warnings.warn(text, stacklevel=2)
            else:
                on_warning(text)
        return state

    def jobs(self, *, ended: bool = False, owner: str | None = None) -> Iterator[JobState]:
        """Open jobs, the newest first; with `ended` also those that have ended."""
        before: int | None = None
        while before != 0:
            query = {"ended": ended, "owner": owner, "limit": 1000, "before": before}
            answer = self._http.call("GET", "/api/v1/jobs", query=query)
            rows, following = part(answer, "jobs", list), part(answer, "next_before", int)
            yield from (read_state(JobState, row) for row in rows)
            if following != 0 and (not rows or (before is not None and following >= before)):
                raise no_end()
            before = following

    def job(self, job: JobId) -> JobState:
        """A job as it is now."""
        return read_state(JobState, part(self._http.call("GET", _path(job)), "job", dict))

    def find(self, name: str) -> JobState:
        """The newest job of this name."""
        for job in self.jobs(ended=True):
            if job.name == name:
                return job
        raise FarmError("not_found", f"there is no job called '{name}'")

    def frames(self, job: JobId, state: str | None = None) -> Iterator[FrameState]:
        """The frames of a job, or those in one state: waiting, rendering, finishing, done, failed."""
        query: dict[str, Any] = {"state": state}
        for frame in self._pages(_path(job, "frames"), "frames", FrameState, query):
            yield frame

    def watch(self, job: JobId) -> Iterator[Change]:
        """The job as it changes, until it has ended: first all its frames, then those that change.
        Restarts of the coordinator are waited for."""
        return iter(JobEvents(self._http, _id(job)))

    def wait(self, job: JobId) -> JobState:
        """The job as it is when it has ended; look at its `state`."""
        state = self.job(job)
        for change in self.watch(job):
            state = change.job
        return state

    def pause(self, job: JobId) -> JobState:
        """No more of it is given to workers."""
        return self._steer(job, "pause")

    def resume(self, job: JobId) -> JobState:
        return self._steer(job, "resume")

    def cancel(self, job: JobId) -> JobState:
        """Ends it; finished frames stay."""
        return self._steer(job, "cancel")

    def retry(self, job: JobId) -> JobState:
        """Renders failed and doubtful frames again, or what a cancelled job has left."""
        return self._steer(job, "retry")

    def set_priority(self, job: JobId, priority: int) -> JobState:
        """Higher goes first."""
        answer = self._http.call("PUT", _path(job, "priority"), message={"priority": priority})
        return read_state(JobState, answer)

    def delete(self, job: JobId) -> None:
        """Forgets a job that has ended, with its films and outputs."""
        self._http.call("DELETE", _path(job))

    def explain(self, job: JobId) -> list[str]:
        """Why it does or does not get on, the weightiest reason first."""
        return [str(reason) for reason in part(self._http.call("GET", _path(job, "explain")), "reasons", list)]

    def logs(self, job: JobId) -> Iterator[LogLine]:
        """What has happened to it, oldest first."""
        return self._pages(_path(job, "logs"), "lines", LogLine, {})

    # What it has made.

    def outputs(self, job: JobId, frame: int | None = None) -> Iterator[OutputFile]:
        """The finished files, in the order in which they were finished."""
        return (file for _, file in self._outputs_after(job, 0, frame))

    def fetch(
        self,
        job: JobId,
        folder: PathLike,
        *,
        frames: Sequence[int] | None = None,
        follow: bool = False,
        hidden: bool = False,
        overwrite: bool = False,
        on_bytes: Callable[[int], None] | None = None,
    ) -> list[Path]:
        """Brings finished files (of some frames) into a folder; with `follow` each as it is finished,
        until the job has ended. Files that are there are not brought again; unfinished ones go on.

        FileRefused: a name leaves the folder or is hidden (`hidden` allows that), a file is there
        that no fetch of this job has written, or that was changed since (`overwrite` replaces it), or
        the bytes are not those promised.
        """
        fetcher = Fetcher(self._http, _id(job), Path(folder), hidden, overwrite, on_bytes)
        here: dict[str, Path] = {}
        told = 0
        # Of a job that is not followed this is one round; of one that is, the last comes after its end.
        for change in itertools.chain(self.watch(job) if follow else (), (None,)):
            if change is not None and not any(frame.state == "done" for frame in change.frames):
                continue
            for after, file in self._outputs_after(job, told):
                if frames is None or file.frame in frames:
                    here[file.id] = fetcher.fetch(file)
                told = after
        return list(here.values())

    def film(
        self,
        job: JobId,
        frame: int,
        layer: str = "beauty",
        *,
        width: int | None = None,
        most_bytes: int | None = None,
    ) -> FilmLayer:
        """A layer of a frame as it is now, also in mid-render; averaged down to `width` pixels. FarmError where it
        would take more than `most_bytes` of memory, or more than half of what there is."""
        query = {"format": "half", "layer": layer, "width": width}
        most = usable_memory() // 2 if most_bytes is None else most_bytes

        def once() -> FilmLayer:
            with self._http.open("GET", _path(job, f"frames/{int(frame)}/picture"), query=query) as answer:
                return read_film(answer, most)

        return self._http.patiently(once)

    def films(
        self, job: JobId, frame: int, *, width: int | None = None, most_bytes: int | None = None
    ) -> Layers:
        """All layers of a frame as it is now; `most_bytes` is for all of them together."""
        left = usable_memory() // 2 if most_bytes is None else most_bytes
        first = self.film(job, frame, width=width, most_bytes=left)
        layers = Layers({"samples": first.samples, "exact": first.exact})
        left -= first.array.nbytes
        for layer in dict.fromkeys(first.layers):
            found = first if layer == first.layer else self.film(job, frame, layer, width=width, most_bytes=left)
            layers[layer] = found.array
            left -= found.array.nbytes if found is not first else 0
        return layers

    # Workers, and the coordinator itself.

    def workers(self) -> list[WorkerState]:
        """All workers, also those that are gone for less than an hour."""
        rows = part(self._http.call("GET", "/api/v1/workers"), "workers", list)
        return [read_state(WorkerState, row) for row in rows]

    def drain(self, worker: WorkerId) -> WorkerState:
        """It delivers what it has and leaves."""
        return self._steer_worker(worker, "drain", "")

    def quarantine(self, worker: WorkerId, reason: str = "") -> WorkerState:
        """No more work for it."""
        return self._steer_worker(worker, "quarantine", reason)

    def release(self, worker: WorkerId) -> WorkerState:
        return self._steer_worker(worker, "release", "")

    def info(self) -> dict[str, Any]:
        """Who is there, which versions: `Info` of openapi.yaml."""
        answer: dict[str, Any] = self._http.call("GET", "/api/v1/info")
        part(answer, "version", str)
        return answer

    def _owner(self) -> str:
        """Nobody in particular where a token tells it; else who runs this."""
        if self._http.has_token:
            return ""
        try:
            return getpass.getuser()
        except (OSError, KeyError, ImportError):
            return ""

    def _outputs_after(self, job: JobId, after: int, frame: int | None = None) -> Iterator[tuple[int, OutputFile]]:
        """Files that were finished later than what `after` stands for, and what stands for each."""
        more = True
        while more:
            query = {"after": after, "frame": frame}
            answer = self._http.call("GET", _path(job, "outputs"), query=query)
            rows, following, more = part(answer, "outputs", list), part(answer, "after", int), part(answer, "more", bool)
            for row in rows:
                yield following, read_state(OutputFile, row)
            if more and (not rows or following <= after):
                raise no_end()
            after = following

    def _steer(self, job: JobId, action: str) -> JobState:
        return read_state(JobState, self._http.call("POST", _path(job, action)))

    def _steer_worker(self, worker: WorkerId, action: str, reason: str) -> WorkerState:
        path = f"/api/v1/workers/{_id(worker)}/{action}"
        return read_state(WorkerState, self._http.call("POST", path, message={"reason": reason}))

    def _pages(self, path: str, rows: str, kind: type[Any], query: dict[str, Any]) -> Iterator[Any]:
        after: int | None = None
        more = True
        while more:
            answer = self._http.call("GET", path, query={**query, "after": after})
            before, more = after, part(answer, "more", bool)
            for row in part(answer, rows, list):
                yield read_state(kind, row)
                after = part(row, "id", int)
            if more and (after is None or (before is not None and after <= before)):
                raise no_end()


def _id(thing: Any) -> int:
    number = getattr(thing, "id", thing)
    if isinstance(number, str) and number.isdecimal():
        return int(number)
    if hasattr(number, "__index__") and not isinstance(number, bool):
        return index(number)
    raise ValueError(f"expected a job or worker, or its number, not {number!r}; Farm.find() finds jobs by name")


def _path(job: JobId, below: str = "") -> str:
    return f"/api/v1/jobs/{_id(job)}" + (f"/{below}" if below else "")


def _frame_range(frames: str | int | range) -> dict[str, int]:
    first, _, rest = str(frames_text(Key("frames"), frames)).partition("-")
    last, _, step = rest.partition("x")
    return {"first": int(first), "last": int(last or first), "step": int(step or 1)}
