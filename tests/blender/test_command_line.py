"""Scenes of Blender from the command line: `hyades render film.blend`, `hyades submit film.blend`."""

import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest
from unittest import mock

import bpy
import hyades
import numpy
from addon import AddOnTest
from environment import HYADES, ROOT
from farm_process import FarmProcess


class CommandLine(AddOnTest):
    def setUp(self) -> None:
        super().setUp()
        self.blend = self.folder / "film.blend"
        self.scene.render.filepath = "//pictures/film_"

    def save(self) -> pathlib.Path:
        bpy.ops.wm.save_as_mainfile(filepath=str(self.blend))
        return self.blend

    def variables(self) -> dict[str, str]:
        """With which programs find this Blender, and the add-on."""
        blender = os.environ.get("HYADES_BLENDER") or bpy.app.binary_path
        return {"HYADES_BLENDER": blender, "HYADES_BLENDER_ADDON": str(ROOT / "blender")}

    def hyades(self, *words, status: int = 0, **variables: str) -> str:
        """What the program says on standard error."""
        environment = {**os.environ, **self.variables(), "TMPDIR": str(self.folder), **variables}
        run = subprocess.run(
            [HYADES, *map(str, words)], cwd=self.folder, env=environment, text=True, stderr=subprocess.PIPE
        )
        self.assertEqual(run.returncode, status, run.stderr)
        self.assertEqual(list(self.folder.glob("hyades-blend-*")), [])
        return run.stderr

    def test_a_still_scene_is_rendered_as_one_picture(self) -> None:
        # Deeper than the folder of the job that is made of it, which names Blender's colour configuration.
        self.blend = self.folder / "a/folder/within/folders/film.blend"
        self.blend.parent.mkdir(parents=True)
        self.hyades("render", self.save(), "-q")
        there = hyades.Picture.read(self.folder / "film_.png").array
        job = self.folder / "job.yaml"
        bpy.ops.hyades.export_job(filepath=str(job))
        here = hyades.render(job, self.folder / "here").picture().array
        numpy.testing.assert_array_equal(there, here)

    def test_nothing_stays_where_it_is_ended(self) -> None:
        blend = self.save()
        environment = {
            **os.environ,
            "HYADES_BLENDER": os.environ.get("HYADES_BLENDER") or bpy.app.binary_path,
            "HYADES_BLENDER_ADDON": str(ROOT / "blender"),
            "TMPDIR": str(self.folder),
        }
        words = [HYADES, "render", blend, "--samples", "100000", "--output", self.folder / "out"]
        for how in (signal.SIGINT, signal.SIGKILL):
            run = subprocess.Popen(list(map(str, words)), cwd=self.folder, env=environment, stderr=subprocess.DEVNULL)
            self.wait_until(lambda: list(self.folder.glob("hyades-blend-*/job.yaml")))
            time.sleep(0.5)
            run.send_signal(how)
            run.wait(30)
            self.wait_until(lambda: not list(self.folder.glob("hyades-blend-*")))

    def wait_until(self, true) -> None:
        end = time.monotonic() + 60
        while not true():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)

    def test_frames_of_an_animation(self) -> None:
        cube = bpy.data.objects["Cube"]
        for frame, turn in ((1, 0.0), (4, 1.0)):
            cube.rotation_euler.z = turn
            cube.keyframe_insert("rotation_euler", frame=frame)
        self.scene.frame_start, self.scene.frame_end = 1, 4
        self.hyades("render", self.save(), "-q", "--frames", "2-4x2", "--output", "out")
        files = sorted(path.name for path in (self.folder / "out").iterdir() if path.is_file())
        self.assertEqual(files, ["film_0002.png", "film_0004.png"])
        first, last = (hyades.Picture.read(self.folder / "out" / name).array for name in files)
        self.assertFalse(numpy.array_equal(first, last))

    def test_it_is_submitted_to_a_farm(self) -> None:
        farm = FarmProcess(self, self.folder / "farm")
        farm.worker()
        words = ("submit", self.save(), "--coordinator", farm.listen, "--watch", "-q")
        self.hyades(*words)
        with mock.patch.dict(os.environ, self.variables()):
            from_python = hyades.Farm(farm.address).submit(self.blend)
        self.assertEqual(hyades.Farm(farm.address).wait(from_python).state, "done")
        job = hyades.Farm(farm.address).find("film")
        self.assertEqual((job.state, job.frames), ("done", 1))

    def test_notes_and_mistakes_are_told(self) -> None:
        self.scene.render.image_settings.file_format = "TARGA"
        self.assertIn("files of type TARGA are not written", self.hyades("check", self.save()))
        broken = self.folder / "broken.blend"
        broken.write_bytes(b"BLENDER?")
        self.assertIn("Blender cannot read it", self.hyades("render", broken, status=2))
        self.assertIn("there is no such file", self.hyades("render", "none.blend", status=2))
        said = self.hyades("render", broken, status=2, HYADES_BLENDER="/nowhere")
        self.assertIn("/nowhere was not found: expected Blender", said)

    def test_a_copy_of_the_program_wants_to_know_where_the_add_on_is(self) -> None:
        for name in ("hyades", "hyades-render"):
            (self.folder / "bin").mkdir(exist_ok=True)
            shutil.copy2(HYADES.with_name(name), self.folder / "bin" / name)
        command = [self.folder / "bin/hyades", "render", self.save()]
        environment = {**os.environ, "HYADES_BLENDER": bpy.app.binary_path}
        environment.pop("HYADES_BLENDER_ADDON", None)
        run = subprocess.run(command, env=environment, text=True, stderr=subprocess.PIPE)
        self.assertEqual(run.returncode, 2)
        self.assertIn("HYADES_BLENDER_ADDON", run.stderr)


if __name__ == "__main__":
    unittest.main()
