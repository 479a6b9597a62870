"""The viewport in a window (Xvfb): it shows what Hyades renders, follows changes, and leaves no process behind."""

import os
import subprocess
import time
import unittest

import bpy
import numpy
from addon import AddOnTest

from hyades_render import viewport


class Window(AddOnTest):
    def setUp(self) -> None:
        super().setUp()
        self.scene.hyades.preview_samples = 4
        self.scene.world.color = (0, 0, 0)
        self.window = bpy.context.window_manager.windows[0]
        self.area = next(area for area in self.window.screen.areas if area.type == "VIEW_3D")
        self.space = self.area.spaces[0]
        self.space.overlay.show_overlays = False
        self.space.show_gizmo = self.space.show_region_header = False
        self.space.show_region_toolbar = self.space.show_region_tool_header = False

    def draw(self, until) -> None:
        """Draws the window again and again."""
        for _ in range(400):
            with bpy.context.temp_override(window=self.window):
                bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
            if until():
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
            if one._refiner is not None and one._refiner.words().startswith("100%"):
                return one._refiner.picture()[0] == one._texture_number
        return False

    def children(self) -> list[str]:
        """Processes that this one has started."""
        found = subprocess.run(["pgrep", "-P", str(os.getpid()), "hyades"], stdout=subprocess.PIPE, text=True)
        return found.stdout.split()

    def test_the_viewport_refines_follows_and_ends(self) -> None:
        self.space.shading.type = "RENDERED"
        self.draw(self.refined)
        first = self.shown()
        self.assertGreater(float(first[:, :, :3].max() - first[:, :, :3].min()), 0.2)
        bpy.data.objects["Cube"].scale = (0.01, 0.01, 0.01)
        self.draw(lambda: not self.refined())
        self.draw(self.refined)
        second = self.shown()
        self.assertLess(float(second[:, :, :3].max() - second[:, :, :3].min()), 0.1)
        bpy.data.objects["Cube"].scale = (1, 1, 1)
        self.draw(lambda: not self.refined())
        self.draw(self.refined)
        numpy.testing.assert_allclose(self.shown(), first, atol=0.02)
        self.space.shading.type = "SOLID"
        self.draw(lambda: not self.children())
        self.assertEqual([one for one in viewport._open if one._refiner is not None], [])


if __name__ == "__main__":
    unittest.main()
