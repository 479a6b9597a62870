"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from ..described import Described, key
from ..values import Number, NumberOrVector, Vector


@dataclass(kw_only=True, eq=False, repr=False)
class Rotation(Described):
    """Rotation."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("transform.rotate", "transform.rotate.quaternion")
    axis: Vector = key("vector, animated", required=True)
    """Range: not [0, 0, 0]. Required."""
    angle: Number = key("number, animated", required=True)
    """Unit: degrees. Required."""
    quaternion: Vector | None = key("quaternion")
    """Instead of axis and angle: axis times sin(angle / 2), and cos(angle / 2), of any length.
    Between keys it turns the shortest way at even speed (slerp). Range: not [0, 0, 0, 0]. Default:
    none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Step(Described):
    """Transform."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("transform",)
    translate: Vector | None = key("vector, animated")
    """Moves. Unit: length. Default: none."""
    scale: NumberOrVector | None = key("scale, animated")
    """Stretches about the origin. Default: none."""
    rotate_x: Number | None = key("number, animated")
    """Turns about the x axis. Unit: degrees. Default: none."""
    rotate_y: Number | None = key("number, animated")
    """Turns about the y axis. Unit: degrees. Default: none."""
    rotate_z: Number | None = key("number, animated")
    """Turns about the z axis. Unit: degrees. Default: none."""
    rotate: Rotation | None = key("map")
    """Turns about any axis through the origin. Default: none."""
    matrix: Vector | None = key("16 numbers")
    """Row by row; points are columns. Range: last row 0, 0, 0, 1. Default: none."""
