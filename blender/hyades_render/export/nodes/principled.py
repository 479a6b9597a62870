"""The Principled BSDF, as it was up to Blender 3.6 and as it is since 4.0."""

from __future__ import annotations

import math
from typing import Any

import numpy
from hyades import materials, textures

from . import graph, values
from .bsdfs import keeps_light, subsurface_of
from .closures import Closure, bright, shader
from .graph import Output
from .normals import normal_keys
from .principled_inputs import tell_of_inputs
from .principled_layers import add_coat, add_fuzz, left_of_emission
from .translator import Translator
from .values import Value, held

_SPECULARS = (0.0, 0.25, 0.5, 1.0)
_ROUGHNESSES = (0.05, 0.2, 0.35, 0.5, 0.75, 1.0)
_BURLEY = (0.958, 0.975, 0.991, 1.008, 1.036, 1.065)
"""By roughness: what Burley's diffuse reflects of even light, by his formula."""
_GLOSS = (
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (0.0652, 0.0612, 0.0501, 0.0375, 0.0215, 0.0117),
    (0.0911, 0.0869, 0.0744, 0.0590, 0.0366, 0.0208),
    (0.1319, 0.1276, 0.1141, 0.0955, 0.0635, 0.0375),
)
"""By Specular and roughness: what black spheres of the job's Principled reflect of an even sky."""


@shader("BSDF_PRINCIPLED")
def principled(translator: Translator, output: Output) -> Closure:
    is_new = output.input("Specular IOR Level") is not None
    made = materials.Principled(**_keys(translator, output), **normal_keys(translator, output))
    (_since_4_0 if is_new else _until_3_6)(translator, output, made)
    _anisotropy(translator, output, made)
    if not values.is_constant(made.transmission, 1):
        made.subsurface = _subsurface(translator, output, is_new)
    if made.subsurface is not None and not values.is_constant(made.transmission, 0):
        made.subsurface = None
        translator.complain(output.node, "light goes through or scatters below the surface: with both Subsurface is left out")
    strength = bright(translator, output, translator.number(output.input("Emission Strength"), 0.0))
    emission = values.product(translator.value(output.input("Emission Color", "Emission")), strength)
    if is_new and not values.is_constant(emission, 0):
        emission = values.product(emission, left_of_emission(translator, output, made))
    made.multiple_scattering = keeps_light(output)
    made.scale_radiance = False
    if not values.is_constant(made.transmission, 0) and not (values.is_constant(made.metallic, 0) or values.is_constant(made.metallic, 1)):
        translator.complain(output.node, "what is metal and glass at once lets more light through than in Cycles")
    tell_of_inputs(translator, output, made)
    alpha = held(translator.number(output.input("Alpha"), 1.0))
    return Closure(made, values.product(emission, alpha), alpha)


def _said(key: str, value: Value, default: float) -> dict[str, Any]:
    """A key that is not what it is by default."""
    return {} if values.is_constant(value, default) else {key: value}


def _keys(translator: Translator, output: Output) -> dict[str, Any]:
    keys: dict[str, Any] = {"base_color": translator.color(output.input("Base Color"), 0.8)}
    keys |= _said("metallic", held(translator.number(output.input("Metallic"))), 0)
    keys |= _said("roughness", held(translator.number(output.input("Roughness"), 0.5)), 0.5)
    keys |= _said("transmission", held(translator.number(output.input("Transmission Weight", "Transmission"))), 0)
    return keys


def _ior(translator: Translator, output: Output) -> float:
    ior = float(values.number(translator.constant(output.input("IOR"), 1.5)))
    if ior < 1:
        translator.complain(output.node, "'IOR' is held at 1: for bubbles take a Glass BSDF")
    return held(ior, 1.0, 100.0)


def _until_3_6(translator: Translator, output: Output, made: materials.Principled) -> None:
    """Specular is 0.08 of light at most, whatever the IOR; tints go towards the base's hue; a coat counts a quarter."""
    specular = translator.number(output.input("Specular"), 0.5)
    if values.is_constant(made.transmission, 0):
        if values.is_texture(specular):
            made.specular = specular
        else:  # the reflection straight on is 0.08 times specular
            root = math.sqrt(min(0.08 * max(specular, 0.0), 0.99))
            made.ior = max((1 + root) / (1 - root), 1.0)
    else:
        made.ior = _ior(translator, output)
    tint = held(translator.number(output.input("Specular Tint")))
    if not values.is_constant(tint, 0):
        made.specular_tint = _towards(translator, output, made, tint)
    sheen = held(translator.number(output.input("Sheen")))
    if not values.is_constant(sheen, 0):
        made.sheen = sheen
        made.sheen_tint = _towards(translator, output, made, held(translator.number(output.input("Sheen Tint"), 0.5)))
        translator.complain(output.node, "fuzz (sheen) is that of Estevez and Kulla, another model")
    coat = held(translator.number(output.input("Clearcoat")))
    if not values.is_constant(coat, 0):
        made.coat = values.product(coat, 0.25)
        made.coat_roughness = held(translator.number(output.input("Clearcoat Roughness"), 0.03))
    blur = translator.number(output.input("Transmission Roughness"))
    if not values.is_constant(blur, 0) and not values.is_constant(made.transmission, 0):
        translator.complain(output.node, "what is seen through is as rough as what is reflected")
    made.base_color = _color_until_3_6(translator, output, made, specular)


