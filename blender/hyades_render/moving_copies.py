"""Copies that a file places, where some of them move: those become objects of their own, whose transforms can have keys."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import hyades
import numpy
from hyades import objects

from .export import Names, axes
from .export.context import free_name
from .export.places import MatrixPlaces

_MOST = 4096
"""Copies of one thing that may move: each is an object of the job, with keys for each moment."""
_EXACT = 1e-6  # of a matrix's largest number


def spread(jobs: Sequence[hyades.Job], names: Names) -> list[str]:
    """Takes copies that do not stay out of the files of places, in each job. `names` learns what they are called. What it
    says: things of which too many move, which are left as they are."""
    too_many = []
    for name in dict.fromkeys(name for job in jobs for name, body in job.objects.items() if _is_placed(body)):
        bodies = [job.objects.get(name) for job in jobs]
        if not all(body is None or _is_placed(body) for body in bodies):
            continue
        places = [{} if body is None else dict(zip(body.places.ids, body.places.matrices)) for body in bodies]
        moving = _moving(places)
        if len(moving) > _MOST:
            too_many.append(f"'{names.objects.get(name, name)}', of which {len(moving)} copies move")
        elif moving:
            _take_out(jobs, name, places, moving, names)
    return too_many


def _is_placed(body: Any) -> bool:
    return isinstance(body, objects.Instance) and isinstance(body.places, MatrixPlaces) and body.places.ids is not None


def _moving(places: list[dict[Any, Any]]) -> dict[Any, None]:
    """Which copies are not at one place all the time, in their order."""
    moving = {}
    for one in dict.fromkeys(one for at in places for one in at):
        first = places[0].get(one)
        for at in places:
            there = at.get(one)
            if first is None or there is None or numpy.abs(there - first).max() > _EXACT * numpy.abs(first).max():
                moving[one] = None
                break
    return moving


def _take_out(jobs: Sequence[hyades.Job], name: str, places: list[Any], moving: dict[Any, None], names: Names) -> None:
    called, taken = {}, {one for job in jobs for one in job.objects}
    for one in moving:
        called[one] = free_name(f"{name} copy", taken)
        taken.add(called[one])
        names.objects[called[one]] = names.objects.get(name, name)
        names.links.owners[called[one]] = names.links.owners[name]
    for job, at in zip(jobs, places):
        whole = job.objects.get(name)
        if whole is None:
            continue
        for one in moving:
            if one in at:
                step = axes.matrix_step(at[one])
                job.objects[called[one]] = objects.Instance(instance=whole.instance, transform=[step])
        rest = [one for one in at if one not in moving]
        if rest:
            whole.places = MatrixPlaces(numpy.array([at[one] for one in rest]), rest)
        else:
            del job.objects[name]
