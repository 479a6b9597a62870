"""What keys take and refuse, and the text that a job becomes."""

import pydoc
import unittest

import environment  # noqa: F401  (finds the package)
import numpy

import hyades
from hyades import cameras, lights, materials, media, objects, outputs, textures


class Keys(unittest.TestCase):
    def refused(self, expected: str, make) -> None:
        with self.assertRaises(hyades.KeyRefused) as caught:
            make()
        self.assertIn(expected, str(caught.exception))

    def test_ranges_are_those_of_the_reader(self) -> None:
        self.refused("Lambert.color is [2, 0, 0], expected a number from 0 up to 1", lambda: materials.Lambert(color=[2, 0, 0]))
        self.refused("above 0 below 180", lambda: cameras.Perspective(fov=180))
        self.refused("a whole number", lambda: hyades.Sampling(samples=1.5))
        self.refused("from 1", lambda: hyades.Film(size=(0, 10)))
        self.refused("2 numbers", lambda: hyades.Film(size=(10,)))
        self.refused("True or False", lambda: lights.Sky(sun=1))
        self.refused("one of 8, 16", lambda: outputs.Png(file="a.png", bits=12))
        self.refused("one of", lambda: media.Medium(preset="mud"))
        self.refused("a number", lambda: materials.Dielectric(ior=float("nan")))
        self.refused("a frame or range", lambda: hyades.Frames(range="1 to 7"))
        self.refused("from 0 up to 1", lambda: textures.Brick(mortar=hyades.Keys({1: 0.5, 9: 1.5})))

    def test_objects_of_other_classes_are_refused(self) -> None:
        clay = materials.Lambert()
        job = hyades.Job(objects={"ball": objects.Sphere()})
        self.refused("expected one of class Object", lambda: job.objects.update(a=clay))
        self.refused("JobKeys.objects['a'] is 5", lambda: job.objects.__setitem__("a", 5))
        self.refused("expected one of class Object", lambda: hyades.Job(objects={"a": clay}))
        self.refused("expected one of class Camera", lambda: hyades.Job(camera=objects.Sphere()))
        self.refused("expected one of class Output", lambda: hyades.Job(outputs=[clay]))
        self.refused("expected one of class Density", lambda: media.Medium(density=clay))
        self.assertEqual(list(job.objects), ["ball"])
        self.refused("Keys.ease is 'bouncy', expected one of 'linear'", lambda: hyades.Keys({1: 2}, ease="bouncy"))

    def test_what_is_taken(self) -> None:
        hyades.Sampling(seed=2**64 - 1)
        materials.Lambert(color="#d8c8a8")
        materials.Lambert(color="3200K")
        materials.Lambert(color="= 0.5 + 0.1 * t")
        materials.Lambert(color="tiles")
        materials.Lambert(color=textures.Checker(scale=8))
        objects.Sphere(at=numpy.array([1.0, 2.0, 3.0]), radius=numpy.float32(0.5))
        outputs.Png(file="a.png", denoise=True, bits=16)
        self.assertEqual(hyades.Job(frames=range(1, 25, 2)).frames, "1-23x2")

    def test_names_are_those_that_jobs_take(self) -> None:
        for right in ("a", "_1", "shot 1.b-2", "Würfel", "x" * 100):
            job = hyades.Job(name=right, objects={right: hyades.objects.Sphere()})
            self.assertIn(f"{right}", job.yaml())
        for wrong in ("", "../escaped", "bad/name", "-a", ".a", " a", "a ", "a\n", "x" * 101, "ü" * 51):
            with self.assertRaisesRegex(hyades.KeyRefused, "Job.name is .*expected a name of 1 to 100 bytes"):
                hyades.Job(name=wrong)
            with self.assertRaisesRegex(hyades.KeyRefused, "objects has .*expected a name"):
                hyades.Job(objects={wrong: hyades.objects.Sphere()})
            with self.assertRaisesRegex(hyades.KeyRefused, "objects has .*expected a name"):
                hyades.Job().objects[wrong] = hyades.objects.Sphere()
        job = hyades.Job(name="kept")
        with self.assertRaises(hyades.KeyRefused):
            job.name = "bad/name"
        self.assertEqual(job.name, "kept")

    def test_help_shows_what_keys_mean(self) -> None:
        text = pydoc.render_doc(hyades.Film, renderer=pydoc.plaintext)
        for words in ("size:", "Size of the full frame.", "crop:", "row 0 is the top"):
            self.assertIn(words, text)
        self.assertIn("priority:", pydoc.render_doc(objects.Sphere, renderer=pydoc.plaintext))  # of its base

    def test_an_unknown_key_is_refused_with_a_hint(self) -> None:
        with self.assertRaisesRegex(AttributeError, "did you mean 'roughness'"):
            materials.Lambert().rougness = 1
        with self.assertRaises(TypeError):
            materials.Lambert(colour=1)

    def test_defaults_are_read_and_only_what_was_said_is_written(self) -> None:
        clay = materials.Lambert(roughness=0)
        self.assertEqual(clay.color, 0.5)
        self.assertEqual([key.name for key, _ in clay.said()], ["roughness"])
        clay.roughness = None
        self.assertEqual(list(clay.said()), [])

    def test_what_must_be_said_is_missed_unless_it_is_copied(self) -> None:
        job = hyades.Job(materials={"x": materials.Mix(first="a")})
        self.refused("has no second", job.yaml)
        job.materials["x"] = materials.Mix(like="y")
        job.yaml()

    def test_a_quaternion_needs_no_axis(self) -> None:
        turned = hyades.Step(rotate=hyades.Rotation(quaternion=[0, 0.6, 0, 0.8]))
        job = hyades.Job(objects={"x": objects.Sphere(transform=[turned])})
        self.assertIn("quaternion: [0, 0.6, 0, 0.8]", job.yaml())
        job.objects["x"].transform = [hyades.Step(rotate=hyades.Rotation(angle=30))]
        self.refused("has no axis", job.yaml)


