"""Lamps: point, spot, sun and area lights.

Cycles' watts are not what a lamp gives off: an area has a radiance of
P / (4 A). Tests hold these numbers against Cycles' pictures (tests/blender/scenes/lights.py).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import bpy
import hyades
import numpy
from hyades import lights, materials, objects

from . import axes
from .context import Context
from .nodes import graph, values
from .nodes.translator import Translator
from .photometry import Profile, profile_of, profile_steps
from .visibility import rays_of_lamp, say, tell_of_bounces

_SIDES = 96
"""Corners of an ellipse; its area is that of the true one."""


_CONE = 256
"""Pixels across the picture of a spot's cone."""


class PlacedLight(NamedTuple):
    """A lamp and where it stands."""

    name: str
    object: Any
    matrix: numpy.ndarray
    """Into the job's world."""

    @property
    def where(self) -> str:
        return f"light '{self.name}'"

    @property
    def at(self) -> list[float]:
        return axes.numbers(self.matrix[:3, 3])

    @property
    def direction(self) -> numpy.ndarray:
        """Where it shines to."""
        return -self.matrix[:3, 2] / numpy.linalg.norm(self.matrix[:3, 2])


def add_light(context: Context, light: PlacedLight) -> None:
    """Adds one lamp to the job, as a light or as a body that shines."""
    data = light.object.data
    if getattr(getattr(data, "cycles", None), "is_portal", False):
        return  # it only says where light comes in
    color, profile = _color(context, light)
    if data.energy < 0 or values.is_constant(color, 0):
        if data.energy < 0:
            context.complain(light.where, "light below 0 is left out")
        return
    if data.type == "POINT":
        _add_point(context, light, color, profile)
    else:
        if profile is not None:
            context.complain(light.where, "IES profiles are supported for point lamps; it shines as without")
        {"SPOT": _add_spot, "SUN": _add_sun, "AREA": _add_area}[data.type](context, light, color)
    tell_of_bounces(context, light.where, data)


def _color(context: Context, light: PlacedLight) -> tuple[Any, Profile | None]:
    """Its colour times what its nodes say, and its profile."""
    data = light.object.data
    color: Any = tuple(axes.numbers(data.color))
    output = graph.output_node(data.node_tree, "OUTPUT_LIGHT") if data.use_nodes else None
    if output is None:
        return values.held(color, 0.0, 1e18), None
    found = graph.source(graph.find_input(output, (), "Surface"))
    if not isinstance(found, graph.Output):
        return 0.0, None
    if found.node.type != "EMISSION":
        context.complain(light.where, "only a shader Emission is supported; its own colour is used")
        return values.held(color, 0.0, 1e18), None
    translator = Translator(context, light.where)
    profiled, profile = profile_of(translator, found) or (None, None)
    strength = 1.0 if profile is None else profile.strength
    if profiled != "Strength":
        strength *= _strength(translator, found)
    own = 1.0 if profiled == "Color" else translator.constant(found.input("Color"), 1.0)
    return values.held(values.product(color, values.product(own, strength)), 0.0, 1e18), profile


def _strength(translator: Translator, emission: graph.Output) -> float:
    """A Light Falloff that falls off as light does gives its own strength."""
    found = graph.source(emission.input("Strength"))
    if isinstance(found, graph.Output) and found.node.type == "LIGHT_FALLOFF":
        if found.socket.identifier != "Quadratic":
            translator.complain(found.node, "light falls off with the square of the distance")
        if float(values.number(translator.constant(found.input("Smooth"), 0.0))) > 0:
            translator.complain(found.node, "Smooth is left out")
        return values.number(translator.constant(found.input("Strength"), 100.0))
    return values.number(translator.constant(emission.input("Strength"), 1.0))


def _add(context: Context, light: PlacedLight, made: lights.Light) -> None:
    _say_what_it_lights(context, light, made, made)
    context.add_light(light.name, made, context.names.links.owner(light.object))


