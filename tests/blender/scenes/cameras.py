"""Cameras: what they show, and what is sharp."""

import math

import bpy
from scene import camera, floor, light, material, primitive, scene, set_of_cycles, world


def things() -> None:
    """Coloured bodies at several distances."""
    floor(size=60)
    world((0.5, 0.6, 0.7))
    light("SUN", 2, at=(3, -2, 5), angle=math.radians(2))
    colors = ((0.8, 0.2, 0.1), (0.2, 0.7, 0.2), (0.1, 0.2, 0.8), (0.8, 0.7, 0.1))
    for i, color in enumerate(colors):
        primitive("cube", material(f"Paint{i}", Color=color), at=(1.6 * i - 2.4, 1.5 * i - 2, 0.5), turn=(0, 0, 20 * i), size=1)


def seen(**keys):
    """The camera, with properties of its data."""
    object = camera((1.5, -7, 2.5), (0, 0, 0.5))
    for name, value in keys.items():
        setattr(object.data, name, value)
    return object


@scene(samples=96)
def perspective() -> None:
    things()
    seen(lens=28)


@scene(samples=96)
def upright_sensor() -> None:
    things()
    seen(lens=28, sensor_fit="VERTICAL", sensor_height=20)
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 48, 64


@scene(samples=96)
def automatic_sensor_upright() -> None:
    things()
    seen(lens=28)
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 48, 64


@scene(samples=96)
def shifted() -> None:
    things()
    seen(shift_x=0.2, shift_y=-0.1)


@scene(samples=96)
def orthographic() -> None:
    things()
    seen(type="ORTHO", ortho_scale=6)


@scene(samples=96)
def orthographic_shifted() -> None:
    things()
    seen(type="ORTHO", ortho_scale=6, shift_x=0.2, shift_y=0.1)


@scene(samples=96)
def panorama() -> None:
    things()
    bpy.data.objects["Sun"].data.angle = 0  # Hyades' camera sees the sun's disc, that of Cycles does not
    object = camera((0.5, -1, 1.2), (0, 3, 1.2))
    object.data.type = "PANO"
    set_of_cycles(object.data, "panorama_type", "EQUIRECTANGULAR")


@scene()
def out_of_focus() -> None:
    things()
    object = seen(lens=50)
    object.data.dof.use_dof = True
    object.data.dof.focus_distance, object.data.dof.aperture_fstop = 6.0, 0.1


@scene()
def blades() -> None:
    things()
    object = seen(lens=50)
    dof = object.data.dof
    dof.use_dof = True
    dof.focus_object, dof.aperture_fstop, dof.aperture_blades, dof.aperture_rotation = bpy.data.objects["Cube"], 0.15, 5, 0.4


@scene(samples=96)
def border_and_percentage() -> None:
    things()
    seen()
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 160, 120, 50
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.2, 0.9, 0.1, 0.7


@scene(samples=96)
def scaled_camera() -> None:
    things()
    seen().scale = (2, 2, 2)


@scene(samples=96)
def transparent_film() -> None:
    things()
    seen()
    bpy.data.objects["Plane"].hide_render = True
    bpy.context.scene.render.film_transparent = True
