"""The farm from Blender: an animation of which a worker is killed, F12 on the farm, the list of jobs."""

import time
import unittest
from unittest import mock

import bpy
import hyades
import numpy
from addon import AddOnTest
from farm_process import FarmProcess

from hyades_render import farm_state, preferences, runs


class Farms(AddOnTest):
    def setUp(self) -> None:
        super().setUp()
        self.farm = FarmProcess(self, self.folder / "farm")
        self.workers = [self.farm.worker(), self.farm.worker()]
        patch = mock.patch.dict("os.environ", {"HYADES_HTTP": self.farm.address})
        patch.start()
        self.addCleanup(patch.stop)
        self.scene.render.resolution_x, self.scene.render.resolution_y = 48, 32

    def wait_for(self, look):
        for _ in range(600):
            if found := look():
                return found
            time.sleep(0.05)
        raise AssertionError("it does not happen")

    def test_an_animation_is_there_though_a_worker_is_killed(self) -> None:
        cube = bpy.data.objects["Cube"]
        for frame, place in ((1, -2.0), (4, 2.0)):
            cube.location.x = place
            cube.keyframe_insert("location", frame=frame)
        self.scene.frame_start, self.scene.frame_end = 1, 4
        self.scene.hyades.samples, self.scene.hyades.farm_name = 256, "moving cube"
        self.scene.hyades.farm_priority = 7
        self.scene.render.filepath = str(self.folder / "out/cube_")
        self.assertEqual(bpy.ops.hyades.submit(), {"FINISHED"})
        farm = hyades.Farm(self.farm.address)
        job = farm.find("moving cube")
        self.assertEqual((job.frames, job.priority), (4, 7))
        self.wait_for(lambda: farm.job(job).samples_done)
        self.farm.kill(self.workers[0])
        bpy.ops.hyades.fetch(job=job.id)
        self.assertEqual(farm.job(job).state, "done")
        files = sorted(path.name for path in (self.folder / "out").glob("*.png"))
        self.assertEqual(files, [f"cube_000{frame}.png" for frame in range(1, 5)])
        pictures = [hyades.Picture.read(self.folder / "out" / name).array.astype(int) for name in files]
        columns = [int(numpy.argmax(abs(p - p[0, 0]).sum(axis=(0, 2)))) for p in pictures]
        self.assertEqual(columns, sorted(columns))  # it moves to the right
        self.assertLess(columns[0] + 5, columns[-1])

    def test_f12_on_the_farm_gives_the_bits_of_this_machine(self) -> None:
        here = self.render("here")["ViewLayer.Combined"]
        self.scene.hyades.render_on = "farm"
        there = self.render("there")["ViewLayer.Combined"]
        numpy.testing.assert_array_equal(here, there)
        self.assertEqual([job.state for job in hyades.Farm(self.farm.address).jobs(ended=True)], ["done"])

    def test_esc_cancels_the_job_and_jobs_are_listed(self) -> None:
        path = self.folder / "long.yaml"
        self.scene.hyades.samples = 1 << 16
        bpy.ops.hyades.export_job(filepath=str(path))
        farm = hyades.Farm(self.farm.address)
        run = runs.FarmRun(farm, preferences.find_program(), path, 1, name="long")
        picture = self.wait_for(lambda: shape_of(run))
        self.assertEqual(picture, (32, 48, 4))
        self.wait_for(lambda: run.progress()["samples_done"])
        self.assertTrue(run.running())
        run.close()
        self.wait_for(lambda: farm.find("long").state == "cancelled")
        farm_state.start_watch()
        self.addCleanup(farm_state.stop_watch)
        seen = self.wait_for(lambda: farm_state.watch.seen.jobs and farm_state.watch.seen)
        self.assertEqual([(job.name, job.state) for job in seen.jobs], [("long", "cancelled")])
        farm_state.take_news()
        self.assertEqual([row.name for row in bpy.context.window_manager.hyades_jobs], ["long"])

    def test_what_is_wrong_is_told(self) -> None:
        with mock.patch.dict("os.environ", {"HYADES_HTTP": "http://farm.example:8080"}):
            with self.assertRaisesRegex(RuntimeError, "farm.example is another machine: expected https"):
                bpy.ops.hyades.submit()
        bpy.ops.hyades.fetch(job=99, folder=str(self.folder / "x"))
        self.assertTrue(farm_state.message_is_error)
        self.assertIn("99", farm_state.message)


def shape_of(run: runs.FarmRun):
    picture = run.picture()
    return None if picture is None else picture.shape


if __name__ == "__main__":
    unittest.main()
