"""The add-on of the source tree, switched on, and small scenes for it."""

import concurrent.futures
import pathlib
import queue
import tempfile
import threading
import unittest

import bpy
import hyades

import hyades_render

ON = False
_wanted: queue.Queue = queue.Queue()


def on_main(do):
    """What `do` returns, done by the thread that Blender runs in. Tests in a window run in another one, so that Blender
    draws as it always does."""
    if threading.current_thread() is threading.main_thread():
        return do()
    result: concurrent.futures.Future = concurrent.futures.Future()
    _wanted.put((do, result))
    return result.result()


def serve() -> float:
    """Does what tests want of the main thread: a timer of Blender."""
    while not _wanted.empty():
        do, result = _wanted.get()
        try:
            result.set_result(do())
        except BaseException as error:
            result.set_exception(error)
    return 0.01  # seconds until it looks again


class AddOnTest(unittest.TestCase):
    """A test with the add-on, a fresh scene of a lit cube, and a folder."""

    def setUp(self) -> None:
        on_main(self._begin)

    def _begin(self) -> None:
        global ON
        if bpy.app.background:  # in a window it takes away what runs the tests; one test has one of its own
            bpy.ops.wm.read_factory_settings()
        if not ON:
            hyades_render.register()
            ON = True
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.scene = bpy.context.scene
        render = self.scene.render
        render.engine = "HYADES"
        render.resolution_x, render.resolution_y = 64, 40
        self.scene.hyades.samples = 16

    def render(self, name: str = "picture") -> hyades.Layers:
        """F12: the layers of the file that it writes."""
        image = self.scene.render.image_settings
        image.file_format, image.color_depth = "OPEN_EXR_MULTILAYER", "32"
        image.exr_codec = "ZIP"
        path = self.folder / f"{name}.exr"
        self.scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True)
        return hyades.read_exr(path)

    def by_job(self) -> hyades.Layers:
        """The same scene by the operator that exports it, and the program."""
        path = self.folder / "exported.yaml"
        bpy.ops.hyades.export_job(filepath=str(path))
        return hyades.render(path, self.folder / "exported").layers()
