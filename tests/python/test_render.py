"""Renders with the real program: arrays arrive, mistakes come back, Ctrl-C ends it."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

import environment
import numpy

import hyades
from hyades import materials, objects, outputs, textures


def small(**keys) -> hyades.Job:
    job = hyades.Job(film=hyades.Film(size=(24, 16)), sampling=hyades.Sampling(samples=16), **keys)
    job.environment = hyades.Environment(color=1)
    return job


class Render(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_scripts_have_parameters(self) -> None:
        script = self.folder / "ball.lua"
        script.write_text(
            "return {film={size={8, 8}}, sampling={samples=1}, environment={color=param('bright', 0.5)},\n"
            "  objects={ball={shape='sphere'}}, outputs={{file='ball.exr'}}}\n"
        )
        made = [hyades.render(script, self.folder / f"{at}", set={"bright": at}).picture().array.mean() for at in (0.1, 0.9)]
        self.assertLess(made[0], made[1] - 0.01)
        with self.assertRaisesRegex(hyades.HyadesError, "brihgt"):
            hyades.check(script, set={"brihgt": 1})

    def test_arrays_become_what_is_seen(self) -> None:
        # A square before the camera, half red and half green, by a picture and by colours of its corners.
        points = [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]]
        uvs = [[0, 0], [1, 0], [1, 1], [0, 1]]
        red = [1, 0, 0]
        square = hyades.MeshData(points, [[0, 1, 2], [0, 2, 3]], uvs=uvs, colors=[red] * 4)
        with self.assertRaisesRegex(ValueError, "divide by 255"):
            hyades.MeshData(points, [[0, 1, 2]], colors=numpy.full((4, 3), 26, "uint8"))
        halves = numpy.zeros((1, 2, 3), "float32")
        halves[0, 0], halves[0, 1] = [0.8, 0, 0], [0, 0.8, 0]
        image = textures.Image(file=halves, filter="nearest", wrap="clamp")
        for color, left, right in ((image, 0, 1), (textures.VertexColor(), 0, 0)):
            job = small(name="square", integrator=hyades.integrators.Path(max_depth=1))
            job.objects["square"] = objects.Mesh(mesh=square, material=materials.Lambert(color=color))
            light = hyades.render(job, self.folder / "square").picture().array
            self.assertEqual(light.shape, (16, 24, 3))
            self.assertEqual(light[8, 2].argmax(), left)
            self.assertEqual(light[8, 21].argmax(), right)
        self.assertAlmostEqual(float(light[8, 2, 0]), 1.0, places=2)

    def test_places_and_float_pictures(self) -> None:
        ball = objects.Group(objects={"a": objects.Sphere(radius=0.5)})
        job = small(name="copies")
        places = hyades.Places([[-2, 0, 0], [2, 0, 0]], scale=[1, 2], rotations=[[0, 0, 0, 1]] * 2)
        job.objects["balls"] = objects.Instance(instance=ball, places=places)
        job.outputs = [outputs.Exr(file="copies.exr", layers=["beauty", "alpha", "depth"], half=True)]
        layers = hyades.render(job, self.folder).layers()
        self.assertEqual(layers.attributes["hyades.samples"], "16")
        self.assertEqual(layers["alpha"].shape, (16, 24))
        self.assertGreater(layers["alpha"][:, 12:].sum(), 2 * layers["alpha"][:, :12].sum())
        self.assertTrue(numpy.isinf(layers["depth"][0, 0]))

    def test_strands_have_widths_and_colors(self) -> None:
        job = small(name="strands", integrator=hyades.integrators.Path(max_depth=1))
        job.environment = hyades.Environment(color=1)
        upright = [[[x, -2, 0], [x, 0, 0], [x, 2, 0]] for x in (-1, 1)]
        strands = hyades.Strands(upright, (0.5, 0.5), colors=[[1, 0, 0], [0, 0, 1]])
        color = hyades.textures.VertexColor()
        job.objects["s"] = objects.Curves(curves=strands, material=materials.Lambert(color=color))
        job.outputs = [outputs.Exr(file="strands.exr", layers=["albedo", "alpha"])]
        layers = hyades.render(job, self.folder).layers()
        # Two upright bands, 0.5 wide each: a red one on the left, a blue one on the right.
        row = layers["albedo"][8]
        self.assertGreater(row[:12, 0].sum(), 10 * row[:12, 2].sum())
        self.assertGreater(row[12:, 2].sum(), 10 * row[12:, 0].sum())
        lists = hyades.Strands([numpy.array(p, "f4") for p in upright], [[0.5] * 3] * 2, colors=strands.colors)
        self.assertEqual(lists.encode(), strands.encode())

    def test_frames_progress_and_what_was_written(self) -> None:
        job = small(name="moves", frames="1-3", keep_films=True)
        mesh = {f: hyades.MeshData([[f, 0, 0], [f + 1, 0, 0], [f, 1, 0]], [[0, 1, 2]]) for f in (1, 2, 3)}
        job.objects["m"] = objects.Mesh(mesh=mesh)
        job.outputs = [outputs.Png(file="png/moves.####.png"), outputs.Exr(file="moves.####.exr")]
        told = []
        done = hyades.render(job, self.folder, on_progress=told.append, threads=1)
        self.assertEqual(sorted(done.files), [1, 2, 3])
        names = [str(path.relative_to(self.folder)) for path in done.files[2]]
        self.assertEqual(names, ["png/moves.0002.png", "moves.0002.exr", "moves.0002.film.exr"])
        self.assertTrue(all(path.is_file() for files in done.files.values() for path in files))
        self.assertTrue(told and told[0].frames == 3 and 0 <= told[0].share <= 1)
        self.assertFalse((done.picture(1).array == done.picture(3).array).all())
        self.assertEqual(done._repr_png_(), hyades.Picture.read(done.files[1][0])._repr_png_())
        # A film's first part is its picture.
        film = hyades.read_exr(done.files[2][2])
        self.assertTrue((film["beauty"] == done.picture(2).array).all())
        self.assertEqual(list(hyades.render(job, self.folder, frames=range(2, 4), resume=True).files), [2, 3])

    def test_a_mistake_comes_back_with_its_place_and_its_object(self) -> None:
        ball = objects.Sphere(material="clay")
        job = small(name="wrong", objects={"ball": ball, "box": objects.Box(size=[1, 2, 3])})
        with self.assertRaises(hyades.JobError) as caught:
            hyades.render(job, self.folder)
        error = caught.exception
        text = (self.folder / "wrong.yaml").read_text().splitlines()
        self.assertEqual(error.file, str(self.folder / "wrong.yaml"))
        self.assertIn("clay", text[error.line - 1])
        self.assertIn("clay", error.message)
        self.assertIs(error.source, ball)
        with self.assertRaises(hyades.JobError):
            hyades.check(job)
        ball.material = None
        self.assertIn("good", hyades.check(job))

    def test_a_file_of_somebody_else_is_not_replaced(self) -> None:
        mine = self.folder / "shot.yaml"
        mine.write_text("hyades: 1\n")
        with self.assertRaisesRegex(hyades.HyadesError, "shot.yaml is there"):
            hyades.render(small(name="shot"), self.folder)
        self.assertEqual(mine.read_text(), "hyades: 1\n")

    def test_other_failures_say_what_is_wrong(self) -> None:
        with self.assertRaisesRegex(hyades.ProgramError, "nowhere.yaml"):
            hyades.render(self.folder / "nowhere.yaml", self.folder)
        with self.assertRaisesRegex(hyades.ProgramError, "no program"):
            hyades.render(small(), self.folder, program=self.folder / "hyades")
        with self.assertRaisesRegex(hyades.ProgramError, "crop"):
            hyades.render(small(), self.folder, crop=(0, 0, 1000, 1000))

    def test_the_files_of_a_job_are_told(self) -> None:
        job = small(name="files", objects={"m": objects.Mesh(mesh=hyades.MeshData([[0, 0, 0]] * 3, [[0, 1, 2]]))})
        path = job.write(self.folder / "files.yaml")
        from hyades.program import files_of

        listed = files_of(path)
        self.assertEqual(listed[0]["path"], "files.yaml")
        self.assertEqual(len(listed), 2)
        self.assertTrue(listed[1]["path"].startswith("assets/"))

    def test_ctrl_c_ends_the_program(self) -> None:
        script = (
            "import environment, hyades, sys\n"
            "job = hyades.Job(name='long', film=hyades.Film(size=(64, 64)), sampling=hyades.Sampling(samples=1 << 24))\n"
            "job.environment = hyades.Environment(color=1)\n"
            "try:\n"
            "    hyades.render(job, sys.argv[1], threads=1, on_progress=lambda p: print('begun', flush=True))\n"
            "except KeyboardInterrupt:\n"
            "    sys.exit(7)\n"
        )
        process = subprocess.Popen(
            [sys.executable, "-c", script, str(self.folder)],
            cwd=pathlib.Path(__file__).parent,
            stdout=subprocess.PIPE,
            start_new_session=True,
        )
        self.addCleanup(process.kill)
        self.addCleanup(process.stdout.close)
        self.assertEqual(process.stdout.readline(), b"begun\n")
        children = subprocess.run(["ps", "-o", "pid=", "--ppid", str(process.pid)], capture_output=True, text=True)
        (child,) = map(int, children.stdout.split())
        process.send_signal(signal.SIGINT)  # to Python alone, as a notebook does
        self.assertEqual(process.wait(20), 7)
        self.assertRaises(ProcessLookupError, os.kill, child, 0)


class Help(unittest.TestCase):
    def test_the_module_tells_where_the_program_is(self) -> None:
        python = {**os.environ, "PYTHONPATH": str(environment.ROOT / "python"), "PYTHONDONTWRITEBYTECODE": "1"}
        run = lambda **more: subprocess.run(
            [sys.executable, "-m", "hyades"], env={**python, **more}, capture_output=True, text=True, check=True
        ).stdout
        self.assertRegex(run(), rf"program +{environment.HYADES} \(hyades \d")
        self.assertIn("none: /nowhere is no program", run(HYADES="/nowhere"))
        wrong = subprocess.run(
            [sys.executable, "-m", "hyades", "render", "job.yaml"], env=python, capture_output=True, text=True, check=False
        )
        self.assertEqual((wrong.returncode, wrong.stdout), (2, ""))
        self.assertIn("unexpected 'render'", wrong.stderr)


if __name__ == "__main__":
    unittest.main()
