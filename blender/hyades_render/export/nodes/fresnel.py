"""Shaders that are mixed by the angle of view."""

from __future__ import annotations

from typing import Optional

from hyades import materials

from . import graph, values
from .evaluate.angles import mean_reflection
from .graph import Input, Output
from .translator import Translator


def mixed_by_angle(translator: Translator, end: Optional[Input], first, second):
    """A mixture by Fresnel or the side that is seen, as a coat or as two sides; None: by something else."""
    found = graph.source(end) if end is not None else None
    if not isinstance(found, Output):
        return None
    kind = (found.node.type, found.socket.identifier)
    if kind == ("NEW_GEOMETRY", "Backfacing"):
        return _two_sides(translator, found, first, second)
    if kind == ("FRESNEL", "Fac"):
        return _coat(translator, found, values.number(translator.constant(found.input("IOR"), 1.45)), first, second)
    if kind == ("LAYER_WEIGHT", "Fresnel"):
        share = values.number(translator.constant(found.input("Blend"), 0.5))
        return _coat(translator, found, 1 / max(1 - share, 1e-5), first, second)
    return None


def _two_sides(translator: Translator, found: Output, first, second):
    from .closures import Closure, blend

    solid = all(values.is_constant(one.opacity, 1) for one in (first, second))
    through = (materials.Dielectric, materials.ThinDielectric, materials.DiffuseTransmission, materials.NullMaterial)
    if not solid or any(isinstance(one.material, through) for one in (first, second)):
        translator.complain(found.node, "sides that let light through cannot differ; both are mixed by half")
        return blend(first, second, 0.5)
    front, back = first.material or materials.Black(), second.material or materials.Black()
    emission, is_front = first.emission, values.is_constant(second.emission, 0)
    if not is_front:
        translator.complain(found.node, "both sides shine alike, by half of what they shine together")
        emission = values.product(values.total(first.emission, second.emission), 0.5)
    made = Closure(materials.TwoSided(front=front, back=back), emission, 1.0, first.medium or second.medium)
    made.is_one_sided = is_front
    return made


def _coat(translator: Translator, found: Output, ior: float, first, second):
    """A mirror over something else is a coat of varnish; anything else is mixed by what is reflected on average."""
    from .closures import Closure, blend

    over = second.material
    is_mirror = isinstance(over, (materials.Mirror, materials.Glossy)) and not values.is_texture(over.color)
    plain = first.material is not None and values.is_constant(first.opacity, 1)
    if is_mirror and plain and min(values.color(over.color)) > 0.9 and 1 <= ior <= 100:
        translator.complain(found.node, "a shiny shader mixed in by Fresnel becomes a coat, which loses less light")
        roughness = values.rest(over.glossiness) if isinstance(over, materials.Glossy) else 0.0
        coat = materials.Coat(base=first.material, ior=ior, roughness=roughness)
        return Closure(coat, first.emission, 1.0, first.medium)
    translator.complain(found.node, "what depends on the angle of view is taken as it is on average")
    return blend(first, second, float(mean_reflection(ior)))
