"""The scene as Blender has evaluated it becomes a job of Hyades.

`export_job` makes the job and says what it cannot say: docs/blender.md, "What is exported".
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import hyades

from .camera import add_camera
from .clipping import tell_of_clipping
from .context import Complaint, Context, Names
from .drivers import tell_of_drivers
from .files import tell_of_libraries
from .film import add_film
from .objects import add_objects
from .world import add_world

__all__ = ["Complaint", "Exported", "Names", "export_job"]


@dataclass(frozen=True)
class Exported:
    """A job, and what it does not say of the scene."""

    job: hyades.Job
    complaints: list[Complaint]
    names: Names = field(default_factory=Names)


def export_job(depsgraph: Any, *, settings: Any = None, moves: bool = False, camera: Any = None) -> Exported:
    """The scene of `depsgraph` at its current frame.

    settings: the add-on's properties (samples, noise, max_depth, ...); None: their defaults. The depsgraph's
    mode (render or viewport) decides what is there. The job's axes: y is up, see axes.py.
    moves: it is one of several moments, which are to be joined: what may change is said in one way at all of them.
    camera: through which the scene is seen; None: the scene's own.
    """
    context = Context(depsgraph, settings, moves)
    add_film(context)
    add_camera(context, camera.evaluated_get(depsgraph) if camera is not None else context.scene.camera)
    tell_of_libraries(context)
    add_objects(context)
    add_world(context)
    if not moves:  # else the names are known when the moments are joined
        for where, what in context.names.links.write(context.job, context.names.objects):
            context.complain(where, what)
    tell_of_clipping(context)
    tell_of_drivers(context)
    return Exported(context.job, context.complaints, context.names)
