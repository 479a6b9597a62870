"""Blender's z is up, the job's y: (x, y, z) becomes (x, z, -y), which changes no digit of a number.

Meshes keep their own coordinates; what is placed in the world gets another matrix.
"""

from __future__ import annotations

from typing import Any

import numpy
from hyades import Step

TO_JOB = numpy.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=float)
"""World of Blender to world of the job, as a matrix for columns."""
_UNCHANGED = numpy.eye(4)
_UNCHANGED_ROWS = _UNCHANGED.reshape(-1).tolist()


def array(matrix: Any) -> numpy.ndarray:
    """A matrix of Blender as an array (4, 4) of doubles."""
    first, second, third, fourth = matrix
    return numpy.array(first[:] + second[:] + third[:] + fourth[:]).reshape(4, 4)


def placed(matrix: Any) -> numpy.ndarray:
    """The matrix that brings an object's own coordinates into the job's world."""
    return TO_JOB @ (matrix if isinstance(matrix, numpy.ndarray) else array(matrix))


def matrix_step(matrix: numpy.ndarray) -> Step:
    """A step of a transform that is this matrix."""
    return Step(matrix=[*matrix[:3].reshape(-1).tolist(), 0.0, 0.0, 0.0, 1.0])


def steps(matrix: numpy.ndarray) -> list[Step] | None:
    """The transform that is this matrix, None for one that changes nothing."""
    return None if (matrix == _UNCHANGED).all() else [matrix_step(matrix)]


def steps_to_world(matrix: Any) -> list[Step] | None:
    """The transform into the job's world that a matrix of Blender is, None for one that changes nothing. Without arrays, for
    there may be very many objects."""
    first, second, third, _ = matrix
    rows = [*first, *third, *(0.0 - number for number in second), 0.0, 0.0, 0.0, 1.0]
    return None if rows == _UNCHANGED_ROWS else [Step(matrix=rows)]


def numbers(vector: Any) -> list[float]:
    """Plain numbers of a vector."""
    return [float(number) for number in vector]
