"""Who sees a thing: rays of which kinds, and whether the camera sees a hole there."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from hyades import materials

from .context import Context
from .links import Owner
from .nodes.values import is_constant

_KEYS = {
    "camera": "visible_to_camera",
    "diffuse": "visible_to_diffuse",
    "glossy": "visible_to_glossy",
    "transmission": "visible_to_transmission",
    "volume_scatter": "visible_to_volume",
    "scatter": "visible_to_volume",
    "shadow": "visible_to_shadow",
}
"""What the job calls a ray, by Blender's words for it."""
_OF_LAMPS = ("diffuse", "glossy", "transmission", "volume_scatter")
_OF_OBJECTS = ("camera", *_OF_LAMPS, "shadow")
_OF_WORLDS = ("camera", "diffuse", "glossy", "transmission", "scatter")


class Shown(NamedTuple):
    """How an object shows itself, or an instancer its copies."""

    hidden: tuple[str, ...] = ()
    """Rays that it is not there for, by Blender's words."""
    is_holdout: bool = False
    is_catcher: bool = False
    linked: int = 0
    """The address of an instancer that light is linked to: then it is not to what is copied."""


class Seen(NamedTuple):
    """What the job says of an object besides what it is."""

    keys: dict[str, bool]
    """Those that are not as they come."""
    owner: Owner


class LayerFlags:
    """What a view layer and instancers say of what they show, which the objects do not say themselves."""

    def __init__(self, context: Context) -> None:
        self._layer = context.depsgraph.view_layer_eval
        self._linked = context.names.links.linked()
        self._of_layer = any(True for _ in _with_flags(self._layer.layer_collection))
        # Of millions of copies each question takes its time: none is asked where nothing that may show them has an answer.
        showing = (one for one in context.depsgraph.objects if one.type != "LIGHT")
        told = (_hidden(one) or one.is_holdout or one.is_shadow_catcher for one in showing)
        self._of_copies = self._of_layer or bool(self._linked) or any(told)
        self._instancers: dict[int, Shown] = {}

    def shown(self, instance: Any, is_copy: bool) -> Shown:
        """How an instance of the depsgraph is shown; of a copy who shows it counts."""
        if is_copy and not self._of_copies:
            return _PLAIN
        if not instance.is_instance:
            return self._shown_by(instance.object)
        by = instance.parent
        address = by.original.as_pointer()
        if address not in self._instancers:
            shown = self._shown_by(by)
            self._instancers[address] = shown._replace(linked=address if address in self._linked else 0)
        return self._instancers[address]

    def _shown_by(self, by: Any) -> Shown:
        hidden, is_holdout = _hidden(by), bool(by.is_holdout)
        if self._of_layer:
            is_holdout = bool(by.holdout_get(view_layer=self._layer))
            if "camera" not in hidden and not is_holdout and by.indirect_only_get(view_layer=self._layer):
                hidden = ("camera", *hidden)
        return Shown(hidden, is_holdout, bool(by.is_shadow_catcher))


_PLAIN = Shown()


def seen_by(context: Context, object: Any, shown: Shown) -> Seen:
    """Who sees an object that is shown so; complains where it is to show shadows alone."""
    if object.is_shadow_catcher or shown.is_catcher:
        context.complain(f"object '{object.name}'", "jobs have no shadow catchers: it is seen")
    keys = _switched_off((*shown.hidden, *_hidden(object)))
    if shown.is_holdout:
        keys["holdout"] = True
    return Seen(keys, context.names.links.owner(object, shown.linked))


def add_seen(context: Context, name: str, body: Any, seen: Seen) -> None:
    """Adds an object to the job, called like `name`, and says who sees it."""
    say(context, f"object '{name}'", body, seen.keys)
    context.add_object(name, body, seen.owner)


def say(context: Context, where: str, thing: Any, keys: dict[str, bool]) -> None:
    """Says `keys` of an object, a light or an environment; tells which are left out, as the job would be refused."""
    is_path, is_filled = context.integrator == "path", _is_filled(thing)
    is_entered = _is_entered(getattr(thing, "material", None))
    left_out = []
    for key, value in keys.items():
        if _can_say(key, is_path, is_filled, is_entered):
            setattr(thing, key, value)
        else:
            left_out.append(key.removeprefix("visible_to_"))
    if left_out:
        why = f"the integrator {context.integrator} cannot tell them apart"
        if is_filled:
            why = "all have to see what has an inside"
        elif is_path:
            why = "light that went in has to come out"
        context.complain(where, f"it is there for rays of {', '.join(left_out)} too: {why}")


def _can_say(key: str, is_path: bool, is_filled: bool, is_entered: bool) -> bool:
    if key == "holdout":
        return True
    if key == "visible_to_transmission" and is_entered:
        return False
    # What is filled is hidden from the camera at most, and paths from lights would show it even there.
    return is_path or not is_filled if key == "visible_to_camera" else is_path and not is_filled


def rays_of_lamp(object: Any) -> dict[str, bool]:
    """What the job says of a lamp that is not there for all rays."""
    return _switched_off(_hidden(object, _OF_LAMPS))


def rays_of_world(world: Any) -> dict[str, bool]:
    """What the job says of a world that is not there for all rays."""
    found = getattr(world, "cycles_visibility", None)
    return _switched_off(ray for ray in _OF_WORLDS if not getattr(found, ray, True))


def tell_of_bounces(context: Context, where: str, lamp: Any) -> None:
    """Complains where a lamp's light is to bounce less often than that of others."""
    least = getattr(getattr(context.scene, "cycles", None), "max_bounces", 12)
    if getattr(getattr(lamp, "cycles", None), "max_bounces", 1024) < least:
        context.complain(where, "its Max Bounces are those of the scene")


def _hidden(object: Any, rays: tuple[str, ...] = _OF_OBJECTS) -> tuple[str, ...]:
    return tuple(ray for ray in rays if not getattr(object, f"visible_{ray}"))


def _switched_off(rays: Iterable[str]) -> dict[str, bool]:
    off = {_KEYS[ray] for ray in rays}
    return {key: False for key in dict.fromkeys(_KEYS.values()) if key in off}


def _is_filled(thing: Any) -> bool:
    """Whether the job has something inside of it."""
    if getattr(thing, "interior", None) is not None:
        return True
    return getattr(getattr(thing, "material", None), "subsurface", None) is not None


def _is_entered(material: Any) -> bool:
    """Whether light goes into what is of the material, as into glass."""
    if isinstance(material, materials.Dielectric):
        return True
    if isinstance(material, materials.Principled):
        return not material.thin_walled and not is_constant(material.transmission, 0)
    parts = (getattr(material, part, None) for part in ("first", "second", "base", "front", "back"))
    return any(_is_entered(part) for part in parts if isinstance(part, materials.Material))


def _with_flags(collection: Any) -> Iterator[Any]:
    """Collections of a layer that are a holdout, or are only seen indirectly."""
    if collection.exclude:
        return
    if collection.holdout or collection.indirect_only:
        yield collection
    for child in collection.children:
        yield from _with_flags(child)
