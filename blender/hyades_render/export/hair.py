"""Hair: particles of type Hair that are shown as paths, and objects of type Hair Curves, as strands."""

from __future__ import annotations

from typing import Any, Iterator, Optional

import hyades
import numpy
from hyades import objects

from . import axes
from .context import Context
from .materials import strand_material
from .visibility import Seen, add_seen


def add_hair(context: Context, object: Any, matrix: Any, seen: Seen) -> None:
    """The hair that grows on an object; `matrix` is where it stands in Blender's world."""
    for system in _systems(object):
        strands = _of_particles(object, system, numpy.linalg.inv(axes.array(matrix)))
        if strands is not None:
            slot = _slot(object, system.settings.material - 1)
            _add(context, f"{object.name}.{system.name}", strands, slot, matrix, seen)


def has_hair(object: Any) -> bool:
    """Whether hair grows on it."""
    return next(_systems(object), None) is not None


def add_curves(context: Context, object: Any, matrix: Any, seen: Seen) -> None:
    """An object of type Hair Curves."""
    strands = _of_curves(object.data)
    if strands is not None:
        _add(context, object.name, strands, _slot(object, 0), matrix, seen)


def _add(context: Context, name: str, strands: hyades.Strands, data: Any, matrix: Any, seen: Seen) -> None:
    body = objects.Curves(curves=strands, material=strand_material(context, context.override or data))
    body.transform = axes.steps_to_world(matrix)
    add_seen(context, name, body, seen)


def _slot(object: Any, index: int) -> Optional[Any]:
    slots = object.material_slots
    return slots[min(max(index, 0), len(slots) - 1)].material if len(slots) else None


def _systems(object: Any) -> Iterator[Any]:
    """The particle systems of an object whose hair is rendered as paths."""
    for system in object.particle_systems:
        settings = system.settings
        modifier = next((one for one in object.modifiers if getattr(one, "particle_system", None) == system), None)
        shown = modifier is None or modifier.show_render
        if settings.type == "HAIR" and settings.render_type == "PATH" and shown:
            yield system


def _of_particles(object: Any, system: Any, to_object: numpy.ndarray) -> Optional[hyades.Strands]:
    """As Cycles takes them: children where there are any, else the particles; in the object's space."""
    settings = system.settings
    parents, children = len(system.particles), len(system.child_particles)
    first = parents if settings.child_type != "NONE" and children else 0
    steps = 2**settings.render_step + 1
    if settings.kink == "SPIRAL":
        steps += settings.kink_extra_steps
    count = parents + children - first
    if count == 0:
        return None
    place = system.co_hair
    rows = [place(object, particle_no=i, step=s)[:] for i in range(first, first + count) for s in range(steps)]
    points = numpy.array(rows).reshape(count, steps, 3)
    points = points @ to_object[:3, :3].T + to_object[:3, 3]
    lengths = numpy.linalg.norm(numpy.diff(points, axis=1), axis=2).cumsum(axis=1)
    whole = lengths[:, -1]
    there = (whole > 0) & numpy.isfinite(points).all(axis=(1, 2))
    if not there.any():
        return None
    along = numpy.zeros((int(there.sum()), steps))
    along[:, 1:] = lengths[there] / whole[there, None]
    widths = settings.radius_scale * _profile(settings, along)
    if settings.use_close_tip:
        widths[:, -1] = 0
    return hyades.Strands(points[there], widths)


def _profile(settings: Any, along: numpy.ndarray) -> numpy.ndarray:
    """How thick strands are from 0 at the root to 1 at the tip."""
    shape, left = settings.shape, 1 - along
    if shape < 0:
        left = left ** (1 + shape)
    elif shape > 0:
        left = left ** (1 / (1 - shape)) if shape < 1 else numpy.where(along == 0, 1.0, 0.0)
    return settings.tip_radius + left * (settings.root_radius - settings.tip_radius)


def _of_curves(data: Any) -> Optional[hyades.Strands]:
    count = len(data.points)
    if count == 0 or len(data.curves) == 0:
        return None
    points = numpy.empty(3 * count, "f4")
    data.attributes["position"].data.foreach_get("vector", points)
    radii = numpy.full(count, 0.005, "f4")  # Cycles' where none are given
    if "radius" in data.attributes:
        data.attributes["radius"].data.foreach_get("value", radii)
    begins = numpy.empty(len(data.curves), "i4")
    data.curves.foreach_get("first_point_index", begins)
    parts = numpy.split(points.reshape(-1, 3), begins[1:])
    widths = numpy.split(2 * numpy.maximum(radii, 0), begins[1:])
    long = [i for i, part in enumerate(parts) if len(part) > 1]
    return hyades.Strands([parts[i] for i in long], [widths[i] for i in long]) if long else None
