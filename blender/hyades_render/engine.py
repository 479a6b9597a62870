"""The render engine Hyades: F12, animations, material previews, and the viewport (viewport.py)."""

from __future__ import annotations

import traceback

import bpy
import hyades

from . import capture, final_render, passes, viewport


class HyadesRenderEngine(bpy.types.RenderEngine):
    """Scene > Render Engine > Hyades."""

    bl_idname = "HYADES"
    bl_label = "Hyades"
    bl_use_preview = True
    bl_use_eevee_viewport = True  # in the viewport's material preview
    bl_use_shading_nodes_custom = False  # Cycles' nodes

    _viewport: viewport.Viewport | None = None

    def __del__(self) -> None:
        # Blender may have freed the engine before this is called.
        try:
            shown = self.__dict__.pop("_viewport", None) if hasattr(self, "__dict__") else None
        except ReferenceError:
            return
        if shown is not None:
            shown.close()

    def update_render_passes(self, scene: bpy.types.Scene = None, renderlayer: bpy.types.ViewLayer = None) -> None:
        """Tells the compositor which passes there will be."""
        for one in passes.asked_for(scene, renderlayer):
            self.register_pass(scene, renderlayer, one.name, len(one.channels), one.channels, one.kind)

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Renders one view layer of one frame."""
        if capture.taken(self, depsgraph):
            return
        try:
            final_render.FinalRender(self, depsgraph).run()
        except (hyades.HyadesError, OSError, ValueError) as error:
            self._fail(str(error))
        except Exception:
            traceback.print_exc()
            self._fail("Hyades' add-on failed: " + traceback.format_exc(limit=-1).strip().splitlines()[-1])

    def view_update(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """Something in the scene has changed, or the viewport is new."""
        self._shown().update(context, depsgraph)

    def view_draw(self, context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> None:
        """The viewport has to be drawn, perhaps from another side."""
        self._shown().draw(context, depsgraph)

    def _shown(self) -> viewport.Viewport:
        if self._viewport is None:
            self._viewport = viewport.Viewport(self)
        return self._viewport

    def _fail(self, message: str) -> None:
        self.report({"ERROR"}, f"Hyades: {message}")
        self.error_set(message)


def register() -> None:
    bpy.utils.register_class(HyadesRenderEngine)


def unregister() -> None:
    viewport.close_all()
    bpy.utils.unregister_class(HyadesRenderEngine)
