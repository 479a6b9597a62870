"""Computes graphs of values with numpy, at many points at once: what is the same everywhere becomes a constant, the rest is baked.

The formulas are those by which Blender's nodes are documented to work, checked against Cycles' pictures (tests/blender).
"""

from __future__ import annotations

from typing import Any, Optional

from ..graph import Input, Output
from ..translator import Inexpressible
from . import angles, attributes, colors, coordinates, images, maths, noise, patterns, vectors, voronoi  # noqa: F401  (they register)
from .evaluator import Evaluator, Varies
from .points import NOWHERE, Points

__all__ = ["Evaluator", "NOWHERE", "Points", "Varies", "constant_value"]


def constant_value(translator: Any, end: Input, found: Output) -> Optional[Any]:
    """The value of an input whose graph is the same everywhere; None where it is not, or cannot be computed."""
    try:
        value = Evaluator(translator, NOWHERE).input(end)
    except (Varies, Inexpressible):
        return None
    if value.ndim == 0:
        return float(value)
    return tuple(float(part) for part in value.reshape(-1)[:3])
