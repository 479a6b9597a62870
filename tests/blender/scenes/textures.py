"""Textures and the nodes that change them, on a board that shines by what they say."""

import math
import os
import tempfile

import bpy
import numpy
from scene import camera, light, link, material, node, primitive, said, scene, shader_of, world


def board(kind: str, output: str | int = 0, coordinates: str | None = "UV", scale=(1.0, 1.0, 1.0), properties=None, **inputs):
    """A texture on an upright board. Returns its material and node."""
    made = material(node="ShaderNodeEmission")
    texture = made.node_tree.nodes.new(kind)
    for name, value in (properties or {}).items():
        setattr(texture, name, value)
    said(texture, **inputs)
    if coordinates is not None:
        place = node(made, "ShaderNodeTexCoord")
        moved = node(made, "ShaderNodeMapping", Scale=scale, Location=(0.1, 0.05, 0.2), Rotation=(0.0, 0.0, 0.3))
        link(made, place.outputs[coordinates], moved.inputs["Vector"])
        link(made, moved.outputs[0], texture.inputs["Vector"])
    link(made, texture.outputs[output], shader_of(made).inputs["Color"])
    hang(made)
    return made, texture


def hang(made) -> None:
    """Two boards: one before the camera, one that is seen from the side."""
    primitive("plane", made, at=(-0.8, 0, 0), turn=(90, 0, 0), size=2.2)
    primitive("cube", made, at=(1.4, 0.4, 0), turn=(20, 10, 35), size=1.3)
    camera((0, -4, 0), (0, 0, 0))


def picture(columns: int = 8, rows: int = 6, square: int = 24):
    """A picture of coloured squares. They are large: Cycles mixes codes of sRGB where it looks between two pixels, Hyades light."""
    colors = numpy.ones((rows, columns, 4), "float32")
    colors[:, :, 0] = numpy.linspace(0, 1, columns)
    colors[:, :, 1] = numpy.linspace(0, 1, rows)[:, None]
    colors[:, :, 2] = 0.25 + 0.5 * (numpy.add.outer(numpy.arange(rows), numpy.arange(columns)) % 2)
    image = bpy.data.images.new("Squares", columns * square, rows * square)
    image.pixels.foreach_set(colors.repeat(square, 0).repeat(square, 1).reshape(-1))
    image.update()
    image.pack()
    return image


@scene(samples=64)
def image() -> None:
    board("ShaderNodeTexImage", scale=(2.0, 1.5, 1.0), properties={"image": picture()})


@scene(samples=64)
def colors_as_numbers() -> None:
    """A link from a colour to a number takes its luminance, of which the strength is what is left above a number."""
    made, texture = board("ShaderNodeTexImage", properties={"image": picture(), "interpolation": "Closest"})
    most = node(made, "ShaderNodeMath")
    most.operation = "MAXIMUM"
    link(made, texture.outputs["Color"], most.inputs[0])
    most.inputs[1].default_value = 0.4
    link(made, most.outputs[0], shader_of(made).inputs["Strength"])


@scene(samples=64)
def image_of_floats() -> None:
    made = bpy.data.images.new("Light", 8, 8, float_buffer=True)
    made.pixels.foreach_set([0.2 + 0.1 * (i % 7) if i % 4 < 3 else 1.0 for i in range(8 * 8 * 4)])
    board("ShaderNodeTexImage", properties={"image": made, "extension": "EXTEND", "interpolation": "Closest"})


@scene(samples=64)
def image_of_a_sequence() -> None:
    folder = tempfile.mkdtemp()
    for number in (1, 2, 3):
        made = bpy.data.images.new(f"One{number}", 8, 8)
        made.generated_color = (0.3 * number, 0.2, 0.1, 1)
        made.filepath_raw, made.file_format = os.path.join(folder, f"a{number:04}.png"), "PNG"
        made.save()
    _, texture = board("ShaderNodeTexImage")
    texture.image = bpy.data.images.load(os.path.join(folder, "a0001.png"))
    texture.image.source = "SEQUENCE"
    texture.image_user.frame_duration, texture.image_user.frame_start = 3, 1
    texture.image_user.use_auto_refresh = True
    bpy.context.scene.frame_set(3)


