"""Where textures of the job look: texture coordinates that its mappings can say."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy
from hyades import textures

from .. import axes
from . import graph
from .graph import Output
from .mappings import matrix_of, own_matrix
from .translator import Inexpressible, Translator
from .values import is_texture

Array = Any


class Coordinates(NamedTuple):
    """A space of the job (uv, object, world) and a matrix (4, 4) from there."""

    space: str
    matrix: Array

    def mapping(self) -> textures.TextureMapping:
        return textures.TextureMapping(type=self.space, transform=axes.steps(self.matrix))


def coordinates_of(translator: Translator, output: Output, unlinked: str) -> Coordinates:
    """What input "Vector" of a texture is. `unlinked`: "uv" or "generated". Inexpressible: no mapping says it."""
    end = output.input("Vector")
    found = graph.source(end) if end is not None else None
    if isinstance(found, Output):
        place = _of_node(translator, found)
    else:
        place = _uv(translator, output, "") if unlinked == "uv" else _generated(translator, output)
    own = own_matrix(output)
    return place if own is None else Coordinates(place.space, own @ place.matrix)


def _of_node(translator: Translator, output: Output) -> Coordinates:
    node, kind = output.node, output.socket.identifier
    if getattr(node, "from_instancer", False):
        raise Inexpressible(output, "coordinates of what instances an object are not supported")
    if node.type == "MAPPING":
        return _mapped(translator, output)
    if node.type == "UVMAP":
        return _uv(translator, output, node.uv_map)
    if node.type == "TEX_COORD" and kind == "UV":
        return _uv(translator, output, "")
    if node.type == "ATTRIBUTE" and kind == "Vector" and _has_uv(translator, node.attribute_name):
        return _uv(translator, output, node.attribute_name)
    if node.type == "TEX_COORD" and kind == "Object" and node.object is None:
        return Coordinates("object", numpy.eye(4))
    if node.type == "TEX_COORD" and kind == "Generated":
        return _generated(translator, output)
    if node.type == "NEW_GEOMETRY" and kind == "Position":
        return Coordinates("world", numpy.linalg.inv(axes.TO_JOB))
    raise Inexpressible(output, "no mapping of the job means these coordinates")


def _has_uv(translator: Translator, name: str) -> bool:
    translator.is_of_surface = True
    return translator.surface is not None and translator.surface.surface.uv(name) is not None


def _uv(translator: Translator, output: Output, name: str) -> Coordinates:
    if translator.surface is None:
        raise Inexpressible(output, "there are no UV coordinates")
    if translator.uv_map not in (None, name):
        raise Inexpressible(output, "this is the second UV map of one material")
    if not _has_uv(translator, name):
        raise Inexpressible(output, "the mesh has no such UV map: Cycles looks at the corner of the picture")
    translator.uv_map = name
    return Coordinates("uv", numpy.eye(4))


def _generated(translator: Translator, output: Output) -> Coordinates:
    if translator.surface is None:
        raise Inexpressible(output, "there are no generated coordinates")
    translator.is_of_surface = True
    surface = translator.surface.surface
    if not numpy.array_equal(surface.undeformed, surface.positions):
        raise Inexpressible(output, "generated coordinates of a mesh that modifiers have deformed are its own")
    half = numpy.array(surface.mesh.texspace_size)
    scale = 1 / numpy.where(half == 0, 1, 2 * half)
    matrix = numpy.eye(4)
    matrix[:3, :3] = numpy.diag(scale)
    matrix[:3, 3] = 0.5 - numpy.array(surface.mesh.texspace_location) * scale
    return Coordinates("object", matrix)


def _mapped(translator: Translator, output: Output) -> Coordinates:
    inner = _of_node(translator, _linked(output))
    parts = []
    for name in ("Scale", "Rotation", "Location"):
        end = output.input(name)
        value = (1.0, 1.0, 1.0) if end is None else translator.native_value(end)
        if is_texture(value):
            raise Inexpressible(output, "the mapping changes from place to place")
        parts.append(numpy.ones(3) * numpy.array(value))
    return Coordinates(inner.space, matrix_of(output, output.node.vector_type, *parts) @ inner.matrix)


def _linked(output: Output) -> Output:
    end = output.input("Vector")
    found = graph.source(end) if end is not None else None
    if not isinstance(found, Output):
        raise Inexpressible(output, "the vector that is mapped is the same everywhere")
    return found
