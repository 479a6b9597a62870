"""Meshes after their modifiers, their normals, materials per face, and copies."""

import math

import bpy
from scene import add, camera, floor, light, link, material, node, primitive, scattered_once, scene, set_of_cycles
from scene import shader_of, sharpen, world


def lit() -> None:
    """Ground and light."""
    floor()
    world((0.3, 0.35, 0.4))
    light("SUN", 2, at=(3, -3, 4), angle=math.radians(5))


@scene(samples=128)
def subdivided_monkey() -> None:
    lit()
    monkey = primitive("monkey", material(Color=(0.7, 0.5, 0.2)), at=(0, 0, 1), smooth=True, size=2)
    monkey.modifiers.new("Subdivision", "SUBSURF").render_levels = 2


@scene(samples=128)
def modified() -> None:
    lit()
    body = primitive("cube", material(Color=(0.2, 0.6, 0.5)), at=(-1.2, 0, 0.6), size=1)
    body.modifiers.new("Bevel", "BEVEL").width = 0.15
    array = body.modifiers.new("Array", "ARRAY")
    array.count = 3
    array.relative_offset_displace = (1.3, 0.2, 0)
    body.modifiers.new("Hidden", "DECIMATE").show_render = False


@scene(samples=128)
def automatic_smooth() -> None:
    # Edges of more than 30 degrees stay sharp, of less are smooth.
    lit()
    body = primitive("cylinder", material(Color=0.7), at=(0, 0, 1), turn=(30, 0, 20), smooth=True, vertices=24)
    if bpy.app.version < (4, 1):
        body.data.use_auto_smooth, body.data.auto_smooth_angle = True, math.radians(30)
    else:
        body.data.set_sharp_from_angle(angle=math.radians(30))


@scene(samples=128)
def flat_and_smooth() -> None:
    lit()
    body = primitive("uv_sphere", material(Color=0.7), at=(0, 0, 1), segments=12, ring_count=8)
    body.data.polygons.foreach_set("use_smooth", [i % 3 > 0 for i in range(len(body.data.polygons))])


@scene(samples=128)
def materials_per_face() -> None:
    lit()
    body = primitive("ico_sphere", material("Red", Color=(0.8, 0.1, 0.1)), at=(0, 0, 1), subdivisions=2)
    body.data.materials.append(material("Blue", Color=(0.1, 0.2, 0.8)))
    body.data.materials.append(material("Lamp", node="ShaderNodeEmission", Strength=2.0))
    body.data.polygons.foreach_set("material_index", [i % 3 for i in range(len(body.data.polygons))])


@scene(samples=128, block=0.08)  # large triangles that are shaded smoothly: at the shadow's edge each has its own remedy
def mirrored_and_stretched() -> None:
    lit()
    paint = material(Color=(0.6, 0.4, 0.7))
    primitive("monkey", paint, at=(-1.2, 0, 1), scale=(-1, 1, 1), smooth=True)
    primitive("monkey", paint, at=(1.2, 0, 1), turn=(10, 20, 30), scale=(0.7, 1.3, -0.9), smooth=True)


def move_into(collection, body) -> None:
    for parent in body.users_collection:
        parent.objects.unlink(body)
    collection.objects.link(body)


@scene(samples=128)
def instanced_collection() -> None:
    lit()
    paint = material(Color=(0.3, 0.6, 0.3))
    collection = bpy.data.collections.new("Pair")
    for x in (-0.4, 0.4):
        body = primitive("ico_sphere", paint, at=(x, 0, 0.4), radius=0.35, subdivisions=3, smooth=True)
        move_into(collection, body)
    for i in range(5):
        empty = add(None, f"Place{i}", at=(1.8 * i - 3.6, i % 2, 0), turn=(0, 0, 40 * i), scale=(1, 1, 0.7 + 0.2 * i))
        empty.instance_type, empty.instance_collection = "COLLECTION", collection


