"""Runs in Blender: the tests of one file, by unittest. See `run`."""

import os
import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.dont_write_bytecode = True
sys.path[:0] = [str(HERE), str(ROOT / "tests/python")]

import bpy  # noqa: E402


def main(subject: str, names: list[str]) -> int:
    """Exit status: 0 passed, 1 failed, 77 all skipped."""
    import environment  # noqa: F401  (names the program)

    if subject != "test_zip":  # what is installed is not hidden by the tree there
        sys.path[:0] = [str(ROOT / "blender")]
    else:
        sys.path.remove(str(ROOT / "python"))
    loader = unittest.defaultTestLoader
    tests = loader.loadTestsFromNames([f"{subject}.{name}" for name in names] or [subject])
    result = unittest.TextTestRunner(verbosity=2, stream=sys.stdout).run(tests)
    if not result.wasSuccessful():
        return 1
    return 77 if len(result.skipped) >= max(result.testsRun, 1) else 0


def run() -> None:
    status = 1
    try:
        arguments = sys.argv[sys.argv.index("--") + 1 :]
        status = main(arguments[0], arguments[1:])
    finally:
        sys.stdout.flush()
        os._exit(status)  # Blender would end with 0 whatever was raised


if bpy.app.background:
    run()
else:
    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(run, first_interval=1)  # once there is a window
