"""What an export carries along: the job that grows, complaints, and what was made already."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import hyades

from .links import Links, Owner

_NOT_ALLOWED = re.compile("[^A-Za-z0-9_. -]")


@dataclass(frozen=True)
class Complaint:
    """Something in the scene that the job does not say, or says in another way."""

    where: str
    """The thing by its name in Blender: "material 'Floor' > node 'Noise Texture'"."""
    what: str
    """What is different, and what was done instead."""

    def __str__(self) -> str:
        return f"{self.where}: {self.what}"


@dataclass
class Names:
    """What things of a job are called in Blender, by their names in the job, and which lamps are linked to them."""

    objects: dict[str, str] = field(default_factory=dict)
    materials: dict[str, str] = field(default_factory=dict)
    links: Links = field(default_factory=Links)


class Context:
    """One export of one depsgraph."""

    def __init__(self, depsgraph: Any, settings: Any, moves: bool = False) -> None:
        """`moves`: the job is one of several moments, which are to be joined."""
        self.moves = moves
        self.depsgraph = depsgraph
        self.scene = depsgraph.scene_eval
        self.override = depsgraph.view_layer_eval.material_override  # what all things are made of; None: of their own
        self.settings = settings
        self.integrator: str = self.setting("integrator", "path")
        self.job = hyades.Job()
        self.names = Names()
        self.complaints: list[Complaint] = []
        self.materials: dict[Any, Any] = {}  # translated ones, by what they depend on
        self.pieces: dict[Any, Any] = {}  # parts of meshes, by the data and materials that several objects have

    def add_object(self, name: str, body: Any, owner: Owner) -> None:
        """Adds an object to the job, called like `name`."""
        ours = free_name(name, self.job.objects)
        self.job.objects[ours], self.names.objects[ours], self.names.links.owners[ours] = body, name, owner

    def add_light(self, name: str, light: Any, owner: Owner) -> None:
        """Adds a light to the job, called like `name`."""
        ours = free_name(name, self.job.lights)
        self.job.lights[ours], self.names.links.lamps[ours] = light, owner

    def add_material(self, name: str, material: Any) -> None:
        """Adds a material to the job, called like `name`."""
        ours = free_name(name, self.job.materials)
        self.job.materials[ours], self.names.materials[ours] = material, name

    def complain(self, where: str, what: str) -> None:
        """Notes a difference once."""
        complaint = Complaint(where, what)
        if complaint not in self.complaints:
            self.complaints.append(complaint)

    def setting(self, name: str, default: Any = None) -> Any:
        """A property of the add-on's settings; `default` where it has none of that name."""
        return getattr(self.settings, name, default)


def free_name(wanted: str, taken: Any) -> str:
    """A name that the job accepts, like `wanted`, and that `taken` does not hold."""
    allowed = _NOT_ALLOWED.sub("_", wanted).strip(" ")
    if not allowed or not (allowed[0].isalnum() or allowed[0] == "_"):
        allowed = "_" + allowed
    base = allowed[:90].rstrip(" ")
    if base not in taken:
        return base
    # Numbers are taken from 2 on without gaps, so that the next one is found without trying them all.
    low, high = 1, 2
    while f"{base}-{high}" in taken:
        low, high = high, 2 * high
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if f"{base}-{middle}" in taken else (low, middle)
    return f"{base}-{high}"
