"""The program `hyades render` while it runs beside Blender."""

from __future__ import annotations

import json
import os
import queue
import signal
import subprocess
import tempfile
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import hyades
from hyades.errors import complaints_in


class RenderProcess:
    """One run. It is watched from the thread that made it, by running() and events()."""

    def __init__(
        self, program: str, job: Path, output: Path, options: Sequence[str] = (), source: Any = None
    ) -> None:
        """Starts `hyades render JOB --output OUTPUT OPTIONS`. `source`: tells which object wrote a line of the
        job, as the error_source of ending_error()."""
        self._source = source
        self._said = tempfile.TemporaryFile()  # noqa: SIM115  (closed by close())
        self._events: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
        command = [program, "render", str(job), "--json", "--no-resume", "--overwrite", "--output", str(output)]
        # A group of its own: Ctrl-C in the terminal is Blender's alone, which ends it.
        self._process = subprocess.Popen(
            [*command, *options],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=self._said,
            encoding="utf-8",
            errors="replace",
            start_new_session=os.name == "posix",
        )
        self._reader = threading.Thread(target=self._read, name="hyades-render", daemon=True)
        self._reader.start()

    @property
    def pid(self) -> int:
        return self._process.pid

    def running(self) -> bool:
        return self._process.poll() is None

    def events(self) -> list[dict[str, Any]]:
        """What it has said since the last call: docs/job.md, `hyades render --json`."""
        found = []
        while not self._events.empty():
            found.append(self._events.get())
        return found

    def stop(self) -> None:
        """Ends it at once: all that it writes lies in a temporary folder, so nothing is worth a wait."""
        if self.running():
            try:
                os.killpg(self._process.pid, signal.SIGKILL) if os.name == "posix" else self._process.kill()
            except ProcessLookupError:
                pass  # it has ended meanwhile
            self._process.wait()
        self.close()

    def close(self) -> None:
        """Lets its files go; it has ended."""
        self._reader.join()
        if self._process.stdout is not None:
            self._process.stdout.close()
        self._said.close()

    def ending_error(self) -> hyades.HyadesError | None:
        """After its end: what went wrong, None where nothing did."""
        status = self._process.wait()
        if status == 0:
            return None
        self._said.seek(0)
        said = self._said.read().decode("utf-8", "replace").strip()
        if status == 2 and complaints_in(said):
            error = hyades.JobError(said)
            error.source = self._source(error.line) if self._source else None
            return error
        return hyades.ProgramError(said or f"hyades render ended with status {status}", status)

    def _read(self) -> None:
        for line in self._process.stdout or ():
            try:
                self._events.put(json.loads(line))
            except ValueError:
                pass  # not for programs


def refusal(error: hyades.HyadesError, names: Any = None) -> str:
    """What people are told: a mistake of the job with the object it is about, without files of a temporary folder.

    names: a function from the Python object that wrote the line to what it is called in Blender, or None."""
    if not isinstance(error, hyades.JobError):
        return str(error)
    where = names(error.source) if names and error.source is not None else None
    message = error.message or str(error)
    return f"{where}: {message}" if where else message
