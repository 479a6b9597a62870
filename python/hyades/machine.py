"""What there is of this machine."""

from __future__ import annotations

import os
from pathlib import Path

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

_NOT_TOLD = 8 << 30
# Of a container that sees itself as the root: version 2, and version 1, whose "no limit" is a huge number.
_LIMITS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")


def usable_memory() -> int:
    """Bytes of memory that this process may take at most: those of the machine, of its container or of its
    own limit, whichever is least; 8 GiB where the system does not tell."""
    found = []
    try:
        found.append(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, ValueError, OSError):
        pass
    for path in _LIMITS:
        try:
            found.append(int(Path(path).read_text(encoding="ascii")))
        except (OSError, ValueError):
            pass  # "max" is no number
    if resource is not None:
        found.append(resource.getrlimit(resource.RLIMIT_AS)[0])  # -1: none
    return min((size for size in found if size > 0), default=_NOT_TOLD)