def row_of_copies(made):
    """Cubes by collections on a row of empties, which are returned."""
    lit()
    collection = bpy.data.collections.new("One")
    move_into(collection, primitive("cube", made, at=(0, 0, 0.35), size=0.7))
    empties = [add(None, f"Place{i}", at=(1.4 * i - 2.8, i % 2, 0), turn=(0, 0, 20 * i)) for i in range(5)]
    for empty in empties:
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
    return empties


@scene(samples=128)
def copies_of_random_colors() -> None:
    made = material()
    info, ramp = node(made, "ShaderNodeObjectInfo"), node(made, "ShaderNodeValToRGB")
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.8, 0.1, 0.1, 1), (0.1, 0.2, 0.9, 1)
    link(made, info.outputs["Random"], ramp.inputs["Fac"])
    link(made, ramp.outputs[0], shader_of(made).inputs["Color"])
    row_of_copies(made)


@scene(samples=128)
def copies_colored_by_their_instancer() -> None:
    made = material()
    tint = node(made, "ShaderNodeAttribute")
    tint.attribute_type, tint.attribute_name = "INSTANCER", "tint"
    link(made, tint.outputs["Color"], shader_of(made).inputs["Color"])
    for i, empty in enumerate(row_of_copies(made)):
        empty["tint"] = [0.1 + 0.2 * i, 0.8 - 0.15 * i, 0.2]


@scene(samples=128)
def particles() -> None:
    lit()
    leaf = primitive("cone", material("Leaf", Color=(0.3, 0.6, 0.2)), at=(0, 0, -20), radius1=0.15, depth=0.4)
    ground = primitive("grid", material("Ground", Color=0.4), size=5)
    ground.location.z = 0.05
    system = ground.modifiers.new("Leaves", "PARTICLE_SYSTEM").particle_system.settings
    system.type, system.count, system.render_type = "HAIR", 300, "OBJECT"
    system.instance_object, system.particle_size, system.use_advanced_hair = leaf, 1.0, True


@scene(samples=128)
def on_vertices() -> None:
    lit()
    small = primitive("uv_sphere", material("Dot", Color=(0.8, 0.5, 0.1)), radius=0.2, segments=16, ring_count=8, smooth=True)
    frame = primitive("ico_sphere", at=(0, 0, 1.2), radius=1.0, subdivisions=2)
    small.parent, frame.instance_type = frame, "VERTS"


@scene(samples=128)
def hidden() -> None:
    # Neither what is not rendered nor what no camera sees is there; the shadow of the latter is.
    lit()
    primitive("cube", material(Color=0.5), at=(-1.5, 0, 1)).hide_render = True
    primitive("cube", material(Color=0.5), at=(1.5, 0, 1)).visible_camera = False


@scene(samples=128)
def hidden_from_some_rays() -> None:
    # Lamps without a size, which no ray meets: of others Cycles weighs both ways to find them as if the same things
    # stopped rays of each.
    floor()
    light("POINT", 250, at=(2, -3, 4), shadow_soft_size=0)
    light("POINT", 250, at=(-3, -3, 3), shadow_soft_size=0, color=(0.6, 0.8, 1)).visible_glossy = False
    primitive("plane", material("Roof", Color=(0.8, 0.6, 0.1)), at=(-1.9, -0.5, 1.3), size=1.4).visible_shadow = False
    primitive("cube", material("Red", Color=(0.8, 0.1, 0.1)), at=(-0.4, 0.4, 0.6), size=1.2).visible_diffuse = False
    steel = material("Steel", "ShaderNodeBsdfGlossy", Color=0.8, Roughness=0.4)
    primitive("uv_sphere", scattered_once(steel), at=(1.2, 0, 0.6), radius=0.6, smooth=True)
    primitive("cube", material("Green", Color=(0.1, 0.7, 0.2)), at=(2.3, 0.3, 0.4), size=0.8).visible_glossy = False
    primitive("cube", material("Hole", Color=0.7), at=(0.4, -1.4, 0.25), turn=(0, 0, 30), size=0.5).is_holdout = True
    mirror = material("Mirror", "ShaderNodeBsdfGlossy", Color=0.9, Roughness=0.0)
    sharpen(mirror)
    primitive("plane", mirror, at=(0, 2.2, 1.2), turn=(90, 0, 0), size=1, scale=(6, 2.4, 1))


