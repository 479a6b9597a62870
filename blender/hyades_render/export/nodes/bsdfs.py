"""The shaders of surfaces that do one thing."""

from __future__ import annotations

from typing import Any

import bpy
from hyades import materials

from . import values
from .closures import Closure, shader
from .graph import Output
from .normals import normal_keys
from .principled_inputs import tell_of_method
from .principled_layers import fuzz_like
from .translator import Translator
from .values import held

_DEEP = 128
"""Depth of paths from which on bodies are about as bright as they are."""
_ROUGH = 0.2001
"""Roughness of matt surfaces up to which those of Blender until 4.2 look the same, within 4 % of a block."""
_FACETS = {"BECKMANN": "Beckmann's", "ASHIKHMIN_SHIRLEY": "Ashikhmin and Shirley's"}


def _roughness(translator: Translator, output: Output) -> Any:
    kind = getattr(output.node, "distribution", "")
    if kind == "SHARP":
        return 0.0
    roughness = held(translator.number(output.input("Roughness")))
    if kind in _FACETS and not values.is_constant(roughness, 0):
        translator.complain(output.node, f"its facets are those of GGX, not {_FACETS[kind]}: highlights have another shape")
    return roughness


def keeps_light(output: Output) -> bool:
    """Whether facets give back what they throw onto each other."""
    return getattr(output.node, "distribution", "") == "MULTI_GGX"


@shader("BSDF_DIFFUSE")
def diffuse(translator: Translator, output: Output) -> Closure:
    made = materials.Lambert(color=translator.color(output.input("Color")), **normal_keys(translator, output))
    roughness = held(translator.number(output.input("Roughness")))
    if not values.is_constant(roughness, 0):
        made.roughness = roughness
        is_rough = values.is_texture(roughness) or values.number(roughness) > _ROUGH
        if bpy.app.version < (4, 3) and is_rough:  # which loses light until there
            translator.complain(output.node, "what is rough loses no light: it is brighter, most where it is seen at an angle")
    return Closure(made)


@shader("BSDF_TRANSLUCENT")
def translucent(translator: Translator, output: Output) -> Closure:
    color = translator.color(output.input("Color"))
    return Closure(materials.DiffuseTransmission(color=0, transmitted=color, **normal_keys(translator, output)))


@shader("BSDF_GLOSSY", "BSDF_ANISOTROPIC")
def glossy(translator: Translator, output: Output) -> Closure:
    color, roughness = translator.color(output.input("Color")), _roughness(translator, output)
    if not values.is_constant(translator.constant(output.input("Anisotropy"), 0.0), 0):
        translator.complain(output.node, "its highlights are round: anisotropy is left out")
    normals = normal_keys(translator, output)
    if values.is_constant(roughness, 0):
        return Closure(materials.Mirror(color=color, **normals))
    # Both have alpha = roughness² of GGX, without Fresnel's factor.
    made = materials.Glossy(color=color, reflectiveness=1, glossiness=values.rest(roughness), **normals)
    made.multiple_scattering = keeps_light(output)
    return Closure(made)


def dielectric(translator: Translator, output: Output, reflection: Any) -> materials.Dielectric:
    """Glass, coloured where light goes through, and `reflection` where it is reflected."""
    color = held(translator.constant(output.input("Color")))
    made = materials.Dielectric(
        ior=held(translator.constant(output.input("IOR"), 1.45), 0.01, 100.0),
        transmission=color,
        reflection=color if reflection is None else reflection,
        multiple_scattering=keeps_light(output),
        scale_radiance=False,
        **normal_keys(translator, output),
    )
    roughness = _roughness(translator, output)
    if not values.is_constant(roughness, 0):
        made.roughness = roughness
    return made


@shader("BSDF_GLASS")
def glass(translator: Translator, output: Output) -> Closure:
    return Closure(dielectric(translator, output, None))


@shader("BSDF_REFRACTION")
def refraction(translator: Translator, output: Output) -> Closure:
    translator.complain(output.node, "it loses what glass would reflect; in Blender all light goes through")
    return Closure(dielectric(translator, output, 0.0))


@shader("BSDF_VELVET", "BSDF_SHEEN")
def sheen(translator: Translator, output: Output) -> Closure:
    translator.complain(output.node, "fuzz is that of Estevez and Kulla, another model")
    roughness = held(translator.number(output.input("Sigma", "Roughness"), 0.5))
    color = translator.color(output.input("Color"))
    if getattr(output.node, "distribution", "") == "MICROFIBER":
        color, roughness = fuzz_like(translator, output, color, roughness)
    return Closure(materials.Sheen(color=color, roughness=roughness))


@shader("SUBSURFACE_SCATTERING")
def subsurface(translator: Translator, output: Output) -> Closure:
    scale = values.number(translator.constant(output.input("Scale"), 1.0))
    made = subsurface_of(
        translator, output, translator.constant(output.input("Color"), 0.8), output.input("Radius"), scale,
        output.input("Anisotropy", "Subsurface Anisotropy"),
    )
    return Closure(materials.NullMaterial(subsurface=made))


def subsurface_of(
    translator: Translator, output: Output, color: values.Value, radius: Any, scale: float, anisotropy: Any
) -> materials.Subsurface:
    """What light does within a body; radius times scale is how far it goes [m]."""
    depth = int(translator.context.setting("max_depth", 32))
    if depth < _DEEP:
        what = f"light scatters often within a body: a max depth of {depth} darkens it, {2 * _DEEP} does not"
        translator.complain(output.node, what)
    far = [max(part * scale, 1e-6) for part in values.color(translator.constant(radius, 0.01))]
    made = materials.Subsurface(color=held(color), radius=far)
    tell_of_method(translator, output)
    g = values.number(translator.constant(anisotropy, 0.0))
    if g:
        made.g = held(g, -0.99, 0.99)
    return made
