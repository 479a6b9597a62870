"""Materials of Blender as materials of the job."""

from __future__ import annotations

from typing import Any

from hyades import materials

from .context import Context, free_name


def material_of(context: Context, object: Any, slot: int) -> materials.Material:
    """What a slot of an object is made of."""
    data = object.material_slots[slot].material if slot < len(object.material_slots) else None
    if data is None:
        return materials.Lambert(color=0.8)
    if data.name in context.materials:
        return context.materials[data.name]
    color = data.diffuse_color[:3]
    if data.use_nodes:
        for node in data.node_tree.nodes:
            if node.type == "BSDF_PRINCIPLED":
                color = node.inputs["Base Color"].default_value[:3]
    made = materials.Lambert(color=[float(c) for c in color])
    context.materials[data.name] = made
    context.job.materials[free_name(data.name, context.job.materials)] = made
    return made
