"""The scene as a final render sees it, without a render: Blender evaluates it so (render visibility, subdivisions of
renders) for render engines only, so one is run that takes nothing but a look."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import bpy

_look: Callable[[Any, Any], None] | None = None


def taken(engine: Any, depsgraph: Any) -> bool:
    """Called by the engine: whether somebody only wanted a look at this depsgraph, and has had it."""
    if _look is None:
        return False
    _look(engine, depsgraph)
    return True


def look_at_final(scene: Any, look: Callable[[Any, Any], Any]) -> Any:
    """What `look` makes of an engine and the depsgraph of a final render of the scene's current frame, of the first
    view layer that is rendered. Exceptions of `look` come through. For the main thread, while nothing is rendered."""
    global _look
    found: list[Any] = []
    wrong: list[BaseException] = []

    def once(engine: Any, depsgraph: Any) -> None:
        try:
            if not found and not wrong:
                found.append(look(engine, depsgraph))
        except BaseException as error:  # Blender would print it and go on
            wrong.append(error)

    _look = once
    try:
        with _plain_render(scene) as layer:
            bpy.ops.render.render(scene=scene.name, layer=layer)
    except RuntimeError as error:  # Blender refuses, as without a camera
        raise ValueError(str(error).removeprefix("Error: ").strip()) from None
    finally:
        _look = None
    if wrong:
        raise wrong[0]
    if not found:
        raise ValueError(f"scene '{scene.name}' has no view layer that is rendered")
    return found[0]


@contextmanager
def _plain_render(scene: Any) -> Iterator[str]:
    """The scene with this engine and nothing after it, for a while; the name of a view layer that is rendered."""
    render = scene.render
    wanted = {"engine": "HYADES"} | dict.fromkeys(("use_compositing", "use_sequencer", "use_multiview", "use_freestyle"), False)
    before = {name: getattr(render, name) for name in wanted}
    for name, value in wanted.items():
        setattr(render, name, value)
    try:
        layers = [layer.name for layer in scene.view_layers if layer.use]
        if not layers:
            raise ValueError(f"scene '{scene.name}' has no view layer that is rendered")
        yield layers[0]
    finally:
        for name, value in before.items():
            setattr(render, name, value)
