"""File > Export > Hyades job (.yaml)."""

from __future__ import annotations

from pathlib import Path

import bpy
import hyades
from bpy.props import StringProperty
from bpy_extras.io_utils import ExportHelper

from . import animation, complaints


class HYADES_OT_export_job(bpy.types.Operator, ExportHelper):
    """Writes the scene as a job for `hyades render`, with its meshes and pictures beside it"""

    bl_idname = "hyades.export_job"
    bl_label = "Export Hyades Job"
    filename_ext = ".yaml"
    filter_glob: StringProperty(default="*.yaml", options={"HIDDEN"})
    frames: bpy.props.EnumProperty(
        name="Frames",
        items=(
            ("current", "Current Frame", "One picture"),
            ("all", "Animation", "All frames of the scene's range"),
        ),
        default="current",
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        scene, path = context.scene, Path(bpy.path.abspath(self.filepath))
        frames = animation.all_frames(scene) if self.frames == "all" else None
        try:
            exported = animation.job_of(scene, frames=frames, name=path.stem)
            exported.job.write(path)
        except (hyades.HyadesError, OSError, ValueError) as error:
            self.report({"ERROR"}, f"Hyades: {error}")
            return {"CANCELLED"}
        complaints.keep(scene, exported.complaints)
        complaints.tell(self, exported.complaints)
        self.report({"INFO"}, f"Hyades: wrote {path}")
        return {"FINISHED"}


def _entry(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.operator(HYADES_OT_export_job.bl_idname, text="Hyades job (.yaml)")


def register() -> None:
    bpy.utils.register_class(HYADES_OT_export_job)
    bpy.types.TOPBAR_MT_file_export.append(_entry)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_export.remove(_entry)
    bpy.utils.unregister_class(HYADES_OT_export_job)
