"""Lamps and worlds."""

import math

import bpy
from lights_room import room
from scene import camera, floor, light, material, primitive, scene, world


@scene()
def point() -> None:
    room()
    light("POINT", 300, at=(2, -2, 4), color=(1, 0.8, 0.5), shadow_soft_size=0)


@scene()
def point_with_radius() -> None:
    room()
    light("POINT", 300, at=(2, -2, 4), shadow_soft_size=0.4)


def emission_of(lamp):
    """The node of a lamp's shader, and the tree that it is in."""
    lamp.data.use_nodes = True
    tree = lamp.data.node_tree
    return next(node for node in tree.nodes if node.type == "EMISSION"), tree


def profiled(socket: str, strength: float, **keys):
    """A point lamp that an IES profile makes brighter to one side and above; half a watt of light for each of its own."""

    def candela(up: int, around: int) -> float:
        return 30 * (1 + math.cos(math.radians(up))) * (1.2 + math.cos(math.radians(around - 50))) + 5

    ups, arounds = range(0, 181, 5), range(0, 361, 10)
    rows = [[f"1 -1 1 {len(ups)} {len(arounds)} 1 2 0 0 0", "1 1 20"], ups, arounds]
    rows += [[f"{candela(up, around):.3f}" for up in ups] for around in arounds]
    text = bpy.data.texts.new("lamp.ies")
    text.write("IESNA:LM-63-2002\nTILT=NONE\n" + "\n".join(" ".join(map(str, row)) for row in rows) + "\n")
    lamp = light("POINT", 10, **keys)
    emission, tree = emission_of(lamp)
    profile = tree.nodes.new("ShaderNodeTexIES")
    profile.mode, profile.ies = "INTERNAL", text
    profile.inputs["Strength"].default_value = strength
    tree.links.new(profile.outputs[0], emission.inputs[socket])
    return lamp


@scene()
def point_with_profile() -> None:
    room()
    profiled("Strength", 3, at=(1, -1, 3), towards=(0, 0, 0), shadow_soft_size=0)


@scene()
def ball_with_profile() -> None:
    room()
    profiled("Color", 2, at=(1, -1, 3.5), towards=(1, 0, 0.5), color=(1, 0.8, 0.5), shadow_soft_size=0.3)


@scene()
def sun() -> None:
    room()
    light("SUN", 3, at=(2, -2, 4), color=(1, 0.9, 0.8), angle=math.radians(8))


@scene()
def sharp_sun() -> None:
    room()
    light("SUN", 3, at=(-2, -2, 4), angle=0)


@scene()
def spot() -> None:
    room()
    light("SPOT", 600, at=(2, -2, 5), towards=(0, 0, 0.5), spot_size=math.radians(50), spot_blend=0.5, shadow_soft_size=0)


@scene()
def spot_with_radius() -> None:
    room()
    light("SPOT", 600, at=(2, -2, 5), towards=(0, 0, 0.5), spot_size=math.radians(50), spot_blend=0.5, shadow_soft_size=0.4)


@scene()
def spot_of_a_scaled_lamp() -> None:
    room()
    lamp = light("SPOT", 600, at=(2, -2, 5), towards=(0, 0, 0.5), spot_size=math.radians(50), spot_blend=0.5, shadow_soft_size=0)
    lamp.scale = (2, 1, 1)


@scene()
def widest_spot() -> None:
    room()
    light("SPOT", 300, at=(2, -2, 4), towards=(0, 0, 0.5), spot_size=math.radians(175), spot_blend=0.3, shadow_soft_size=0)


@scene()
def large_sun() -> None:
    room()
    light("SUN", 3, at=(2, -2, 4), angle=math.radians(75))


@scene(mean=1, block=10, complaints=("it is sheared",))
def area_of_a_sheared_lamp() -> None:
    # Cycles' shines along an axis that is not its surface's normal.
    from scene import add

    room()
    above = add(None, "Above", at=(1, -2, 4), turn=(20, 30, 40), scale=(2, 0.7, 1))
    lamp = light("AREA", 200, at=(0, 0, 0), shape="RECTANGLE", size=1, size_y=0.7)
    lamp.rotation_euler = [math.radians(angle) for angle in (-20, 15, 35)]
    lamp.parent = above
    bpy.context.view_layer.update()


