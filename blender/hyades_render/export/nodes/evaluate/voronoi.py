"""Node Voronoi Texture: points at random in unit cells (Worley 1996)."""

from __future__ import annotations

import itertools
from typing import Any

import numpy

from ..graph import Output
from ..translator import Inexpressible
from .evaluator import Evaluator, computes
from .noise import place_of, random_color, unit

Array = Any


def _jitter(cell: Array) -> Array:
    """Where in a cell its point lies (n, dimensions), 0..1."""
    keys = [cell[:, axis] for axis in range(cell.shape[1])]
    one = numpy.ones_like(keys[0])
    if len(keys) == 1:
        return unit(*keys)[:, None]
    if len(keys) == 2:
        return numpy.stack([unit(*keys), unit(*keys, one)], axis=1)
    if len(keys) == 3:
        return random_color(keys)
    x, y, z, w = keys
    return numpy.stack([unit(x, y, z, w), unit(w, x, y, z), unit(z, w, x, y), unit(y, z, w, x)], axis=1)


def _distance(metric: str, exponent: Array, arm: Array) -> Array:
    parts = numpy.abs(arm)
    if metric == "MANHATTAN":
        return parts.sum(axis=1)
    if metric == "CHEBYCHEV":
        return parts.max(axis=1)
    if metric == "MINKOWSKI":
        power = numpy.broadcast_to(exponent, parts.shape[:1])[:, None]
        return (parts**power).sum(axis=1) ** (1 / power[:, 0])
    return numpy.sqrt((parts**2).sum(axis=1))


class _Cells:
    """The points around places."""

    def __init__(self, place: Array, randomness: Array, reach: int = 1) -> None:
        self.cell = numpy.floor(place)
        self.local = place - self.cell
        self.randomness = numpy.broadcast_to(numpy.clip(randomness, 0, 1), place.shape[:1])[:, None]
        count = place.shape[1]
        # The first coordinate moves fastest.
        self.steps = [numpy.array(step[::-1], float) for step in itertools.product(range(-reach, reach + 1), repeat=count)]

    def point(self, step: Array) -> Array:
        """The point of the cell that lies `step` away, relative to the place's own cell."""
        return step + _jitter(self.cell + step) * self.randomness


@computes("TEX_VORONOI")
def voronoi_texture(at: Evaluator, output: Output) -> Array:
    node, kind = output.node, output.socket.identifier
    if kind not in ("Distance", "Color", "Radius"):
        raise Inexpressible(output, f"'{output.socket.name}' is not supported")
    if getattr(node, "normalize", False) or float(numpy.max(at.number(output, "Detail", default=0.0))) > 0:
        raise Inexpressible(output, "only detail 0, not normalized, is supported")
    place = place_of(at, output, node.voronoi_dimensions)
    place = place * numpy.atleast_1d(at.number(output, "Scale"))[:, None]
    cells = _Cells(place, at.number(output, "Randomness"), 2 if node.feature == "SMOOTH_F1" else 1)
    if node.feature == "DISTANCE_TO_EDGE":
        return _edge_distance(cells)
    exponent = at.number(output, "Exponent", default=1.0)
    if node.feature == "N_SPHERE_RADIUS":
        return _radius(cells)
    if node.feature == "SMOOTH_F1":
        smoothness = numpy.clip(at.number(output, "Smoothness") / 2, 0, 0.5)
        return _smooth(cells, node.distance, exponent, smoothness, kind)
    return _nearest(cells, node.distance, exponent, node.feature == "F2", kind)


def _nearest(cells: _Cells, metric: str, exponent: Array, second: bool, kind: str) -> Array:
    best = [numpy.full(len(cells.cell), 8.0) for _ in range(2)]
    where = [numpy.zeros_like(cells.cell) for _ in range(2)]
    for step in cells.steps:
        far = _distance(metric, exponent, cells.point(step) - cells.local)
        first, next_ = far < best[0], (far >= best[0]) & (far < best[1])
        best[1] = numpy.where(first, best[0], numpy.where(next_, far, best[1]))
        where[1] = numpy.where(first[:, None], where[0], numpy.where(next_[:, None], step, where[1]))
        best[0] = numpy.where(first, far, best[0])
        where[0] = numpy.where(first[:, None], step, where[0])
    which = 1 if second else 0
    if kind == "Distance":
        return best[which]
    cell = cells.cell + where[which]
    return random_color([cell[:, axis] for axis in range(cell.shape[1])])


def _smooth(cells: _Cells, metric: str, exponent: Array, smoothness: Array, kind: str) -> Array:
    far = numpy.full(len(cells.cell), 8.0)
    color = numpy.zeros((len(cells.cell), 3))
    width = numpy.maximum(smoothness, 1e-9)
    for step in cells.steps:
        here = _distance(metric, exponent, cells.point(step) - cells.local)
        share = numpy.clip(0.5 + 0.5 * (far - here) / width, 0, 1)
        share = share * share * (3 - 2 * share)
        less = smoothness * share * (1 - share)
        far = far + (here - far) * share - less
        if kind == "Color":
            cell = cells.cell + step
            own = random_color([cell[:, axis] for axis in range(cell.shape[1])])
            color = color + (own - color) * share[:, None] - (less / (1 + 3 * smoothness))[:, None]
    return far if kind == "Distance" else color


def _edge_distance(cells: _Cells) -> Array:
    """How far the nearest wall between two cells is."""
    best = numpy.full(len(cells.cell), 8.0)
    nearest = numpy.zeros_like(cells.cell)
    for step in cells.steps:
        arm = cells.point(step) - cells.local
        square = (arm * arm).sum(axis=1)
        less = square < best
        best = numpy.where(less, square, best)
        nearest = numpy.where(less[:, None], arm, nearest)
    wall = numpy.full(len(cells.cell), 8.0)
    for step in cells.steps:
        arm = cells.point(step) - cells.local
        across = arm - nearest
        square = (across * across).sum(axis=1)
        far = ((nearest + arm) / 2 * across).sum(axis=1) / numpy.sqrt(numpy.maximum(square, 1e-20))
        wall = numpy.where((square > 0.0001) & (far < wall), far, wall)
    return wall


def _radius(cells: _Cells) -> Array:
    """Half of the way from the nearest point to that nearest to it."""
    best = numpy.full(len(cells.cell), 8.0)
    point, home = numpy.zeros_like(cells.cell), numpy.zeros_like(cells.cell)
    for step in cells.steps:
        there = cells.point(step)
        far = numpy.sqrt(((there - cells.local) ** 2).sum(axis=1))
        less = far < best
        best = numpy.where(less, far, best)
        point = numpy.where(less[:, None], there, point)
        home = numpy.where(less[:, None], step, home)
    around = numpy.full(len(cells.cell), 8.0)
    for step in cells.steps:
        if not step.any():
            continue
        there = home + step + _jitter(cells.cell + home + step) * cells.randomness
        around = numpy.minimum(around, numpy.sqrt(((there - point) ** 2).sum(axis=1)))
    return around / 2