class Text(unittest.TestCase):
    def test_a_job_as_yaml(self) -> None:
        clay = materials.Lambert(color=[0.8, 0.1, 0.05])
        job = hyades.Job(name="ball", film=hyades.Film(size=(64, 36)), materials={"clay": clay})
        job.objects["ball"] = objects.Sphere(material=clay, at=hyades.Keys({1: [0, 0, 0], 8: [0, 2, 0]}, "smooth"))
        job.objects["milk"] = objects.Box(interior=media.Medium(preset="whole-milk"), emit=objects.Emit(power=60))
        job.objects["all"] = objects.InPlaceGroup(group=objects.Group(objects={"a": objects.Disk(material=clay)}))
        job.objects["air"] = objects.Sphere(material=materials.NullMaterial(), transform=[hyades.Step(rotate_y="= 30 * t")])
        job.environment = hyades.Environment(color="2700K")
        job.outputs.append(outputs.Exr(file="a.####.exr", layers=["beauty", "depth"]))
        self.assertEqual(
            job.yaml(),
            """\
# Made by hyades for Python.
hyades: 1
name: ball
film: {size: [64, 36]}
materials:
  clay: {type: lambert, color: [0.8, 0.1, 0.05]}
  null-1: {type: "null"}
media:
  medium-1: {preset: whole-milk}
objects:
  ball: {shape: sphere, material: clay, at: {keys: {1: [0, 0, 0], 8: [0, 2, 0]}, ease: smooth}}
  milk: {shape: box, emit: {power: 60}, interior: medium-1}
  all: {group: {objects: {a: {shape: disk, material: clay}}}}
  air: {shape: sphere, material: null-1, transform: [{rotate_y: "= 30 * t"}]}
environment: {color: "2700K"}
outputs: [{file: "a.####.exr", layers: [beauty, depth]}]
""",
        )

    def test_lines_know_what_wrote_them(self) -> None:
        steel = materials.Conductor(metal="iron", reflection=[0.9, 0.9, 0.9], roughness=0.125, opacity=0.75, edge=0.5)
        job = hyades.Job(materials={"clay": materials.Lambert(), "steel": steel})
        text = job.document().text
        line = next(i for i, t in enumerate(str(text).splitlines(), 1) if "roughness" in t)
        self.assertIs(text.source_of(line), steel)


if __name__ == "__main__":
    unittest.main()
