"""Walks a graph of shader nodes."""

from __future__ import annotations

import math
from typing import Any, Callable, Optional

from hyades import textures

from ..context import Context
from . import graph, values
from .graph import Input, Output
from .values import Value

ValueMaker = Callable[["Translator", Output], Value]

NATIVE: dict[str, ValueMaker] = {}
"""By type of node: makes the texture of the job that means the same, or raises Inexpressible. Filled by native.py."""


class Inexpressible(Exception):
    """A node that no texture of the job means; the message says why."""

    def __init__(self, output: Output, why: str) -> None:
        super().__init__(why)
        self.node = output.node
        self.why = why


def native(*types: str) -> Callable[[ValueMaker], ValueMaker]:
    """Marks the function for nodes of these types."""

    def mark(make: ValueMaker) -> ValueMaker:
        NATIVE.update(dict.fromkeys(types, make))
        return make

    return mark


class Translator:
    """One material, world or lamp on its way into the job.

    `surface`: the mesh that it lies on, for baking (surface.py); None: there is none. Afterwards `uv_map` and
    `color_attribute` say what the job's textures look at ("" is the active one), and `is_of_surface` whether the
    result holds for this surface alone. `is_of_strands`: it is made for hair.
    """

    def __init__(self, context: Context, where: str, surface: Any = None) -> None:
        self.context = context
        self.where = where
        self.surface = surface
        self.is_of_strands = False
        self.uv_map: Optional[str] = None
        self.color_attribute: Optional[str] = None
        self.is_of_surface = False
        self.baked = False

    def complain(self, node: Any, what: str) -> None:
        self.context.complain(f"{self.where} > node '{node.label or node.name}'", what)

    def value(self, end: Optional[Input], default: Value = 0.0) -> Value:
        """What an input is: a constant or a texture, baked where no texture of the job means it."""
        if end is None:
            return default
        try:
            return self.native_value(end)
        except Inexpressible as reason:
            return self._computed(end, reason)

    def number(self, end: Optional[Input], default: float = 0.0) -> Any:
        """What an input is, as a number or texture."""
        return values.number(self.value(end, default))

    def color(self, end: Optional[Input], default: Value = 0.0) -> Any:
        """What an input is, as what things make of light: 0 to 1. Complains where it is known that it may be beyond."""
        value = self.value(end, default)
        if end is not None and 1.00001 < values.most(value) < math.inf:
            self.complain(end.socket.node, f"'{end.socket.name}' is held at 1 where it is above: nothing reflects more light than it gets")
            if values.is_texture(value) and not isinstance(value, textures.Image):
                return textures.Min(a=value, b=1)  # as reflectance the job refuses what is brighter
        return values.held(value)

    def constant(self, end: Optional[Input], default: Value = 0.0) -> Value:
        """What an input is where the job takes no texture: of one, its mean, with a complaint."""
        value = self.value(end, default)
        if end is None or not values.is_texture(value):
            return value
        mean = self._mean(end)
        self.complain(end.socket.node, f"'{end.socket.name}' cannot change from place to place; its mean is used")
        return mean

    def native_value(self, end: Input) -> Value:
        """A constant, or a texture that means the same. Inexpressible: there is none."""
        found = graph.source(end)
        if isinstance(found, Input):
            return default_of(found.socket)
        folded = self._folded(end, found)
        if folded is not None:
            return folded
        make = NATIVE.get(found.node.type)
        if make is None:
            raise Inexpressible(found, "no texture of the job means this")
        value = make(self, found)
        return values.grey(value) if graph.becomes_grey(end) else value

    def _folded(self, end: Input, found: Output) -> Optional[Value]:
        """The value of a graph that is the same everywhere."""
        from .evaluate import constant_value

        return constant_value(self, end, found)

    def _computed(self, end: Input, reason: Inexpressible) -> Value:
        from . import bake

        return bake.texture_of(self, end, reason)

    def _mean(self, end: Input) -> Value:
        from . import bake

        return bake.mean_of(self, end)


def default_of(socket: Any) -> Value:
    """The value that an input has by itself."""
    value = getattr(socket, "default_value", 0.0)
    if isinstance(value, (int, float)):
        return float(value)
    if isinstance(value, str):
        return 0.0
    return (float(value[0]), float(value[1]), float(value[2]))
