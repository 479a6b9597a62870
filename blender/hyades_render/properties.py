"""What a scene and its view layers say to Hyades alone: `scene.hyades` and `view_layer.hyades`.

Names and defaults are those of docs/job.md; what Blender has itself (size, frames, shutter) is not here again.
"""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

INTEGRATORS = (
    ("path", "Path Tracing", "The fastest where lamps are large or in the open"),
    ("bdpt", "Bidirectional", "Finds caustics and rooms lit through a gap; about three times as slow a sample"),
    ("mlt", "Metropolis", "Stays where light is hard to find, once it has found it"),
)
DENOISERS = (
    ("none", "None", "The picture as it was rendered"),
    ("true", "Automatic", "Open Image Denoise where it is installed, else by features"),
    ("features", "Features", "Fits colours to albedo and normals nearby"),
    ("oidn", "Open Image Denoise", "By Intel's network; its library has to be installed"),
)


PLACES = (
    ("here", "This Machine", "By the program hyades on this machine"),
    ("farm", "Farm", "By the farm that the preferences name"),
)
CLASSES = (
    ("native", "Native", "The fastest on processors. On a farm each frame is rendered by machines of one maker"),
    ("portable", "Portable", "The same pixels on every processor, so that all machines of a farm share each frame"),
)


class HyadesSceneSettings(bpy.types.PropertyGroup):
    """How a scene is rendered."""

    render_on: EnumProperty(name="Render On", description="Where F12 is rendered", items=PLACES, default="here")
    integrator: EnumProperty(name="Integrator", description="How light is found", items=INTEGRATORS, default="path")
    samples: IntProperty(
        name="Samples",
        description="Samples per pixel: four times as many halve the noise. With a noise to aim at, the most",
        default=64, min=1, max=16777216, soft_max=65536,
    )
    noise: FloatProperty(
        name="Noise",
        description="Noise at which sampling stops: 0.05 is a preview, 0.02 clean, 0.01 very clean; 0: all samples",
        default=0.0, min=0.0, max=1.0, precision=3, step=1,
    )
    min_samples: IntProperty(
        name="Min Samples",
        description="Samples that every pixel gets before its noise is judged",
        default=32, min=1, max=16777216, soft_max=4096,
    )
    seed: IntProperty(name="Seed", description="Another seed, another noise", default=0, min=0)
    max_depth: IntProperty(
        name="Max Depth",
        description="Most reflections and transmissions between light and camera",
        default=32, min=0, max=65536, soft_max=256,
    )
    roulette_depth: IntProperty(
        name="Roulette Depth",
        description="From this many reflections on, faint paths may end early (unbiased)",
        default=4, min=0, max=65536, soft_max=64,
    )
    clamp: FloatProperty(
        name="Clamp",
        description="Biased: most light that one indirect sample may bring, W/(m² sr); 0: off",
        default=0.0, min=0.0, soft_max=100.0,
    )
    mlt_over: EnumProperty(
        name="Mutates",
        description="Whose samples Metropolis mutates",
        items=(("bdpt", "Bidirectional", "Two-way paths"), ("path", "Path Tracing", "Paths from the camera")),
        default="bdpt",
    )
    large_step: FloatProperty(
        name="Large Steps",
        description="How often Metropolis tries an independent sample",
        default=0.3, min=0.01, max=1.0,
    )
    render_class: EnumProperty(
        name="Class", description="By which arithmetic rays meet surfaces", items=CLASSES, default="native"
    )
    denoise: EnumProperty(name="Denoise", description="What takes noise out", items=DENOISERS, default="none")
    bake: BoolProperty(
        name="Bake",
        description="Graphs of nodes that no texture of Hyades means become pictures; off: their mean is used",
        default=True,
    )
    bake_size: IntProperty(
        name="Bake Size",
        description="Side of such a picture in pixels, one for each material of an object",
        default=1024, min=64, max=4096,
    )
    preview_samples: IntProperty(
        name="Viewport Samples",
        description="Samples per pixel in the viewport, which refines step by step",
        default=64, min=1, max=65536,
    )
    farm_name: StringProperty(
        name="Name", description="What the job is called on the farm; empty: the file's name"
    )
    farm_priority: IntProperty(
        name="Priority", description="Jobs of higher priority go first", default=0, min=-1000000, max=1000000
    )
    farm_tags: StringProperty(
        name="Tags", description="Only workers that have all of these render it: fast,gpu"
    )


class HyadesLayerSettings(bpy.types.PropertyGroup):
    """Passes that Blender has no switch of its own for."""

    use_pass_albedo: BoolProperty(
        name="Albedo", description="The colour of surfaces; through mirrors that of what they show"
    )
    use_pass_volume_direct: BoolProperty(name="Direct", description="Light that media scatter straight to the camera")
    use_pass_volume_indirect: BoolProperty(name="Indirect", description="Light that media scatter more than once")
    use_pass_variance: BoolProperty(name="Variance", description="Variance of the mean of each pixel")
    use_pass_samples: BoolProperty(name="Sample Count", description="How many samples each pixel took")


_CLASSES = (HyadesSceneSettings, HyadesLayerSettings)


def register() -> None:
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.hyades = PointerProperty(type=HyadesSceneSettings)
    bpy.types.ViewLayer.hyades = PointerProperty(type=HyadesLayerSettings)


def unregister() -> None:
    del bpy.types.ViewLayer.hyades
    del bpy.types.Scene.hyades
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