@scene(samples=128, complaints=("object 'Text': its normals lean far from its faces",))
def curve_and_text() -> None:
    lit()
    paint = material(Color=(0.7, 0.3, 0.2))
    bpy.ops.curve.primitive_bezier_circle_add(radius=1.2, location=(0, 0, 1), rotation=(1.2, 0, 0.3))
    bpy.context.object.data.bevel_depth = 0.2
    bpy.context.object.data.materials.append(paint)
    text = bpy.data.curves.new("Text", "FONT")
    text.body, text.extrude, text.size = "Hy", 0.1, 1.2
    text.materials.append(paint)
    add(text, at=(-0.8, -0.5, 0.6), turn=(90, 0, 0))


@scene(samples=128, complaints=("object 'Text': its normals lean far from its faces",))
def text_that_glows() -> None:
    lit()
    text = bpy.data.curves.new("Text", "FONT")
    text.body, text.extrude, text.size = "Hy", 0.1, 1.2
    text.materials.append(material("Neon", "ShaderNodeEmission", Color=(1, 0.3, 0.1), Strength=3.0))
    add(text, at=(-0.8, -0.5, 0.6), turn=(90, 0, 0))


@scene(samples=64)
def color_by_object() -> None:
    # One material, whose colour is that of each object.
    made = material(node="ShaderNodeEmission")
    link(made, node(made, "ShaderNodeObjectInfo").outputs["Color"], made.node_tree.nodes["Emission"].inputs["Color"])
    for x, color in ((-1.2, (0.8, 0.1, 0.1, 1)), (1.2, (0.1, 0.3, 0.8, 1))):
        primitive("cube", made, at=(x, 0, 0.5), size=1).color = color
    camera((0, -6, 2.5), (0, 0, 0.5))


@scene(samples=64)
def random_by_object() -> None:
    # As random as each object's name.
    made = material(node="ShaderNodeEmission")
    link(made, node(made, "ShaderNodeObjectInfo").outputs["Random"], made.node_tree.nodes["Emission"].inputs["Color"])
    for number, name in enumerate(("Cube", "Würfel", "Cube.007")):
        primitive("cube", made, at=(1.6 * number - 1.6, 0, 0.5), size=1).name = name
    camera((0, -6, 2.5), (0, 0, 0.5))


def displaced_grid(method: str, scale: float, cuts: int):
    made = material(Color=(0.6, 0.5, 0.3))
    set_of_cycles(made, "displacement_method", method)
    noise = node(made, "ShaderNodeTexNoise", Scale=1.5, Detail=1.0)
    moved = node(made, "ShaderNodeDisplacement", Midlevel=0.4, Scale=scale)
    link(made, node(made, "ShaderNodeTexCoord").outputs["Object"], noise.inputs["Vector"])
    link(made, noise.outputs["Fac"], moved.inputs["Height"])
    link(made, moved.outputs[0], made.node_tree.nodes["Material Output"].inputs["Displacement"])
    return primitive("grid", made, at=(0, 0, 0.6), size=4, x_subdivisions=cuts, y_subdivisions=cuts, smooth=True)


@scene(samples=128)
def displaced() -> None:
    lit()
    displaced_grid("DISPLACEMENT", 1.5, 60)


@scene(samples=128, block=0.08)
def displaced_in_looks() -> None:
    lit()
    displaced_grid("BUMP", 0.4, 4)


@scene(samples=128)
def displaced_along_sharp_edges() -> None:
    # Cycles tears them apart.
    lit()
    made = displaced_grid("DISPLACEMENT", 0.5, 2).data.materials[0]
    bpy.context.object.hide_render = True
    block = primitive("cube", made, at=(0, 0, 1.3), size=1.6)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=6)
    bpy.ops.object.mode_set(mode="OBJECT")
    mesh = block.data
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    if bpy.app.version < (4, 1):
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.radians(40)
    else:
        mesh.set_sharp_from_angle(angle=math.radians(40))
