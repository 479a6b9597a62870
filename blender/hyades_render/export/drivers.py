"""Drivers that Blender does not compute."""

from __future__ import annotations

from .context import Context


def tell_of_drivers(context: Context) -> None:
    """Complains of each thing that has some: scripts may be off, or they are wrong."""
    for data in context.depsgraph.ids:
        found = getattr(data, "animation_data", None)
        wrong = [curve.data_path for curve in found.drivers if not curve.driver.is_valid] if found is not None else []
        if wrong:
            what = f"its driver of {wrong[0]} is not computed, as in Blender: scripts are off, or it is wrong"
            context.complain(f"{data.bl_rna.name.lower()} '{data.name}'", what)
