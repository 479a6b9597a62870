"""The world: light from all around, and what fills all space."""

from __future__ import annotations

import math
from typing import Any, Optional

import hyades
import numpy

from .context import Context
from .nodes import graph, values
from .nodes.directions import panorama
from .nodes.graph import Input, Output
from .nodes.images import image_file
from .nodes.mappings import own_matrix
from .nodes.translator import Inexpressible, Translator
from .nodes.volumes import medium_of
from .visibility import rays_of_world, say


_SUN = 145.0
"""Above the air [W/m²], as bright as that of Blender's Nishita sky is on the ground."""


def add_world(context: Context) -> None:
    """Says environment and atmosphere of the job."""
    world = context.scene.world
    if world is None or not context.depsgraph.view_layer_eval.use_sky:
        return
    context.job.environment = _environment(context, world)
    say(context, f"world '{world.name}'", context.job.environment, rays_of_world(world))
    if context.scene.render.film_transparent:
        context.job.environment.visible_to_camera = False


def _environment(context: Context, world: Any) -> hyades.Environment:
    if not world.use_nodes or world.node_tree is None:
        return hyades.Environment(color=[float(part) for part in world.color])
    output = graph.output_node(world.node_tree, "OUTPUT_WORLD")
    if output is None:
        return hyades.Environment(color=0)
    translator = Translator(context, f"world '{world.name}'")
    medium = medium_of(translator, graph.find_input(output, (), "Volume"))
    if medium is not None:
        context.job.atmosphere = _named(context, medium)
    surface = graph.find_input(output, (), "Surface")
    found = graph.source(surface) if surface is not None else None
    if not isinstance(found, Output):
        return hyades.Environment(color=0)
    return _plain(translator, found) or _panorama(translator, surface)


def _named(context: Context, medium: Any) -> str:
    context.job.media["atmosphere"] = medium
    return "atmosphere"


def _plain(translator: Translator, found: Output) -> Optional[hyades.Environment]:
    """One Background of one colour, one picture or one sky; None: it is more than that."""
    if found.node.type not in ("BACKGROUND", "EMISSION"):
        return None
    try:
        strength = translator.native_value(found.input("Strength"))
    except Inexpressible:
        return None
    if values.is_texture(strength):
        return None
    strength = max(values.number(strength), 0.0)
    color = found.input("Color")
    source = graph.source(color)
    try:
        if isinstance(source, Output) and source.node.type == "TEX_ENVIRONMENT":
            return _picture(translator, source, strength)
        if isinstance(source, Output) and source.node.type == "TEX_SKY":
            return _sky(translator, source, strength)
        value = translator.native_value(color)
    except Inexpressible:
        return None
    if values.is_texture(value):
        return None
    return hyades.Environment(color=values.held(value, 0.0, 1e18), strength=strength)


def _picture(translator: Translator, source: Output, strength: float) -> hyades.Environment:
    """A picture that is at most turned about the vertical. Inexpressible: it is turned otherwise."""
    node = source.node
    if node.image is None or node.projection != "EQUIRECTANGULAR":
        raise Inexpressible(source, "only panoramas are environments of the job")
    turn = _turn(translator, source)
    if node.interpolation == "Closest":
        translator.complain(node, "it is smooth between its pixels, not as by Closest")
    found = image_file(translator, node, source)
    if found.color_space == "srgb" and str(found.file).lower().endswith((".hdr", ".exr")):
        raise Inexpressible(source, "light that is marked as sRGB is computed")
    return hyades.Environment(image=found.file, color=1, strength=strength, rotate_y=turn)


def _turn(translator: Translator, source: Output) -> float:
    """By how many degrees the picture is turned counter-clockwise, seen from above."""
    if own_matrix(source) is not None:
        raise Inexpressible(source, "a texture's own mapping is no turn")
    end = source.input("Vector")
    found = graph.source(end) if end is not None else None
    if not isinstance(found, Output) or (found.node.type == "TEX_COORD" and found.socket.identifier == "Generated"):
        return 0.0
    inner = graph.source(found.input("Vector")) if found.node.type == "MAPPING" else None
    is_direction = isinstance(inner, Output) and inner.node.type == "TEX_COORD" and inner.socket.identifier in (
        "Generated", "Object")
    if not is_direction or getattr(inner.node, "object", None) is not None:
        raise Inexpressible(found, "these coordinates are no turn")
    angles, scale = (values.color(translator.native_value(found.input(name))) for name in ("Rotation", "Scale"))
    where = found.input("Location")
    moved = where is not None and getattr(where.socket, "enabled", True) and any(values.color(translator.native_value(where)))
    if angles[0] or angles[1] or scale != (1.0, 1.0, 1.0) or moved:
        raise Inexpressible(found, "this mapping is more than a turn about the vertical")
    return math.degrees(angles[2]) * (1 if found.node.vector_type in ("TEXTURE",) else -1)


def _sky(translator: Translator, source: Output, strength: float) -> hyades.Environment:
    """A clear sky by the job's own model, which is another one."""
    node = source.node
    if node.sky_type not in ("NISHITA", "SINGLE_SCATTERING", "MULTIPLE_SCATTERING"):
        direction = numpy.array(node.sun_direction)
        elevation = math.asin(float(numpy.clip(direction[2] / numpy.linalg.norm(direction), -1, 1)))
        turn, size, disc = math.atan2(direction[0], direction[1]), math.radians(0.545), False
    else:
        elevation, turn, size = node.sun_elevation, node.sun_rotation, node.sun_size
        disc = node.sun_disc
    translator.complain(node, "the sky is the job's own (Hillaire's), another model; its light is about as strong")
    # Towards +y of Blender, turned clockwise seen from above.
    flat = math.cos(elevation)
    towards = [flat * math.sin(turn), math.sin(elevation), -flat * math.cos(turn)]
    sky = hyades.Sky(sun_direction=towards, sun=bool(disc), sun_size=min(math.degrees(size), 90.0))
    sky.irradiance = _SUN
    sky.ground_albedo = 0.1
    dust = float(getattr(node, "dust_density", getattr(node, "aerosol_density", 1.0)))
    sky.turbidity = min(max(1 + 0.2 * dust, 1.0), 10.0)
    return hyades.Environment(sky=sky, strength=strength)


def _panorama(translator: Translator, surface: Input) -> hyades.Environment:
    """Whatever the nodes say, computed for all directions."""
    try:
        picture = panorama(translator, surface)
    except Inexpressible as why:
        translator.complain(why.node, f"{why.why}; the world is black")
        return hyades.Environment(color=0)
    return hyades.Environment(image=picture)
