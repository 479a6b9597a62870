"""Blender's z is up, the job's y: (x, y, z) becomes (x, z, -y), which changes no digit of a number.

Meshes keep their own coordinates; what is placed in the world gets another matrix.
"""

from __future__ import annotations

from typing import Any

import numpy
from hyades import Step

TO_JOB = numpy.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=float)
"""World of Blender to world of the job, as a matrix for columns."""


def array(matrix: Any) -> numpy.ndarray:
    """A matrix of Blender as an array (4, 4) of doubles."""
    return numpy.array([tuple(row) for row in matrix], dtype=float)


def placed(matrix: Any) -> numpy.ndarray:
    """The matrix that brings an object's own coordinates into the job's world."""
    return TO_JOB @ (matrix if isinstance(matrix, numpy.ndarray) else array(matrix))


def matrix_step(matrix: numpy.ndarray) -> Step:
    """A step of a transform that is this matrix."""
    rows = numpy.array(matrix, dtype=float)
    rows[3] = (0, 0, 0, 1)
    return Step(matrix=[float(number) for number in rows.reshape(-1)])


def steps(matrix: numpy.ndarray) -> list[Step] | None:
    """The transform that is this matrix, None for one that changes nothing."""
    return None if numpy.array_equal(matrix, numpy.eye(4)) else [matrix_step(matrix)]


def numbers(vector: Any) -> list[float]:
    """Plain numbers of a vector."""
    return [float(number) for number in vector]
