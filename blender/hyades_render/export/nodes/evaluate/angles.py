"""Nodes Fresnel and Layer Weight: what depends on the angle of view, which nobody knows before it is rendered, as it is
on average over light from all sides."""

from __future__ import annotations

from typing import Any

import numpy

from ..graph import Output
from .evaluator import Evaluator, computes

Array = Any


def mean_reflection(ior: Array) -> Array:
    """Share of diffuse light that a surface reflects: Schlick's curve, weighted by the cosine."""
    r = ((ior - 1) / (ior + 1)) ** 2
    return r + (1 - r) / 21


@computes("FRESNEL")
def fresnel(at: Evaluator, output: Output) -> Array:
    _tell(at, output)
    return mean_reflection(numpy.maximum(at.number(output, "IOR", default=1.45), 1e-5))


@computes("LAYER_WEIGHT")
def layer_weight(at: Evaluator, output: Output) -> Array:
    _tell(at, output)
    blend = numpy.clip(at.number(output, "Blend", default=0.5), 0, 1 - 1e-5)
    if output.socket.identifier == "Fresnel":
        return mean_reflection(1 / (1 - blend))
    # 1 - cosine ^ exponent, weighted by the cosine.
    exponent = numpy.where(blend < 0.5, 2 * blend, 0.5 / (1 - blend))
    return exponent / (exponent + 2)


def _tell(at: Evaluator, output: Output) -> None:
    at.translator.complain(output.node, "what depends on the angle of view is taken as it is on average")