def through(mode: str, kind: str, packed: bool, asked: bool) -> None:
    """A picture from a file of PNG or OPEN_EXR, whose left half lets 0.6 through, and whether a shader asks for that."""
    colors = numpy.ones((64, 64, 4), "float32")
    colors[:] = (0.8, 0.4, 0.5, 1)
    colors[:32, :, 1] = 0.7
    colors[:, :32, 3] = 0.4
    file = bpy.data.images.new("Leaf", 64, 64, alpha=True, float_buffer=kind == "OPEN_EXR")
    file.pixels.foreach_set(colors.reshape(-1))
    file.filepath_raw, file.file_format = os.path.join(tempfile.mkdtemp(), "leaf" + {"PNG": ".png"}.get(kind, ".exr")), kind
    file.save()
    image = bpy.data.images.load(file.filepath_raw)
    image.alpha_mode = mode
    if packed:
        image.pack()
    made, texture = board("ShaderNodeTexImage", properties={"image": image, "extension": "EXTEND", "interpolation": "Closest"})
    if not asked:
        return
    both = node(made, "ShaderNodeMixShader")
    link(made, texture.outputs["Alpha"], both.inputs[0])
    link(made, node(made, "ShaderNodeBsdfTransparent").outputs[0], both.inputs[1])
    link(made, shader_of(made).outputs[0], both.inputs[2])
    link(made, both.outputs[0], made.node_tree.nodes["Material Output"].inputs["Surface"])


@scene(samples=64)
def alpha_of_bytes() -> None:
    through("STRAIGHT", "PNG", packed=False, asked=False)


@scene(samples=64)
def alpha_of_packed_bytes() -> None:
    through("PREMUL", "PNG", packed=True, asked=True)


@scene(samples=64)
def alpha_of_light() -> None:
    through("PREMUL", "OPEN_EXR", packed=False, asked=True)


@scene(samples=64)
def alpha_of_packed_light() -> None:
    through("STRAIGHT", "OPEN_EXR", packed=True, asked=False)


@scene(samples=64, block=0.07)
def alpha_from_afar() -> None:
    # Pixels of the picture see many of the texture, inside the disc and outside.
    y, x = numpy.mgrid[0:256, 0:256] / 16 % 1 - 0.5
    colors = numpy.ones((256, 256, 4), "float32")
    colors[..., :3], colors[..., 3] = (0.2, 0.5, 0.1), x * x + y * y < 0.16
    image = bpy.data.images.new("Discs", 256, 256, alpha=True)
    image.pixels.foreach_set(colors.reshape(-1))
    image.pack()
    made, _ = board("ShaderNodeTexImage", properties={"image": image})
    diffuse = node(made, "ShaderNodeBsdfDiffuse")
    link(made, made.node_tree.nodes["Image Texture"].outputs["Color"], diffuse.inputs["Color"])
    link(made, diffuse.outputs[0], made.node_tree.nodes["Material Output"].inputs["Surface"])
    world(1)


@scene(samples=64)
def mapping_of_its_own() -> None:
    _, texture = board("ShaderNodeTexNoise", Scale=3.0)
    own = texture.texture_mapping
    own.translation, own.rotation, own.scale = (0.2, 0.1, 0.3), (0.3, 0.2, 0.4), (1.5, 2.0, 1.0)
    own.mapping_x, own.mapping_y, own.mapping_z = "Z", "X", "Y"


@scene(samples=64)
def mapping_of_a_checker() -> None:
    _, texture = board("ShaderNodeTexChecker", Scale=3.0)
    own = texture.texture_mapping
    own.vector_type, own.translation, own.rotation = "TEXTURE", (0.2, 0.1, 0.0), (0.0, 0.0, 0.4)


def projected(projection: str, blend: float = 0.0) -> None:
    """A ball with a picture that is laid on it by its generated coordinates."""
    made = material(node="ShaderNodeEmission")
    texture = node(made, "ShaderNodeTexImage")
    texture.image, texture.projection, texture.projection_blend = picture(), projection, blend
    link(made, node(made, "ShaderNodeTexCoord").outputs["Generated"], texture.inputs["Vector"])
    link(made, texture.outputs["Color"], shader_of(made).inputs["Color"])
    primitive("uv_sphere", made, turn=(20, 10, 30), radius=1.2, segments=48, ring_count=24, smooth=True)
    camera((0, -4, 0), (0, 0, 0))


@scene(samples=64)
def image_on_a_box() -> None:
    projected("BOX", 0.3)


@scene(samples=64)
def image_on_a_sharp_box() -> None:
    projected("BOX")


