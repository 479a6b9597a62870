"""Makes a job of the .blend that Blender has opened: for `hyades render file.blend` and `hyades submit file.blend`.

    blender -b file.blend -P export_command.py -- FOLDER [FRAMES]

FOLDER gets job.yaml with what it needs, and notes.txt: what was not exported, a line each. FRAMES: 7, 1-10 or 1-10x2;
without, all of the scene's, or one picture where nothing moves. Where that fails, error.txt says why and the exit
status is 1.
"""

import os
import re
import sys
import threading
import time
import traceback
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.dont_write_bytecode = True

import bpy  # noqa: E402


def main(arguments: list) -> None:
    folder = Path(arguments[0])
    threading.Thread(target=_end_with, args=(os.getppid(),), daemon=True).start()
    try:
        notes = export(folder, arguments[1] if len(arguments) > 1 else "")
    except Exception as error:
        if not isinstance(error, (OSError, ValueError, ImportError, RuntimeError)) and not _is_ours(error):
            traceback.print_exc()
        (folder / "error.txt").write_text(f"{error}\n", "utf-8")
        sys.stdout.flush()
        os._exit(1)  # sys.exit() within a script ends Blender with status 0 in some versions
    (folder / "notes.txt").write_text("".join(f"{note}\n" for note in notes), "utf-8")


def export(folder: Path, frames: str) -> list:
    """Writes the job; what it could not say. Whatever is wrong is an exception."""
    import hyades_render

    if not bpy.data.filepath:
        raise ValueError("Blender cannot read it: expected a .blend of this version or an older one")
    hyades_render.register()
    from hyades_render import animation

    scene = bpy.context.scene
    chosen = _frames(frames) if frames else animation.moving_frames(scene)
    exported = animation.job_of(scene, frames=chosen, name=Path(bpy.data.filepath).stem)
    exported.job.write(folder / "job.yaml")
    note = animation.still_note(scene) if chosen is None else ""
    return [*exported.complaints, *([note] if note else [])]


def _end_with(parent: int) -> None:
    """Ends where nobody waits for the job any more: what is written then nobody would remove."""
    while os.getppid() == parent:
        time.sleep(0.2)
    os._exit(1)


def _frames(text: str) -> range:
    match = re.fullmatch(r"(\d+)(?:-(\d+)(?:x(\d+))?)?", text)
    if match is None:
        raise ValueError(f"frames {text!r}: expected 7, 1-10 or 1-10x2")
    first, last, step = (int(part) if part else None for part in match.groups())
    return range(first, (first if last is None else last) + 1, step or 1)


def _is_ours(error: Exception) -> bool:
    return type(error).__module__.startswith("hyades")


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1 :])
