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
from told_surfaces import Surfaces, Values  # noqa: F401  (tests of this run)
from told_volumes import Volumes  # noqa: F401

from hyades_render import animation, complaints, moving_copies, panels, preferences
from hyades_render.export import objects
from hyades_render.export.nodes import graph


class Copies(ExportTest):
    def test_objects_of_one_mesh_keep_their_materials(self) -> None:
        mesh = bpy.data.objects["Cube"].data
        things = []
        names = [f"Hue {number}" for number in range(6)]
        for number, name in enumerate(names):
            thing = bpy.data.objects.new(name, mesh)
            thing.material_slots[0].link = "OBJECT"
            thing.material_slots[0].material = self.material(name, color=(number / 6, 0, 0))[0]
            things.append(thing)
        self.collection(*things, copies=3)
        job, _ = self.export()
        for name in names:
            (body,) = job.objects[name].instance.objects.values()
            self.assertIs(body.material, job.materials[name])
            self.assertEqual(len(job.objects[name].places.matrices), 3)

    def test_copies_look_as_their_place_has_them(self) -> None:
        made, shader = self.material("Place")
        info = made.node_tree.nodes.new("ShaderNodeObjectInfo")
        made.node_tree.links.new(info.outputs["Location"], shader.inputs[0])
        thing = bpy.data.objects.new("Thing", bpy.data.objects["Cube"].data.copy())
        thing.data.materials[0] = made
        self.collection(thing, copies=4)
        self.scene.hyades.bake_size = 64
        job, said = self.export()
        copies = [body for name, body in job.objects.items() if name.startswith("Thing")]
        self.assertEqual([round(float(body.material.color.file.max()), 3) for body in copies], [0, 2, 4, 6])
        self.assertEqual(said, "")
        with mock.patch.object(objects, "_MOST_OWN", 2):
            job, said = self.export()
        self.assertEqual(len(job.objects["Thing"].places.matrices), 3)
        self.assertIn("object 'Thing': its looks depend on where it is, or on the object: copies beyond 2", said)

    def test_a_view_layer_may_override_all_materials(self) -> None:
        bpy.data.objects["Cube"].data.materials.clear()
        bpy.context.view_layer.material_override = self.material("Clay", color=(0.25, 0.5, 0.75))[0]
        job, _ = self.export()
        self.assertEqual(job.objects["Cube"].material.color, [0.25, 0.5, 0.75])

    def test_the_panel_shows_the_filter_that_is_used(self) -> None:
        shown = []
        layout = SimpleNamespace(prop=lambda owner, name, **_: shown.append((owner, name)))
        panel = SimpleNamespace(begin=lambda: layout)
        panels.HYADES_PT_film.draw(panel, SimpleNamespace(scene=self.scene))
        (owner,) = [owner for owner, name in shown if name == "filter_width"]
        owner.filter_width = 3.0
        self.assertEqual(self.export()[0].film.filter.radius, 1.5)

    def test_images_without_alpha_are_there_everywhere(self) -> None:
        made, shader = self.material("Leaf", "ShaderNodeBsdfTransparent")
        texture = made.node_tree.nodes.new("ShaderNodeTexImage")
        made.node_tree.links.new(texture.outputs["Alpha"], shader.inputs[0])
        texture.image = bpy.data.images.new("Leaf", 4, 4, alpha=True)
        bpy.data.objects["Cube"].data.materials[0] = made
        for mode, kind in (("STRAIGHT", hyades.textures.Texture), ("NONE", float)):
            texture.image.alpha_mode = mode
            self.assertIsInstance(self.export()[0].objects["Cube"].material.opacity, kind)

    def test_angles_count_as_on_average(self) -> None:
        made, shader = self.material("Pearl")
        tree = made.node_tree
        mix = tree.nodes.new("ShaderNodeMixRGB")
        mix.inputs["Color1"].default_value, mix.inputs["Color2"].default_value = (0, 0, 0, 1), (1, 1, 1, 1)
        tree.links.new(mix.outputs[0], shader.inputs[0])
        bpy.data.objects["Cube"].data.materials[0] = made
        for kind, socket, expected in (
            ("ShaderNodeFresnel", "Fac", 0.0796),
            ("ShaderNodeLayerWeight", "Fresnel", 0.1534),
            ("ShaderNodeLayerWeight", "Facing", 1 / 3),
        ):
            node = tree.nodes.new(kind)
            if kind == "ShaderNodeFresnel":
                node.inputs["IOR"].default_value = 1.45  # Blender 4.3 has another default
            tree.links.new(node.outputs[socket], mix.inputs["Fac"])
            job, said = self.export()
            self.assertAlmostEqual(job.objects["Cube"].material.color[0], expected, places=3)
            self.assertIn("what depends on the angle of view is taken as it is on average", said)

    def test_mixtures_beyond_both_are_computed(self) -> None:
        made, shader = self.material("Beyond")
        tree = made.node_tree
        mix, checker = tree.nodes.new("ShaderNodeMix"), tree.nodes.new("ShaderNodeTexChecker")
        mix.data_type, mix.clamp_factor, mix.inputs[0].default_value = "RGBA", False, 1.8
        mix.inputs[6].default_value = (0.1, 0.1, 0.1, 1)
        checker.inputs[1].default_value = checker.inputs[2].default_value = (0.4, 0.4, 0.4, 1)
        tree.links.new(checker.outputs[0], mix.inputs[7])
        tree.links.new(mix.outputs[2], shader.inputs[0])
        bpy.data.objects["Cube"].data.materials[0] = made
        self.scene.hyades.bake_size = 64
        picture = self.export()[0].objects["Cube"].material.color.file
        self.assertAlmostEqual(float(picture.max()), 0.1 + 1.8 * 0.3, places=4)

    def test_colors_of_images_hold_their_alpha_while_nobody_asks_for_it(self) -> None:
        made, shader = self.material("Leaf")
        texture = made.node_tree.nodes.new("ShaderNodeTexImage")
        made.node_tree.links.new(texture.outputs["Color"], shader.inputs[0])
        image = texture.image = bpy.data.images.new("Leaf", 2, 1, alpha=True)
        bpy.data.objects["Cube"].data.materials[0] = made

        def darkest() -> float:
            return float(self.export()[0].objects["Cube"].material.color.file[..., 0].min())

        for alpha, mode, light in ((1, "STRAIGHT", 1), (0.5, "STRAIGHT", 0.21404), (0.5, "CHANNEL_PACKED", 1)):
            image.pixels, image.alpha_mode = [1, 1, 1, 1, 1, 1, 1, alpha], mode
            self.assertAlmostEqual(darkest(), light, delta=0.003)  # of bytes
        image.alpha_mode = "STRAIGHT"
        made.node_tree.links.new(texture.outputs["Alpha"], shader.inputs["Roughness"])
        self.assertEqual(darkest(), 1)

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
        self.assertNotIn("without an inside", said)
        bpy.data.objects["Cube"].data.materials[0] = self.material("Glass", "ShaderNodeBsdfGlass")[0]
        self.assertNotIn("without an inside", self.export()[1])
        bpy.ops.mesh.primitive_plane_add()
        bpy.context.object.data.materials.append(bpy.data.materials["Glass"])
        self.assertIn("object 'Plane': glass without an inside", self.export()[1])


