"""Shaders, between a floor and a world, below an area light."""

import pathlib
import tempfile

import bpy
import numpy
import vdb_file
from scene import add, camera, floor, light, link, material, node, primitive, scene, shader_of, sharpen, world


def ball(made, kind: str = "uv_sphere"):
    """A ball of a material on the floor."""
    floor()
    world((0.3, 0.35, 0.4))
    light("AREA", 150, at=(2, -2, 4), towards=(0, 0, 0.5), shape="SQUARE", size=2)
    if kind == "uv_sphere":
        return primitive(kind, made, at=(0, 0, 1), smooth=True, segments=96, ring_count=48)
    return primitive(kind, made, at=(0, 0, 1.05))  # not quite on the floor, where faces would fight


# Until 3.6 the Principled BSDF is another model: Disney's diffuse lobe, and facets that do not share light with what is below.
@scene(mean=0.02, block=0.1)
def principled_matt() -> None:
    ball(material(node="ShaderNodeBsdfPrincipled", Base_Color=(0.7, 0.3, 0.1), Roughness=0.6))


@scene(mean=0.02, block=0.08)
def principled_metal() -> None:
    ball(material(node="ShaderNodeBsdfPrincipled", Base_Color=(0.9, 0.6, 0.2), Metallic=1.0, Roughness=0.25))


@scene(mean=0.02, block=0.06)
def principled_glass() -> None:
    ball(material(node="ShaderNodeBsdfPrincipled", Base_Color=1.0, Transmission=1.0, Roughness=0.0, IOR=1.45))


@scene(mean=0.02, block=0.06)
def principled_tinted_glass() -> None:
    keys = {"Transmission": 1.0, "Roughness": 0.0, "IOR": 1.45}
    ball(material(node="ShaderNodeBsdfPrincipled", Base_Color=(0.4, 0.7, 0.9), **keys))


@scene(mean=0.05, block=0.08)
def principled_room() -> None:
    # All light comes from walls, many times over: what a surface keeps of it counts several times.
    primitive("cube", material("Walls", "ShaderNodeBsdfPrincipled", Base_Color=0.7, Roughness=0.5), at=(0, 0, 2), size=14)
    light("AREA", 400, at=(0, -1, 6), towards=(0, -1, 0), size=1)
    world(0)


@scene(mean=0.02, block=0.1)
def principled_coat() -> None:
    ball(material(node="ShaderNodeBsdfPrincipled", Base_Color=(0.2, 0.05, 0.3), Clearcoat=1.0, Roughness=0.5))


@scene()
def principled_emission() -> None:
    ball(material(node="ShaderNodeBsdfPrincipled", Base_Color=0.0, Specular=0.0, Emission=(1, 0.5, 0.2), Emission_Strength=2.0))


# Hyades' bodies scatter in another way (docs/blender.md): the colours are to be those of Cycles.
# Of the weight 0.3 Blender 3 makes a body that scatters, and Blender 4 none.
_OF_SUBSURFACE = (
    "light scatters often within a body: a max depth of 32 darkens it"
    if bpy.app.version < (4, 0)
    else "a body scatters light below its surface or not"
)


@scene(mean=0.04, block=0.15, complaints=(_OF_SUBSURFACE,))
def principled_subsurface() -> None:
    keys = {"Base_Color": (0.7, 0.1, 0.1), "Subsurface": 0.3, "Subsurface_Radius": (0.1, 0.1, 0.1)}
    if bpy.app.version < (4, 0):
        keys["Subsurface_Color"] = (0.1, 0.7, 0.1)
    ball(material(node="ShaderNodeBsdfPrincipled", Specular=0.0, **keys))


@scene(mean=0.02, block=0.1)
def principled_alpha() -> None:
    ball(material(node="ShaderNodeBsdfPrincipled", Base_Color=(0.8, 0.2, 0.2), Roughness=1.0, Specular=0.0, Alpha=0.4))


if bpy.app.version >= (4, 0):  # with layers

    @scene(block=0.09, complaints=("what the tint of its coat takes", "fuzz (sheen) is that of"))
    def principled_layers() -> None:
        layers = {"Coat_Weight": 0.8, "Coat_Tint": (0.9, 0.6, 0.3), "Sheen_Weight": 0.6, "Sheen_Roughness": 0.4}
        glow = {"Emission_Color": (0.2, 0.5, 1), "Emission_Strength": 0.5}
        ball(material(node="ShaderNodeBsdfPrincipled", Base_Color=(0.5, 0.4, 0.3), **layers, **glow))


@scene()
def glossy() -> None:
    ball(material(node="ShaderNodeBsdfGlossy", Color=(0.9, 0.8, 0.6), Roughness=0.3))


