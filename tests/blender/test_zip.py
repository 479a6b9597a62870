"""The zip as people install it: Blender's own installer, a fresh home, no tree beside it."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import bpy

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Zip(unittest.TestCase):
    def test_it_installs_renders_and_goes_again(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        folder = pathlib.Path(scratch.name)
        made = subprocess.run(
            ["python3", ROOT / "blender/make_zip", folder], check=True, stdout=subprocess.PIPE, text=True
        ).stdout.strip()
        bpy.ops.preferences.addon_install(filepath=made)
        bpy.ops.preferences.addon_enable(module="hyades_render")
        self.assertIn("hyades_render", bpy.context.preferences.addons)
        import hyades

        home = pathlib.Path(bpy.utils.user_resource("SCRIPTS"))
        self.assertTrue(pathlib.Path(hyades.__file__).is_relative_to(home / "addons/hyades_render/vendor"))
        scene = bpy.context.scene
        scene.render.engine = "HYADES"
        scene.render.resolution_x = scene.render.resolution_y = 32
        scene.hyades.samples = 1
        scene.render.filepath = str(folder / "picture.png")
        bpy.ops.render.render(write_still=True)
        self.assertEqual(hyades.Picture.read(folder / "picture.png").array.shape[:2], (32, 32))
        preferences = bpy.context.preferences.addons["hyades_render"].preferences
        preferences.program = str(folder / "none")
        with self.assertRaisesRegex(RuntimeError, "none is no program"):
            bpy.ops.render.render()
        bpy.ops.preferences.addon_disable(module="hyades_render")
        self.assertFalse(hasattr(bpy.types.Scene, "hyades"))
        self.assertNotIn("HYADES", bpy.types.RENDER_PT_simplify.COMPAT_ENGINES)
        bpy.ops.preferences.addon_enable(module="hyades_render")
        self.assertTrue(hasattr(bpy.types.Scene, "hyades"))

    def test_equal_files_give_equal_bytes(self) -> None:
        sizes = []
        for _ in range(2):
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run(["python3", ROOT / "blender/make_zip", folder], check=True, stdout=subprocess.DEVNULL)
                (made,) = pathlib.Path(folder).iterdir()
                sizes.append(made.read_bytes())
        self.assertEqual(*sizes)


if __name__ == "__main__":
    sys.exit(unittest.main())