@scene(samples=64)
def image_on_a_sphere() -> None:
    projected("SPHERE")


@scene(samples=64)
def image_on_a_tube() -> None:
    projected("TUBE")


@scene(samples=64)
def checker() -> None:
    board("ShaderNodeTexChecker", coordinates="Object", Scale=3.0, Color1=(0.9, 0.2, 0.1), Color2=(0.1, 0.3, 0.8))


@scene(samples=64)
def checker_generated() -> None:
    board("ShaderNodeTexChecker", coordinates=None, Scale=5.0, Color1=(0.9, 0.2, 0.1), Color2=(0.1, 0.3, 0.8))


@scene(samples=64)
def noise() -> None:
    board("ShaderNodeTexNoise", output="Color", coordinates="Generated", Scale=4.0, Detail=3.5, Roughness=0.6, Distortion=0.4)


@scene(samples=64)
def noise_flat() -> None:
    board("ShaderNodeTexNoise", properties={"noise_dimensions": "2D"}, Scale=6.0, Detail=2.0)


@scene(samples=64)
def noise_in_time() -> None:
    board("ShaderNodeTexNoise", coordinates="Object", properties={"noise_dimensions": "4D"}, output="Color", Scale=2.0, W=1.7)


@scene(samples=64)
def voronoi() -> None:
    board("ShaderNodeTexVoronoi", output="Color", coordinates="Object", Scale=3.0, Randomness=0.9)


@scene(samples=64)
def voronoi_f2() -> None:
    board("ShaderNodeTexVoronoi", coordinates="Object", Scale=3.0,
          properties={"feature": "F2", "distance": "MANHATTAN", "voronoi_dimensions": "2D"})


@scene(samples=64)
def voronoi_edges() -> None:
    board("ShaderNodeTexVoronoi", coordinates="Object", Scale=3.0, properties={"feature": "DISTANCE_TO_EDGE"})


@scene(samples=64)
def voronoi_smooth() -> None:
    board("ShaderNodeTexVoronoi", output="Color", coordinates="Object", Scale=3.0, Smoothness=0.7, properties={"feature": "SMOOTH_F1"})


@scene(samples=64)
def wave() -> None:
    board("ShaderNodeTexWave", coordinates="Object", properties={"bands_direction": "DIAGONAL"}, Scale=1.5, Distortion=3.0, Detail=2.0)


@scene(samples=64)
def rings() -> None:
    board("ShaderNodeTexWave", coordinates="Object", properties={"wave_type": "RINGS", "wave_profile": "SAW"}, Scale=1.0)


@scene(samples=64)
def magic() -> None:
    board("ShaderNodeTexMagic", coordinates="Object", properties={"turbulence_depth": 4}, Scale=2.0, Distortion=1.3)


@scene(samples=64)
def brick() -> None:
    board("ShaderNodeTexBrick", Scale=4.0, Color1=(0.8, 0.3, 0.2), Color2=(0.5, 0.1, 0.1), Mortar=(0.2, 0.2, 0.2), Mortar_Size=0.03)


@scene(samples=64)
def gradient() -> None:
    board("ShaderNodeTexGradient", coordinates="Object", properties={"gradient_type": "RADIAL"})


@scene(samples=64)
def ramp() -> None:
    made, texture = board("ShaderNodeTexGradient", coordinates="UV")
    colors = node(made, "ShaderNodeValToRGB")
    colors.color_ramp.elements.new(0.4).color = (0.9, 0.1, 0.1, 1)
    colors.color_ramp.interpolation = "EASE"
    link(made, texture.outputs["Fac"], colors.inputs["Fac"])
    link(made, colors.outputs[0], shader_of(made).inputs["Color"])


@scene(samples=64)
def mixed_colors() -> None:
    made, texture = board("ShaderNodeTexImage", properties={"image": picture()})
    mix = node(made, "ShaderNodeMix")
    mix.data_type, mix.blend_type = "RGBA", "MULTIPLY"
    mix.inputs[0].default_value = 0.7
    mix.inputs[7].default_value = (0.9, 0.5, 0.3, 1)
    link(made, texture.outputs["Color"], mix.inputs[6])
    link(made, mix.outputs[2], shader_of(made).inputs["Color"])


