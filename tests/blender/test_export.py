"""What the exporter makes of things in a scene: the job says the same, or it is told by name."""

import math
import os
import tempfile
import unittest
from types import SimpleNamespace
from unittest import mock

import bpy
import hyades
from addon import AddOnTest
from exporting import ExportTest
from told_copies import Copies  # noqa: F401  (tests of this run)
from told_images import Images  # noqa: F401
from told_motion import Moving  # noqa: F401
from told_surfaces import Surfaces, Values  # noqa: F401
from told_visibility import BlendersLinks, Links, Visibility  # noqa: F401
from told_volumes import Volumes  # noqa: F401

from hyades_render import animation, complaints, panels, preferences


class NotThere(ExportTest):
    """What jobs do not have is told by name."""

    def test_the_panel_shows_the_filter_that_is_used(self) -> None:
        shown = []
        layout = SimpleNamespace(prop=lambda owner, name, **_: shown.append((owner, name)))
        panel = SimpleNamespace(begin=lambda: layout)
        panels.HYADES_PT_film.draw(panel, SimpleNamespace(scene=self.scene))
        (owner,) = [owner for owner, name in shown if name == "filter_width"]
        owner.filter_width = 3.0
        self.assertEqual(self.export()[0].film.filter.radius, 1.5)

    def test_what_a_job_has_not_is_told(self) -> None:
        made, shader = self.material("Bright")
        shader.inputs["Color"].default_value = (1.5, 0.2, 0.2, 1)
        bpy.data.objects["Cube"].data.materials[0] = made
        self.scene.camera.scale = (-1, 1, 1)
        volume = bpy.data.objects.new("Smoke", bpy.data.volumes.new("Smoke"))
        self.scene.collection.objects.link(volume)
        said = self.export()[1]
        self.assertIn("'Color' is held at 1", said)
        self.assertIn("camera 'Camera': its scale mirrors the picture", said)
        self.assertIn("object 'Smoke': only volumes of files are supported", said)

    def test_what_sees_and_moves_otherwise_is_told(self) -> None:
        self.assertEqual(self.export()[1], "")
        parent = bpy.data.objects.new("Rig", None)
        parent.scale = (1, 3, 1)
        self.scene.collection.objects.link(parent)
        self.scene.camera.parent = parent
        self.assertIn("camera 'Camera': what it is parented to shears it", self.export()[1])
        self.scene.camera.parent = None
        cube = bpy.data.objects["Cube"]
        cube.driver_add("location", 0).driver.expression = "no_such_name + 1"
        bpy.context.view_layer.update()
        self.assertIn("object 'Cube': its driver of location is not computed", self.export()[1])
        cube.driver_remove("location", 0)
        cycles = getattr(self.scene, "cycles", None)
        if cycles is None:
            self.skipTest("Cycles is not here")
        self.scene.render.use_simplify = cycles.use_camera_cull = cube.cycles.use_camera_cull = True
        self.assertIn("object 'Cube': it is there wherever it is: Simplify's culling", self.export()[1])
        self.scene.render.use_simplify = False
        cycles.feature_set, cube.cycles.use_adaptive_subdivision = "EXPERIMENTAL", True
        cube.modifiers.new("Finer", "SUBSURF")
        self.assertIn("object 'Cube': Adaptive Subdivision is left out", self.export()[1])

    def test_portals_do_not_shine(self) -> None:
        lamp = bpy.data.objects["Light"]
        lamp.data.type = "AREA"
        self.assertIn("Light", self.export()[0].objects)
        bpy.data.lights["Light"].cycles.is_portal = True
        self.assertNotIn("Light", self.export()[0].objects)

    def test_lamps_near_things_for_their_size_are_told(self) -> None:
        lamp = bpy.data.objects["Light"]  # the cube ends 1 m from the origin
        words = "light 'Light': it is near 'Cube' for its radius"
        for kind, height, radius, told in (
            ("POINT", 2, 0.19, False),
            ("POINT", 2, 0.22, True),
            ("SPOT", 2, 0.22, True),
            ("POINT", 0, 0.5, False),  # within its bounds
        ):
            lamp.data.type, lamp.location = kind, (0, 0, height)
            lamp.data.shadow_soft_size = radius
            self.assertEqual(words in self.export()[1], told, (kind, height, radius))
        if hasattr(lamp.data, "use_soft_falloff"):
            lamp.location.z, lamp.data.use_soft_falloff = 2, False
            self.assertEqual(self.export()[1], "")

    def test_exposure_of_light_is_told(self) -> None:
        self.scene.cycles.film_exposure = 2.0
        self.scene.view_settings.exposure = 0.5
        job, said = self.export()
        self.assertEqual((job.outputs[0].exposure, said), (1.5, ""))
        self.scene.render.image_settings.file_format = "OPEN_EXR"
        self.assertIn("film: files of type EXR keep the light as it is", self.export()[1])

    def test_what_follows_a_render_is_told(self) -> None:
        self.scene.use_nodes = True
        self.assertEqual(self.export()[1], "")  # nodes as they are at first do nothing
        self.scene.node_tree.nodes.new("CompositorNodeBlur")
        self.scene.view_layers.new("Back")
        self.scene.render.use_multiview = True
        said = self.export()[1]
        for what in ("view layer 'ViewLayer' is rendered, not 'Back'", "nodes of the compositor", "stereo"):
            self.assertIn(f"output: {what}", said)
        self.scene.render.use_compositing = False
        self.assertNotIn("compositor", self.export()[1])

    def test_layers_of_files_that_differ_are_told(self) -> None:
        layer, image = bpy.context.view_layer, self.scene.render.image_settings
        layer.use_pass_normal, layer.use_pass_z = True, True
        image.file_format = "OPEN_EXR_MULTILAYER"
        job, said = self.export()
        self.assertEqual(job.outputs[0].layers, ["beauty", "depth", "normal"])
        self.assertIn("output: normal of EXR files are those of the job, where y is up: x, z, -y of Blender's", said)
        self.assertIn("output: depth of EXR files is infinite where there is nothing, not 1e10", said)
        layer.use_pass_cryptomatte_object = True
        self.assertNotIn("crypto", self.export()[1])
        bpy.data.objects["Cube"].name = "Würfel"
        self.assertIn("crypto_object of EXR files has the job's names: 'Würfel' is 'W_rfel'", self.export()[1])
        image.file_format = "OPEN_EXR"
        self.scene.render.film_transparent = True
        job, said = self.export()
        self.assertEqual((job.outputs[0].layers, said), (["beauty", "alpha"], ""))

    def test_what_the_camera_would_clip_is_told(self) -> None:
        bpy.ops.mesh.primitive_plane_add(size=1000, location=(0, 0, -1))
        self.scene.camera.location, self.scene.camera.rotation_euler = (0, -11, 2), (math.pi / 2, 0, 0)
        lens = self.scene.camera.data  # 11 m before the cube, 3 m above the plane
        lens.clip_start, lens.clip_end = 1, 2000
        self.assertEqual(self.export()[1], "")
        lens.clip_end = 100
        said = "camera 'Camera': jobs clip nothing: 'Plane' is seen, farther away than its clip end of 100 m"
        self.assertEqual(self.export()[1], said)
        bpy.data.objects["Plane"].visible_camera = False
        self.assertEqual(self.export()[1], "")
        lens.clip_start = 11
        said = "camera 'Camera': jobs clip nothing: 'Cube' is seen, nearer than its clip start of 11 m"
        self.assertEqual(self.export()[1], said)
        lens.clip_start, bpy.data.objects["Cube"].location = 1, (0, -60, 0)  # behind it
        self.assertEqual(self.export()[1], "")
        lens.type = "ORTHO"
        self.assertEqual(self.export()[1], "")

    def test_a_broken_mesh_is_told_and_left_out(self) -> None:
        bpy.ops.mesh.primitive_plane_add()
        bpy.data.objects["Plane"].data.vertices[0].co.x = float("nan")
        job, said = self.export()
        self.assertEqual(said, "object 'Plane': its mesh is left out: positions have numbers that are not finite")
        self.assertEqual([name for name in job.objects if name != "Light"], ["Cube"])

    def test_a_camera_that_is_none_is_refused(self) -> None:
        self.scene.camera = bpy.data.objects["Light"]
        with self.assertRaisesRegex(ValueError, "camera 'Light' is of type light, expected a camera"):
            self.export()

    def test_passes_that_are_not_there_are_told(self) -> None:
        layer = bpy.context.view_layer
        layer.use_pass_mist = layer.use_pass_uv = True
        layer.aovs.add().name = "Heat"
        layer.lightgroups.add().name = "Key"
        words = "view layer 'ViewLayer': there are no passes Mist, UV, AOV Heat, light group Key"
        self.scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
        self.assertEqual(self.export()[1], words)
        self.scene.hyades.samples = 1
        bpy.ops.render.render()
        self.assertEqual([str(one) for one in complaints.of(self.scene)], [words])

    def test_what_stays_sharp_is_told(self) -> None:
        bpy.data.objects["Cube"].cycles.use_motion_blur = False
        self.assertEqual(self.export()[1], "")
        self.scene.render.use_motion_blur = True
        self.assertEqual(self.export()[1], "object 'Cube': motion blur is for all: it is blurred where it moves")

    def test_switches_that_jobs_have_not_are_told(self) -> None:
        render, layer = self.scene.render, bpy.context.view_layer
        layer.use_sky = False
        job, said = self.export()
        self.assertEqual((job.environment, said), (None, ""))
        layer.use_solid = False
        render.film_transparent = self.scene.cycles.film_transparent_glass = True
        render.use_motion_blur = True
        self.scene.cycles.rolling_shutter_type = "TOP"
        render.motion_blur_shutter_curve.curves[0].points[0].location = (0.4, 0.5)
        bpy.data.objects["Cube"].cycles.use_deform_motion = False
        said = self.export()[1]
        for what in (
            "output: view layer 'ViewLayer' is to have no surfaces",
            "film: Transparent Glass",
            "render: the rolling shutter",
            "render: the curve of the shutter",
            "object 'Cube': motion blur is for all: it is blurred where it changes its shape",
        ):
            self.assertIn(what, said)

    def test_libraries_that_are_not_there_are_told(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/shelf.blend"
            bpy.data.libraries.write(path, {bpy.data.objects["Cube"]})
            with bpy.data.libraries.load(path, link=True) as (there, here):
                here.objects = ["Cube"]
            self.assertEqual(self.export()[1], "")
            os.unlink(path)
            self.assertIn(f"there is no file {path}: what is linked from it is left out", self.export()[1])

    def test_an_exposure_that_moves_is_told(self) -> None:
        view = self.scene.view_settings
        self.scene.frame_start, self.scene.frame_end = 1, 4
        for frame, stops in ((1, 0.0), (4, -6.0)):
            view.exposure = stops
            view.keyframe_insert("exposure", frame=frame)
        self.assertEqual(animation.moving_frames(self.scene), range(1, 5))
        exported = animation.job_of(self.scene, frames=range(1, 5), name="fade")
        self.assertIn("color management: the exposure moves", "\n".join(map(str, exported.complaints)))

    def test_a_frame_is_seen_through_its_own_camera(self) -> None:
        other = bpy.data.objects.new("Other", bpy.data.cameras.new("Other"))
        other.location = (50, 0, 0)
        self.scene.collection.objects.link(other)
        for frame, camera in ((1, self.scene.camera), (3, other)):
            self.scene.timeline_markers.new(camera.name, frame=frame).camera = camera
        self.scene.render.use_motion_blur = True
        job = animation.job_of(self.scene, frames=range(3, 4), name="cut").job
        self.assertEqual(list(job.camera.look_from), [50, 0, 0])

    def test_colors_of_what_is_clear_are_told(self) -> None:
        made, shader = self.material("Stained", "ShaderNodeBsdfTransparent")
        texture = made.node_tree.nodes.new("ShaderNodeTexChecker")
        bpy.data.objects["Cube"].data.materials[0] = made
        for socket, told in (("Fac", False), ("Color", True)):
            made.node_tree.links.new(texture.outputs[socket], shader.inputs[0])
            self.assertEqual("has no colour in the job" in self.export()[1], told, socket)
        owner = made if hasattr(made, "use_transparent_shadow") else made.cycles
        owner.use_transparent_shadow = False
        self.assertIn("material 'Stained': Transparent Shadows is on in the job", self.export()[1])

    def test_limits_of_panoramas_are_told(self) -> None:
        lens = self.scene.camera.data
        lens.type = "PANO"
        owner = lens if hasattr(lens, "panorama_type") else lens.cycles
        owner.panorama_type = "EQUIRECTANGULAR"
        self.assertEqual(self.export()[1], "")
        owner.latitude_min = 0
        self.assertEqual(self.export()[1], "camera 'Camera': a panorama shows all around: its limits are left out")

    def test_light_below_nothing_is_told(self) -> None:
        made, shader = self.material("Dark", "ShaderNodeEmission")
        shader.inputs["Strength"].default_value = -1
        bpy.data.objects["Cube"].data.materials[0] = made
        job, said = self.export()
        self.assertEqual(said, "material 'Dark' > node 'Emission': light below 0 is left out")
        self.assertIsNone(job.objects["Cube"].emit)

    def test_videos_are_as_asked_for_or_told(self) -> None:
        image, video = self.scene.render.image_settings, self.scene.render.ffmpeg
        image.file_format = "FFMPEG"
        for kind, codec, end, words in (
            ("MPEG4", "H264", ".mp4", ""),
            ("WEBM", "WEBM", ".webm", ""),
            ("QUICKTIME", "H264", ".mov", ""),
            ("MKV", "H264", ".mp4", "output: videos of format MKV are not written; MPEG4 is"),
            ("MPEG4", "MPEG4", ".mp4", "output: videos of codec MPEG4 are not written; H264 is"),
        ):
            video.format, video.codec = kind, codec
            exported = animation.job_of(self.scene, frames=range(1, 3), name="film")
            self.assertTrue(exported.job.outputs[0].file.endswith(end), kind)
            self.assertEqual("\n".join(map(str, exported.complaints)), words)
        self.assertEqual(self.export()[1], "output: one picture is no video: PNG is written")
        image.file_format, image.color_mode = "PNG", "BW"
        self.assertEqual(self.export()[1], "output: pictures are written in colour, not in black and white")

    def test_passes_that_cycles_was_asked_for_are_there(self) -> None:
        bpy.context.view_layer.cycles.use_pass_volume_direct = True
        self.scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
        self.assertEqual(self.export()[0].outputs[0].layers, ["beauty", "volume_direct"])

    def test_bodies_that_want_longer_paths_are_told(self) -> None:
        wax = self.material("Wax", "ShaderNodeSubsurfaceScattering")[0]
        bpy.data.objects["Cube"].data.materials[0] = wax
        self.assertIn("material 'Wax' > node 'Subsurface Scattering': light scatters often", self.export()[1])
        self.scene.hyades.max_depth = 256
        self.assertEqual(self.export()[1], "")

    def test_hair_becomes_strands(self) -> None:
        cube = bpy.data.objects["Cube"]
        cube.modifiers.new("Fur", "PARTICLE_SYSTEM")
        cube.particle_systems[0].name = "Fur"
        cube.particle_systems[0].settings.type = "HAIR"
        settings = cube.particle_systems[0].settings
        settings.count, settings.render_step, settings.radius_scale = 7, 2, 0.1
        cube.location = (1, 2, 3)
        job, told = self.export()
        self.assertEqual(told, "")
        fur = job.objects["Cube.Fur"]
        self.assertEqual([len(strand) for strand in fur.curves.points], [5] * 7)
        roots = [strand[0] for strand in fur.curves.points]
        # In the cube's own space, so that it takes its hair along.
        self.assertTrue(all(abs(max(abs(root)) - 1) < 1e-5 for root in roots))
        self.assertAlmostEqual(float(fur.curves.widths[0][0]), 0.1, places=6)
        self.assertIsInstance(fur.material, hyades.materials.Principled)
        cube.modifiers[0].show_render = False
        job, told = self.export()
        self.assertEqual(told, "")
        self.assertNotIn("Cube.Fur", job.objects)

    def test_the_shader_of_hair_is_for_hair(self) -> None:
        made, node = self.material("Mane")
        tree = made.node_tree
        hair = tree.nodes.new("ShaderNodeBsdfHairPrincipled")
        tree.links.new(hair.outputs[0], next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL").inputs["Surface"])
        if hasattr(hair, "model"):
            hair.model = "CHIANG"
        hair.parametrization = "COLOR"
        hair.inputs["Coat"].default_value = 0.5
        cube = bpy.data.objects["Cube"]
        cube.data.materials[0] = made
        self.assertIn("material 'Mane' > node 'Principled Hair BSDF': it is for hair; matt grey is used", self.export()[1])
        cube.modifiers.new("Fur", "PARTICLE_SYSTEM")
        cube.particle_systems[0].settings.type = "HAIR"
        cube.show_instancer_for_render = False
        job, told = self.export()
        self.assertIn("Coat is left out", told)
        self.assertNotIn("matt grey", told)
        (fur,) = (one for one in job.objects.values() if isinstance(one, hyades.objects.Curves))
        self.assertIsInstance(fur.material, hyades.materials.Hair)


class Preferences(AddOnTest):
    def test_a_farm_that_is_refused_is_told_by_the_preferences(self) -> None:
        there = SimpleNamespace(farm_address="http://farm.example:8080", token_file="", ca_file="", insecure=False)
        words = "expected https:// and its CA Certificate, or the preference Plain Text Beyond This Machine to send"
        with mock.patch.object(preferences, "get", lambda: there), self.assertRaisesRegex(ValueError, words):
            preferences.farm()


if __name__ == "__main__":
    unittest.main()
