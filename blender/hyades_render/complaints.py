"""What Hyades cannot say of a scene yet: told when it is rendered, and kept for the panel."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import bpy

_MOST_TOLD = 20  # in one report, which people have to read

# Of the last export, by the name of the scene.
_kept: dict[str, list[Any]] = {}


def keep(scene: Any, found: Sequence[Any]) -> None:
    """Replaces what is known of a scene."""
    _kept[scene.name] = list(found)


def of(scene: Any) -> list[Any] | None:
    """What the last export of a scene complained about; None: it was not exported yet."""
    return _kept.get(scene.name)


def print_all(found: Sequence[Any]) -> None:
    """Without a window: on standard output, each on a line."""
    if bpy.app.background:
        for one in found:
            print(f"Hyades: warning: {one}", flush=True)


def tell(reporter: Any, found: Sequence[Any]) -> None:
    """Warns by `reporter.report`; without a window also on standard output, each on a line."""
    if not found or bpy.app.background:
        return print_all(found)
    lines = [str(one) for one in found[:_MOST_TOLD]]
    if len(found) > _MOST_TOLD:
        lines.append(f"and {len(found) - _MOST_TOLD} more: see Render properties > Not Exported")
    reporter.report({"WARNING"}, "Hyades: " + "\n".join(lines))
