"""The viewport in a window (Xvfb): it shows what Hyades renders, follows changes, and leaves no process behind."""

import os
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
        """What the viewport shows, without its edges: (h, w, 4), row 0 at the top."""
        path = self.folder / "window.png"
        with bpy.context.temp_override(window=self.window, area=self.area):
            bpy.ops.screen.screenshot_area(filepath=str(path))
        image = bpy.data.images.load(str(path))
        pixels = numpy.empty(len(image.pixels), numpy.float32)
        image.pixels.foreach_get(pixels)
        width, height = image.size
        bpy.data.images.remove(image)
        return pixels.reshape(height, width, 4)[::-1][60:-10, 10:-10]

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
        self.assertGreater(float(first[:, :, :3].max() - first[:, :, :3].min()), 0.2)
        self.change(lambda: self.place_cube(1000))
        second = on_main(self.shown)
        self.assertLess(float(second[:, :, :3].max() - second[:, :, :3].min()), 0.1)
        self.change(lambda: self.place_cube(0))
        numpy.testing.assert_allclose(on_main(self.shown), first, atol=0.02)
        on_main(lambda: self.shade("SOLID"))
        self.wait(lambda: not self.children())
        self.assertEqual([one for one in viewport._open if one._refiner is not None], [])


if __name__ == "__main__":
    unittest.main()
