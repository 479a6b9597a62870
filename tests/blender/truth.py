"""Runs in Blender: scenes of one file, rendered by Cycles and by Hyades, and whether they mean the same.

    blender -b --factory-startup -P tests/blender/truth.py -- lights [NAME ...]

Prints a line for each scene: means of Cycles and of Hyades, the difference of the means (at most 2 %, unless the scene
says otherwise) and the largest of a block of 8 x 8 pixels (at most 5 %). HYADES_TRUTH names a folder that keeps the pictures;
HYADES_TEST_QUARTER=0..3 takes a quarter of the scenes.
"""

import importlib
import os
import pathlib
import sys
import tempfile
import time
import traceback
import types

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "python")]
# The exporter alone, without the rest of the add-on.
sys.modules["hyades_render"] = types.ModuleType("hyades_render")
sys.modules["hyades_render"].__path__ = [str(HERE.parents[1] / "blender/hyades_render")]

import bpy  # noqa: E402
from both import Exporting, by_cycles, by_hyades, exported  # noqa: E402
from compare import Comparison  # noqa: E402
from scene import SCENES, Scene, begin  # noqa: E402

import hyades  # noqa: E402


def judge(scene: Scene, folder: pathlib.Path) -> list[str]:
    """What is wrong with a scene; empty: it means the same."""
    folder.mkdir(parents=True, exist_ok=True)
    begin()
    scene.build()
    made = exported()
    began = time.process_time()
    light = by_cycles(folder, scene.samples)
    both = Comparison(light, by_hyades(made, folder, scene.samples))
    hyades.Picture(light.astype("float32")).save(folder / "cycles.png")
    hyades.Picture.read(folder / "hyades.exr").save(folder / "hyades.png")
    print(f"{scene.name:24} {both}  ({time.process_time() - began:.1f} s)", *made.complaints, sep="\n    ", flush=True)
    wrong = []
    if both.mean > scene.mean:
        wrong.append(f"{scene.name}: the means differ by {100 * both.mean:.2f} %, more than {100 * scene.mean:g} %")
    if both.block > scene.block:
        wrong.append(f"{scene.name}: a block differs by {100 * both.block:.2f} %, more than {100 * scene.block:g} %")
    said = {str(complaint) for complaint in made.complaints}
    for expected in scene.complaints:
        if not any(expected in one for one in said):
            wrong.append(f"{scene.name}: nobody complains of '{expected}'")
    if not scene.complaints and said:
        wrong.append(f"{scene.name}: unexpected complaints")
    return wrong


def main(subject: str, names: list[str]) -> int:
    importlib.import_module(f"scenes.{subject}")
    bpy.utils.register_class(Exporting)
    kept = os.environ.get("HYADES_TRUTH")
    quarter = os.environ.get("HYADES_TEST_QUARTER")
    scenes = SCENES[["0", "1", "2", "3"].index(quarter) :: 4] if quarter else SCENES
    print(f"{len(scenes)} of {len(SCENES)} scenes")
    wrong: list[str] = []
    with tempfile.TemporaryDirectory() as scratch:
        for scene in scenes:
            if not names or scene.name in names:
                wrong += judge(scene, pathlib.Path(kept or scratch) / scene.name)
    print(*wrong, sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    status = 1
    try:
        arguments = sys.argv[sys.argv.index("--") + 1 :]
        status = main(arguments[0], arguments[1:])
    except Exception:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        os._exit(status)  # Blender would end with 0 whatever was raised
