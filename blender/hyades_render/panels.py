"""Panels of the properties editor: Hyades' own, and those of Blender that it shares."""

from __future__ import annotations

import bpy

from . import complaints

_ENGINE = "HYADES"

# Blender's panels that other engines use too, and that make sense here.
_SHARED = (
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "DATA_PT_spot",
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "EEVEE_MATERIAL_PT_volume",
    "EEVEE_WORLD_PT_surface",
    "EEVEE_WORLD_PT_volume",
    "MATERIAL_PT_preview",
    "VIEWLAYER_PT_layer_passes_cryptomatte",
)
_NOT_SHARED = ("RENDER_PT_gpencil", "RENDER_PT_freestyle", "DATA_PT_falloff_curve", "VIEWLAYER_PT_layer_passes")


class _Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.engine == _ENGINE

    def begin(self) -> bpy.types.UILayout:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        return layout


class HYADES_PT_sampling(_Panel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.hyades, self.begin()
        layout.prop(settings, "render_on")
        column = layout.column(align=True)
        column.prop(settings, "samples", text="Max Samples" if settings.noise > 0 else "Samples")
        column.prop(settings, "noise")
        row = column.row()
        row.active = settings.noise > 0
        row.prop(settings, "min_samples")
        layout.prop(settings, "preview_samples")
        layout.prop(settings, "denoise")
        layout.prop(settings, "seed")


class HYADES_PT_integrator(_Panel, bpy.types.Panel):
    bl_label = "Light Paths"

    def draw(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.hyades, self.begin()
        layout.prop(settings, "integrator")
        column = layout.column(align=True)
        column.prop(settings, "max_depth")
        column.prop(settings, "roulette_depth")
        if settings.integrator == "path":
            layout.prop(settings, "clamp")
        elif settings.integrator == "mlt":
            layout.prop(settings, "mlt_over")
            layout.prop(settings, "large_step")


class HYADES_PT_motion_blur(_Panel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context: bpy.types.Context) -> None:
        layout, render = self.begin(), context.scene.render
        layout.active = render.use_motion_blur
        layout.prop(render, "motion_blur_shutter")


class HYADES_PT_film(_Panel, bpy.types.Panel):
    bl_label = "Film"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, render = self.begin(), context.scene.render
        layout.prop(render, "film_transparent", text="Transparent")
        cycles = getattr(context.scene, "cycles", None)
        if cycles is None:  # the add-on Cycles is off
            layout.prop(render, "filter_size")
            return
        layout.prop(cycles, "film_exposure")
        layout.prop(cycles, "pixel_filter_type")
        if cycles.pixel_filter_type != "BOX":
            layout.prop(cycles, "filter_width")


class HYADES_PT_performance(_Panel, bpy.types.Panel):
    bl_label = "Performance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, render = self.begin(), context.scene.render
        layout.prop(render, "threads_mode")
        row = layout.row()
        row.active = render.threads_mode == "FIXED"
        row.prop(render, "threads")
        layout.prop(render, "preview_pixel_size", text="Viewport Pixel Size")
        layout.prop(context.scene.hyades, "render_class")


class HYADES_PT_textures(_Panel, bpy.types.Panel):
    bl_label = "Textures"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings, layout = context.scene.hyades, self.begin()
        layout.prop(settings, "bake", text="Bake Other Nodes")
        row = layout.row()
        row.active = settings.bake
        row.prop(settings, "bake_size")


class HYADES_PT_complaints(_Panel, bpy.types.Panel):
    """What the last export could not say."""

    bl_label = "Not Exported"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        found = complaints.of(context.scene)
        if not found:
            layout.label(text="Not exported yet" if found is None else "Everything was exported", icon="INFO")
            return
        for one in found:
            box = layout.column(align=True)
            box.label(text=one.where, icon="ERROR")
            for line in _wrapped(one.what, max(int(context.region.width / 7.5 / _scale(context)), 20)):
                box.label(text=line, icon="BLANK1")


class HYADES_PT_passes(_Panel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        layout, layer = self.begin(), context.view_layer
        column = layout.column(heading="Data", align=True)
        column.prop(layer, "use_pass_combined")
        column.prop(layer, "use_pass_z")
        column.prop(layer, "use_pass_position")
        column.prop(layer, "use_pass_normal")
        column.prop(layer, "use_pass_vector")
        column.prop(layer.hyades, "use_pass_albedo")
        column.prop(layer.hyades, "use_pass_variance")
        column.prop(layer.hyades, "use_pass_samples")
        for kind in ("diffuse", "glossy", "transmission"):
            column = layout.column(heading=kind.title(), align=True)
            column.prop(layer, f"use_pass_{kind}_direct", text="Direct")
            column.prop(layer, f"use_pass_{kind}_indirect", text="Indirect")
        column = layout.column(heading="Volume", align=True)
        column.prop(layer.hyades, "use_pass_volume_direct")
        column.prop(layer.hyades, "use_pass_volume_indirect")
        column = layout.column(heading="Other", align=True)
        column.prop(layer, "use_pass_emit", text="Emission")
        column.prop(layer, "use_pass_environment")


class HYADES_PT_light(_Panel, bpy.types.Panel):
    bl_label = "Light"
    bl_context = "data"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bool(context.light) and super().poll(context)

    def draw(self, context: bpy.types.Context) -> None:
        light, layout = context.light, self.begin()
        self.layout.row().prop(light, "type", expand=True)
        column = layout.column()
        column.prop(light, "color")
        column.prop(light, "energy", text="Strength" if light.type == "SUN" else "Power")
        if light.type == "SUN":
            column.prop(light, "angle")
        elif light.type == "AREA":
            column.prop(light, "shape")
            if light.shape in {"RECTANGLE", "ELLIPSE"}:
                column.prop(light, "size", text="Size X")
                column.prop(light, "size_y", text="Y")
            else:
                column.prop(light, "size")
        else:
            column.prop(light, "shadow_soft_size", text="Radius")


_CLASSES = (
    HYADES_PT_sampling,
    HYADES_PT_integrator,
    HYADES_PT_motion_blur,
    HYADES_PT_film,
    HYADES_PT_textures,
    HYADES_PT_performance,
    HYADES_PT_complaints,
    HYADES_PT_passes,
    HYADES_PT_light,
)


def _wrapped(text: str, width: int) -> list[str]:
    import textwrap

    return textwrap.wrap(text, width)


def _scale(context: bpy.types.Context) -> float:
    return max(context.preferences.system.ui_scale, 0.1)


def _shared_panels() -> list[type]:
    found = []
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is None or panel.__name__ in _NOT_SHARED:
            continue
        if "BLENDER_RENDER" in engines or panel.__name__ in _SHARED:
            found.append(panel)
    return found


def register() -> None:
    for one in _CLASSES:
        bpy.utils.register_class(one)
    for panel in _shared_panels():
        panel.COMPAT_ENGINES.add(_ENGINE)


def unregister() -> None:
    for panel in bpy.types.Panel.__subclasses__():
        getattr(panel, "COMPAT_ENGINES", set()).discard(_ENGINE)
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
