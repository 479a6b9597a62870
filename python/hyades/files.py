"""The files that a job brings along: what arrays become, and where others lie."""

from __future__ import annotations

import hashlib
import os
import re
import secrets
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .picture import encode_array

_FOLDER = "assets"


class JobFiles:
    """Files beside a job in `folder`. Those made of arrays are called by their content, so that
    equal ones are there once."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.made: dict[str, bytes | Path] = {}  # or of which file it is a copy
        self.named: list[str] = []  # paths as the job has them
        self._known: dict[int, tuple[Any, str]] = {}  # what was encoded already, by its identity

    def reference(self, value: Any) -> str:
        """What the job calls a file: a path, something with encode(), an array, or those by frame."""
        if isinstance(value, (str, os.PathLike)):
            if "#" in os.fspath(value) and os.path.isfile(value):
                return self._copy(os.path.abspath(value))
            path = os.path.relpath(os.path.abspath(value), os.path.abspath(self.folder))
            self.named.append(Path(path).as_posix())
            return self.named[-1]
        if id(value) in self._known:
            return self._known[id(value)][1]
        if isinstance(value, Mapping):
            name = self._sequence(value)
        else:
            data, end = _encoded(value)
            name = f"{_FOLDER}/{_digest(data)}{end}"
            self.made[name] = data
        self._known[id(value)] = (value, name)  # kept, so that its identity stays its own
        return name

    def _copy(self, path: str) -> str:
        """A copy of a file whose own name would mean one for each frame."""
        data, end = _brought(path)
        name = f"{_FOLDER}/{_digest(_told(data).encode())}{end}"
        self.made[name] = data
        return name

    def _sequence(self, values: Mapping[int, Any]) -> str:
        """A file for each frame: those that are there, if their names are those of one pattern; else made ones or copies,
        named by their frames and contents."""
        paths = {frame: os.path.abspath(value) for frame, value in values.items() if isinstance(value, (str, os.PathLike))}
        pattern = _pattern(paths) if len(paths) == len(values) else None
        if pattern is not None:
            return self.reference(pattern)
        files = {frame: _brought(value) for frame, value in values.items()}
        ends = {end for _, end in files.values()}
        if len(ends) != 1:
            raise ValueError(f"a file for each frame has to be of one kind, not {sorted(ends)}")
        all_digest = _digest("".join(f"{frame} {_told(data)}\n" for frame, (data, _) in files.items()).encode())
        end = ends.pop()
        for frame, (data, _) in files.items():
            self.made[f"{_FOLDER}/{all_digest}.{frame:04d}{end}"] = data
        return f"{_FOLDER}/{all_digest}.####{end}"

    def write(self) -> None:
        """Brings what arrays have become, and copies, to the disk; what is there has that content already."""
        for name, data in self.made.items():
            path = self.folder / name
            if not stays_in_folder(self.folder, path):
                raise OSError(f"{path}: a link leads it out of the job's folder")
            size = data.stat().st_size if isinstance(data, Path) else len(data)
            if path.exists() and path.stat().st_size == size:
                continue
            path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(path, data)


def write_whole(path: Path, data: bytes | Path) -> None:
    """Writes a file of bytes, or a copy of another one.

    Nobody sees a part of the file. A link that stands there is replaced, not followed: the folder may have come
    with somebody's scene."""
    temporary = path.with_name(f".{path.name[:200]}.{secrets.token_hex(8)}.part")
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    try:
        with os.fdopen(os.open(temporary, flags, 0o666), "wb") as file:
            if isinstance(data, Path):
                with data.open("rb") as source:
                    shutil.copyfileobj(source, file)
            else:
                file.write(data)
        os.replace(temporary, path)
    except OSError:
        temporary.unlink(missing_ok=True)
        raise


def led_to(path: str | Path) -> Path:
    """Where links lead the path, as the system follows them; OSError where nobody can tell: below folders that are
    deeper than any name is long, what is not strict takes links for none, and the system does not."""
    led = Path(os.path.realpath(path, strict=True))
    if not os.path.samestat(os.stat(path), os.stat(led)):
        raise OSError(f"{path}: it leads elsewhere than it says")
    return led


def stays_in_folder(folder: Path, path: Path) -> bool:
    """Whether no link leads `path`, below `folder` and still to be written, out of it, or to nobody knows where.
    The folder itself may be a link: who names it means it."""
    try:
        home = led_to(folder)
        way = folder
        for step in path.relative_to(folder).parts[:-1]:
            way = way / step
            if step == ".." or way.is_symlink() and home not in (led := led_to(way), *led.parents):
                return False
            way.lstat()
    except (FileNotFoundError, NotADirectoryError):
        # From here on it is made, without links. A link to what is not there cannot be made a folder.
        return ".." not in path.relative_to(folder).parts
    except (OSError, ValueError):
        return False
    return True


def _pattern(paths: Mapping[int, str]) -> str | None:
    """The name with # that means these files, by frame, if there is one: the last number of their names is the frame's."""
    path = next(iter(paths.values()))
    numbers = list(re.finditer(r"\d+", os.path.basename(path)))
    if not numbers or "#" in path:
        return None
    at = len(path) - len(os.path.basename(path))
    head, tail = path[:at + numbers[-1].start()], path[at + numbers[-1].end():]
    for width in {len(numbers[-1].group()), 1}:
        if all(other == f"{head}{frame:0{width}d}{tail}" for frame, other in paths.items()):
            return head + "#" * width + tail
    return None


def _encoded(value: Any) -> tuple[bytes, str]:
    if hasattr(value, "encode"):
        data, end = value.encode()
        return bytes(data), str(end)
    return encode_array(value)


def _brought(value: Any) -> tuple[bytes | Path, str]:
    """What a file holds, or of which file it is a copy; and how its name ends."""
    if isinstance(value, (str, os.PathLike)):
        path = os.path.abspath(value)
        return Path(path), os.path.splitext(path)[1]
    return _encoded(value)


def _told(data: bytes | Path) -> str:
    """What tells data from others; of files, which may be large, their names, sizes and times."""
    if isinstance(data, bytes):
        return hashlib.sha256(data).hexdigest()
    stat = data.stat()
    return f"{stat.st_size} {stat.st_mtime_ns} {data}"


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]
