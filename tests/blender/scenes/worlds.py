"""Worlds: pictures, skies, what is computed, and fog."""

import math

import bpy
import numpy
from lights_room import room
from scene import floor, light, link, material, node, primitive, scattered_once, scene, world


def panorama(width: int = 128):
    """Light that is warm on one side, with a bright spot."""
    image = bpy.data.images.new("Panorama", width, width // 2, float_buffer=True)
    u, v = numpy.meshgrid((numpy.arange(width) + 0.5) / width, (numpy.arange(width // 2) + 0.5) / (width // 2))
    light = numpy.ones((width // 2, width, 4), "float32")
    light[:, :, 0] = 0.4 + 0.3 * numpy.sin(2 * numpy.pi * u)
    light[:, :, 1] = 0.4
    light[:, :, 2] = 0.2 + 0.5 * v
    light[(u > 0.6) & (u < 0.66) & (v > 0.7) & (v < 0.8), :3] = 30
    image.pixels.foreach_set(light.reshape(-1))
    return image


def environment(turn=(0.0, 0.0, 0.0)):
    nodes = world(1.0, 0.8)
    texture = node(nodes, "ShaderNodeTexEnvironment")
    texture.image = panorama()
    moved = node(nodes, "ShaderNodeMapping", Rotation=turn)
    link(nodes, node(nodes, "ShaderNodeTexCoord").outputs["Generated"], moved.inputs["Vector"])
    link(nodes, moved.outputs[0], texture.inputs["Vector"])
    link(nodes, texture.outputs[0], nodes.nodes["Background"].inputs["Color"])
    return nodes


@scene(samples=128)
def world_for_some_rays() -> None:
    # Metal shows it, and the camera does not; what is matt has the light of a lamp alone.
    floor()
    light("POINT", 200, at=(2, -2, 4), shadow_soft_size=0)
    steel = material("Steel", "ShaderNodeBsdfGlossy", Color=0.8, Roughness=0.4)
    primitive("uv_sphere", scattered_once(steel), at=(0, 0, 1), radius=1, smooth=True)
    world((0.4, 0.5, 0.7))
    rays = bpy.context.scene.world.cycles_visibility
    rays.camera = rays.diffuse = False


@scene(samples=128)
def environment_image() -> None:
    room()
    environment()


@scene(samples=128)
def environment_turned() -> None:
    room()
    environment((0.0, 0.0, 1.9))


@scene(samples=128)
def environment_tilted() -> None:
    # More than a turn about the vertical: it is computed.
    room()
    environment((0.4, 0.2, 1.0))


@scene(samples=128)
def gradient_world() -> None:
    room()
    nodes = world(1.0)
    place = node(nodes, "ShaderNodeTexCoord")
    parts = node(nodes, "ShaderNodeSeparateXYZ")
    mix = node(nodes, "ShaderNodeMixShader")
    second = node(nodes, "ShaderNodeBackground", Color=(0.2, 0.3, 0.9), Strength=1.5)
    link(nodes, place.outputs["Generated"], parts.inputs[0])
    link(nodes, parts.outputs["Z"], mix.inputs[0])
    link(nodes, nodes.nodes["Background"].outputs[0], mix.inputs[1])
    link(nodes, second.outputs[0], mix.inputs[2])
    link(nodes, mix.outputs[0], nodes.nodes["World Output"].inputs["Surface"])


# Hillaire's sky and Nishita's are two models: alike on the whole, not in their blues.
@scene(mean=0.2, block=0.6, complaints=("the sky is the job's own",))
def sky() -> None:
    room()
    nodes = world(1.0, 0.1)
    texture = node(nodes, "ShaderNodeTexSky")
    texture.sky_type, texture.sun_elevation, texture.sun_rotation = "NISHITA", math.radians(35), 2.2
    link(nodes, texture.outputs[0], nodes.nodes["Background"].inputs["Color"])


@scene(samples=48, block=0.08)
def fog() -> None:
    floor()
    primitive("uv_sphere", material("Ball", Color=(0.8, 0.4, 0.2)), at=(0, 0, 1), smooth=True, segments=64, ring_count=32)
    light("POINT", 300, at=(2, -2, 4), shadow_soft_size=0)
    nodes = world(0.0)
    nodes.nodes.remove(nodes.nodes["Background"])
    volume = node(nodes, "ShaderNodeVolumeScatter", Color=(0.8, 0.8, 0.9), Density=0.03)
    link(nodes, volume.outputs[0], nodes.nodes["World Output"].inputs["Volume"])
