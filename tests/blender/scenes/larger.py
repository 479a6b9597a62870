"""Larger scenes, in which everything comes together. docs/blender.md shows them as Cycles and Hyades render them."""

import math

import bpy
from scene import add, camera, floor, light, link, material, node, primitive, scattered_once, scene, set_of_cycles, shader_of, world


def sized(width: int = 160, height: int = 120) -> None:
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = width, height


def textured(made, texture, output: str, target: str = "Color", coordinates: str = "Object"):
    """A texture for an input of a material's shader, by these coordinates."""
    link(made, node(made, "ShaderNodeTexCoord").outputs[coordinates], texture.inputs["Vector"])
    link(made, texture.outputs[output], shader_of(made).inputs[target])
    return made


def smooth_monkey(made, at, turn: float):
    monkey = primitive("monkey", made, at=at, turn=(-15, 0, turn), smooth=True, size=1.5)
    monkey.modifiers.new("Subdivision", "SUBSURF").render_levels = 1
    return monkey


@scene(samples=512, block=0.3)  # the glass, and its caustics
def monkeys() -> None:
    # Matt, gold, glass and coated, on a chequered floor, by an area, a point and the sun.
    sized()
    world((0.25, 0.28, 0.35))
    ground = material("Ground")
    checker = node(ground, "ShaderNodeTexChecker", Scale=1.0, Color1=(0.5, 0.45, 0.4), Color2=(0.2, 0.2, 0.22))
    floor(textured(ground, checker, "Color"), size=20)
    kinds = (
        material("Matt", Color=(0.7, 0.2, 0.1)),
        material("Gold", node="ShaderNodeBsdfGlossy", Color=(0.95, 0.7, 0.3), Roughness=0.25),
        material("Glass", node="ShaderNodeBsdfGlass", Color=1.0, Roughness=0.0, IOR=1.45),
        material("Coated", node="ShaderNodeBsdfPrincipled", Base_Color=(0.1, 0.3, 0.6), Clearcoat=1.0, Roughness=0.4),
    )
    for i, made in enumerate(kinds):
        smooth_monkey(made, (1.7 * i - 2.55, 0.4 * (i % 2), 0.8), 25 - 17 * i)
    light("AREA", 250, at=(-3, -3, 5), towards=(0, 0, 0.5), shape="RECTANGLE", size=2, size_y=1)
    light("POINT", 60, at=(3, -2.5, 2), color=(1, 0.8, 0.6), shadow_soft_size=0.2)
    light("SUN", 1.5, at=(2, -4, 5), angle=math.radians(4))
    camera((0, -8, 3.2), (0, 0, 0.7))


@scene(samples=640, block=0.1)
def room() -> None:
    # A room lit through its window and by a lamp, with wood, bricks and a mirror.
    sized()
    world((0.6, 0.75, 1.0), 2.0)
    wood = material("Wood")
    waves = node(wood, "ShaderNodeTexWave", Scale=1.2, Distortion=4.0, Detail=2.0)
    ramp = node(wood, "ShaderNodeValToRGB")
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.25, 0.12, 0.05, 1), (0.5, 0.3, 0.15, 1)
    link(wood, node(wood, "ShaderNodeTexCoord").outputs["Object"], waves.inputs["Vector"])
    link(wood, waves.outputs["Fac"], ramp.inputs["Fac"])
    link(wood, ramp.outputs[0], shader_of(wood).inputs["Color"])
    bricks = material("Bricks")
    pattern = node(bricks, "ShaderNodeTexBrick", Scale=2.5, Color1=(0.6, 0.3, 0.2), Color2=(0.45, 0.2, 0.15), Mortar=0.5)
    white = material("Plaster", Color=0.75)
    textured(bricks, pattern, "Color", coordinates="UV")
    primitive("plane", wood, size=6)
    primitive("plane", white, at=(0, 0, 3), turn=(180, 0, 0), size=6)
    primitive("plane", bricks, at=(0, 3, 1.5), turn=(90, 0, 0), scale=(1, 0.5, 1), size=6)
    primitive("plane", white, at=(3, 0, 1.5), turn=(0, -90, 0), scale=(0.5, 1, 1), size=6)
    for low, high, far in ((0, 0.8, 6), (2.3, 3, 6)):  # around the window, on the left
        primitive("plane", white, at=(-3, 0, (low + high) / 2), turn=(0, 90, 0), scale=((high - low) / far, 1, 1), size=far)
    for y in (-2.2, 2.2):
        primitive("plane", white, at=(-3, y, 1.55), turn=(0, 90, 0), scale=(0.9375, 1, 1), size=1.6)
    table = primitive("cube", material("Table", Color=(0.3, 0.25, 0.2)), at=(0.3, 0.6, 0.45), scale=(1.2, 0.8, 0.05), size=1)
    table.modifiers.new("Bevel", "BEVEL").width = 0.02
    primitive("uv_sphere", material("Ball", node="ShaderNodeBsdfGlossy", Color=0.9, Roughness=0.1), at=(0.1, 0.5, 0.78),
              radius=0.3, smooth=True, segments=64, ring_count=32)
    smooth_monkey(material("Clay", Color=(0.7, 0.4, 0.3)), (-1.2, 1.2, 0.6), 10)
    lamp = material("Lamp", node="ShaderNodeEmission", Color=(1, 0.8, 0.5), Strength=8.0)
    primitive("ico_sphere", lamp, at=(1.8, 1.5, 1.8), radius=0.2, subdivisions=3, smooth=True)
    camera((1.2, -2.9, 1.5), (-0.3, 1.5, 0.9), lens=24)