@scene(samples=64)
def changed_colors() -> None:
    # Hue, brightness, gamma, curves and inversion behind each other: more than the job's textures say.
    made, texture = board("ShaderNodeTexImage", properties={"image": picture()})
    end = texture.outputs["Color"]
    curves = node(made, "ShaderNodeRGBCurve")
    curves.mapping.curves[3].points.new(0.4, 0.6)
    steps = [node(made, "ShaderNodeHueSaturation", Hue=0.6, Saturation=0.8, Value=0.9, Fac=0.9),
             node(made, "ShaderNodeBrightContrast", Bright=0.05, Contrast=0.2), node(made, "ShaderNodeGamma", Gamma=1.4),
             curves, node(made, "ShaderNodeInvert", Fac=0.8)]
    for step in steps:
        link(made, end, step.inputs["Color"])
        end = step.outputs["Color"]
    link(made, end, shader_of(made).inputs["Color"])


@scene(samples=64)
def computed() -> None:
    # sin(20 x) * y of the coordinates, brought into another range, as a saturation.
    made, texture = board("ShaderNodeSeparateXYZ", coordinates="UV")
    wave = node(made, "ShaderNodeMath")
    wave.operation = "SINE"
    factor = node(made, "ShaderNodeMath")
    factor.operation, factor.inputs[1].default_value = "MULTIPLY", 20.0
    product = node(made, "ShaderNodeMath")
    product.operation = "MULTIPLY"
    ranged = node(made, "ShaderNodeMapRange", From_Min=-1.0, To_Min=0.1, To_Max=0.9)
    combined = node(made, "ShaderNodeCombineColor", Green=0.7, Blue=0.6)
    combined.mode = "HSV"
    link(made, texture.outputs["X"], factor.inputs[0])
    link(made, factor.outputs[0], wave.inputs[0])
    link(made, wave.outputs[0], product.inputs[0])
    link(made, texture.outputs["Y"], product.inputs[1])
    link(made, product.outputs[0], ranged.inputs["Value"])
    link(made, ranged.outputs[0], combined.inputs[0])
    link(made, combined.outputs[0], shader_of(made).inputs["Color"])


@scene(samples=64)
def vertex_colors() -> None:
    made = material(node="ShaderNodeEmission")
    color = node(made, "ShaderNodeVertexColor")
    color.layer_name = "Paint"
    link(made, color.outputs["Color"], shader_of(made).inputs["Color"])
    board = primitive("grid", made, turn=(90, 0, 0), size=3, x_subdivisions=7, y_subdivisions=5)
    paint = board.data.color_attributes.new("Paint", "FLOAT_COLOR", "CORNER")
    for i, corner in enumerate(paint.data):
        corner.color = (0.2 + 0.1 * (i % 8), 0.8 - 0.1 * (i % 5), 0.1 * (i % 9), 1)
    camera((0, -4, 0), (0, 0, 0))


def of_edges(kind: str) -> None:
    """A board that shows what its edges say: numbers that Cycles hands to vertices."""
    made = material(node="ShaderNodeEmission")
    said_by = node(made, "ShaderNodeAttribute")
    said_by.attribute_name = "Said"
    link(made, said_by.outputs["Color"], shader_of(made).inputs["Color"])
    mesh = primitive("grid", made, turn=(90, 0, 0), size=3, x_subdivisions=7, y_subdivisions=5).data
    numbers = numpy.random.default_rng(1).random(len(mesh.edges))
    mesh.attributes.new("Said", kind, "EDGE").data.foreach_set("value", numbers if kind == "FLOAT" else numbers > 0.5)
    camera((0, -4, 0), (0, 0, 0))


@scene(samples=64)
def numbers_of_edges() -> None:
    of_edges("FLOAT")


@scene(samples=64)
def switches_of_edges() -> None:
    of_edges("BOOLEAN")


@scene(samples=64)
def normals_of_faces() -> None:
    # True Normal is that of a face, however smooth it looks.
    made = material(node="ShaderNodeEmission")
    bright = node(made, "ShaderNodeVectorMath")
    bright.operation = "ABSOLUTE"
    link(made, node(made, "ShaderNodeNewGeometry").outputs["True Normal"], bright.inputs[0])
    link(made, bright.outputs[0], shader_of(made).inputs["Color"])
    primitive("ico_sphere", made, subdivisions=2, smooth=True, radius=1.4)
    camera((0, -6, 0), (0, 0, 0))


