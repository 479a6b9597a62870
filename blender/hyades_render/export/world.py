"""The world: light from all around."""

from __future__ import annotations

import hyades

from .context import Context


def add_world(context: Context) -> None:
    """Says the environment of the job."""
    world = context.scene.world
    if world is None:
        return
    color, strength = [float(c) for c in world.color], 1.0
    if world.use_nodes:
        for node in world.node_tree.nodes:
            if node.type == "BACKGROUND":
                color = [float(c) for c in node.inputs["Color"].default_value[:3]]
                strength = float(node.inputs["Strength"].default_value)
    context.job.environment = hyades.Environment(color=color, strength=strength)
    if context.scene.render.film_transparent:
        context.job.environment.visible_to_camera = False
