"""What a world's nodes say for all directions, as a panorama."""

from __future__ import annotations

from typing import Any

import numpy

from . import graph
from .evaluate import Evaluator, Points
from .graph import Input, Output
from .translator import Inexpressible, Translator

Array = Any
_HEIGHT = 512  # pixels; pictures within may be finer, up to
_MOST = 2048


class Directions(Points):
    """Directions (n, 3) of Blender's world."""

    def __init__(self, directions: Array) -> None:
        self.directions = directions

    def position(self) -> Array:
        return self.directions

    def normal(self) -> Array:
        return self.directions

    def true_normal(self) -> Array:
        return self.directions

    def generated(self) -> Array:
        return self.directions

    def uv(self, name: str) -> Array:
        return numpy.zeros((len(self.directions), 2))

    def matrix(self) -> Array:
        return numpy.eye(4)


def panorama(translator: Translator, surface: Input) -> Array:
    """Light (h, 2 h, 3), row 0 at the top, +x in the middle. Inexpressible: a node cannot be computed."""
    height = min(max([_HEIGHT, *(int(n.image.size[1]) for n in surface.socket.id_data.nodes
                                 if n.type == "TEX_ENVIRONMENT" and n.image is not None)]), _MOST)
    up = (0.5 - (numpy.arange(height) + 0.5) / height) * numpy.pi
    around = (0.5 - (numpy.arange(2 * height) + 0.5) / (2 * height)) * 2 * numpy.pi
    rows = []
    for angles in numpy.array_split(up, max(height // 32, 1)):
        flat = numpy.cos(angles)[:, None]
        parts = (flat * numpy.cos(around), flat * numpy.sin(around), numpy.sin(angles)[:, None] + 0 * around)
        directions = numpy.stack(parts, axis=2).reshape(-1, 3)
        light = numpy.broadcast_to(_radiance(Evaluator(translator, Directions(directions)), surface), directions.shape)
        rows.append(light.reshape(len(angles), -1, 3))
    return numpy.maximum(numpy.nan_to_num(numpy.concatenate(rows)), 0).astype("float32")


def _radiance(at: Evaluator, end: Input) -> Array:
    """What is linked to an input for shaders shines."""
    found = graph.source(end)
    if not isinstance(found, Output):
        return numpy.zeros(3)
    node = found.node
    if node.type in ("BACKGROUND", "EMISSION"):
        return at.color(found, "Color") * numpy.atleast_1d(at.number(found, "Strength"))[:, None]
    if node.type not in ("MIX_SHADER", "ADD_SHADER"):
        raise Inexpressible(found, "this shader is not supported in a world")
    first, second = (_radiance(at, Input(socket, found.groups)) for socket in node.inputs[-2:])
    if node.type == "ADD_SHADER":
        return first + second
    amount = numpy.clip(numpy.atleast_1d(at.number(found, "Fac")), 0, 1)[:, None]
    return first * (1 - amount) + second * amount
