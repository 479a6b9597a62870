"""IES profiles of lamps: a node IES Texture that says how strong a point lamp is, or of which colour."""

from __future__ import annotations

import os
from typing import Any, NamedTuple, Optional

import bpy
import numpy

from . import axes
from .files import may_be_sent
from .nodes import graph, values
from .nodes.images import PackedFile
from .nodes.translator import Translator

_AXES = numpy.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""From the directions of a profile in a job (x where horizontal angles begin, y up) into those of a lamp of Blender."""


def profile_steps(matrix: numpy.ndarray) -> Any:
    """The transform of a light with a lat-long picture or profile, where the lamp stands as `matrix` says."""
    turned = numpy.array(matrix, dtype=float)
    turned[:3, :3] = turned[:3, :3] @ _AXES
    return axes.steps(turned)


class Profile(NamedTuple):
    """What a lamp's node says."""

    image: Any
    strength: float


def profile_of(translator: Translator, emission: graph.Output) -> Optional[tuple[str, Profile | None]]:
    """The socket of a lamp's shader Emission that an IES Texture is linked to, and the profile; None for it, with a
    complaint: it cannot be said. None: there is no such node."""
    for name in ("Strength", "Color"):
        found = graph.source(emission.input(name))
        if not isinstance(found, graph.Output) or found.node.type != "TEX_IES":
            continue
        node = found.node
        if isinstance(graph.source(found.input("Vector")), graph.Output):
            translator.complain(node, "a lamp's profile stands as the lamp does: its Vector is not taken")
        image = _file(node)
        if image is None:
            translator.complain(node, "there is no file .ies, and the lamp shines the same all round")
            return name, None
        return name, Profile(image, values.number(translator.constant(found.input("Strength"), 1.0)))
    return None


def _file(node: Any) -> Any:
    if node.mode == "INTERNAL":
        return PackedFile(node.ies.as_string().encode(), ".ies") if node.ies is not None else None
    path = os.path.abspath(bpy.path.abspath(node.filepath, library=node.id_data.library))
    return path if may_be_sent(path, {".ies"}) else None
