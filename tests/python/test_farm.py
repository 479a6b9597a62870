"""A real coordinator and real workers: what comes back is what `render` makes, whoever is killed."""

import pathlib
import subprocess
import tempfile
import threading
import time
import unittest
import warnings

from environment import HYADES, PROGRAMS
import numpy
from farm_process import FarmProcess

import hyades
from hyades import materials, objects, outputs, textures

if not (PROGRAMS / "hyades-coordinator").exists():
    raise unittest.SkipTest("these programs were built without the farm")


def scene(frames: str = "1-3", samples: int = 64) -> hyades.Job:
    job = hyades.Job(name="forest", frames=frames, film=hyades.Film(size=(64, 48)))
    job.sampling = hyades.Sampling(samples=samples)
    pixels = numpy.arange(4 * 4 * 3, dtype="uint8").reshape(4, 4, 3)
    red = materials.Lambert(color=textures.Image(file=pixels))
    points = numpy.array([[-1, 0, 0], [1, 0, 0], [0, 2, 0]], float)
    job.objects["ball"] = objects.Sphere(material=red, at=["= frame - 2", 0, 0])
    job.objects["leaf"] = objects.Mesh(mesh=hyades.MeshData(points, [[0, 1, 2]]))
    job.environment = hyades.Environment(color=[0.5, 0.6, 0.8])
    job.outputs = [outputs.Exr(file="forest.####.exr", layers=["beauty", "alpha", "normal"]), outputs.Png(file="png/forest.####.png")]
    return job


