"""Lamps: point, spot, sun and area lights."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy
from hyades import lights

from . import axes
from .context import Context, free_name


class PlacedLight(NamedTuple):
    """A lamp and where it stands."""

    name: str
    data: Any
    matrix: numpy.ndarray
    """Into the job's world."""


def add_light(context: Context, light: PlacedLight) -> None:
    """Adds one lamp to the job, as a light or as a body that shines."""
    if light.data.type == "POINT":
        at = axes.numbers(light.matrix[:3, 3])
        # Cycles' watts are those of a surface: a point of P gives P / pi all round.
        power = light.data.energy / math.pi
        point = lights.Point(at=at, color=axes.numbers(light.data.color), power=power)
        context.job.lights[free_name(light.name, context.job.lights)] = point
    else:
        context.complain(f"light '{light.name}'", f"lights of type {light.data.type.lower()} are not supported yet")
