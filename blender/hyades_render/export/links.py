"""Whom lamps light, and whose shadows fall in their light: light and shadow linking, since Blender 4.0.

All goes by the addresses of Blender's objects until the whole job is there, for a lamp names what is made after it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import bpy
import hyades
from hyades import lights, objects

Owner = tuple[int, int]
"""The address of an object, and that of an instancer that shows it where light is linked to that; else 0."""
States = dict[int, bool]
"""Whether things are included, or excluded, by their addresses."""

_COLLECTIONS = {"light_linking": "receiver_collection", "shadow_linking": "blocker_collection"}
"""Blender's collections by the job's keys."""
_MOST = 62
"""Different lists that a job may have, but for that of lamps without shadows."""
_NOBODY = (0, 0)


@dataclass
class Links:
    """What lamps of a scene are linked to."""

    integrator: str = "path"
    states: dict[str, dict[int, States]] = field(default_factory=lambda: {key: {} for key in _COLLECTIONS})
    """By the job's key and the lamp's address."""
    owners: dict[str, Owner] = field(default_factory=dict)
    """Of objects of the job."""
    lamps: dict[str, Owner] = field(default_factory=dict)
    """Of lights of the job."""

    def collect(self, depsgraph: Any, integrator: str) -> None:
        """Looks at everything that may shine, what only copies show too."""
        self.integrator = integrator
        for one in depsgraph.ids:
            if isinstance(one, bpy.types.Object):
                for key, collection in collections_of(one.original).items():
                    self.states[key][one.original.as_pointer()] = states_of(collection)

    @property
    def are_any(self) -> bool:
        """Whether any lamp is linked."""
        return any(self.states.values())

    def linked(self, *keys: str) -> set[int]:
        """All things that some lamp is linked to, by one of the job's keys."""
        return {address for key in keys or _COLLECTIONS for states in self.states[key].values() for address in states}

    def owner(self, object: Any, instancer: int = 0) -> Owner:
        """Whom an object of the job stands for."""
        return (object.original.as_pointer(), instancer) if self.are_any else _NOBODY

    def merge(self, other: Links) -> None:
        """Learns what those of another moment know."""
        self.integrator = other.integrator
        self.owners |= other.owners
        self.lamps |= other.lamps
        for key, of_lamps in other.states.items():
            self.states[key] |= of_lamps

    def write(self, job: hyades.Job, called: dict[str, str]) -> Iterator[tuple[str, str]]:
        """Says them in a job that has all its objects, whose names in Blender are `called`; yields complaints."""
        if not self.are_any:
            return
        writer = _Writer(self, job)
        for name, owner in self.lamps.items():
            if name in job.lights:
                yield from writer.link(job.lights[name], owner, f"light '{name}'")
        for name, owner in self.owners.items():
            for body in _bodies(job.objects.get(name)):
                where = f"object '{called.get(name, name)}'"
                if getattr(body, "emit", None) is not None:
                    yield from writer.link(body.emit, owner, where)
                if _glows(body) and any(of_lamps.get(owner[0]) for of_lamps in self.states.values()):
                    yield where, "the light of what is inside of it falls on all things: its links are left out"


class _Writer:
    def __init__(self, links: Links, job: hyades.Job) -> None:
        self._links = links
        self._lists: set[tuple[Any, ...]] = set()
        self._names: dict[str, dict[int, list[str]]] = {}
        for key in _COLLECTIONS:
            linked, names = links.linked(key), self._names.setdefault(key, {})
            for name, (object, instancer) in links.owners.items():
                if name in job.objects:
                    names.setdefault(instancer if instancer in linked else object, []).append(name)

    def link(self, shining: Any, owner: Owner, where: str) -> Iterator[tuple[str, str]]:
        """Says in what of the job shines which things it is linked to."""
        for key, of_lamps in self._links.states.items():
            states = of_lamps.get(owner[0])
            if not states or getattr(shining, key) is not None:  # of a lamp without shadows all is said
                continue
            integrator, called = self._links.integrator, key.replace("_", " ")
            if key == "shadow_linking" and integrator != "path":
                yield where, f"all things throw shadows in its light: the integrator {integrator} has no {called}"
                continue
            included = any(states.values())  # where anything is, all else is not
            names = [name for one, state in states.items() if state == included for name in self._names[key].get(one, ())]
            listed = (included, *sorted(names))
            if listed not in self._lists and len(self._lists) == _MOST:
                yield where, f"lamps are linked to more than {_MOST} different lists of things: its {called} is left out"
                continue
            self._lists.add(listed)
            setattr(shining, key, lights.Linking(**{"include" if included else "exclude": names}))


def collections_of(object: Any) -> dict[str, Any]:
    """The collections that an object's light is linked to, by the job's keys."""
    links = getattr(object, "light_linking", None)
    found = {key: getattr(links, name, None) for key, name in _COLLECTIONS.items()}
    return {key: collection for key, collection in found.items() if collection is not None}


def states_of(collection: Any) -> States:
    """What a collection says of the things in it. Those of a collection within it have its state; what is there twice,
    that of the last time."""
    states: States = {}
    for child, said in zip(collection.children, collection.collection_children):
        states |= {one.as_pointer(): _is_included(said) for one in child.all_objects}
    for one, said in zip(collection.objects, collection.collection_objects):
        states[one.as_pointer()] = _is_included(said)
    return states


def _is_included(said: Any) -> bool:
    return bool(said.light_linking.link_state == "INCLUDE")


def _bodies(body: Any) -> list[Any]:
    """What is there of an object of the job: it, or what an instance shows."""
    if body is None:
        return []
    return list(body.instance.objects.values()) if isinstance(body, objects.Instance) else [body]


def _glows(body: Any) -> bool:
    return getattr(getattr(body, "interior", None), "emission", None) is not None
