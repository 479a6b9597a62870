"""Whether anything of a scene may change from frame to frame."""

from __future__ import annotations

from typing import Any

# Modifiers that look at the time themselves.
_IN_TIME = {
    "BUILD", "CLOTH", "DYNAMIC_PAINT", "EXPLODE", "FLUID", "MESH_CACHE", "MESH_SEQUENCE_CACHE", "PARTICLE_SYSTEM",
    "SOFT_BODY", "WAVE",
}
_TIMED_NODES = {"GeometryNodeInputSceneTime", "GeometryNodeSimulationInput"}


def may_move(depsgraph: Any) -> bool:
    """Whether something that `depsgraph` uses is animated, driven or simulated. What does may still be the same in all
    frames: a driver that asks for another property, say."""
    scene = depsgraph.scene
    if any(marker.camera for marker in scene.timeline_markers) or scene.rigidbody_world is not None:
        return True
    return any(_is_animated(data) or _is_in_time(data) for data in depsgraph.ids)


def _is_animated(data: Any) -> bool:
    found = getattr(data, "animation_data", None)
    if found is None:
        return False
    return bool(found.action or len(found.nla_tracks) or len(found.drivers))


def _is_in_time(data: Any) -> bool:
    kind = data.bl_rna.identifier
    if kind == "Object":
        return any(modifier.type in _IN_TIME for modifier in data.modifiers)
    if kind == "Image":
        return data.source in ("SEQUENCE", "MOVIE")
    if kind == "Key":
        return not data.use_relative
    if kind.endswith("NodeTree"):
        return any(node.bl_idname in _TIMED_NODES for node in data.nodes)
    return bool(getattr(data, "is_sequence", False))  # of volumes and caches
