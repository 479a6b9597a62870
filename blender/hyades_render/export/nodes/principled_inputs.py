"""What the Principled BSDF says that no key of the job means: told by name."""

from __future__ import annotations

from typing import Any

from hyades import materials

from . import graph, values
from .graph import Output
from .translator import Translator

_TAKEN = {
    "Alpha", "Anisotropic", "Anisotropic Rotation", "Base Color", "Clearcoat", "Clearcoat Roughness", "Coat IOR",
    "Coat Roughness", "Coat Tint", "Coat Weight", "Emission", "Emission Color", "Emission Strength", "IOR", "Metallic",
    "Normal", "Roughness", "Sheen", "Sheen Roughness", "Sheen Tint", "Sheen Weight", "Specular", "Specular IOR Level",
    "Specular Tint", "Subsurface", "Subsurface Anisotropy", "Subsurface Color", "Subsurface Radius", "Subsurface Scale",
    "Subsurface Weight", "Tangent", "Transmission", "Transmission Roughness", "Transmission Weight",
}
_NOTHING_ALONE = {
    "Clearcoat Normal", "Coat Normal",  # see _tell_of_coat
    "Subsurface IOR",  # of a method that is told
    "Thin Film IOR",  # without a thickness
    "Weight",
}
_METHODS = {"BURLEY": "Christensen and Burley's profile", "RANDOM_WALK_SKIN": "the entry of skin"}


def tell_of_inputs(translator: Translator, output: Output, made: materials.Principled) -> None:
    """Complains of inputs that nothing is made of, also of those that Blender has had since this was written."""
    for socket in output.node.inputs:
        if not getattr(socket, "enabled", True) or socket.name in _TAKEN | _NOTHING_ALONE:
            continue
        found = graph.source(graph.Input(socket, output.groups))
        if isinstance(found, Output) or _says(getattr(found.socket, "default_value", 0.0)):
            translator.complain(output.node, f"the job has no '{socket.name}' of it: it is left out")
    if not values.is_constant(made.transmission, 0) and not values.is_constant(made.specular_tint, 1):
        translator.complain(output.node, "what glass reflects is tinted in another way")
    _tell_of_coat(translator, output, made)


def _says(value: Any) -> bool:
    """Whether what an input has by itself is more than nothing."""
    return bool(value) if isinstance(value, (int, float, str)) or value is None else any(list(value)[:3])


def _tell_of_coat(translator: Translator, output: Output, made: materials.Principled) -> None:
    """The job has one normal for a coat and what is below."""
    if values.is_constant(made.coat, 0):
        return
    ends = [output.input(name) for name in ("Normal", "Coat Normal")]
    ends[1] = ends[1] or output.input("Clearcoat Normal")
    found = [graph.source(end) if end is not None else None for end in ends]
    sources = [(one.socket.as_pointer(), one.groups) if isinstance(one, Output) else None for one in found]
    if sources[0] != sources[1]:
        translator.complain(output.node, "its coat has the normals of what is below it")


def tell_of_method(translator: Translator, output: Output) -> None:
    """Complains where light is to go below the surface otherwise than by a random walk."""
    node = output.node
    method = _METHODS.get(getattr(node, "subsurface_method", getattr(node, "falloff", "")))
    if method is not None:
        translator.complain(node, f"below its surface light takes a random walk: {method} is left out")
