"""The scene as Blender has evaluated it becomes a job of Hyades.

`export_job` makes the job and says what it cannot say: docs/blender.md, "What is exported".
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .. import library  # noqa: F401  (finds the package hyades)

import hyades  # noqa: E402

from .camera import add_camera  # noqa: E402
from .context import Complaint, Context  # noqa: E402
from .film import add_film  # noqa: E402
from .lights import add_light  # noqa: E402
from .objects import add_objects  # noqa: E402
from .world import add_world  # noqa: E402

__all__ = ["Complaint", "Exported", "export_job"]


@dataclass(frozen=True)
class Exported:
    """A job, and what it does not say of the scene."""

    job: hyades.Job
    complaints: list[Complaint]


def export_job(depsgraph: Any, *, settings: Any = None) -> Exported:
    """The scene of `depsgraph` at its current frame.

    settings: the add-on's properties (samples, noise, max_depth, ...); None: their defaults. The depsgraph's
    mode (render or viewport) decides what is there. The job's axes: y is up, see axes.py.
    """
    context = Context(depsgraph, settings)
    add_film(context)
    add_camera(context)
    lights = add_objects(context)
    for instance in lights:
        add_light(context, instance)
    add_world(context)
    return Exported(context.job, context.complaints)
