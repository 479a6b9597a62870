"""What scenes of the truth tests are made of."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import bpy

SCENES: list["Scene"] = []
"""All scenes of the file that was imported, in its order."""


@dataclass(frozen=True)
class Scene:
    """A scene, and by how much Hyades may differ from Cycles."""

    build: Callable[[], None]
    mean: float
    block: float
    samples: int
    complaints: tuple[str, ...]

    @property
    def name(self) -> str:
        return self.build.__name__


def scene(*, mean: float = 0.02, block: float = 0.05, samples: int = 192, complaints: tuple[str, ...] = ()):
    """Marks a function that builds a scene. `complaints`: parts of those that the exporter has to make."""

    def add(build: Callable[[], None]) -> Callable[[], None]:
        SCENES.append(Scene(build, mean, block, samples, complaints))
        return build

    return add


def begin() -> None:
    """An empty scene: a black world, a picture of 64 x 48 pixels, a camera that looks at the origin from the front."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 64, 48, 100
    bpy.context.scene.view_settings.view_transform = "Standard"
    bpy.context.scene.cycles.pixel_filter_type = "BOX"
    world(0.0)
    camera((0, -6, 2.5), (0, 0, 0.5))


def add(data, name: str = "", at=(0, 0, 0), turn=(0, 0, 0), scale=(1, 1, 1)):
    """An object of this data; `turn` in degrees about x, y and z."""
    object = bpy.data.objects.new(name or data.name, data)
    object.location, object.scale = at, scale
    object.rotation_euler = [math.radians(angle) for angle in turn]
    bpy.context.scene.collection.objects.link(object)
    return object


def camera(at, towards, lens: float = 35.0):
    """The scene's camera."""
    data = bpy.data.cameras.new("Camera")
    data.lens = lens
    object = add(data, at=at)
    look(object, towards)
    bpy.context.scene.camera = object
    return object


def look(object, towards) -> None:
    """Turns a camera or lamp towards a point."""
    from mathutils import Vector

    direction = Vector(towards) - object.location
    object.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()


def world(color, strength: float = 1.0):
    """Light from all around; returns the world's nodes."""
    made = bpy.data.worlds.new("World")
    made.use_nodes = True
    background = made.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = rgba(color)
    background.inputs["Strength"].default_value = strength
    bpy.context.scene.world = made
    return made.node_tree


def light(kind: str, energy: float, at=(0, 0, 3), towards=(0, 0, 0), **keys):
    """A lamp, with properties of its data."""
    data = bpy.data.lights.new(kind.title(), kind)
    data.energy = energy
    for name, value in keys.items():
        setattr(data, name, value)
    object = add(data, at=at)
    look(object, towards)
    return object


def rgba(color):
    """A number or three as four."""
    values = [color] * 3 if isinstance(color, (int, float)) else list(color)
    return (*values[:3], values[3] if len(values) > 3 else 1.0)


def material(name: str = "Matt", node: str | None = "ShaderNodeBsdfDiffuse", **inputs):
    """A material of one shader; `inputs` by socket, with _ for spaces: Base_Color=0.8."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    if node is not None:
        shader = tree.nodes.new(node)
        said(shader, **inputs)
        tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return made


def set_of_cycles(data, name: str, value) -> None:
    """A setting of Cycles, which Blender 4 has with its own."""
    setattr(data if hasattr(data, name) else data.cycles, name, value)


def sharpen(made) -> None:
    """Lets a glossy shader be a mirror, as which Blender 4 takes any without roughness."""
    if bpy.app.version < (4, 0):
        shader_of(made).distribution = "SHARP"


def scattered_once(made):
    """`made`, whose glossy shader loses what its grooves reflect more than once: what Blender 4 makes of that by default is
    another model than ours (docs/blender.md)."""
    shader_of(made).distribution = "GGX"
    return made


# Sockets of the Principled BSDF as Blender 4 calls them.
_RENAMED = {
    "Clearcoat": "Coat Weight",
    "Clearcoat Roughness": "Coat Roughness",
    "Emission": "Emission Color",
    "Sheen": "Sheen Weight",
    "Specular": "Specular IOR Level",
    "Subsurface": "Subsurface Weight",
    "Transmission": "Transmission Weight",
}


def said(node, **inputs):
    """Gives a node's sockets their values; by the names of Blender 3."""
    for name, value in inputs.items():
        name = name.replace("_", " ")
        socket = node.inputs[name if name in node.inputs else _RENAMED[name]]
        if socket.type == "RGBA":
            value = rgba(value)
        socket.default_value = value
    return node


def shader_of(made):
    """The shader of a material with one."""
    return made.node_tree.nodes["Material Output"].inputs["Surface"].links[0].from_node


def node(made, kind: str, **inputs):
    """Another node of a material (or of a tree)."""
    tree = getattr(made, "node_tree", made)
    return said(tree.nodes.new(kind), **inputs)


def link(made, output, target) -> None:
    """From an output to an input."""
    getattr(made, "node_tree", made).links.new(output, target)


def primitive(kind: str, made=None, at=(0, 0, 0), turn=(0, 0, 0), scale=(1, 1, 1), smooth: bool = False, **keys):
    """A mesh of Blender's operators: plane, cube, uv_sphere, ico_sphere, monkey, torus, cylinder, cone."""
    angles = [math.radians(angle) for angle in turn]
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(location=at, rotation=angles, **keys)
    object = bpy.context.object
    object.scale = scale
    if made is not None:
        object.data.materials.append(made)
    if smooth:
        object.data.polygons.foreach_set("use_smooth", [True] * len(object.data.polygons))
    return object


def floor(made=None, size: float = 30.0):
    """The ground at z = 0."""
    return primitive("plane", made or material("Floor", Color=0.6), size=size)
