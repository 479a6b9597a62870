"""Objects of type Volume: files of OpenVDB as media in a box."""

from __future__ import annotations

import os
from typing import Any, Optional

import hyades
import numpy
from hyades import materials, media, objects

from . import axes
from .context import Context
from .files import may_be_sent
from .nodes import graph, values
from .nodes.evaluate.blackbody import STEFAN
from .nodes.graph import Output
from .nodes.translator import Translator

_ENDS = {".vdb", ".nvdb"}
_FACES = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]


def add_volume(context: Context, object: Any, matrix: Any) -> None:
    """A Volume object as a box that is filled with what its file says."""
    data, where = object.data, f"object '{object.name}'"
    path = _file(context, data)
    if not data.filepath:
        context.complain(where, "only volumes of files are supported, none that modifiers make; it is left out")
        return
    if path is None:
        context.complain(where, f"there is no file {data.filepath}, expected .vdb or .nvdb, or a link to one")
        return
    slot = object.material_slots[0].material if len(object.material_slots) else None
    medium = _medium(context, context.override or slot, path)
    if medium is None:
        context.complain(where, "it has no material with a volume; it is left out")
        return
    box = objects.Mesh(mesh=_box(object.bound_box), material=materials.NullMaterial(), interior=medium)
    box.transform = axes.steps(axes.placed(matrix))
    context.add_object(object.name, box)


def _file(context: Context, data: Any) -> Optional[str]:
    """The file of the current frame."""
    import bpy

    path = data.grids.frame_filepath if data.is_sequence else bpy.path.abspath(data.filepath, library=data.library)
    path = os.path.abspath(path) if path else ""
    return path if may_be_sent(path, _ENDS) else None


def _medium(context: Context, material: Any, path: str) -> Optional[media.Medium]:
    if material is None or not material.use_nodes:
        return None
    translator = Translator(context, f"material '{material.name}'")
    output = graph.output_node(material.node_tree, "OUTPUT_MATERIAL")
    end = graph.find_input(output, (), "Volume") if output is not None else None
    found = graph.source(end) if end is not None else None
    if not isinstance(found, Output):
        return None
    if found.node.type not in ("PRINCIPLED_VOLUME", "VOLUME_SCATTER", "VOLUME_ABSORPTION"):
        translator.complain(found.node, "only one shader of volumes is supported for files; it is left out")
        return None
    return _of_node(translator, found, path)


def _of_node(translator: Translator, found: Output, path: str) -> media.Medium:
    from .nodes.volumes import medium_of_node

    made = medium_of_node(translator, found)
    grid = "density"
    name = found.input("Density Attribute")
    if name is not None and name.socket.default_value:
        grid = str(name.socket.default_value)
    made.density = media.Density(vdb=path, grid=grid, place="native")
    heat = found.input("Blackbody Intensity")
    if heat is not None and values.number(translator.constant(heat)) > 0:
        temperature = found.input("Temperature Attribute").socket.default_value or "temperature"
        kelvin = values.number(translator.constant(found.input("Temperature"), 1000.0))
        strength = values.number(translator.constant(heat)) * STEFAN * 1500.0**4 / numpy.pi
        made.emission = media.Emission(temperature=temperature, kelvin=kelvin, strength=float(strength))
    elif made.emission and isinstance(made.emission, list):
        strongest = max(made.emission)
        color = [part / strongest for part in made.emission]
        made.emission = media.Emission(color=color, strength=strongest)
        translator.complain(found.node, "what shines follows the density")
    return made


def _box(corners: Any) -> hyades.MeshData:
    """The bounds of an object, a little wider."""
    points = numpy.array([tuple(corner) for corner in corners])
    low, high = points.min(axis=0), points.max(axis=0)
    more = 0.001 * (high - low).max()
    low, high = low - more, high + more
    rows = [(x, y, z) for z in (low[2], high[2]) for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]),
                                                              (low[0], high[1]))]
    triangles = [[face[0], face[i], face[i + 1]] for face in _FACES for i in (1, 2)]
    return hyades.MeshData(rows, numpy.array(triangles))