@scene()
def mirror() -> None:
    made = material(node="ShaderNodeBsdfGlossy", Color=(0.9, 0.8, 0.6), Roughness=0.0)
    sharpen(made)
    ball(made)


@scene()
def glass() -> None:
    made = material(node="ShaderNodeBsdfGlass", Color=(0.9, 1.0, 0.95), Roughness=0.0, IOR=1.5)
    sharpen(made)
    ball(made)


# A caustic, and its noise; Blender 3 has facets of Beckmann's if nobody says otherwise.
@scene(block=0.15, complaints=("its facets are those of GGX",) if bpy.app.version < (4, 0) else ())
def rough_glass() -> None:
    ball(material(node="ShaderNodeBsdfGlass", Color=1.0, Roughness=0.3, IOR=1.45))


# Facets that lose what they throw onto each other: twelve in a hundred of a picture.
@scene()
def principled_metal_that_loses_light() -> None:
    made = material(node="ShaderNodeBsdfPrincipled", Base_Color=(0.9, 0.5, 0.3), Roughness=0.85, Metallic=1.0)
    shader_of(made).distribution = "GGX"
    ball(made)


@scene()
def translucent() -> None:
    ball(material(node="ShaderNodeBsdfTranslucent", Color=(0.8, 0.7, 0.2)))


@scene()
def transparent() -> None:
    ball(material(node="ShaderNodeBsdfTransparent", Color=0.5))


@scene()
def emission() -> None:
    ball(material(node="ShaderNodeEmission", Color=(1, 0.6, 0.3), Strength=3.0))


@scene()
def mixed_shaders() -> None:
    made = material(node="ShaderNodeMixShader", Fac=0.3)
    mix = shader_of(made)
    link(made, node(made, "ShaderNodeBsdfDiffuse", Color=(0.8, 0.1, 0.1)).outputs[0], mix.inputs[1])
    link(made, node(made, "ShaderNodeBsdfGlossy", Color=0.9, Roughness=0.2).outputs[0], mix.inputs[2])
    ball(made)


@scene()
def added_shaders() -> None:
    made = material(node="ShaderNodeAddShader")
    total = shader_of(made)
    link(made, node(made, "ShaderNodeBsdfDiffuse", Color=(0.4, 0.1, 0.1)).outputs[0], total.inputs[0])
    link(made, node(made, "ShaderNodeEmission", Color=(0.1, 0.2, 0.5)).outputs[0], total.inputs[1])
    ball(made)


@scene()
def added_glow() -> None:
    # Light that is added to what is seen through it.
    made = material(node="ShaderNodeAddShader")
    total = shader_of(made)
    link(made, node(made, "ShaderNodeBsdfTransparent").outputs[0], total.inputs[0])
    link(made, node(made, "ShaderNodeEmission", Color=(0.1, 0.5, 0.2)).outputs[0], total.inputs[1])
    ball(made)


@scene()
def shining_to_one_side() -> None:
    # A lamp of a mesh, whose back is matt.
    made = material(node="ShaderNodeMixShader")
    mix, side = shader_of(made), node(made, "ShaderNodeNewGeometry")
    link(made, side.outputs["Backfacing"], mix.inputs["Fac"])
    link(made, node(made, "ShaderNodeEmission", Color=(1, 0.5, 0.2), Strength=3.0).outputs[0], mix.inputs[1])
    link(made, node(made, "ShaderNodeBsdfDiffuse", Color=(0.2, 0.3, 0.8)).outputs[0], mix.inputs[2])
    ball(material(Color=0.5))
    primitive("plane", made, at=(-1.6, 0, 1), turn=(0, 60, 0), size=1.5)