@scene(samples=192, block=0.1)
def wood() -> None:
    # Two kinds of trees by the hundred, on a ground that is displaced.
    sized()
    world((0.45, 0.6, 0.9))
    light("SUN", 3, at=(-4, -3, 5), color=(1, 0.9, 0.75), angle=math.radians(2))
    soil = material("Soil", Color=(0.25, 0.2, 0.12))
    set_of_cycles(soil, "displacement_method", "DISPLACEMENT")
    hills = node(soil, "ShaderNodeTexNoise", Scale=0.25, Detail=2.0)
    raised = node(soil, "ShaderNodeDisplacement", Midlevel=0.5, Scale=2.0)
    link(soil, node(soil, "ShaderNodeTexCoord").outputs["Object"], hills.inputs["Vector"])
    link(soil, hills.outputs["Fac"], raised.inputs["Height"])
    link(soil, raised.outputs[0], soil.node_tree.nodes["Material Output"].inputs["Displacement"])
    primitive("grid", soil, size=30, x_subdivisions=120, y_subdivisions=120, smooth=True)
    trees = bpy.data.collections.new("Trees")
    for i, color in enumerate(((0.1, 0.3, 0.08), (0.2, 0.35, 0.05))):
        crown = primitive("cone", material(f"Leaves{i}", Color=color), at=(0, 0, 1.3), radius1=0.5 - 0.1 * i, depth=1.6)
        stem = primitive("cylinder", material(f"Bark{i}", Color=(0.2, 0.12, 0.06)), at=(0, 0, 0.3), radius=0.08, depth=0.8)
        crown.select_set(True)
        stem.select_set(True)
        bpy.context.view_layer.objects.active = crown
        bpy.ops.object.join()
        crown.location.x += 100 * (i + 1)
        trees.objects.link(crown)
    field = primitive("grid", size=22, x_subdivisions=4, y_subdivisions=4)
    system = field.modifiers.new("Wood", "PARTICLE_SYSTEM").particle_system.settings
    system.type, system.count, system.render_type = "HAIR", 400, "COLLECTION"
    system.instance_collection, system.use_advanced_hair = trees, True
    system.particle_size, system.size_random, system.use_rotations = 0.8, 0.6, True
    system.rotation_mode, system.phase_factor_random = "GLOB_Z", 2.0
    field.show_instancer_for_render = False
    camera((0, -14, 5), (0, 0, 0.5), lens=32)


