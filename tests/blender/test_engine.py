"""F12 in Blender: pictures and passes, borders, Esc, refused scenes, motion blur."""

import json
import pathlib
import time
import unittest
from unittest import mock

import bpy
import hyades
import numpy
from addon import AddOnTest

from hyades_render import complaints, final_render, render_process, runs, scene_job
from hyades_render.export import Complaint


class Pictures(AddOnTest):
    def test_f12_gives_the_pixels_of_the_job_with_all_passes(self) -> None:
        layer = bpy.context.view_layer
        for name in ("z", "normal", "position", "vector", "diffuse_direct", "diffuse_indirect", "environment", "emit"):
            setattr(layer, f"use_pass_{name}", True)
        for name in ("glossy_direct", "glossy_indirect", "transmission_direct", "transmission_indirect"):
            setattr(layer, f"use_pass_{name}", True)
        layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_material = True
        for name in ("albedo", "volume_direct", "volume_indirect", "variance", "samples"):
            setattr(layer.hyades, f"use_pass_{name}", True)
        found = self.render()
        expected = self.by_job()
        light = found["ViewLayer.Combined"]
        numpy.testing.assert_array_equal(light[:, :, :3], expected["beauty"])
        self.assertTrue((light[:, :, 3] == 1).all())
        numpy.testing.assert_array_equal(found["ViewLayer.DiffDir"], expected["diffuse_direct"])
        numpy.testing.assert_array_equal(found["ViewLayer.Albedo"], expected["albedo"])
        self.assertTrue((found["ViewLayer.Sample Count"] == 16).all())
        parts = ("DiffDir", "DiffInd", "GlossDir", "GlossInd", "TransDir", "TransInd", "VolumeDir", "VolumeInd")
        total = sum(found[f"ViewLayer.{name}"] for name in (*parts, "Emit", "Env"))
        numpy.testing.assert_allclose(total, light[:, :, :3], rtol=1e-5, atol=1e-6)
        self.geometry(found)

    def geometry(self, found) -> None:
        """Passes of the first surface are Blender's: z is up."""
        depth, up = found["ViewLayer.Depth"], found["ViewLayer.Normal"]
        self.assertTrue((depth[0] == numpy.float32(1e10)).all())
        self.assertAlmostEqual(float(depth.min()), self.nearest_depth(), delta=0.2)
        # The cube shows its top and two sides.
        for axis in ([0, 0, 1], [1, 0, 0], [0, -1, 0]):
            self.assertGreater(int((up @ numpy.array(axis) > 0.999).sum()), 40, axis)
        inside = up @ numpy.array([0, 0, 1]) > 0.999
        numpy.testing.assert_allclose(found["ViewLayer.Position"][inside][:, 2], 1, atol=1e-4)
        ids = found["ViewLayer.CryptoObject00"]
        cube = ids[inside]
        self.assertEqual(len(numpy.unique(cube[:, 0])), 1)
        numpy.testing.assert_allclose(cube[:, 1], 1)
        said = {key.split("/")[2]: text for key, text in found.attributes.items() if key.startswith("cryptomatte/")}
        self.assertIn("Cube", "".join(t for k, t in found.attributes.items() if k.endswith("/manifest")))
        self.assertEqual(said["conversion"], "uint32_to_float32")

    def nearest_depth(self) -> float:
        camera = self.scene.camera.matrix_world.inverted()
        return min(-(camera @ vertex.co).z for vertex in bpy.data.objects["Cube"].data.vertices)

    def test_a_border_is_that_part_of_the_picture(self) -> None:
        whole = self.render("whole")["ViewLayer.Combined"]
        render = self.scene.render
        render.use_border = render.use_crop_to_border = True
        render.border_min_x, render.border_max_x = 0.26, 0.74  # 16.64 and 47.36 of 64 pixels
        render.border_min_y, render.border_max_y = 0.11, 0.61  # 4.4 and 24.4 of 40
        part = self.render("part")["ViewLayer.Combined"]
        numpy.testing.assert_array_equal(part, whole[40 - 24 : 40 - 4, 16:47])

    def test_what_is_transparent_has_no_background(self) -> None:
        self.scene.render.film_transparent = True
        picture = self.render()["ViewLayer.Combined"]
        self.assertFalse(picture[0].any())
        self.assertTrue((picture[:, :, 3] == 1).any())

    def test_views_look_as_in_blender(self) -> None:
        """Files that the program makes of a job are those that Blender saves after F12."""
        self.scene.render.dither_intensity = 0
        image = self.scene.render.image_settings
        for view, look in (("Standard", "None"), ("Filmic", "None"), ("Filmic", "High Contrast")):
            settings = self.scene.view_settings
            settings.view_transform, settings.look, settings.exposure = view, look, 0.5
            self.scene.cycles.film_exposure = 1.5
            image.file_format, image.color_mode = "PNG", "RGB"
            self.scene.render.filepath = str(self.folder / "blender.png")
            bpy.ops.render.render(write_still=True)
            job = self.folder / "job.yaml"
            bpy.ops.hyades.export_job(filepath=str(job))
            ours = hyades.render(job, self.folder / "ours").picture().array[:, :, :3].astype(int)
            theirs = hyades.Picture.read(self.folder / "blender.png").array[:, :, :3].astype(int)
            self.assertLessEqual(int(abs(ours - theirs).max()), 1, (view, look))

    def test_film_exposure_makes_light_brighter(self) -> None:
        layer = bpy.context.view_layer
        layer.use_pass_environment = layer.use_pass_normal = layer.hyades.use_pass_albedo = True
        plain = self.render("plain")
        self.scene.cycles.film_exposure = 2.0
        bright = self.render("bright")
        for name, factor in (("Combined", 2), ("Env", 2), ("Albedo", 1), ("Normal", 1)):
            a, b = (found[f"ViewLayer.{name}"][:, :, :3] for found in (plain, bright))
            numpy.testing.assert_allclose(b, factor * a, rtol=1e-6, err_msg=name)
        self.assertTrue((bright["ViewLayer.Combined"][:, :, 3] == 1).all())

    def test_denoised_pictures_keep_the_noisy_one(self) -> None:
        self.scene.hyades.denoise = "features"
        found = self.render()
        noisy, clean = found["ViewLayer.Noisy Image"], found["ViewLayer.Combined"][:, :, :3]
        self.assertFalse(numpy.array_equal(noisy, clean))
        self.assertAlmostEqual(float(noisy.mean()), float(clean.mean()), delta=0.02 * float(noisy.mean()))

    def test_what_moves_is_blurred(self) -> None:
        cube = bpy.data.objects["Cube"]
        for frame, place in ((1, -3.0), (5, 3.0)):
            cube.location.x = place
            cube.keyframe_insert("location", frame=frame)
        cube.animation_data.action.fcurves[0].keyframe_points[0].interpolation = "LINEAR"
        self.scene.frame_set(3)
        self.scene.render.film_transparent = True
        sharp = self.render("sharp")["ViewLayer.Combined"][:, :, 3]
        self.scene.render.use_motion_blur = True
        blurred = self.render("blurred")["ViewLayer.Combined"][:, :, 3]
        self.assertGreater(int((blurred % 1 > 0).sum()), 3 * int((sharp % 1 > 0).sum()))
        self.assertAlmostEqual(float(blurred.sum()), float(sharp.sum()), delta=0.03 * float(sharp.sum()))
        self.assertEqual((self.scene.frame_current, self.scene.frame_subframe), (3, 0))

    def test_the_vector_pass_is_that_of_cycles(self) -> None:
        cube = bpy.data.objects["Cube"]
        for frame in (1, 5):
            cube.location = (0.2 * frame, 0.1 * frame, 0)
            cube.keyframe_insert("location", frame=frame)
        for curve in cube.animation_data.action.fcurves:
            curve.keyframe_points[0].interpolation = "LINEAR"
        self.scene.frame_set(3)
        bpy.context.view_layer.use_pass_vector = True
        self.scene.render.use_motion_blur = False
        self.scene.cycles.samples, self.scene.cycles.use_denoising = 16, False
        found = {}
        for engine in ("CYCLES", "HYADES"):
            self.scene.render.engine = engine
            found[engine] = self.render(engine)["ViewLayer.Vector"]
        moving = found["CYCLES"].any(axis=2) & found["HYADES"].any(axis=2)
        self.assertGreater(int(moving.sum()), 200)
        # Edges of the cube are mixed with what stands still.
        difference = numpy.median(numpy.abs(found["CYCLES"] - found["HYADES"])[moving], axis=0)
        size = numpy.median(numpy.abs(found["CYCLES"])[moving], axis=0)
        self.assertTrue((difference < 0.03 * size).all(), (difference, size))

    def test_cryptomattes_are_those_of_cycles(self) -> None:
        """Whatever jobs call things, and of how many parts and copies they are."""
        cube = bpy.data.objects["Cube"]
        cube.name, cube.location.x = "Würfel", -1.2
        cube.data.materials[0].name = "Grün"
        cube.data.materials.append(bpy.data.materials.new("Rot"))
        for face in cube.data.polygons:
            face.material_index = int(face.normal.z > 0.5)
        kit = bpy.data.collections.new("Kit")
        kit.objects.link(bpy.data.objects.new("Teil", cube.data))
        for at in range(2):
            empty = bpy.data.objects.new("Copy", None)
            empty.instance_type, empty.instance_collection = "COLLECTION", kit
            empty.location = (1.5, 3 * at, 0)
            self.scene.collection.objects.link(empty)
        layer = bpy.context.view_layer
        layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_material = True
        self.scene.cycles.samples, self.scene.cycles.use_denoising = 16, False
        found = {}
        for engine in ("CYCLES", "HYADES"):
            self.scene.render.engine = engine
            found[engine] = self.render(engine)
        for kind, names in (("Object", ("Würfel", "Teil")), ("Material", ("Grün", "Rot"))):
            code, theirs, ours = {}, {}, {}
            for engine, said in (("CYCLES", theirs), ("HYADES", ours)):
                attributes = found[engine].attributes
                key = next(k for k, v in attributes.items() if k.endswith("/name") and v == f"ViewLayer.Crypto{kind}")
                code[engine] = json.loads(attributes[key[: -len("name")] + "manifest"])
                ranks = [found[engine][f"ViewLayer.Crypto{kind}0{rank}"] for rank in range(3)]
                # Cycles calls its channels r, g, b, a, which are read by the alphabet.
                pairs = numpy.concatenate([rank[:, :, ::-1] if engine == "CYCLES" else rank for rank in ranks], axis=2)
                for name in names:
                    number = numpy.array(int(code[engine][name], 16), "uint32").view("float32")
                    said[name] = float((pairs[:, :, 1::2] * (pairs[:, :, 0::2] == number)).sum())
            for name in names:
                self.assertEqual(code["CYCLES"][name], code["HYADES"][name])
                self.assertGreater(theirs[name], 30)
                self.assertAlmostEqual(ours[name], theirs[name], delta=0.05 * theirs[name])


