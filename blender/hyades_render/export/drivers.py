"""Drivers that Blender does not compute."""

from __future__ import annotations

from typing import Any

from .context import Context


def tell_of_drivers(context: Context) -> None:
    """Complains of each thing that has some: scripts may be off, or they are wrong."""
    for data in context.depsgraph.ids:
        if data.is_embedded_data:  # the nodes of a material, which has them
            continue
        wrong = _not_computed(data) or _not_computed(getattr(data, "node_tree", None))
        if wrong:
            what = f"its driver of {wrong} is not computed, as in Blender: scripts are off, or it is wrong"
            context.complain(f"{data.bl_rna.name.lower()} '{data.name}'", what)


def _not_computed(data: Any) -> str:
    """What the first of its drivers that is none drives; empty: there is none."""
    found = getattr(data, "animation_data", None)
    return next((curve.data_path for curve in found.drivers if not curve.driver.is_valid), "") if found is not None else ""
