"""Everything that the depsgraph lists: meshes, their instances, and lamps."""

from __future__ import annotations

from typing import Any

from hyades import objects

from . import axes
from .context import Context, free_name
from .lights import PlacedLight
from .materials import material_of
from .meshes import mesh_parts

_WITH_SURFACE = {"MESH", "CURVE", "SURFACE", "META", "FONT", "CURVES"}


def add_objects(context: Context) -> list[PlacedLight]:
    """Adds what has a surface to the job. Returns the lamps that were met."""
    found: list[PlacedLight] = []
    for instance in context.depsgraph.object_instances:
        if not instance.show_self:
            continue
        object = instance.object
        if object.type == "LIGHT":
            found.append(PlacedLight(object.name, object.data, axes.placed(instance.matrix_world)))
        elif object.type in _WITH_SURFACE:
            _add_surface(context, object, axes.placed(instance.matrix_world))
    return found


def _add_surface(context: Context, object: Any, matrix: Any) -> None:
    for slot, data in mesh_parts(context, object):
        name = free_name(object.name, context.job.objects)
        material = material_of(context, object, slot)
        context.job.objects[name] = objects.Mesh(mesh=data, material=material, transform=axes.steps(matrix))
