"""Transforms at several moments as one that moves: matrices are taken apart, for keys of a matrix there are none."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy
from hyades import Keys, Rotation, Step

_EXACT = 1e-5  # of the matrix's size: what a scale along the axes, a turn and a move may miss


def joined(transforms: list[Any], keys: Callable[[list[Any]], Keys]) -> list[Step] | None:
    """Steps that are each of `transforms` (lists of steps, None for none) at its moment; `keys` makes values move.
    None where they are not made of matrices alone."""
    matrices = [_matrix(steps) for steps in transforms]
    if any(matrix is None for matrix in matrices):
        return None
    moves = [[float(x) for x in matrix[:3, 3]] for matrix in matrices]
    linear = [matrix[:3, :3] for matrix in matrices]
    parts = [_upright(one) for one in linear]
    if all(part is not None for part in parts):
        steps = [Step(scale=_moving([scale for scale, _ in parts], keys)), _turn([turn for _, turn in parts], keys)]
    else:
        # Sheared: a turn, a scale, and another turn, which every matrix is.
        values = [_two_turns(one) for one in linear]
        first, scale, second = (list(column) for column in zip(*values))
        steps = [_turn(first, keys), Step(scale=_moving(scale, keys)), _turn(second, keys)]
    return [*steps, Step(translate=_moving(moves, keys))]


def _matrix(steps: Any) -> numpy.ndarray | None:
    """What the steps do together."""
    whole = numpy.eye(4)
    for step in steps or ():
        said = {key.name: value for key, value in step.said()}
        if set(said) != {"matrix"}:
            return None
        whole = numpy.array(said["matrix"], float).reshape(4, 4) @ whole
    return whole


def _upright(linear: numpy.ndarray) -> tuple[list[float], list[float]] | None:
    """Scale and quaternion; None for what is sheared."""
    scale = numpy.linalg.norm(linear, axis=0)
    if scale.min() <= 1e-12 * scale.max():
        return None
    turn = linear / scale
    if numpy.linalg.det(turn) < 0:
        scale[0], turn[:, 0] = -scale[0], -turn[:, 0]
    if numpy.abs(turn.T @ turn - numpy.eye(3)).max() > _EXACT:
        return None
    return [float(f"{x:.6g}") for x in scale], _quaternion(turn)  # matrices of Blender are of single precision


def _two_turns(linear: numpy.ndarray) -> tuple[list[float], list[float], list[float]]:
    second, scale, first = numpy.linalg.svd(linear)
    for turn, axis in ((second, 1), (first, 0)):
        if numpy.linalg.det(turn) < 0:
            numpy.moveaxis(turn, axis, 0)[2] *= -1
            scale[2] *= -1
    return _quaternion(first), [float(x) or 1e-6 for x in scale], _quaternion(second)


def _quaternion(turn: numpy.ndarray) -> list[float]:
    """x, y, z, w of a rotation: the eigenvector of largest eigenvalue (Bar-Itzhack 2000), safe at every angle."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = turn
    matrix = numpy.array(
        [
            [xx - yy - zz, xy + yx, xz + zx, zy - yz],
            [xy + yx, yy - xx - zz, yz + zy, xz - zx],
            [xz + zx, yz + zy, zz - xx - yy, yx - xy],
            [zy - yz, xz - zx, yx - xy, xx + yy + zz],
        ]
    )
    values, vectors = numpy.linalg.eigh(matrix)
    found = vectors[:, int(numpy.argmax(values))]
    return [float(x) for x in found * (1.0 if found[3] >= 0 else -1.0)]


def _turn(quaternions: list[list[float]], keys: Callable[[list[Any]], Keys]) -> Step:
    return Step(rotate=Rotation(quaternion=_moving(quaternions, keys)))


def _moving(values: list[list[float]], keys: Callable[[list[Any]], Keys]) -> Any:
    """The value, where it is always the same; else keys."""
    first = values[0]
    return first if all(value == first for value in values[1:]) else keys(values)
