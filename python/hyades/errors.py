"""What can go wrong with jobs, runs and farms. What is wrong with a call, an array or a file is an exception of Python's:
TypeError, AttributeError, ValueError, OSError."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from .printable import printable_lines

_COMPLAINT = re.compile(r"^(?P<file>[^\n]+?):(?P<line>\d+):(?:(?P<column>\d+):)? (?P<message>.*)$")


class HyadesError(Exception):
    """Mistakes in jobs, and what programs and farms refuse."""


class KeyRefused(HyadesError, ValueError):
    """A key was given a value that it does not take; the message names both and what was expected."""


@dataclass(frozen=True)
class Complaint:
    """One mistake in a job, as the program tells it."""

    file: str
    line: int
    column: int
    message: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}: {self.message}"


class JobError(HyadesError):
    """A job that the program or the coordinator refuses.

    `file`, `line` and `message` are those of the first of its `complaints`; `line` is 0 where the
    mistake has no place. `source` is the Python object that wrote this line, where one did.
    """

    def __init__(self, text: str, source: Any = None) -> None:
        super().__init__(text.strip())
        self.complaints = complaints_in(text)
        first = self.complaints[0] if self.complaints else Complaint("", 0, 0, text.strip())
        self.file: str = first.file
        self.line: int = first.line
        self.message: str = first.message
        self.source = source


class ProgramError(HyadesError):
    """The program `hyades` is not there, or failed; `status` is its exit status (-1: none)."""

    def __init__(self, message: str, status: int = -1) -> None:
        super().__init__(message)
        self.status = status


class FarmError(HyadesError):
    """What a coordinator answered instead of what was asked for, or that it did not answer.

    `code` is gRPC's name for it in small letters (`not_found`, `unauthenticated`, `unavailable`, ...),
    `missing` the SHA-256 of files that it wants first. The message steers no terminal, whatever it answered:
    '?' stands for what is not printable.
    """

    def __init__(self, code: str, message: str, missing: tuple[str, ...] = ()) -> None:
        super().__init__(printable_lines(message))
        self.code = printable_lines(code)
        self.missing = missing


class FileRefused(FarmError):
    """A file that the coordinator offered and that is not written: its name or its bytes are wrong."""

    def __init__(self, message: str) -> None:
        super().__init__("refused", message)


def complaints_in(text: str) -> list[Complaint]:
    """The lines of `text` that tell of a mistake with its place."""
    found = (_COMPLAINT.match(line) for line in text.splitlines())
    return [
        Complaint(match["file"], int(match["line"]), int(match["column"] or 0), match["message"])
        for match in found
        if match
    ]
