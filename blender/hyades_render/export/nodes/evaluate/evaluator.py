"""Walks a graph of values, node by node."""

from __future__ import annotations

from typing import Any, Callable

import numpy

from .. import graph
from ..graph import Input, Output
from ..mappings import own_matrix
from ..translator import Inexpressible, default_of
from .points import Points, Varies, transformed  # noqa: F401

Array = Any
LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])

COMPUTED: dict[str, Callable[["Evaluator", Output], Array]] = {}
"""By type of node: what it gives."""


def computes(*types: str) -> Callable[[Any], Any]:
    """Marks the function for nodes of these types."""

    def mark(make: Any) -> Any:
        COMPUTED.update(dict.fromkeys(types, make))
        return make

    return mark


class Evaluator:
    """Values at some points. Numbers are arrays () or (n,), colours and vectors (3,) or (n, 3)."""

    def __init__(self, translator: Any, points: Points) -> None:
        self.translator = translator
        self.points = points
        self._known: dict[Any, Array] = {}

    def input(self, end: Input) -> Array:
        """The value of an input, as numbers or colours as its socket has them."""
        found = graph.source(end)
        if isinstance(found, Input):
            return as_type(numpy.asarray(default_of(found.socket)), found.socket.type, end.socket.type)
        key = (found.node.as_pointer(), found.socket.identifier, tuple(g.as_pointer() for g in found.groups))
        if key not in self._known:
            make = COMPUTED.get(found.node.type)
            if make is None:
                raise Inexpressible(found, "this node is not supported")
            self._known[key] = numpy.asarray(make(self, found))
        return as_type(self._known[key], found.socket.type, end.socket.type)

    def number(self, output: Output, *names: str, default: float = 0.0) -> Array:
        """An input of a node as numbers."""
        end = output.input(*names)
        return numpy.asarray(default) if end is None else as_type(self.input(end), end.socket.type, "VALUE")

    def vector(self, output: Output, *names: str, default: float = 0.0) -> Array:
        """An input of a node as vectors or colours."""
        end = output.input(*names)
        return numpy.full(3, default) if end is None else as_type(self.input(end), end.socket.type, "VECTOR")

    color = vector

    def place(self, output: Output, unlinked: str = "generated") -> Array:
        """Where a texture looks: input "Vector", or where that is not linked, "generated" coordinates, the active "uv"
        map or the "position" in the world; moved as its own mapping says."""
        end = output.input("Vector")
        if end is not None and isinstance(graph.source(end), Output):
            place = self.vector(output, "Vector")
        elif unlinked == "uv":
            place = with_zero(self.points.uv(""))
        elif unlinked == "position":
            place = transformed(self.points.matrix(), self.points.position())
        else:
            place = self.points.generated()
        own = own_matrix(output)
        return place if own is None else place @ own[:3, :3].T + own[:3, 3]


def as_type(value: Array, given: str, wanted: str) -> Array:
    """What a link makes of a value: colours as numbers are luminance, vectors the mean of their parts."""
    if wanted in ("VALUE", "INT", "BOOLEAN"):
        if value.ndim == 0 or (given in ("VALUE", "INT", "BOOLEAN")):
            return value
        return value @ LUMINANCE if given == "RGBA" else value.mean(axis=-1)
    if given in ("VALUE", "INT", "BOOLEAN"):
        return numpy.repeat(value[..., None], 3, axis=-1)
    if value.ndim == 0:
        return numpy.repeat(value[None], 3)
    return value[..., :3]


def with_zero(uv: Array) -> Array:
    """(n, 2) as (n, 3)."""
    return numpy.concatenate([uv, numpy.zeros((len(uv), 1))], axis=1)


def stacked(*parts: Array) -> Array:
    """Numbers as vectors."""
    return numpy.stack(numpy.broadcast_arrays(*parts), axis=-1)
