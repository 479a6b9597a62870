"""Finished files from a coordinator into a folder, with the care of `hyades fetch`."""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Callable
from pathlib import Path
from urllib.parse import quote

from ..errors import FarmError, FileRefused
from ..files import stays_in_folder
from .answers import part as answered
from .http import Http
from .names import check_name
from .states import OutputFile

_PIECE = 1 << 20
_NO_LINKS = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)


class FetchRecord:
    """Which files of a folder a fetch has written, of which job and with which bytes, in its file
    .hyades/fetched: without it a hostile coordinator, which names the files, could have others of
    the folder replaced, and one job's pictures could replace another's."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / ".hyades/fetched"
        # What is a link, or a pipe, came with somebody's folder.
        is_plain = self._file.is_file() and not self._file.is_symlink()
        if self._file.parent.is_symlink() or (os.path.lexists(self._file) and not is_plain):
            raise FileRefused(f"{self._file}: expected what hyades has made there, no link and no pipe")
        text = self._file.read_text(encoding="utf-8", errors="replace") if self._file.exists() else ""
        self._lines = set(text.split("\n")[:-1])  # the last line may have been cut short

    def has(self, job: str, path: str, sha256: str) -> bool:
        """Whether a fetch of the job, called by id and moment, has written these bytes there."""
        return f"{sha256} {job} {path}" in self._lines

    def add(self, job: str, path: str, sha256: str) -> None:
        """Before the file gets its name."""
        if self.has(job, path, sha256):
            return
        line = f"{sha256} {job} {path}"
        self._file.parent.mkdir(exist_ok=True)
        file = os.open(self._file, os.O_WRONLY | os.O_CREAT | os.O_APPEND | _NO_LINKS, 0o666)
        with os.fdopen(file, "ab") as lines:
            lines.write(line.encode() + b"\n")
        self._lines.add(line)


class Fetcher:
    """Brings files of one job into `folder`."""

    def __init__(
        self,
        http: Http,
        job: int,
        folder: Path,
        hidden: bool,
        overwrite: bool,
        on_bytes: Callable[[int], None] | None = None,
    ) -> None:
        self._http = http
        self._job = job
        self._folder = folder
        self._hidden = hidden
        self._overwrite = overwrite
        self._on_bytes = on_bytes
        self._record = FetchRecord(folder)
        self._name = ""

    def fetch(self, file: OutputFile) -> Path:
        """The file's path, once it is there whole. FileRefused where it must not be written."""
        # First: that a file is there already would tell the coordinator what is in it.
        check_name(file.id, self._hidden)
        if len(file.sha256) != 64 or not all(c in "0123456789abcdef" for c in file.sha256):
            raise FileRefused(f"{file.id}: the coordinator names no SHA-256")
        target = self._folder / file.id
        if not stays_in_folder(self._folder, target):
            raise FileRefused(f"{target}: a link leads it out of the folder that is written to")
        if _is_complete(target, file):
            return target
        if not self._overwrite and os.path.lexists(target) and not self._is_own(file.id, target):
            raise FileRefused(
                f"{target} is there, and was not written by a fetch of this job or was changed since "
                "(overwrite=True replaces it, another folder helps too)"
            )
        target.parent.mkdir(parents=True, exist_ok=True)
        part = target.parent / f".{target.name[:200]}.{file.sha256[:16]}.part"
        # The second round is for a part that an earlier run left damaged.
        for again in (False, True):
            if self._bring(file, part, anew=again):
                self._record.add(self._job_name(), file.id, file.sha256)
                os.replace(part, target)
                return target
        raise FileRefused(f"{file.id}: what the coordinator sends has not the SHA-256 that it promised")

    def _is_own(self, path: str, target: Path) -> bool:
        """Whether a file is as a fetch of this job has left it."""
        if target.is_symlink() or not target.is_file():
            return False
        with open(target, "rb") as data:
            return self._record.has(self._job_name(), path, hashlib.file_digest(data, "sha256").hexdigest())

    def _job_name(self) -> str:
        """Id and moment: other coordinators number their jobs alike."""
        if not self._name:
            answer = self._http.call("GET", f"/api/v1/jobs/{self._job}", query={"after": 2147483646})
            self._name = f"{self._job} {answered(answered(answer, 'job', dict), 'submitted_ms', int)}"
        return self._name

    def _bring(self, file: OutputFile, part: Path, anew: bool) -> bool:
        """Fills the part; whether its bytes are right."""
        flags = os.O_RDWR | os.O_CREAT | _NO_LINKS | (os.O_TRUNC if anew else 0)
        if os.path.lexists(part) and not stat.S_ISREG(part.lstat().st_mode):
            raise FileRefused(f"{part}: no file, expected what an earlier fetch has left, or nothing")
        with os.fdopen(os.open(part, flags, 0o666), "r+b") as out:
            digest = hashlib.sha256()
            while piece := out.read(_PIECE):
                digest.update(piece)
            if out.tell() > file.size:
                return False

            def put(piece: bytes) -> None:
                digest.update(piece)
                out.write(piece)

            def once() -> None:
                while out.tell() < file.size:
                    self._take(file, out.tell(), put)

            self._http.patiently(once, out.tell)
            out.flush()
            os.fsync(out.fileno())
        return digest.hexdigest() == file.sha256

    def _take(self, file: OutputFile, offset: int, put: Callable[[bytes], object]) -> None:
        """One try to bring what is missing; what has come of it counts."""
        path = f"/api/v1/jobs/{self._job}/outputs/{quote(file.id)}"
        headers = {"Range": f"bytes={offset}-"} if offset else {}
        with self._http.open("GET", path, headers=headers) as answer:
            if offset and answer.status != 206:
                raise FarmError("unknown", f"{file.id}: the coordinator does not send the rest of a file")
            left = file.size - offset
            while left > 0 and (piece := answer.read(min(_PIECE, left))):
                put(piece)
                left -= len(piece)
                if self._on_bytes is not None:
                    self._on_bytes(len(piece))
        if left > 0:
            raise ConnectionError(f"{file.id} ended early")


def _is_complete(path: Path, file: OutputFile) -> bool:
    if not path.is_file() or path.stat().st_size != file.size:
        return False
    with open(path, "rb") as data:
        return hashlib.file_digest(data, "sha256").hexdigest() == file.sha256
