"""Which names of files a coordinator may give: it chooses them, and is not to be trusted with a disk.

The same rules as of `hyades fetch`: core/job/output_path.h.
"""

from __future__ import annotations

import os
import posixpath

from ..errors import FileRefused
from ..printable import is_printable

# What files of jobs may be: kFormats of core/job/read_outputs.cpp.
ENDINGS = (".exr", ".png", ".tif", ".tiff", ".jpg", ".jpeg", ".mp4", ".mov", ".webm")


def check_name(path: str, hidden: bool = False) -> None:
    """FileRefused where `path`, as a coordinator names it, must not be written below a folder."""
    parts = path.split("/")
    # Some systems take a backslash for what a slash is here.
    slashed = path.replace("\\", "/")
    outside = slashed.startswith("/") or ".." in slashed.split("/")
    stays = path and not outside and posixpath.normpath(path) == path
    # Other systems have other ways to say "elsewhere": drives, backslashes.
    foreign = os.name == "nt" and any(c in path for c in '\\:*?"<>|')
    if not stays or path == "." or foreign or not is_printable(path):
        raise FileRefused(f"the coordinator names an output that is no file of a job: {path[:200]!r}")
    if ".hyades" in parts:
        raise FileRefused(f"{path}: what hyades keeps for itself no job writes")
    if not hidden and any(part.startswith((".", "-")) for part in parts):
        raise FileRefused(
            f"{path}: hidden files, and names that begin with '-', are not written (hidden=True writes them)"
        )
    # What builds, scripts and shells take for theirs (a Makefile, say) is no picture either.
    if posixpath.splitext(path)[1].lower() not in ENDINGS:
        raise FileRefused(f"{path}: no job has such an output; expected the ending {', '.join(ENDINGS)}")