def _add_body(context: Context, light: PlacedLight, body: objects.Mesh) -> None:
    """A lamp that has a size, which the camera does not see."""
    body.visible_to_camera = False
    _say_what_it_lights(context, light, body, body.emit)
    context.add_object(light.name, body, context.names.links.owner(light.object))


def _say_what_it_lights(context: Context, light: PlacedLight, made: Any, shining: Any) -> None:
    """`shining`: what of it says whose shadows there are."""
    say(context, light.where, made, rays_of_lamp(light.object))
    if _has_shadows(light.object.data):
        return
    if context.integrator == "path":
        shining.shadow_linking = lights.Linking(include=[])
        return
    what = f"everything throws shadows in its light: the integrator {context.integrator} has no lamps without"
    context.complain(light.where, what)


def _has_shadows(data: Any) -> bool:
    cycles = getattr(data, "cycles", None)
    # Cycles had a switch of its own, beside which the lamp's was Eevee's.
    return bool(getattr(cycles, "cast_shadow", getattr(data, "use_shadow", True)))


def _add_point(context: Context, light: PlacedLight, color: Any, profile: Profile | None) -> None:
    data = light.object.data
    made = lights.Point(color=color, power=float(data.energy), radius=float(data.shadow_soft_size))
    if profile is None:
        made.at = light.at
    else:
        made.image = profile.image
        made.transform = profile_steps(light.matrix)
    _add(context, light, made)


def _add_spot(context: Context, light: PlacedLight, color: Any) -> None:
    data = light.object.data
    half = data.spot_size / 2
    ahead = axes.numbers(numpy.array(light.at) + light.direction)
    keys = {"at": light.at, "look_at": ahead, "color": color, "power": float(data.energy)}
    keys["radius"] = float(data.shadow_soft_size)
    # Until 3.6 Cycles' cones were darker towards their edge, by the cosine, and round whatever the lamp's scale.
    is_old = bpy.app.version < (4, 0)
    stretch = numpy.linalg.norm(light.matrix[:3, :2], axis=0) / max(numpy.linalg.norm(light.matrix[:3, 2]), 1e-9)
    if is_old:
        stretch = numpy.ones(2)
    is_round = numpy.allclose(stretch, 1, rtol=1e-3)
    is_plain = is_round and not is_old
    widest = math.atan(math.tan(min(half, 1.5)) * float(stretch.max()))
    if not is_plain and widest < math.radians(80):
        up = axes.numbers(light.matrix[:3, 1] / numpy.linalg.norm(light.matrix[:3, 1]))
        picture = _cone(math.tan(widest), stretch, math.cos(half), data.spot_blend, is_old)
        _add(context, light, lights.Projector(image=picture, up=up, fov=math.degrees(2 * widest), **keys))
        return
    if is_old:  # no picture in a plane shows so much
        made = lights.Point(image=_wide_cone(math.cos(half), data.spot_blend), transform=profile_steps(light.matrix))
        made.color, made.power, made.radius = color, keys["power"], keys["radius"]
        _add(context, light, made)
        return
    if not is_round:
        context.complain(light.where, "so wide a cone is round, whatever the lamp's scale")
    # Blender's share is one of the cosine, the job's one of the angle; both fade alike between the two cones.
    inner = math.acos(min(math.cos(half) + (1 - math.cos(half)) * data.spot_blend, 1.0))
    blend = min(max(1 - inner / half, 0.0), 1.0)
    _add(context, light, lights.Spot(angle=min(math.degrees(half), 180.0), blend=blend, **keys))


def _cone(edge: float, stretch: numpy.ndarray, cosine: float, blend: float, darkens: bool) -> numpy.ndarray:
    """What a spot throws on a plane that it faces, out to the tangent `edge`, as a picture (n, n, 3)."""
    steps = ((numpy.arange(_CONE) + 0.5) / _CONE * 2 - 1) * edge
    x, y = numpy.meshgrid(steps / stretch[0], -steps / stretch[1])
    towards = 1 / numpy.sqrt(1 + x * x + y * y)
    light = _fade(towards, cosine, blend) * (towards if darkens else 1)
    return numpy.repeat(light[:, :, None], 3, axis=2).astype("float16")


