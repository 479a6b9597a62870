"""Brings a job and its files to a coordinator."""

from __future__ import annotations

import hashlib
import io
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

from ..errors import FarmError, HyadesError, JobError
from ..job import Document, Job
from ..job_types.objects import GltfScene, Group, ObjScene, Object, PbrtScene
from ..program import PathLike, files_of
from .answers import part
from .http import Http

_PIECE = 8 << 20  # the most that a coordinator takes at once
_MOST_ASKED = 10_000  # files in one question
_MOST_ROUNDS = 3  # of bringing what the coordinator misses
_LONG = 300.0  # seconds

OnBytes = Callable[[int, int], None]


@dataclass(frozen=True)
class JobFile:
    """A file that travels with a job; `path` is only its name."""

    path: str
    content: bytes | Path
    sha256: str
    size: int

    def open(self) -> BinaryIO:
        return io.BytesIO(self.content) if isinstance(self.content, bytes) else open(self.content, "rb")


@dataclass(frozen=True)
class Package:
    """A job made ready to travel; `files` begin with its text. `described` is what it was made of."""

    name: str
    files: list[JobFile]
    described: Document | None = None


@contextmanager
def packed(job: Job | PathLike, program: PathLike | None, set: Mapping[str, object] | None = None) -> Iterator[Package]:
    """A job with all its files, while the block lasts. Where files name others (include, scenes of
    other tools, ...) the program is asked which."""
    if not isinstance(job, Job):
        with tempfile.TemporaryDirectory() as made:
            yield Package("", _listed(Path(job), program, Path(made), set))
        return
    name = f"{job.name or 'job'}.yaml"
    document = job.document()
    if _names_all_files(job, document):
        yield Package(name, list(_own_files(name, document)), document)
        return
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as made:
        document = job.document(folder)
        try:
            files = _listed(document.write(Path(folder) / name), program, Path(made))
        except JobError as error:
            error.source = document.text.source_of(error.line)
            raise
        yield Package(name, files, document)


def submit(http: Http, package: Package, message: dict[str, Any], on_bytes: OnBytes | None) -> dict[str, Any]:
    """Brings what is missing, and submits; what the coordinator has taken in. JobError: the job has
    mistakes."""
    files = [{"path": f.path, "sha256": f.sha256, "size": f.size} for f in package.files]
    message = {**message, "document": package.files[0].path, "files": files}
    for rounds_left in reversed(range(_MOST_ROUNDS)):
        upload_missing(http, package.files, on_bytes)
        try:
            answer: dict[str, Any] = http.call("POST", "/api/v1/jobs", message=message, timeout=_LONG)
            return answer
        except FarmError as error:
            # Files that were there may have been removed since, with the last job that had them.
            if error.missing and rounds_left:
                continue
            raise _of_job(error, package) from None
    raise AssertionError("the last round returns or raises")


def upload_missing(http: Http, files: Sequence[JobFile], on_bytes: OnBytes | None = None) -> None:
    """Sends those files that the coordinator has not, from where an earlier upload was cut off."""
    by_digest = {file.sha256: file for file in files}
    missing = _missing(http, list(by_digest.values()))
    total = sum(by_digest[digest].size - offset for digest, offset in missing)
    sent = 0

    def moved(count: int) -> None:
        nonlocal sent
        sent += count
        if on_bytes is not None:
            on_bytes(sent, total)

    for digest, offset in missing:
        _upload(http, by_digest[digest], offset, moved)


def _missing(http: Http, files: Sequence[JobFile]) -> list[tuple[str, int]]:
    """Which of `files` are not there, and from where on."""
    found = []
    for at in range(0, len(files), _MOST_ASKED):
        asked = {file.sha256: file for file in files[at : at + _MOST_ASKED]}
        question = {"files": [{"sha256": f.sha256, "size": f.size} for f in asked.values()]}
        for row in part(http.call("POST", "/api/v1/assets/missing", message=question), "missing", list):
            file = asked.pop(part(row, "sha256", str), None)
            if file is None:
                raise FarmError("unknown", "the coordinator asks for a file that the job does not have, or for one twice")
            found.append((file.sha256, _offset(row, file)))
    return found