@scene(samples=640, block=0.1, complaints=("object 'Plate': its normals lean far from its faces",))
def machine() -> None:
    # Bevelled parts, text, pipes and a mesh of lamps, out of focus before and behind.
    sized()
    world((0.3, 0.3, 0.32))
    light("AREA", 400, at=(3, -4, 5), towards=(0, 0, 0.5), shape="DISK", size=2)
    floor(material("Bench", Color=(0.35, 0.38, 0.4)), size=30)
    steel = scattered_once(material("Steel", node="ShaderNodeBsdfGlossy", Color=(0.7, 0.72, 0.75), Roughness=0.35))
    body = primitive("cube", steel, at=(-0.6, 0.5, 0.6), scale=(1.8, 1, 1.2), size=1)
    body.modifiers.new("Bevel", "BEVEL").width = 0.08
    wheel = primitive("torus", material("Rubber", Color=0.06), at=(1.4, -0.4, 0.62), turn=(90, 0, 20), smooth=True,
                      major_radius=0.5, minor_radius=0.12)
    wheel.modifiers.new("Subdivision", "SUBSURF").render_levels = 1
    bolt = primitive("cylinder", steel, at=(-1.4, -0.05, 0.3), turn=(90, 0, 0), vertices=6, radius=0.06, depth=0.1)
    row = bolt.modifiers.new("Array", "ARRAY")
    row.count, row.use_relative_offset, row.use_constant_offset = 5, False, True
    row.constant_offset_displace = (0.3, 0, 0)
    bpy.ops.curve.primitive_bezier_curve_add(radius=1.2, location=(0.6, 1.2, 1.2), rotation=(0.4, 0, 0.2))
    bpy.context.object.data.bevel_depth = 0.08
    copper = material("Copper", node="ShaderNodeBsdfGlossy", Color=(0.9, 0.5, 0.35), Roughness=0.2)
    bpy.context.object.data.materials.append(scattered_once(copper))
    letters = bpy.data.curves.new("Plate", "FONT")
    letters.body, letters.extrude, letters.size = "HYADES", 0.03, 0.4
    letters.materials.append(material("Paint", Color=(0.8, 0.6, 0.1)))
    add(letters, at=(-1.35, -0.02, 0.65), turn=(90, 0, 0))
    shining = material("Lamps", node="ShaderNodeEmission", Color=(0.3, 1, 0.4), Strength=3.0)
    primitive("ico_sphere", shining, at=(-0.2, -1.2, 0.15), radius=0.12, subdivisions=2)
    object = camera((1.0, -5.5, 1.9), (-0.2, 0, 0.6), lens=50)
    dof = object.data.dof
    dof.use_dof, dof.focus_distance, dof.aperture_fstop, dof.aperture_blades = True, 5.4, 0.2, 6


@scene(samples=128, block=1.0)  # single bright pixels of Cycles in the dark
def fog() -> None:
    # A lamp of a street and windows in a thin fog that fills all space.
    sized(80, 60)  # Cycles takes long with what fills all space
    floor(material("Street", Color=0.2), size=40)
    house = primitive("cube", material("House", Color=(0.4, 0.35, 0.3)), at=(2.2, 2.5, 1.5), scale=(2, 2, 3), size=1)
    house.modifiers.new("Bevel", "BEVEL").width = 0.05
    panes = material("Panes", node="ShaderNodeEmission", Color=(1, 0.7, 0.3), Strength=4.0)
    for x in (1.7, 2.7):
        primitive("plane", panes, at=(x, 1.47, 1.9), turn=(90, 0, 0), size=0.5)
    primitive("cylinder", material("Iron", Color=0.1), at=(-1.5, 0.5, 1.2), radius=0.05, depth=2.4)
    light("AREA", 120, at=(-1.5, 0.2, 2.6), towards=(-1.5, 0.2, 0), color=(1, 0.85, 0.6), shape="DISK", size=0.6)
    # Not another body of fog: where it overlaps with that of the world Cycles shows it twice as bright (docs/blender.md).
    primitive("uv_sphere", material("Clay", Color=(0.6, 0.3, 0.2)), at=(0.2, 0, 0.6), radius=0.6, smooth=True)
    nodes = world(0.0)
    nodes.nodes.remove(nodes.nodes["Background"])
    thin = node(nodes, "ShaderNodeVolumeScatter", Color=(0.85, 0.85, 0.9), Density=0.02)
    link(nodes, thin.outputs[0], nodes.nodes["World Output"].inputs["Volume"])
    camera((0, -7, 1.7), (0, 1, 1.2), lens=30)
