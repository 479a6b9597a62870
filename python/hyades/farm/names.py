"""Which names of files a coordinator may give: it chooses them, and is not to be trusted with a disk.

The same rules as of `hyades fetch`: core/job/output_path.h.
"""

from __future__ import annotations

import os
import posixpath

from ..errors import FileRefused
from ..printable import is_printable

def check_name(path: str, hidden: bool = False) -> None:
    """FileRefused where `path`, as a coordinator names it, must not be written below a folder."""
    parts = path.split("/")
    stays = path and not path.startswith("/") and ".." not in parts and posixpath.normpath(path) == path
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
