"""Input "Normal" of shaders: bumps and normal maps."""

from __future__ import annotations

from typing import Any

from hyades import materials

from . import graph, values
from .graph import Input, Output
from .translator import Translator


_FLAT, _LEANS = (0.5, 0.5, 1.0), 0.02
"""The colour of a normal map where nothing leans, and by how much others may differ that hardly lean."""


def normal_keys(translator: Translator, output: Output, name: str = "Normal") -> dict[str, Any]:
    """Keys `bump` and `normal_map` of a material, as far as they are said."""
    keys: dict[str, Any] = {}
    end = output.input(name)
    while end is not None:
        found = graph.source(end)
        if isinstance(found, Input):
            break
        end = _taken(translator, found, keys)
    return keys


def _taken(translator: Translator, found: Output, keys: dict[str, Any]) -> Input | None:
    """Adds a node's key; returns the input for the normal that it changes."""
    node = found.node
    if node.type == "BUMP" and "bump" not in keys:
        height = translator.value(found.input("Height"))
        if values.is_texture(height):
            distance = values.number(translator.constant(found.input("Distance"), 1.0))
            sign = -1.0 if node.invert else 1.0
            keys["bump"] = materials.Bump(texture=height, height=sign * distance)
            strength = translator.number(found.input("Strength"), 1.0)
            if not values.is_constant(strength, 1):
                keys["bump"].strength = values.held(strength, 0.0, 100.0)
        return found.input("Normal")
    if node.type == "NORMAL_MAP" and "normal_map" not in keys:
        if node.space != "TANGENT":
            translator.complain(node, "normal maps are in tangent space; this one is left out")
            return None
        texture = translator.value(found.input("Color"))
        if values.is_texture(texture):
            if node.uv_map and translator.uv_map not in (None, node.uv_map):
                translator.complain(node, "this is the second UV map of one material: the tangents are those of the first")
            elif node.uv_map:
                translator.uv_map = node.uv_map
            translator.uv_map = translator.uv_map if translator.uv_map is not None else ""
            keys["normal_map"] = materials.NormalMap(texture=texture)
            strength = translator.number(found.input("Strength"), 1.0)
            if not values.is_constant(strength, 1):
                keys["normal_map"].strength = values.held(strength, 0.0, 100.0)
        elif max(abs(part - flat) for part, flat in zip(values.color(texture), _FLAT)) > _LEANS:
            translator.complain(node, "normals that lean the same everywhere do not in the job; it is left out")
        return None
    is_normal = node.type in ("NEW_GEOMETRY", "TEX_COORD") and found.socket.identifier == "Normal"
    if not is_normal:
        translator.complain(node, "this does not turn normals in the job; it is left out")
    return None