class WholeFarm(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.process = FarmProcess(self, self.folder / "farm")
        self.farm = hyades.Farm(self.process.address, patience=30)

    def assert_same_as_here(self, job: hyades.Job, fetched: list) -> None:
        here = hyades.render(job, self.folder / "here")
        files = [path for frame in here.files.values() for path in frame]
        self.assertEqual(len(fetched), len(files))
        for path in files:
            name = path.relative_to(self.folder / "here")
            self.assertEqual(path.read_bytes(), (self.folder / "there" / name).read_bytes(), name)

    def test_what_is_likely_not_meant_is_told(self) -> None:
        dark = scene()
        dark.environment = None
        with self.assertWarnsRegex(UserWarning, "nothing gives light"):
            self.farm.submit(dark)
        told: list = []
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.farm.submit(dark, on_warning=told.append)
            self.assertEqual(len(told), 1)
            self.farm.submit(scene())

    def test_the_farm_gives_the_bits_of_this_machine_whoever_is_killed(self) -> None:
        job = scene(samples=256)
        submitted = self.farm.submit(job, priority=3, tags=[])
        self.assertEqual((submitted.state, submitted.frames, submitted.priority), ("running", 3, 3))
        self.assertTrue(submitted.waiting)  # nobody is there
        self.assertTrue(any("worker" in reason for reason in self.farm.explain(submitted)))
        first = self.process.worker()
        events, killed = [], False
        for change in self.farm.watch(submitted):
            events.append(change)
            if not killed and change.job.samples_done > 0:
                killed = True
                self.process.kill(first)  # in the middle of its units
                self.process.kill(self.process.coordinator)
                self.process.start()
                self.process.worker()
        self.assertTrue(killed)
        self.assertEqual([frame.id for frame in events[0].frames], [1, 2, 3])
        self.assertEqual(events[-1].job.state, "done")
        self.assertEqual(events[-1].job.share, 1.0)
        self.assert_same_as_here(job, self.farm.fetch(submitted, self.folder / "there"))
        # Once more: nothing comes, for all is there; and the command knows the same list.
        came = []
        self.farm.fetch(submitted, self.folder / "there", on_bytes=came.append)
        self.assertEqual(came, [])
        listed = (self.folder / "there/.hyades/fetched").read_text().splitlines()
        name = f"{submitted.id} {submitted.submitted_ms}"
        self.assertEqual(sorted(listed), sorted(f"{f.sha256} {name} {f.id}" for f in self.farm.outputs(submitted)))

    def test_files_are_sent_once_and_submissions_made_once(self) -> None:
        sent = []
        self.farm.submit(scene(), on_bytes=lambda done, total: sent.append((done, total)))
        self.assertGreater(len(sent), 2)
        self.assertEqual(sent[-1][0], sent[-1][1])
        sent.clear()
        again = self.farm.submit(scene(), name="again", frames=range(2, 4), on_bytes=lambda *b: sent.append(b))
        self.assertEqual(sent, [])
        self.assertEqual((again.name, again.frames), ("again", 2))
        self.assertEqual([job.name for job in self.farm.jobs()], ["again", "forest"])
        self.assertEqual(self.farm.find("forest").frames, 3)
        with self.assertRaisesRegex(ValueError, "not 'forest'; Farm.find"):
            self.farm.job("forest")
        number = self.farm.find("forest").id
        self.assertEqual(self.farm.job(str(number)).name, "forest")

    def test_jobs_are_steered_and_looked_at(self) -> None:
        job = self.farm.submit(scene())
        self.assertEqual(self.farm.pause(job).state, "paused")
        self.assertEqual(self.farm.resume(job).state, "running")
        self.assertEqual(self.farm.set_priority(job, 7).priority, 7)
        self.assertEqual([frame.state for frame in self.farm.frames(job, "waiting")], ["waiting"] * 3)
        worker = self.process.worker()
        layers = self.wait_for_film(job)
        self.assertEqual(layers["beauty"].shape, (48, 64, 3))
        self.assertEqual(layers["beauty"].dtype, numpy.float32)
        self.assertIn("normal", layers)
        self.assertEqual(self.farm.wait(job).state, "done")
        (row,) = self.farm.workers()
        self.assertEqual((row.state, row.threads), ("active", 1))
        self.assertEqual(self.farm.drain(row).state, "draining")
        worker.wait(20)
        self.assertTrue(any(line.level == "info" for line in self.farm.logs(job)))
        self.farm.delete(job)
        with self.assertRaises(hyades.FarmError) as caught:
            self.farm.job(job)
        self.assertEqual(caught.exception.code, "not_found")

    def wait_for_film(self, job):
        for _ in range(300):
            try:
                return self.farm.films(job, 1)
            except hyades.FarmError:
                time.sleep(0.1)
        self.fail("no film came")

    def test_a_cancelled_job_keeps_what_it_has(self) -> None:
        job = self.farm.submit(scene(samples=1 << 20))
        self.assertEqual(self.farm.cancel(job).state, "cancelled")
        self.assertEqual(self.farm.wait(job).state, "cancelled")
        self.assertEqual(self.farm.fetch(job, self.folder / "there"), [])
        self.assertEqual(self.farm.retry(job).state, "running")

    def test_fetch_follows(self) -> None:
        job = scene()
        submitted = self.farm.pause(self.farm.submit(job))
        self.process.worker()
        threading.Timer(0.5, self.farm.resume, (submitted,)).start()
        self.assert_same_as_here(job, self.farm.fetch(submitted, self.folder / "there", follow=True))

    def test_a_mistake_in_the_job_comes_back_with_its_place(self) -> None:
        job = scene()
        job.objects["ball"].material = "clay"
        with self.assertRaises(hyades.JobError) as caught:
            self.farm.submit(job)
        self.assertEqual(caught.exception.file, "forest.yaml")
        self.assertIn("clay", caught.exception.message)
        self.assertIs(caught.exception.source, job.objects["ball"])

    def test_files_that_name_others_are_found_by_the_program(self) -> None:
        (self.folder / "look.yaml").write_text("materials: {clay: {type: lambert, color: 0.3}}\n")
        job = scene(frames="1")
        job.include = self.folder / "look.yaml"
        job.objects["ball"].material = "clay"
        path = job.write(self.folder / "job/forest.yaml")
        for what in (job, path):
            self.farm.submit(what)
        # Without the program only what needs none is submitted.
        with self.assertRaises(hyades.ProgramError):
            self.farm.submit(path, program=self.folder / "none")
        self.farm.submit(scene(), program=self.folder / "none")

    def test_scenes_of_other_tools_travel_as_what_is_made_of_them(self) -> None:
        (self.folder / "tent.mtl").write_text("newmtl cloth\nKd 0.8 0.2 0.1\n")
        (self.folder / "tent.obj").write_text("mtllib tent.mtl\nv -1 0 0\nv 1 0 0\nv 0 2 0\nusemtl cloth\nf 1 2 3\n")
        (self.folder / "three.lua").write_text(
            "local list = {} for i = 1, 100 do list[i] = {at = {i / 50 - 1, 0, 0}, scale = 0.01} end\n"
            "return {name = 'three', film = {size = {32, 32}}, sampling = {samples = 16}, environment = {color = 1},\n"
            "  groups = {g = {objects = {b = {shape = 'sphere'}}}}, outputs = {{file = 'three.exr'}},\n"
            "  objects = {all = {instance = 'g', places = places(list)}}}\n"
        )
        self.process.worker()
        job = scene(frames="1")
        job.objects["tent"] = objects.ObjScene(obj=self.folder / "tent.obj")
        for what in (job, self.folder / "three.lua"):
            with self.subTest(what=str(what)):
                submitted = self.farm.submit(what)
                self.assertEqual(self.farm.wait(submitted).state, "done")
                self.assert_same_as_here(what, self.farm.fetch(submitted, self.folder / "there"))


class Guarded(unittest.TestCase):
    def test_token_and_tls(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            certs = folder / "certs"
            run = lambda *words: subprocess.run([HYADES, *words], check=True, capture_output=True)
            run("certs", "init", "--dir", str(certs))
            run("certs", "issue", "--dir", str(certs), "--name", "farm", "--ip", "127.0.0.1", "--server")
            (folder / "token").write_text("a-token-of-thirty-two-characters!\n")
            (folder / "token").chmod(0o600)
            options = ["--tls-cert", str(certs / "farm.pem"), "--tls-key", str(certs / "farm.key")]
            process = FarmProcess(self, folder / "farm", *options, "--token-file", str(folder / "token"))
            token = (folder / "token").read_text().strip()
            self.assertTrue(process.address.startswith("https://"))
            farm = hyades.Farm(process.address, token=token, ca=certs / "ca.pem", patience=5)
            self.assertEqual(farm.info()["jobs"], 0)
            with self.assertRaises(hyades.FarmError) as caught:
                hyades.Farm(process.address, token="another", ca=certs / "ca.pem", patience=5).info()
            self.assertEqual(caught.exception.code, "unauthenticated")
            with self.assertRaises(hyades.FarmError) as caught:  # signed by nobody whom this machine knows
                hyades.Farm(process.address, token=token, patience=5).info()
            self.assertEqual(caught.exception.code, "untrusted")


if __name__ == "__main__":
    unittest.main()