def _color_until_3_6(translator: Translator, output: Output, made: materials.Principled, specular: Value) -> Value:
    """The job's body is Lambert's, less what the gloss over it reflects, and has the colour of what goes in and out again.
    Cycles' is Burley's (2012), rough ones reflect more, and adds the gloss; it colours what goes through at each surface."""
    base, metallic, through = made.base_color, made.metallic, made.transmission
    if not (values.is_constant(through, 0) or values.is_constant(through, 1) or values.is_constant(metallic, 1)):
        translator.complain(output.node, "what is matt and what goes through have one colour: with both it is about right")
    matt = values.product(base, _body(specular, made.roughness))
    twice = textures.Power(input=base, exponent=2) if values.is_texture(base) else values.product(base, base)
    return held(values.mixed(values.mixed(matt, twice, through), base, metallic))


def _body(specular: Value, roughness: Value) -> float:
    """How much more even light Cycles' body reflects than the job's; of textures as with 0.5."""
    amount, blur = (0.5 if values.is_texture(value) else float(values.number(value)) for value in (specular, roughness))
    by_amount = [numpy.interp(blur, _ROUGHNESSES, row) for row in _GLOSS]
    return float(numpy.interp(blur, _ROUGHNESSES, _BURLEY) / (1 - numpy.interp(amount, _SPECULARS, by_amount)))


def _towards(translator: Translator, output: Output, made: materials.Principled, amount: Value) -> Value:
    """From white to the base colour at full brightness."""
    base = made.base_color
    if values.is_texture(base):
        base = translator.constant(output.input("Base Color"))
    bright = values.number(values.color(base))
    hue = tuple(min(part / bright, 1.0) if bright > 0 else 1.0 for part in values.color(base))
    return held(values.mixed(1.0, hue, amount))


def _since_4_0(translator: Translator, output: Output, made: materials.Principled) -> None:
    made.ior = _ior(translator, output)
    specular = held(translator.number(output.input("Specular IOR Level"), 0.5))
    if not values.is_constant(specular, 0.5):
        made.specular = specular
    tint = held(translator.value(output.input("Specular Tint"), 1.0))
    if not values.is_constant(tint, 1):
        made.specular_tint = tint
    add_fuzz(translator, output, made)
    add_coat(translator, output, made)


def _anisotropy(translator: Translator, output: Output, made: materials.Principled) -> None:
    anisotropic = held(translator.number(output.input("Anisotropic")))
    if values.is_constant(anisotropic, 0):
        return
    made.anisotropic = anisotropic
    made.anisotropic_rotation = held(translator.number(output.input("Anisotropic Rotation")))
    tangent = output.input("Tangent")
    translator.uv_map = translator.uv_map if translator.uv_map is not None else ""
    found = graph.source(tangent) if tangent is not None else None
    if not isinstance(found, Output) or getattr(found.node, "direction_type", "") != "UV_MAP":
        translator.complain(output.node, "its highlights are longer along the UV map, not around an axis")


def _subsurface(translator: Translator, output: Output, is_new: bool) -> Any:
    """What is below the surface; None: nothing."""
    share = values.number(translator.constant(output.input("Subsurface Weight", "Subsurface")))
    if share <= 0:
        return None
    if share < 1 and is_new:
        what = f"a body scatters light below its surface or not: a weight of {share:.2f} is {int(share >= 0.5)}"
        translator.complain(output.node, what)
        if share < 0.5:
            return None
    # Up to 3.6 the weight makes the radius smaller, and leads from the base's colour to one of its own.
    scale = values.number(translator.constant(output.input("Subsurface Scale"), 1.0)) if is_new else share
    color = translator.constant(output.input("Base Color"), 0.8)
    if not is_new:
        color = values.mixed(color, translator.constant(output.input("Subsurface Color"), 0.8), held(share))
    return subsurface_of(
        translator, output, color, output.input("Subsurface Radius"), scale, output.input("Subsurface Anisotropy")
    )
