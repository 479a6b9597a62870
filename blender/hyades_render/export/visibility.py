"""Who sees a thing: the camera, or rays of one kind, which jobs cannot tell apart."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .context import Context

_OF_OBJECTS = ("diffuse", "glossy", "transmission", "volume_scatter", "shadow")
_OF_LAMPS = ("diffuse", "glossy", "transmission", "volume_scatter")
_OF_WORLDS = ("diffuse", "glossy", "transmission", "scatter")


def is_seen(context: Context, object: Any) -> bool:
    """Whether the camera sees an object; complains where other rays do not."""
    where = f"object '{object.name}'"
    _tell(context, where, [ray for ray in _OF_OBJECTS if not getattr(object, f"visible_{ray}")])
    _tell_of_links(context, where, object)
    if object.is_holdout:
        context.complain(where, "jobs have no holdouts: it is seen")
    if object.is_shadow_catcher:
        context.complain(where, "jobs have no shadow catchers: it is seen")
    return bool(object.visible_camera)


def tell_of_lamp(context: Context, where: str, object: Any) -> None:
    """Complains where rays of one kind do not meet a lamp's light."""
    _tell(context, where, [ray for ray in _OF_LAMPS if not getattr(object, f"visible_{ray}")])
    _tell_of_links(context, where, object)
    if getattr(getattr(object.data, "cycles", None), "max_bounces", 1024) < getattr(getattr(context.scene, "cycles", None), "max_bounces", 12):
        context.complain(where, "its Max Bounces are those of the scene")


def is_world_seen(context: Context, world: Any) -> bool:
    """Whether the camera sees the world; complains where other rays do not."""
    found = getattr(world, "cycles_visibility", None)
    _tell(context, f"world '{world.name}'", [ray for ray in _OF_WORLDS if not getattr(found, ray, True)])
    return bool(getattr(found, "camera", True))


def _tell(context: Context, where: str, hidden: list[str]) -> None:
    if hidden:
        context.complain(where, f"it is there for rays of {', '.join(hidden)} too: only the camera's can be kept from it")


def _tell_of_links(context: Context, where: str, object: Any) -> None:
    """Complains where light is for some things alone, or some alone are in its way: since Blender 4.0."""
    links = getattr(object, "light_linking", None)
    if _has_things(links, "receiver_collection"):
        context.complain(where, "its light falls on all things: light linking is left out")
    if _has_things(links, "blocker_collection"):
        context.complain(where, "all things throw shadows in its light: shadow linking is left out")


def _has_things(links: Any, name: str) -> bool:
    found = getattr(links, name, None)
    return found is not None and len(found.all_objects) > 0  # empty ones link nothing


class LayerFlags:
    """What collections of a view layer say of the objects in them, which the objects do not say themselves."""

    def __init__(self, context: Context) -> None:
        self._layer = context.depsgraph.view_layer_eval
        found = list(_with_flags(self._layer.layer_collection))
        self._any = any(one.indirect_only for one in found)
        for one in found:
            if one.holdout:
                context.complain(f"collection '{one.name}'", "jobs have no holdouts: what is in it is seen")

    def is_indirect(self, instance: Any) -> bool:
        """Whether the camera does not see what an instance of the depsgraph shows; of a copy who shows it counts."""
        if not self._any:
            return False
        shown_by = instance.parent if instance.is_instance else instance.object
        return bool(shown_by.indirect_only_get(view_layer=self._layer))


def _with_flags(collection: Any) -> Iterator[Any]:
    """Collections of a layer that are a holdout, or are only seen indirectly."""
    if collection.exclude:
        return
    if collection.holdout or collection.indirect_only:
        yield collection
    for child in collection.children:
        yield from _with_flags(child)