def _wide_cone(cosine: float, blend: float) -> numpy.ndarray:
    """What a spot that darkens throws all round, as a lat-long picture (h, w, 3) whose lowest row lies ahead."""
    towards = -numpy.cos((numpy.arange(1024) + 0.5) / 1024 * math.pi)
    light = _fade(towards, cosine, blend) * numpy.maximum(towards, 0)
    return numpy.repeat(numpy.repeat(light[:, None, None], 4, axis=1), 3, axis=2).astype("float16")


def _fade(towards: numpy.ndarray, cosine: float, blend: float) -> numpy.ndarray:
    """How much of a spot's light goes in directions of these cosines to its axis."""
    fade = numpy.clip((towards - cosine) / max((1 - cosine) * blend, 1e-6), 0, 1)
    return fade * fade * (3 - 2 * fade)


def _add_sun(context: Context, light: PlacedLight, color: Any) -> None:
    data = light.object.data
    angle = min(math.degrees(data.angle), 90.0)
    direction, irradiance = axes.numbers(light.direction), float(data.energy)
    if data.angle > math.pi / 2:
        context.complain(light.where, "a sun of more than 90 degrees has 90")
    if bpy.app.version < (4, 0):
        # Its disc is as bright as if it lay in a plane, which costs large ones some of their light.
        cosine = math.cos(min(data.angle, 3.1) / 2)
        irradiance *= 2 * cosine / (1 + cosine)
    _add(context, light, lights.Sun(direction=direction, color=color, irradiance=irradiance, angle=angle))


def _add_area(context: Context, light: PlacedLight, color: Any) -> None:
    data = light.object.data
    width = data.size
    height = data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size
    is_round = data.shape in ("DISK", "ELLIPSE")
    mesh = _ellipse(width, height) if is_round else _rectangle(width, height)
    stretch = numpy.linalg.norm(numpy.cross(light.matrix[:3, 0], light.matrix[:3, 1]))  # of the area, sheared too
    area = width * height * float(stretch) * (math.pi / 4 if is_round else 1.0)
    if area <= 0:
        context.complain(light.where, "a lamp without a size is left out")
        return
    sides = light.matrix[:3, :3] / numpy.linalg.norm(light.matrix[:3, :3], axis=0)
    if numpy.abs(sides.T @ sides - numpy.eye(3)).max() > 1e-3:
        context.complain(light.where, "it is sheared, and shines to where its surface faces")
    # Until Blender 4 the same watts are darker by pi / 4.
    radiance = data.energy / ((math.pi if bpy.app.version >= (4, 0) else 4) * area)
    spread = min(max(math.degrees(data.spread), 1.0), 180.0)  # Cycles' least
    emit = objects.Emit(color=color, radiance=radiance, spread=spread)
    body = objects.Mesh(mesh=mesh, material=materials.NullMaterial(), emit=emit, transform=axes.steps(light.matrix))
    _add_body(context, light, body)


def _rectangle(width: float, height: float) -> hyades.MeshData:
    """Around the origin, facing -z as lamps of Blender do."""
    x, y = width / 2, height / 2
    return hyades.MeshData([[-x, -y, 0], [-x, y, 0], [x, y, 0], [x, -y, 0]], numpy.array([[0, 1, 2], [0, 2, 3]]))


def _ellipse(width: float, height: float) -> hyades.MeshData:
    """As a polygon of the same area."""
    turns = numpy.arange(_SIDES) * 2 * numpy.pi / _SIDES
    larger = math.sqrt(2 * math.pi / _SIDES / math.sin(2 * math.pi / _SIDES))
    rim = numpy.stack([numpy.sin(turns) * width, numpy.cos(turns) * height, 0 * turns], axis=1) * larger / 2
    around = numpy.arange(_SIDES)
    triangles = numpy.stack([0 * around + _SIDES, around, (around + 1) % _SIDES], axis=1)
    return hyades.MeshData(numpy.concatenate([rim, numpy.zeros((1, 3))]), triangles)
