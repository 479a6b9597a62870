"""The viewport in a window (Xvfb): it shows what Hyades renders, follows changes, and leaves no process behind."""

import os
import pathlib
import struct
import subprocess
import time
import unittest

import bpy
import numpy
from addon import AddOnTest, on_main

from hyades_render import viewport


class Window(AddOnTest):
    def setUp(self) -> None:
        super().setUp()
        on_main(self.prepare)

    def prepare(self) -> None:
        self.scene.hyades.preview_samples = 4
        self.scene.world.color = (0, 0, 0)
        self.window = bpy.context.window_manager.windows[0]
        self.area = next(area for area in self.window.screen.areas if area.type == "VIEW_3D")
        self.space = self.area.spaces[0]
        self.space.overlay.show_overlays = False
        self.space.show_gizmo = self.space.show_region_header = False
        self.space.show_region_toolbar = self.space.show_region_tool_header = False

    def wait(self, until) -> None:
        """Until Blender's window has got so far."""
        for _ in range(1200):
            if on_main(until):
                return
            time.sleep(0.05)
        self.fail("it does not come")

    def shown(self) -> numpy.ndarray:
        """What the viewport shows, without its edges: (h, w, 3) from 0 to 1, row 0 at the top. Read from the screen's
        file: of what Mesa draws in Blender 4.3 the operator that takes screenshots makes black ones."""
        data = pathlib.Path(os.environ["HYADES_SCREEN"]).read_bytes()
        header = struct.unpack(">25I", data[:100])  # XWDFile.h
        width, height, bytes_per_line, colors = header[4], header[5], header[12], header[19]
        rows = numpy.frombuffer(data, numpy.uint8, height * bytes_per_line, header[0] + 12 * colors)
        blue_first = rows.reshape(height, bytes_per_line)[:, : 4 * width].reshape(height, width, 4)
        top, left = height - self.area.y - self.area.height, self.area.x
        area = blue_first[top : top + self.area.height, left : left + self.area.width, 2::-1]
        return area[60:-10, 10:-10] / 255.0

    def refined(self) -> bool:
        """Whether the newest picture has all samples and is drawn."""
        for one in list(viewport._open):
            if one._refiner is not None and one._refiner.is_done():
                return one._refiner.picture()[0] == one._texture_number
        return False

    def children(self) -> list[str]:
        """Processes that this one has started."""
        found = subprocess.run(["pgrep", "-P", str(os.getpid()), "hyades"], stdout=subprocess.PIPE, text=True)
        return found.stdout.split()

    def change(self, what) -> None:
        """Changes the scene, and waits for the picture of it."""
        on_main(what)
        self.wait(lambda: not self.refined())
        self.wait(self.refined)

    def place_cube(self, x: float) -> None:
        bpy.data.objects["Cube"].location.x = x

    def shade(self, kind: str) -> None:
        self.space.shading.type = kind

    def test_the_viewport_refines_follows_and_ends(self) -> None:
        self.change(lambda: self.shade("RENDERED"))
        first = on_main(self.shown)
        self.assertGreater(float(first.max() - first.min()), 0.2)
        self.change(lambda: self.place_cube(1000))
        second = on_main(self.shown)
        self.assertLess(float(second.max() - second.min()), 0.1)
        self.change(lambda: self.place_cube(0))
        numpy.testing.assert_allclose(on_main(self.shown), first, atol=0.02)
        on_main(lambda: self.shade("SOLID"))
        self.wait(lambda: not self.children())
        self.assertEqual([one for one in viewport._open if one._refiner is not None], [])


if __name__ == "__main__":
    unittest.main()