def _offset(answer: Any, file: JobFile) -> int:
    """From where on a coordinator wants a file; FarmError where that is no place in it."""
    offset = part(answer, "offset", int)
    if not 0 <= offset <= file.size:
        raise FarmError("unknown", f"the coordinator wants {file.path} from byte {offset} on, expected 0 to {file.size}")
    return offset


def _upload(http: Http, file: JobFile, offset: int, moved: Callable[[int], None]) -> None:
    """Piece by piece. After a failure it is asked anew where the file stands; once it may begin again
    from the beginning, for what was there of it may have been wrong."""
    restarts = 1
    with file.open() as data:
        while True:
            data.seek(offset)
            piece = data.read(min(_PIECE, file.size - offset))
            if len(piece) < min(_PIECE, file.size - offset):
                raise HyadesError(f"{file.path} has become shorter while it was sent")
            try:
                answer = _send(http, file, offset, piece)
            except FarmError:
                left = _missing(http, [file])
                if not left:
                    return
                if left[0][1] == offset or restarts == 0:
                    raise
                restarts -= left[0][1] < offset
                offset = left[0][1]
                continue
            moved(len(piece))
            if part(answer, "complete", bool):
                return
            stands = _offset(answer, file)
            if stands <= offset:
                if restarts == 0:
                    raise FarmError("unknown", f"the coordinator takes {file.path} and does not get on with it")
                restarts -= 1
            offset = stands


def _send(http: Http, file: JobFile, offset: int, piece: bytes) -> dict[str, Any]:
    query = {"size": file.size, "offset": offset}
    path = f"/api/v1/assets/{file.sha256}"
    answer: dict[str, Any] = http.call("PUT", path, query=query, body=piece, timeout=_LONG)
    return answer


def _of_job(error: FarmError, package: Package) -> HyadesError:
    """A refusal that tells of places in the job is the job's."""
    if error.code != "invalid_argument" or ": " not in str(error):
        return error
    refused = package.described.error(str(error)) if package.described else JobError(str(error))
    return refused if refused.complaints else error


def _names_all_files(job: Job, document: Document) -> bool:
    """Whether the files that the job names are all that it needs."""
    everything = [*all_objects(job.objects), *(o for g in job.groups.values() for o in all_objects(g.objects))]
    scenes = any(isinstance(thing, (GltfScene, ObjScene, PbrtScene)) for thing in everything)
    plain = all((document.files.folder / name).is_file() for name in document.files.named)
    return plain and not scenes and not job.include and job.color is None


def all_objects(objects: Mapping[str, Object], within: tuple[Group, ...] = ()) -> Iterator[Object]:
    """These, and those in groups among them, wherever those are described."""
    for thing in objects.values():
        yield thing
        group = thing.__dict__.get("group") or thing.__dict__.get("instance")
        if isinstance(group, Group) and group not in within:
            yield from all_objects(group.objects, (*within, group))


def _own_files(name: str, document: Document) -> Iterator[JobFile]:
    yield _file(name, str(document.text).encode())
    for made, data in document.files.made.items():
        yield _file(made, data)
    for named in dict.fromkeys(document.files.named):
        yield _file(named, document.files.folder / named)


def _file(name: str, content: bytes | Path) -> JobFile:
    if isinstance(content, bytes):
        return JobFile(name, content, hashlib.sha256(content).hexdigest(), len(content))
    with open(content, "rb") as data:
        digest = hashlib.file_digest(data, "sha256").hexdigest()
        return JobFile(name, content, digest, data.tell())


def _listed(
    path: Path, program: PathLike | None, made: Path, set: Mapping[str, object] | None = None
) -> list[JobFile]:
    """What the program reads of a job, or of a scene of another tool; what it makes of scenes comes into `made`."""
    files = []
    for row in files_of(path, program, made=made, set=set):
        content = made / row["sha256"]
        if not content.is_file():
            content = path.parent / row["path"]
        files.append(JobFile(row["path"], content, row["sha256"], row["size"]))
    return files