@scene(samples=64)
def glowing_colors() -> None:
    # Black bodies from 600 to 3000 K, side by side.
    made = material(node="ShaderNodeEmission", Strength=0.3)
    place, heat = node(made, "ShaderNodeSeparateXYZ"), node(made, "ShaderNodeMath")
    heat.operation = "MULTIPLY_ADD"
    heat.inputs[1].default_value, heat.inputs[2].default_value = 2400, 600
    body = node(made, "ShaderNodeBlackbody")
    link(made, node(made, "ShaderNodeTexCoord").outputs["UV"], place.inputs[0])
    link(made, place.outputs["X"], heat.inputs[0])
    link(made, heat.outputs[0], body.inputs[0])
    link(made, body.outputs[0], shader_of(made).inputs["Color"])
    hang(made)


@scene(samples=64)
def second_uv_map() -> None:
    made, texture = board("ShaderNodeTexImage", coordinates=None, properties={"image": picture(), "interpolation": "Closest"})
    other = node(made, "ShaderNodeUVMap")
    other.uv_map = "Other"
    link(made, other.outputs[0], texture.inputs["Vector"])
    for object in bpy.data.objects:
        if object.type == "MESH":
            layer = object.data.uv_layers.new(name="Other")
            for i, corner in enumerate(layer.data):
                corner.uv = (0.3 * (i % 4), 0.2 * (i % 3))


@scene(samples=128, block=0.08)
def bump() -> None:
    made = material(node="ShaderNodeBsdfDiffuse", Color=0.8)
    wave = node(made, "ShaderNodeTexImage")
    image = bpy.data.images.new("Heights", 64, 64, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    values = [0.5 + 0.5 * math.sin(2 * math.pi * x / 32) for _ in range(64) for x in range(64)]
    image.pixels.foreach_set([channel for value in values for channel in (value, value, value, 1.0)])
    wave.image = image
    bump = node(made, "ShaderNodeBump", Strength=1.0, Distance=0.2)
    link(made, wave.outputs["Color"], bump.inputs["Height"])
    link(made, bump.outputs[0], shader_of(made).inputs["Normal"])
    lit_board(made)


@scene(samples=128)
def normal_map() -> None:
    made = material(node="ShaderNodeBsdfDiffuse", Color=0.8)
    texture = node(made, "ShaderNodeTexImage")
    image = bpy.data.images.new("Normals", 2, 2, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set([0.7, 0.5, 0.9, 1, 0.5, 0.7, 0.9, 1, 0.3, 0.5, 0.9, 1, 0.5, 0.3, 0.9, 1])
    texture.image, texture.interpolation = image, "Closest"
    turned = node(made, "ShaderNodeNormalMap", Strength=0.8)
    link(made, texture.outputs["Color"], turned.inputs["Color"])
    link(made, turned.outputs[0], shader_of(made).inputs["Normal"])
    lit_board(made)


def lit_board(made) -> None:
    """A board with a lamp from the side."""
    primitive("plane", made, turn=(90, 0, 0), size=4)
    camera((0, -4, 0), (0, 0, 0))
    light("SUN", 3, at=(3, -4, 2), angle=0)


@scene(samples=128)
def weak_bump() -> None:
    """Steep hills, of which normals take a tenth."""
    made = material(node="ShaderNodeBsdfDiffuse", Color=0.8)
    bump = node(made, "ShaderNodeBump", Strength=0.1, Distance=4.0)
    noise = node(made, "ShaderNodeTexNoise", Scale=4.0)
    link(made, node(made, "ShaderNodeTexCoord").outputs["Object"], noise.inputs["Vector"])
    link(made, noise.outputs[0], bump.inputs["Height"])
    link(made, bump.outputs[0], shader_of(made).inputs["Normal"])
    lit_board(made)


@scene(samples=64)
def numbers_below_nothing() -> None:
    """What is below 0 on the way and above it in the end."""
    made, checker = board("ShaderNodeTexChecker", Scale=3.0, Color1=(0.9, 0.9, 0.9), Color2=(0.4, 0.4, 0.4))
    twice, rest, more = (node(made, "ShaderNodeMath") for _ in range(3))
    twice.operation, rest.operation = "MULTIPLY", "SUBTRACT"
    twice.inputs[1].default_value, rest.inputs[0].default_value, more.inputs[1].default_value = 2.0, 1.0, 0.8
    link(made, checker.outputs["Color"], twice.inputs[0])
    link(made, twice.outputs[0], rest.inputs[1])
    link(made, rest.outputs[0], more.inputs[0])
    link(made, more.outputs[0], shader_of(made).inputs["Color"])
