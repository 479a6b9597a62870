"""Runs in Blender: the tests of one file, by unittest. See `run`."""

import os
import pathlib
import sys
import threading
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
ARGUMENTS = sys.argv[sys.argv.index("--") + 1 :]
sys.dont_write_bytecode = True
sys.path[:0] = [str(HERE), str(ROOT / "tests/python")]

import bpy  # noqa: E402


def find_add_on(subject: str) -> None:
    """Makes `import hyades_render` mean the tree's; but what test_zip installs is not hidden by the tree."""
    import environment  # noqa: F401  (names the program)

    if subject != "test_zip":
        sys.path[:0] = [str(ROOT / "blender")]
    else:
        sys.path.remove(str(ROOT / "python"))


def main(subject: str, names: list[str]) -> int:
    """Exit status: 0 passed, 1 failed, 77 all skipped."""
    loader = unittest.defaultTestLoader
    tests = loader.loadTestsFromNames([f"{subject}.{name}" for name in names] or [subject])
    result = unittest.TextTestRunner(verbosity=2, stream=sys.stdout).run(tests)
    if not result.wasSuccessful():
        return 1
    return 77 if len(result.skipped) >= max(result.testsRun, 1) else 0


def run() -> None:
    status = 1
    try:
        status = main(ARGUMENTS[0], ARGUMENTS[1:])
    finally:
        sys.stdout.flush()
        os._exit(status)  # Blender would end with 0 whatever was raised


find_add_on(ARGUMENTS[0])
if bpy.app.background:
    run()
else:
    import addon  # noqa: E402

    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(addon.serve, first_interval=1, persistent=True)  # once there is a window
    threading.Thread(target=run, daemon=True).start()
