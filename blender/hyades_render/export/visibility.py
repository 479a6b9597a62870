"""Who sees a thing: the camera, or rays of one kind, which jobs cannot tell apart."""

from __future__ import annotations

from typing import Any

from .context import Context

_OF_OBJECTS = ("diffuse", "glossy", "transmission", "volume_scatter", "shadow")
_OF_LAMPS = ("diffuse", "glossy", "transmission", "volume_scatter")
_OF_WORLDS = ("diffuse", "glossy", "transmission", "scatter")


def is_seen(context: Context, object: Any) -> bool:
    """Whether the camera sees an object; complains where other rays do not."""
    where = f"object '{object.name}'"
    _tell(context, where, [ray for ray in _OF_OBJECTS if not getattr(object, f"visible_{ray}")])
    return bool(object.visible_camera)


def tell_of_lamp(context: Context, where: str, object: Any) -> None:
    """Complains where rays of one kind do not meet a lamp's light."""
    _tell(context, where, [ray for ray in _OF_LAMPS if not getattr(object, f"visible_{ray}")])


def is_world_seen(context: Context, world: Any) -> bool:
    """Whether the camera sees the world; complains where other rays do not."""
    found = getattr(world, "cycles_visibility", None)
    _tell(context, f"world '{world.name}'", [ray for ray in _OF_WORLDS if not getattr(found, ray, True)])
    return bool(getattr(found, "camera", True))


def _tell(context: Context, where: str, hidden: list[str]) -> None:
    if hidden:
        context.complain(where, f"it is there for rays of {', '.join(hidden)} too: only the camera's can be kept from it")