class Ends(AddOnTest):
    def test_esc_ends_the_program_and_leaves_nothing(self) -> None:
        self.scene.hyades.samples = 1 << 20
        started: list[int] = []
        begun = render_process.RenderProcess.__init__

        def begin(process, *arguments, **options) -> None:
            begun(process, *arguments, **options)
            started.append(process.pid)

        def pressed(_render) -> bool:
            return bool(started)

        with (
            mock.patch.object(render_process.RenderProcess, "__init__", begin),
            mock.patch.object(final_render.FinalRender, "stopped", pressed),
        ):
            bpy.ops.render.render()
        self.assertEqual(len(started), 1)
        self.assertFalse(pathlib.Path(f"/proc/{started[0]}").exists())
        self.assertEqual(list(pathlib.Path(bpy.app.tempdir).glob("hyades-*")), [])

    def test_a_refused_scene_is_told_with_its_object(self) -> None:
        applied = scene_job.apply_settings

        def spoil(job, settings) -> None:
            applied(job, settings)
            job.objects["Cube"].material = "nothing"

        with mock.patch.object(scene_job, "apply_settings", spoil):
            with self.assertRaisesRegex(RuntimeError, "object 'Cube'.*names the material 'nothing'"):
                bpy.ops.render.render()

    def test_a_missing_program_is_told(self) -> None:
        with mock.patch.dict("os.environ", {"HYADES": "/nowhere/hyades"}):
            with self.assertRaisesRegex(RuntimeError, "/nowhere/hyades is no program"):
                bpy.ops.render.render()

    def test_complaints_are_told_and_kept(self) -> None:
        exported = final_render.scene_job.scene_job

        def complain(*arguments):
            result = exported(*arguments)
            result.complaints.append(Complaint("material 'Floor'", "is not what it seems"))
            return result

        with mock.patch.object(final_render.scene_job, "scene_job", complain):
            bpy.ops.render.render()
        self.assertIn("material 'Floor': is not what it seems", [str(one) for one in complaints.of(self.scene)])

    def test_stereo_is_told(self) -> None:
        self.scene.render.use_multiview = True
        bpy.ops.render.render()
        self.assertIn("scene: stereo and multiple views are not supported", str(complaints.of(self.scene)[0]))

    def test_pictures_come_while_it_is_rendered(self) -> None:
        """As the window shows them, which is not there in the background."""
        self.scene.hyades.samples = 64
        job = self.folder / "job.yaml"
        bpy.ops.hyades.export_job(filepath=str(job))
        run = runs.LocalRun(final_render.preferences.find_program(), job, ["--samples", "4096"], None)
        try:
            while (picture := run.picture()) is None and run.running():
                time.sleep(0.01)
            self.assertEqual(picture.shape, (40, 64, 4))
            self.assertGreater(float(picture[:, :, :3].max()), 0)
        finally:
            run.close()
        self.assertFalse(run.running())


if __name__ == "__main__":
    unittest.main()