@scene()
def point_with_falloff() -> None:
    room()
    lamp = light("POINT", 3, at=(2, -2, 4), shadow_soft_size=0)
    emission, tree = emission_of(lamp)
    falloff = tree.nodes.new("ShaderNodeLightFalloff")
    falloff.inputs["Strength"].default_value = 90
    tree.links.new(falloff.outputs["Quadratic"], emission.inputs["Strength"])


@scene()
def point_without_shadows() -> None:
    room()
    lamp = light("POINT", 300, at=(2, -2, 4), shadow_soft_size=0)
    if hasattr(lamp.data.cycles, "cast_shadow"):
        lamp.data.cycles.cast_shadow = False
    else:
        lamp.data.use_shadow = False


@scene()
def area_with_spread() -> None:
    room()
    light("AREA", 200, at=(1, -2, 4), towards=(0, 0, 0.5), shape="RECTANGLE", size=2, size_y=1, spread=math.radians(70))


@scene()
def area_rectangle() -> None:
    room()
    light("AREA", 200, at=(1, -2, 4), towards=(0, 0, 0.5), shape="RECTANGLE", size=2, size_y=1)


@scene()
def area_square_scaled() -> None:
    room()
    light("AREA", 200, at=(1, -2, 4), towards=(0, 0, 0.5), shape="SQUARE", size=1).scale = (2, 0.5, 1)


@scene()
def area_disk() -> None:
    room()
    light("AREA", 200, at=(1, -2, 4), towards=(0, 0, 0.5), shape="DISK", size=1.5)


@scene()
def area_ellipse() -> None:
    room()
    light("AREA", 200, at=(1, -2, 4), towards=(0, 0, 0.5), shape="ELLIPSE", size=2, size_y=1)


@scene()
def area_from_behind() -> None:
    # The lamp shines away from the camera's side: it lights the floor, and is dark from above.
    room()
    light("AREA", 100, at=(0, 0, 2.6), towards=(0, 0, 0), shape="SQUARE", size=1.5)
    camera((0, -5, 4.5), (0, 0, 1))


@scene()
def plain_world() -> None:
    room()
    world((0.4, 0.5, 0.7), 1.5)


if bpy.app.version >= (4, 0):  # whose lamps are linked to things

    def collection(state: str, *bodies):
        made = bpy.data.collections.new(state)
        for number, body in enumerate(bodies):
            made.objects.link(body)
            made.collection_objects[number].light_linking.link_state = state
        return made

    def cube_and_ball():
        ground = floor()
        ball = primitive("uv_sphere", material("Ball", Color=(0.8, 0.4, 0.2)), at=(-1, 0, 0.8), radius=0.8, smooth=True)
        return primitive("cube", material("Cube", Color=0.6), at=(1, 0, 0.6), turn=(0, 0, 30), size=1.2), ball, ground

    @scene()
    def linked_lights() -> None:
        cube, ball, ground = cube_and_ball()
        key = light("POINT", 300, at=(2, -2, 4), color=(1, 0.6, 0.5), shadow_soft_size=0)
        key.light_linking.receiver_collection = collection("INCLUDE", ball, ground)
        soft = light("AREA", 150, at=(-3, -2, 3), color=(0.5, 0.7, 1), size=1)
        soft.light_linking.receiver_collection = collection("EXCLUDE", ball)
        glow = primitive("cube", material("Glow", "ShaderNodeEmission", Strength=8), at=(0, -1.2, 0.2), size=0.4)
        glow.light_linking.receiver_collection = collection("INCLUDE", cube)

    @scene()
    def linked_shadows() -> None:
        cube, ball, _ = cube_and_ball()
        light("POINT", 200, at=(2, -3, 4), shadow_soft_size=0).light_linking.blocker_collection = collection("EXCLUDE", ball)
        light("AREA", 150, at=(-3, -2, 3), size=1).light_linking.blocker_collection = collection("INCLUDE", ball)
