"""Objects of type Volume: files of OpenVDB as media in a box."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Set
from typing import Any, NamedTuple, Optional

import hyades
import numpy
from hyades import materials, media, objects

from . import axes
from .context import Context
from .files import may_be_sent
from .nodes import graph, values
from .nodes.graph import Output
from .nodes.translator import Translator
from .nodes.volumes import heat_of, medium_of_node
from .visibility import Seen, add_seen

_ENDS = {".vdb", ".nvdb"}
_NUMBERS, _COLORS = {"FLOAT", "DOUBLE"}, {"VECTOR_FLOAT"}
"""Blender's types of grids that jobs have."""
_KELVIN = 1500.0
_FACES = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]


class _Field(NamedTuple):
    """What a Volume object's file holds, and how large it is shown."""

    path: str
    kinds: Optional[Mapping[str, str]]
    """Blender's types of its grids by their names; None: Blender does not read such files."""
    voxels: Mapping[str, numpy.ndarray]
    """The axes (3, 3) of their voxels, as columns, in the object's space."""
    scale: float
    """By how much lengths of its space are longer in the world, where densities are those of its own space; else 1."""


def add_volume(context: Context, object: Any, matrix: Any, seen: Seen) -> None:
    """A Volume object as a box that is filled with what its file says."""
    data, where = object.data, f"object '{object.name}'"
    if not data.filepath:
        context.complain(where, "only volumes of files are supported, none that modifiers make; it is left out")
        return
    is_read = data.grids.load()  # a sequence's file of the frame is not known before
    path = _file(data)
    if path is None and data.is_sequence and not data.grids.frame_filepath:
        return  # nothing is there before and after a sequence
    if path is None:
        context.complain(where, f"there is no file {data.filepath}, expected .vdb or .nvdb, or a link to one")
        return
    if not is_read and not path.lower().endswith(".nvdb"):
        context.complain(where, f"Blender reads no volume from the file {path}: {data.grids.error_message}; it is left out")
        return
    grids = {grid.name: grid for grid in data.grids} if is_read else {}
    kinds = {name: grid.data_type for name, grid in grids.items()} if is_read else None
    voxels = {name: axes.array(grid.matrix_object)[:3, :3] for name, grid in grids.items()}
    if context.scene.render.use_motion_blur and data.velocity_grid in grids:
        context.complain(where, f"it stands still while the shutter is open: its grid '{data.velocity_grid}' is left out")
    slot = object.material_slots[0].material if len(object.material_slots) else None
    found = _shader(context, context.override or slot)
    if found is None:
        context.complain(where, "it has no material with a volume; it is left out")
        return
    translator, shader = found
    field = _Field(path, kinds, voxels, _scale(data, matrix))
    medium = _medium(translator, shader, field, where)
    if medium is None:
        return
    box = objects.Mesh(mesh=_box(object.bound_box, field.voxels), material=materials.NullMaterial(), interior=medium)
    box.transform = axes.steps(axes.placed(matrix))
    add_seen(context, object.name, box, seen)


def _file(data: Any) -> Optional[str]:
    """The file of the current frame."""
    import bpy

    path = data.grids.frame_filepath if data.is_sequence else bpy.path.abspath(data.filepath, library=data.library)
    path = os.path.abspath(path) if path else ""
    return path if may_be_sent(path, _ENDS) else None


def _scale(data: Any, matrix: Any) -> float:
    """As Cycles has it: how much longer a diagonal becomes."""
    if data.render.space != "OBJECT":
        return 1.0
    return max(float(numpy.linalg.norm(matrix[:3, :3] @ numpy.ones(3))) / math.sqrt(3), 1e-9)


def _shader(context: Context, material: Any) -> Optional[tuple[Translator, Output]]:
    """The shader of volumes that a material has; None: it has none."""
    if material is None or not material.use_nodes:
        return None
    translator = Translator(context, f"material '{material.name}'")
    output = graph.output_node(material.node_tree, "OUTPUT_MATERIAL")
    if output is not None and isinstance(graph.source(graph.find_input(output, (), "Surface")), Output):
        context.complain(f"material '{material.name}'", "volumes of files have no surface: that of the material is left out")
    end = graph.find_input(output, (), "Volume") if output is not None else None
    found = graph.source(end) if end is not None else None
    return (translator, found) if isinstance(found, Output) else None


