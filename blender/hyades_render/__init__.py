"""Hyades in Blender: a render engine, the farm's jobs, and the export of jobs. docs/blender.md tells the rest."""

import importlib

from . import package

bl_info = {
    "name": "Hyades",
    "author": "The Hyades maintainers",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render properties > Render Engine > Hyades",
    "description": "Path tracing on this machine or on a render farm",
    "category": "Render",
}

package.find_hyades()

# In the order in which Blender learns of them. Imported when the add-on is switched on: the exporter is of use without.
_MODULES = (
    "preferences",
    "properties",
    "engine",
    "panels",
    "export_operator",
    "farm_state",
    "farm_operators",
    "farm_panel",
)


def _modules() -> list:
    return [importlib.import_module(f".{name}", __name__) for name in _MODULES]


def register() -> None:
    """Called by Blender when the add-on is switched on."""
    for module in _modules():
        module.register()


def unregister() -> None:
    """Called by Blender when the add-on is switched off."""
    for module in reversed(_modules()):
        module.unregister()
