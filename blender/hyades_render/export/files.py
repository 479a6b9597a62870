"""Files that a .blend names, which go to farms as they are."""

from __future__ import annotations

import os
from collections.abc import Set

from hyades.files import led_to

from .context import Context


def may_be_sent(path: str, ends: Set[str]) -> bool:
    """Whether there is a file that ends in one of `ends` (".png"), and leads to one if it is a link.

    A .blend comes from anybody and names what it likes, anywhere; nobody's other files (keys, say) go to a farm.
    """
    try:
        led = led_to(path)
    except (OSError, ValueError):
        return False
    return led.is_file() and all(os.path.splitext(name)[1].lower() in ends for name in (path, led))


def tell_of_libraries(context: Context) -> None:
    """Complains of .blend files that are linked to and not there: Blender goes on without what they held."""
    import bpy

    for library in bpy.data.libraries:
        path = bpy.path.abspath(library.filepath, library=library.parent)
        if not library.packed_file and not os.path.isfile(path):
            context.complain(f"library '{library.name}'", f"there is no file {path}: what is linked from it is left out")