class Moving(ExportTest):
    """Several frames as one job."""

    def film(self, last: int = 3) -> tuple[hyades.Job, str]:
        exported = animation.job_of(self.scene, frames=range(1, last + 1), name="film")
        return exported.job, "\n".join(map(str, exported.complaints))

    def test_copies_that_move_have_keys(self) -> None:
        thing = bpy.data.objects.new("Thing", bpy.data.objects["Cube"].data)
        self.collection(thing, copies=4)
        for name, there in (("Copy 1", (True, True)), ("Copy 2", (False, True))):
            copy = bpy.data.objects[name]
            for frame, shown in zip((1, 3), there):
                copy.location.z, copy.hide_render = frame, not shown
                copy.keyframe_insert("location", frame=frame)
                copy.keyframe_insert("hide_render", frame=frame)
        job, said = self.film()
        self.assertEqual(said, "")
        self.assertEqual(sorted(job.objects["Thing"].places.matrices[:, 0, 3]), [0, 6])
        moved = {name: body for name, body in job.objects.items() if name.startswith("Thing copy")}
        self.assertEqual(len(moved), 2)
        first, late = moved.values()
        move = first.transform[-1].translate.keys
        self.assertEqual([round(move[frame][1], 3) for frame in (1, 2, 3)], [1, 2, 3])
        self.assertEqual(late.transform[0].scale.keys, {1: 1e-6, 2: 1e-6, 3: 1.0})
        with mock.patch.object(moving_copies, "_MOST", 1), self.assertRaisesRegex(ValueError, "'Thing', of which 2 copies"):
            self.film()

    def test_values_that_begin_at_nothing_have_keys(self) -> None:
        cube = bpy.data.objects["Cube"]
        shining = self.material("Shining", "ShaderNodeEmission")[0]
        strength = shining.node_tree.nodes["Emission"].inputs["Strength"]
        mixed, second = self.material("Mixed")
        tree = mixed.node_tree
        mix, first = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
        ends = (mix.inputs[1], mix.inputs[2], tree.nodes["Material Output"].inputs["Surface"])
        for output, end in zip((first, second, mix), ends):
            tree.links.new(output.outputs[0], end)
        other = bpy.data.objects.new("Other", cube.data.copy())
        self.scene.collection.objects.link(other)
        cube.data.materials[0], other.data.materials[0] = shining, mixed
        for socket in (strength, mix.inputs["Fac"]):
            for frame, value in ((1, 0.0), (3, 1.0)):
                socket.default_value = value
                socket.keyframe_insert("default_value", frame=frame)
        job, said = self.film()
        self.assertEqual(said, "")
        self.assertEqual(job.objects["Cube"].emit.radiance.keys, {1: 0.0, 2: 1.0, 3: 1.0})
        half = job.objects["Cube"].emit.color.keys[2][0]
        self.assertTrue(0 < half < job.objects["Cube"].emit.color.keys[3][0])
        opacity = job.objects["Other"].material.opacity.keys
        self.assertEqual((opacity[1], round(opacity[2], 3), opacity[3]), (0, 0.5, 1))
        self.assertEqual(job.objects["Other"].material.color, [0.5, 0.5, 0.5])

    def test_what_a_shutter_does_not_blur_is_as_at_its_frame(self) -> None:
        self.scene.render.use_motion_blur, self.scene.render.motion_blur_shutter = True, 0.5
        lamp, cube = bpy.data.lights["Light"], bpy.data.objects["Cube"]
        for frame in (1, 2, 3):
            lamp.energy, cube.hide_render, cube.location.x = 100 * frame, frame == 3, frame
            lamp.keyframe_insert("energy", frame=frame)
            cube.keyframe_insert("hide_render", frame=frame)
            cube.keyframe_insert("location", frame=frame)
        for curve in (*lamp.animation_data.action.fcurves, *cube.animation_data.action.fcurves):
            for key in curve.keyframe_points:
                key.interpolation = "CONSTANT" if "energy" in curve.data_path else "LINEAR"
        for position, moved in (("CENTER", (1.75, 2, 2.25)), ("START", (2, 2.5)), ("END", (1.5, 2))):
            render = self.scene.render if hasattr(self.scene.render, "motion_blur_position") else self.scene.cycles
            render.motion_blur_position = position
            job, said = self.film()
            self.assertEqual(said, "")
            power = job.lights["Light"].power.keys
            self.assertEqual([round(power[frame] / power[1], 3) for frame in (1, 2, 3)], [1, 2, 3])
            size, *_, move = job.objects["Cube"].transform
            self.assertEqual(size.scale.keys, {1: 1.0, 2: 1.0, 3: 1e-6})
            there = [move.translate.keys.get(2 + late) for late in (0, 0.25, 0.5)]
            self.assertEqual([round(at[0], 3) for at in there if at][-1], moved[-1])
            self.assertEqual(round(there[0][0], 3), moved[0])

    def test_alpha_counts_that_gets_to_an_output(self) -> None:
        made, _ = self.material("Leaf")
        tree = made.node_tree
        texture = tree.nodes.new("ShaderNodeTexImage")
        alpha = graph.Output(texture, texture.outputs["Alpha"])
        self.assertFalse(graph.is_taken(alpha))
        nowhere = tree.nodes.new("ShaderNodeMath")
        link = tree.links.new(alpha.socket, nowhere.inputs[0])
        self.assertFalse(graph.is_taken(alpha))
        tree.links.new(nowhere.outputs[0], tree.nodes["Diffuse BSDF"].inputs["Roughness"])
        self.assertTrue(graph.is_taken(alpha))
        link.is_muted = True
        self.assertFalse(graph.is_taken(alpha))
        group = bpy.data.node_groups.new("Leaf", "ShaderNodeTree")
        group.outputs.new("NodeSocketColor", "Color") if hasattr(group, "outputs") else group.interface.new_socket(
            "Color", in_out="OUTPUT", socket_type="NodeSocketColor")
        inner, end = group.nodes.new("ShaderNodeTexImage"), group.nodes.new("NodeGroupOutput")
        group.links.new(inner.outputs["Alpha"], end.inputs[0])
        holder = tree.nodes.new("ShaderNodeGroup")
        holder.node_tree = group
        alpha = graph.Output(inner, inner.outputs["Alpha"], (holder,))
        self.assertFalse(graph.is_taken(alpha))
        tree.links.new(holder.outputs[0], tree.nodes["Diffuse BSDF"].inputs["Color"])
        self.assertTrue(graph.is_taken(alpha))


