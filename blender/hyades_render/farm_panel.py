"""The farm in the render properties: submit, and a list of its jobs."""

from __future__ import annotations

from typing import Any

import bpy

from . import farm_state

_ICONS = {"waiting": "SORTTIME", "running": "PLAY", "paused": "PAUSE", "done": "CHECKMARK", "failed": "ERROR", "cancelled": "CANCEL"}


class HYADES_UL_jobs(bpy.types.UIList):
    """One job a row: its picture, name, state, and how far it is."""

    def draw_item(
        self, context: Any, layout: Any, data: Any, item: Any, icon: int, active_data: Any, active_property: str
    ) -> None:
        row = layout.row(align=True)
        picture = farm_state.icon_of(int(item.job_id)) if item.job_id else 0
        row.label(text=f"{item.job_id}  {item.name}", icon_value=picture)
        side = row.row()
        side.alignment = "RIGHT"
        side.label(text=f"{item.share:.0%}" if item.state == "running" else item.state)
        side.label(text="", icon=_ICONS.get(item.state, "QUESTION"))


class HYADES_PT_farm(bpy.types.Panel):
    """Jobs of the farm that the preferences name."""

    bl_label = "Farm"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.engine == "HYADES"

    def draw(self, context: Any) -> None:
        layout, settings = self.layout, context.scene.hyades
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column()
        column.prop(settings, "farm_name")
        column.prop(settings, "farm_priority")
        column.prop(settings, "farm_tags")
        row = layout.row(align=True)
        row.operator("hyades.submit", icon="RENDER_ANIMATION").whole = True
        row.operator("hyades.submit", text="", icon="RENDER_STILL").whole = False
        for task in farm_state.tasks:
            layout.label(text=f"{task.what}: {task.words}" if task.words else task.what, icon="SORTTIME")
        if farm_state.message:
            row = layout.row()
            row.label(text=farm_state.message, icon="ERROR" if farm_state.message_is_error else "INFO")
            if farm_state.submission is not None:
                row.operator("hyades.stop_submission", text="", icon="X")
        watch = farm_state.watch
        layout.operator(
            "hyades.watch_farm", text="Hide Jobs" if watch else "Show Jobs", icon="HIDE_ON" if watch else "HIDE_OFF"
        )
        if watch is not None:
            if watch.seen.error:
                layout.label(text=watch.seen.error, icon="ERROR")
            self._draw_jobs(context, layout)

    def _draw_jobs(self, context: Any, layout: Any) -> None:
        manager = context.window_manager
        jobs = manager.hyades_jobs
        layout.template_list("HYADES_UL_jobs", "", manager, "hyades_jobs", manager, "hyades_job", rows=4)
        if not 0 <= manager.hyades_job < len(jobs):
            return
        job = jobs[manager.hyades_job]
        picture = farm_state.icon_of(int(job.job_id))
        if picture:
            layout.template_icon(icon_value=picture, scale=6)
        for line in _lines(job):
            layout.label(text=line)
        row = layout.row(align=True)
        row.operator("hyades.fetch", icon="IMPORT").job = int(job.job_id)
        row.operator("hyades.open_dashboard", text="Dashboard", icon="URL").job = int(job.job_id)
        cancel = row.row(align=True)
        cancel.enabled = job.state in ("waiting", "running", "paused")
        cancel.operator("hyades.cancel", icon="X").job = int(job.job_id)


def _lines(job: Any) -> list[str]:
    words = [f"{job.state}: {job.frames_done} of {job.frames} frames"]
    if job.frames_finishing:
        words[0] += f", {job.frames_finishing} finishing"
    if job.frames_failed:
        words[0] += f", {job.frames_failed} failed"
    if job.state == "running" and job.seconds_left >= 0:
        words[0] += f", {_time(job.seconds_left)} left"
    if job.noise >= 0:
        words[0] += f", noise {job.noise:.3f}"
    if job.reason:
        words.append(job.reason)
    return words


def _time(seconds: float) -> str:
    minutes = round(seconds / 60)
    return f"{minutes // 60} h {minutes % 60} min" if minutes >= 60 else f"{minutes} min" if minutes else "< 1 min"


_CLASSES = (HYADES_UL_jobs, HYADES_PT_farm)


def register() -> None:
    for one in _CLASSES:
        bpy.utils.register_class(one)


def unregister() -> None:
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
