"""Materials of Blender as materials of the job, with what they shine and what fills them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

from hyades import materials, media

from .context import Context
from .nodes import bsdfs, hair, native, principled  # noqa: F401  (they register)
from .nodes import graph, values
from .nodes.closures import closure_of, with_opacity
from .nodes.displacement import Displacement, add_bump, displacement_of
from .nodes.surface import PartOfSurface
from .nodes.translator import Translator
from .nodes.values import Value
from .nodes.volumes import medium_of


@dataclass(frozen=True)
class Made:
    """What a slot of an object is made of."""

    material: materials.Material
    emission: Value
    """Radiance [W/(m² sr)]; 0: it does not shine."""
    interior: Optional[media.Medium]
    uv_map: Optional[str]
    """The UV map that its textures look at; None: none."""
    color_attribute: Optional[str]
    is_baked: bool
    displacement: Optional[Displacement] = None
    """How the surface is moved."""
    is_one_sided: bool = False
    """It shines to where its surface faces alone."""


def material_of(context: Context, part: PartOfSurface, data: Any) -> Made:
    """Translates a material for a part of a mesh; once for all parts where it says the same of all."""
    name = data.name_full if data is not None else ""
    if name in context.materials:
        return context.materials[name]
    if data is None:
        made = Made(materials.Lambert(color=0.8), 0.0, None, None, None, False)
        context.add_material("default", made.material)
        context.materials[name] = made
        return made
    translator = Translator(context, f"material '{data.name}'", part)
    translator.material = data
    made = _translated(translator, data)
    context.add_material(data.name, made.material)
    if not translator.is_of_surface:
        context.materials[name] = made
    return made


def strand_material(context: Context, data: Any) -> materials.Material:
    """Translates a material for hair: where it looks at places of a surface, its means count."""
    key = ("strands", data.name_full if data is not None else "")
    if key not in context.materials:
        name = f"{data.name} hair" if data is not None else "default hair"
        made = materials.Hair() if data is None else _of_strands(context, data)
        context.add_material(name, made)
        context.materials[key] = made
    return context.materials[key]


def _of_strands(context: Context, data: Any) -> materials.Material:
    translator = Translator(context, f"material '{data.name}'")
    translator.material = data
    translator.is_of_strands = True
    made = _translated(translator, data)
    if not values.is_constant(made.emission, 0):
        context.complain(translator.where, "hair does not shine: its emission is left out")
    if made.interior is not None:
        context.complain(translator.where, "hair has no inside: its volume is left out")
    return made.material


def _translated(translator: Translator, data: Any) -> Made:
    if not data.use_nodes or data.node_tree is None:
        color = [float(part) for part in data.diffuse_color[:3]]
        return Made(materials.Lambert(color=values.held(color)), 0.0, None, None, None, False)
    output = graph.output_node(data.node_tree, "OUTPUT_MATERIAL")
    if output is None:
        translator.context.complain(translator.where, "it has no output; it is black")
        return Made(materials.Black(), 0.0, None, None, None, False)
    surface = graph.find_input(output, (), "Surface")
    closure = closure_of(translator, surface)
    clear = not values.is_constant(closure.opacity, 1) or closure.mixed_opacity
    # The key moved from Cycles' to the material's own in 4.2.
    if clear and not getattr(data if hasattr(data, "use_transparent_shadow") else data.cycles, "use_transparent_shadow", True):
        translator.context.complain(translator.where, "Transparent Shadows is on in the job: light goes through its shadows")
    medium = medium_of(translator, graph.find_input(output, (), "Volume"))
    has_surface = surface is not None and surface.socket.is_linked
    material = with_opacity(closure) or materials.Black()
    glows = values.is_constant(closure.opacity, 0) and not values.is_constant(closure.emission, 0)
    if glows or (not has_surface and medium is not None):
        material = materials.NullMaterial()
    displacement = displacement_of(translator, data, output)
    if displacement is not None and not displacement.is_real:
        add_bump(displacement, material)
        displacement = None
    # What is not there at all shines as much as it says.
    emission = closure.emission if glows else values.quotient(closure.emission, values.held(closure.opacity))
    seen = (translator.uv_map, translator.color_attribute, translator.baked)
    return Made(material, emission, medium, *seen, displacement, closure.is_one_sided)
