"""Hair: particles, their children, and objects of type Hair Curves."""

import bpy
from scene import camera, floor, light, material, primitive, scene, world


# With Blender 4 blocks of dense hair differ by up to 6 %: why is not known (docs/blender.md).
BLOCK = 0.05 if bpy.app.version < (4, 0) else 0.08


def hairy(fur, count: int = 600, **settings):
    """A ball with hair of this material in the light of a lamp and of the world."""
    floor()
    world((0.3, 0.35, 0.4))
    light("AREA", 400, at=(2.5, -3, 4), towards=(0, 0, 1), size=2)
    camera((0, -6, 2.5), (0, 0, 0.9))
    ball = primitive("uv_sphere", material(Color=(0.5, 0.4, 0.3)), at=(0, 0, 1), radius=0.6)
    ball.data.materials.append(fur)
    bpy.context.scene.cycles_curves.shape = "THICK"
    hair = ball.modifiers.new("Hair", "PARTICLE_SYSTEM").particle_system.settings
    hair.type, hair.count, hair.hair_length, hair.hair_step, hair.render_step = "HAIR", count, 0.7, 4, 3
    # Thin: where roots stand within each other, the two have different words for what is inside.
    hair.material, hair.radius_scale, hair.root_radius, hair.tip_radius = 2, 0.02, 1.0, 0.25
    for name, value in settings.items():
        setattr(hair, name, value)
    return ball


def shader(**values):
    """A material of Principled Hair."""
    made = material("Fur", node="ShaderNodeBsdfHairPrincipled")
    node = next(node for node in made.node_tree.nodes if node.type == "BSDF_HAIR_PRINCIPLED")
    if hasattr(node, "model"):
        node.model = "CHIANG"
    node.parametrization = values.pop("kind", "MELANIN")
    inputs = {socket.name: socket for socket in node.inputs}  # Blender 4 does not find hidden ones by name
    inputs["Random Color"].default_value = 0.0
    for name, value in values.items():
        socket = inputs[name.replace("_", " ")]
        socket.default_value = (*value, 1.0)[: len(socket.default_value)] if isinstance(value, tuple) else value
    return made


@scene(samples=384, block=BLOCK)
def hair_with_pigments() -> None:
    hairy(shader(Melanin=0.5, Melanin_Redness=0.4, Tint=(0.9, 0.8, 0.7)))


@scene(samples=384, block=BLOCK)
def hair_of_a_color() -> None:
    hairy(shader(kind="COLOR", Color=(0.6, 0.3, 0.1), Roughness=0.5, Radial_Roughness=0.6, IOR=1.4, Offset=0.1))


@scene(samples=384, block=BLOCK)
def hair_that_absorbs() -> None:
    hairy(shader(kind="ABSORPTION", Absorption_Coefficient=(0.1, 0.4, 1.2)), shape=0.5)


@scene(samples=384, block=BLOCK)
def matt_hair() -> None:
    hairy(material("Fur", Color=(0.3, 0.5, 0.2)), shape=-0.5, use_close_tip=True)


@scene(samples=1024, block=BLOCK)
def children() -> None:
    hairy(shader(Melanin=0.3), count=100, child_type="INTERPOLATED", rendered_child_count=8)
