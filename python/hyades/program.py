"""The program `hyades`: where it is, and what it says."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

from .errors import HyadesError, JobError, ProgramError, complaints_in
from .job import Job
from .yaml_text import MADE_HERE

PathLike: TypeAlias = "str | os.PathLike[str]"

_REFUSED = 2  # its exit status where the job or the arguments are wrong
_ENDS_WITHIN = 10.0  # seconds, after it was asked to


def find_program(program: PathLike | None = None) -> str:
    """The program: `program`, what the environment variable HYADES names, one on PATH, or the one
    that was built or installed beside this package. ProgramError where there is none."""
    # No other folders: anybody may write above a package that lies in /tmp.
    around = Path(__file__).resolve().parents[1]
    beside = []
    if around.name == "python":
        beside.append(around.parent / "build/bin/hyades")
    if around.name in ("dist-packages", "site-packages"):
        beside.append(around.parents[2] / "bin/hyades")
    named = program or os.environ.get("HYADES")
    if named:
        found = shutil.which(os.fspath(named))
        if found is None:
            raise ProgramError(f"{os.fspath(named)} is no program that can be run")
        return found
    for candidate in ["hyades", *map(str, beside)]:
        if found := shutil.which(candidate):
            return found
    raise ProgramError(
        "the program hyades was not found: expected it on PATH, or its path in the environment variable HYADES"
    )


def run_program(
    arguments: Sequence[str],
    program: PathLike | None = None,
    on_line: Callable[[str], None] | None = None,
) -> str:
    """Runs `hyades ARGUMENTS`; what it printed. Each line goes to `on_line` as it comes.

    JobError where it tells of mistakes in a job, ProgramError where it fails otherwise. Ctrl-C ends it.
    """
    command = [find_program(program), *arguments]
    printed = []
    with tempfile.TemporaryFile() as said_file:
        process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=said_file, encoding="utf-8", errors="replace"
        )
        with _ended_in_any_case(process):
            for line in process.stdout or ():
                printed.append(line)
                if on_line is not None:
                    on_line(line)
            status = process.wait()
        said_file.seek(0)
        said = said_file.read().decode("utf-8", "replace")
    if status == 0:
        return "".join(printed)
    if status == _REFUSED and complaints_in(said):
        raise JobError(said)
    raise ProgramError(said.strip() or f"hyades {arguments[0]} ended with status {status}", status)


@contextmanager
def _ended_in_any_case(process: subprocess.Popen[str]) -> Iterator[None]:
    """Whatever happens here, Ctrl-C too, the program does not outlive it."""
    try:
        yield
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
            try:
                process.wait(_ENDS_WITHIN)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        if process.stdout is not None:
            process.stdout.close()


@contextmanager
def written(job: Job | PathLike, folder: Path) -> Iterator[Path]:
    """The file of a job: where it is one already, or as it is written into `folder`. Complaints of
    the program within know the object that wrote the line."""
    if not isinstance(job, Job):
        yield Path(job)
        return
    document = job.document(folder)
    path = folder / f"{job.name or 'job'}.yaml"
    if path.exists() and not path.read_bytes().startswith(MADE_HERE.encode()):
        raise HyadesError(f"{path} is there and was not made by this package: expected another output or name")
    try:
        yield document.write(path)
    except JobError as error:
        error.source = document.text.source_of(error.line)
        raise


def set_options(parameters: Mapping[str, object] | None) -> list[str]:
    """Parameters of a script as options of the program."""
    plain = {name: str(value).lower() if isinstance(value, bool) else value for name, value in (parameters or {}).items()}
    return [f"--set={name}={value}" for name, value in plain.items()]


def check(job: Job | PathLike, *, set: Mapping[str, object] | None = None, program: PathLike | None = None) -> str:
    """Reads a job and all files that it names; what it is and needs, in words. JobError: mistakes. `set`: the parameters
    of a script (`.lua`)."""
    with tempfile.TemporaryDirectory() as folder, written(job, Path(folder)) as path:
        return run_program(["check", str(path), "--no-probe", *set_options(set)], program)


def files_of(
    path: PathLike,
    program: PathLike | None = None,
    *,
    made: PathLike | None = None,
    set: Mapping[str, object] | None = None,
) -> list[dict[str, Any]]:
    """The files that a job is read from: `path` (relative to its folder), `sha256` and `size`; the
    job itself comes first. Those that are made of scenes of other tools, and lie on no disk, are
    written into the folder `made`, each under its `sha256`. `set`: the parameters of a script."""
    written = [] if made is None else ["--made", os.fspath(made)]
    listed: list[dict[str, Any]] = json.loads(run_program(["check", os.fspath(path), "--files", *written, *set_options(set)], program))
    return listed