def _medium(translator: Translator, found: Output, field: _Field, where: str) -> Optional[media.Medium]:
    """What fills a file's grid. None: there is nothing to be seen, with a complaint where Blender shows something."""
    if found.node.type not in ("PRINCIPLED_VOLUME", "VOLUME_SCATTER", "VOLUME_ABSORPTION"):
        translator.complain(found.node, "only one shader of volumes is supported for files; it is left out")
        return None
    grid = _attribute(found, "Density Attribute") or "density"
    if not _asks_for_grids(found):
        translator.complain(found.node, "it asks for no grid of the file: nothing is there, as in Cycles")
        return None
    if not _has(translator.context, field, grid, _NUMBERS, where, "it is left out"):
        return None
    heat = heat_of(translator, found)
    name = _attribute(found, "Temperature Attribute")
    is_hot = heat.share > 0 and bool(name) and _has(
        translator.context, field, name, _NUMBERS, where, "all of it has one temperature")
    made = medium_of_node(translator, found, 1 / field.scale, not is_hot)
    made.density = media.Density(vdb=field.path, grid=grid, place="native")
    if grid in field.voxels:  # Cycles has values in the middle of voxels, OpenVDB at their corners
        made.density.at = axes.numbers(field.voxels[grid] @ numpy.full(3, 0.5))
    tint = _attribute(found, "Color Attribute")
    if tint and _has(translator.context, field, tint, _COLORS, where, "its colour is left out"):
        made.density.tint = tint
        if any(values.color(translator.constant(found.input("Absorption Color"), 0.0))):
            translator.complain(found.node, f"what the grid '{tint}' takes of light is absorbed, whatever Absorption Color says")
    emission = made.emission if isinstance(made.emission, list) else None
    if is_hot:
        # The job's are in proportion to the fourth power of the temperature, from 1500 K.
        strength = heat.strength(_KELVIN) / field.scale
        made.emission = media.Emission(color=list(heat.tint), temperature=name, kelvin=heat.kelvin, strength=strength)
        if emission is not None:
            translator.complain(found.node, "it shines as a black body alone: Emission is left out")
    elif emission is not None:
        strongest = max(emission)
        made.emission = media.Emission(color=[part / strongest for part in emission], strength=strongest)
        translator.complain(found.node, "what shines follows the density")
    return made


def _asks_for_grids(found: Output) -> bool:
    """Whether a shader looks at what a file holds: of others Cycles shows nothing."""
    if found.node.type != "PRINCIPLED_VOLUME":
        return any(end.is_linked for end in found.node.inputs)
    looks = {"Density Attribute": "Density", "Temperature Attribute": "Blackbody Intensity"}
    ends = [found.input(name) for at, name in looks.items() if _attribute(found, at)]
    return any(end.socket.is_linked or end.socket.default_value > 0 for end in ends if end is not None)


def _attribute(found: Output, name: str) -> str:
    """The name of a grid that a shader looks at; "": none."""
    end = found.input(name)
    return str(end.socket.default_value) if end is not None else ""


def _has(context: Context, field: _Field, grid: str, wanted: Set[str], where: str, instead: str) -> bool:
    """Whether the file has a grid of one of these types; complains where it has not."""
    if field.kinds is None or field.kinds.get(grid) in wanted:
        return True
    there = ", ".join(f"'{name}'" for name, kind in field.kinds.items() if kind in wanted) or "none"
    kind = "colours" if wanted is _COLORS else "numbers"
    context.complain(where, f"its file has no grid '{grid}' of {kind}, expected one of {there}: {instead}")
    return False


def _box(corners: Any, voxels: Mapping[str, numpy.ndarray]) -> hyades.MeshData:
    """The bounds of an object, wider by what lies between the outermost values of its grids and nothing."""
    points = numpy.array([tuple(corner) for corner in corners])
    low, high = points.min(axis=0), points.max(axis=0)
    far = [numpy.full(3, 0.001 * (high - low).max()), *(1.5 * numpy.abs(one).sum(axis=1) for one in voxels.values())]
    more = numpy.max(far, axis=0)
    low, high = low - more, high + more
    rows = [(x, y, z) for z in (low[2], high[2]) for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]),
                                                              (low[0], high[1]))]
    triangles = [[face[0], face[i], face[i + 1]] for face in _FACES for i in (1, 2)]
    return hyades.MeshData(rows, numpy.array(triangles))