@scene()
def half_there() -> None:
    # A lamp that is there by half, in front of a matt ball.
    made = material(node="ShaderNodeMixShader", Fac=0.5)
    mix = shader_of(made)
    link(made, node(made, "ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
    link(made, node(made, "ShaderNodeEmission", Color=(1, 0.5, 0.2), Strength=2.0).outputs[0], mix.inputs[2])
    ball(material(Color=0.5))
    primitive("plane", made, at=(-0.8, -1.5, 0.8), turn=(90, 0, 0), size=1)


@scene()
def absorbing_volume() -> None:
    ball(_volume("ShaderNodeVolumeAbsorption", Color=(0.8, 0.4, 0.2), Density=1.5), "cube")


@scene()
def scattering_volume() -> None:
    ball(_volume("ShaderNodeVolumeScatter", Color=(0.8, 0.6, 0.9), Density=1.0, Anisotropy=0.3), "cube")


@scene()
def principled_volume() -> None:
    ball(_volume("ShaderNodeVolumePrincipled", Color=(0.5, 0.6, 0.7), Density=0.8, Emission_Strength=0.2), "cube")


@scene()
def glowing_volume() -> None:
    hot = {"Blackbody_Intensity": 0.9, "Temperature": 2500, "Blackbody_Tint": (1, 0.8, 0.9)}
    ball(_volume("ShaderNodeVolumePrincipled", Color=(0.5, 0.6, 0.7), Density=0.5, **hot), "cube")


@scene()
def volume_of_a_file() -> None:
    # Coloured smoke that is hot at one side; the object is scaled, and densities are those of its own space.
    x, y, z = numpy.mgrid[0:8, 0:8, 0:8] / 7
    smoke = numpy.clip(1.2 - 2.4 * numpy.sqrt((x - 0.5) ** 2 + (y - 0.5) ** 2 + (z - 0.5) ** 2), 0, 1)
    grids = {"density": smoke, "Cd": x[..., None] * [-0.5, 0.2, -0.2] + [0.9, 0.4, 0.6], "temperature": x}
    data = bpy.data.volumes.new("Smoke")
    data.filepath = str(vdb_file.write(pathlib.Path(tempfile.mkdtemp()) / "smoke.vdb", grids, voxel=0.1))
    ball(material(Color=0.5)).hide_render = True
    hot = {"Blackbody_Intensity": 0.9, "Temperature": 2000, "Blackbody_Tint": (1, 0.8, 0.9)}
    made = _volume("ShaderNodeVolumePrincipled", Color=(0.9, 0.9, 0.8), Density=5.0, Anisotropy=0.3, **hot)
    made.node_tree.nodes["Principled Volume"].inputs["Color Attribute"].default_value = "Cd"
    data.materials.append(made)
    add(data, at=(-0.9, -0.9, 0.2), scale=(2.5, 2.5, 2.0))


def _volume(kind: str, **inputs):
    made = material(node=None)
    volume = node(made, kind, **inputs)
    link(made, volume.outputs[0], made.node_tree.nodes["Material Output"].inputs["Volume"])
    return made


@scene()
def in_a_group() -> None:
    # The same as matt red, behind a reroute, a muted node and a group of nodes.
    import bpy

    group = bpy.data.node_groups.new("Paint", "ShaderNodeTree")
    if bpy.app.version < (4, 0):
        group.inputs.new("NodeSocketColor", "Tint")
        group.outputs.new("NodeSocketShader", "Shader")
    else:
        group.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
        group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    inside, outside = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    diffuse = node(group, "ShaderNodeBsdfDiffuse")
    link(group, inside.outputs["Tint"], diffuse.inputs["Color"])
    link(group, diffuse.outputs[0], outside.inputs["Shader"])
    made = material(node=None)
    paint = made.node_tree.nodes.new("ShaderNodeGroup")
    paint.node_tree = group
    color = made.node_tree.nodes.new("ShaderNodeRGB")
    color.outputs[0].default_value = (0.8, 0.2, 0.1, 1)
    invert = node(made, "ShaderNodeInvert")
    link(made, color.outputs[0], invert.inputs["Color"])
    invert.mute = True
    reroute = made.node_tree.nodes.new("NodeReroute")
    link(made, invert.outputs[0], reroute.inputs[0])
    link(made, reroute.outputs[0], paint.inputs["Tint"])
    link(made, paint.outputs[0], made.node_tree.nodes["Material Output"].inputs["Surface"])
    ball(made)


@scene(samples=128)
def under_water() -> None:
    water = material("Water", "ShaderNodeBsdfGlass", Roughness=0.0, IOR=1.33)
    world((0.4, 0.5, 0.8))
    primitive("cube", water, scale=(12, 12, 8))
    primitive("cube", material(Color=(0.7, 0.4, 0.2)), turn=(20, 10, 30))
    camera((0, -4, 1), (0, 0, 0))


@scene(samples=256, block=0.12)  # the light that resin throws onto the floor, and its noise
def glow_in_resin() -> None:
    resin = material("Resin", "ShaderNodeBsdfGlass", Roughness=0.0, IOR=1.5)
    glow = material("Glow", "ShaderNodeEmission", Color=(0.9, 0.5, 0.2), Strength=2.0)
    floor()
    world((0.1, 0.1, 0.1))
    primitive("uv_sphere", resin, at=(0, 0, 1.1), smooth=True, segments=64, ring_count=32)
    primitive("cube", glow, at=(0, 0, 1.1), scale=(0.4, 0.4, 0.4), turn=(20, 10, 40))
    camera((0, -5, 2.5), (0, 0, 0.8))