class NotThere(ExportTest):
    """What jobs do not have is told by name."""

    def test_portals_do_not_shine(self) -> None:
        lamp = bpy.data.objects["Light"]
        lamp.data.type = "AREA"
        self.assertIn("Light", self.export()[0].objects)
        bpy.data.lights["Light"].cycles.is_portal = True
        self.assertNotIn("Light", self.export()[0].objects)

    def test_who_sees_lamps_and_the_world_is_told(self) -> None:
        bpy.data.objects["Light"].visible_glossy = False
        world = self.scene.world.cycles_visibility
        world.diffuse = world.camera = False
        job, said = self.export()
        self.assertIn("light 'Light': it is there for rays of glossy too", said)
        self.assertIn("world 'World': it is there for rays of diffuse too", said)
        self.assertFalse(job.environment.visible_to_camera)

    def test_links_of_light_are_told(self) -> None:
        things = bpy.data.collections.new("Things")
        for name in ("Light", "Cube"):
            links = getattr(bpy.data.objects[name], "light_linking", None)
            if links is None:
                self.skipTest("since Blender 4.0")
            links.receiver_collection = links.blocker_collection = things
        self.assertEqual(self.export()[1], "")  # empty ones link nothing
        things.objects.link(bpy.data.objects["Cube"])
        said = self.export()[1]
        for where in ("light 'Light'", "object 'Cube'"):
            self.assertIn(f"{where}: its light falls on all things: light linking is left out", said)
            self.assertIn(f"{where}: all things throw shadows in its light: shadow linking is left out", said)

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

    def test_holdouts_and_catchers_are_told(self) -> None:
        cube = bpy.data.objects["Cube"]
        cube.is_holdout = cube.is_shadow_catcher = True
        bpy.context.view_layer.layer_collection.children["Collection"].holdout = True
        _, said = self.export()
        self.assertIn("object 'Cube': jobs have no holdouts", said)
        self.assertIn("object 'Cube': jobs have no shadow catchers", said)
        self.assertIn("collection 'Collection': jobs have no holdouts", said)

    def test_collections_may_be_kept_from_the_camera(self) -> None:
        thing = bpy.data.objects.new("Thing", bpy.data.objects["Cube"].data)
        self.collection(thing, copies=2)
        self.assertEqual([self.export()[0].objects[name].visible_to_camera for name in ("Cube", "Thing")], [True, True])
        shelf = bpy.data.collections.new("Shelf")
        self.scene.collection.children.link(shelf)
        for name in ("Cube", "Copy 1"):
            bpy.data.objects[name].users_collection[0].objects.unlink(bpy.data.objects[name])
            shelf.objects.link(bpy.data.objects[name])
        bpy.context.view_layer.layer_collection.children["Shelf"].indirect_only = True
        job, said = self.export()
        things = [body for name, body in job.objects.items() if name.startswith("Thing")]
        moved = {body.visible_to_camera: (body.transform[0].matrix[3] if body.transform else 0) for body in things}
        self.assertEqual((moved, job.objects["Cube"].visible_to_camera, said), ({True: 0, False: 2}, False, ""))

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
