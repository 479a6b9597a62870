"""Parts of the add-on by themselves: the receiver of pictures, joined frames, names and files of outputs."""

import os
import socket
import struct
import unittest

import addon  # noqa: F401  (finds the add-on)
import bpy
import hyades
import numpy
import vdb_file
from addon import AddOnTest
from hyades import Keys, MeshData, Step, cameras, lights, materials, objects, textures
from hyades.farm.states import JobState, read_state

from hyades_render import animation, farm_state, joined_frames, moving_transform, scene_job, view_camera
from hyades_render.farm_watch import Seen
from hyades_render.viewer import Viewer


def create(name: str, width: int, height: int, channels: str) -> bytes:
    body = b"\x04\x01" + name.encode() + b"\0" + struct.pack("<3i", width, height, len(channels))
    return packet(body + b"".join(c.encode() + b"\0" for c in channels))


def update(name: str, x: int, y: int, values: numpy.ndarray, channels: str) -> bytes:
    count = len(channels)
    body = b"\x06\x00" + name.encode() + b"\0" + struct.pack("<i", count)
    body += b"".join(c.encode() + b"\0" for c in channels)
    body += struct.pack("<4i", x, y, values.shape[1], values.shape[0])
    body += struct.pack(f"<{2 * count}q", *range(count), *[count] * count)
    return packet(body + values.astype("<f4").tobytes())


def packet(body: bytes) -> bytes:
    return struct.pack("<I", len(body) + 4) + body


class Receiver(unittest.TestCase):
    def setUp(self) -> None:
        self.viewer = Viewer()
        self.addCleanup(self.viewer.close)

    def send(self, *packets: bytes) -> None:
        host, port = self.viewer.address.split(":")
        with socket.create_connection((host, int(port))) as connection:
            connection.sendall(b"".join(packets))
            connection.shutdown(socket.SHUT_WR)
            connection.settimeout(20)
            try:
                connection.recv(1)  # until it has read all, and closes
            except ConnectionResetError:
                pass  # it has read enough

    def test_parts_come_to_their_places(self) -> None:
        part = numpy.arange(2 * 3 * 3, dtype=float).reshape(2, 3, 3)
        self.send(create("a", 8, 6, "RGB"), update("a", 4, 1, part, "RGB"))
        picture = self.viewer.pixels()
        self.assertEqual(picture.shape, (6, 8, 4))
        numpy.testing.assert_array_equal(picture[1:3, 4:7, :3], part)
        self.assertEqual(picture[:, :, :3].sum(), part.sum())
        self.assertTrue((picture[:, :, 3] == 1).all())
        self.assertEqual(self.viewer.changes(), 1)

    def test_the_newest_picture_is_shown(self) -> None:
        self.send(create("a", 8, 6, "R"), create("b", 2, 2, "R"))
        self.assertEqual(self.viewer.pixels("R").shape, (2, 2, 1))

    def test_nonsense_does_no_harm(self) -> None:
        good = update("a", 0, 0, numpy.ones((1, 1, 1)), "R")
        for wrong in (
            b"\xff\xff\xff\xff",
            struct.pack("<I", 4),
            packet(b"\x06\x00a\0" + struct.pack("<i", 1 << 30)),
            packet(b"\x04\x01a"),
            create("a", 1 << 30, 1 << 30, "R"),
            create("a", -1, 4, "R"),
            update("a", 7, 5, numpy.ones((4, 4, 1)), "R"),
            update("a", -1, 0, numpy.ones((1, 1, 1)), "R"),
            good[:-1],
        ):
            self.send(create("a", 8, 6, "R"), wrong)
            self.assertEqual(self.viewer.pixels("R").shape, (6, 8, 1), wrong[:40])
            self.assertFalse(self.viewer.pixels("R").any(), wrong[:40])
        self.send(create("a", 8, 6, "R"), good)
        self.assertEqual(self.viewer.pixels("R").sum(), 1)


class Joined(unittest.TestCase):
    """Jobs of moments as one."""

    def job(self, x: float, **more) -> hyades.Job:
        clay = hyades.materials.Lambert(color=[0.5, x / 10, 0.1])
        job = hyades.Job(materials={"clay": clay}, frames=hyades.Frames(fps=25))
        matrix = [1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        mesh = MeshData([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        job.objects["a"] = objects.Mesh(mesh=mesh, material=clay, transform=[Step(matrix=matrix)])
        job.camera = cameras.Perspective(fov=30 + x)
        for name, value in more.items():
            job.objects[name] = value
        return job

    def joined(self, *jobs: hyades.Job, moments=None):
        for before, now in zip(jobs, jobs[1:]):
            joined_frames.share(before, now)
        moments = moments or range(1, len(jobs) + 1)
        return joined_frames.join(moments, [int(at) if at == int(at) else None for at in moments], jobs)

    def test_what_stands_still_is_of_the_own_times(self) -> None:
        jobs, red, blue = [], materials.Lambert(color=[1, 0, 0]), materials.Lambert(color=[0, 0, 1])
        mesh = MeshData([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        for x in range(6):
            there = [Step(matrix=[1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])]
            lamp = objects.Mesh(mesh=mesh, material=materials.NullMaterial(), emit=objects.Emit(radiance=1), transform=there)
            clay = materials.Lambert(color=textures.Checker(mapping=textures.TextureMapping(type="uv", transform=there)))
            swapped = objects.Mesh(mesh=mesh, material=red if x < 4 else blue)
            jobs.append(self.job(x, lamp=lamp, tiles=objects.Mesh(mesh=mesh, material=clay), swapped=swapped))
        job, complaints = joined_frames.join([1, 1.25, 1.5, 2, 2.25, 2.5], [None, 1, None, None, 2, None], jobs)
        self.assertEqual(complaints, [])
        self.assertEqual(list(job.objects["a"].transform[-1].translate.keys), [1, 1.25, 1.5, 2, 2.25, 2.5])
        lamp = job.objects["lamp"].transform[-1].translate
        self.assertEqual((lamp.keys, lamp.ease), ({1: [1, 0, 0], 2: [4, 0, 0]}, "step"))
        tiles = job.objects["tiles"].material.color.mapping.transform[-1].translate
        self.assertEqual(tiles.keys, {1: [1, 0, 0], 2: [4, 0, 0]})
        self.assertEqual(job.objects["swapped"].material.color.keys, {1: [1, 0, 0], 2: [0, 0, 1]})

    def test_what_differs_becomes_keys(self) -> None:
        job, complaints = self.joined(self.job(0), self.job(1), self.job(3))
        self.assertEqual(complaints, [])
        self.assertEqual(job.camera.fov, Keys({1: 30, 2: 31, 3: 33}))
        self.assertEqual(job.materials["clay"].color, Keys({1: [0.5, 0, 0.1], 2: [0.5, 0.1, 0.1], 3: [0.5, 0.3, 0.1]}))
        self.assertIs(job.objects["a"].material, job.materials["clay"])
        self.assertIsInstance(job.objects["a"].mesh, MeshData)
        scale, turn, move = job.objects["a"].transform
        self.assertEqual(scale.scale, [1, 1, 1])
        self.assertEqual(turn.rotate.quaternion, [0, 0, 0, 1])
        self.assertEqual(move.translate, Keys({1: [0, 0, 0], 2: [1, 0, 0], 3: [3, 0, 0]}))

    def test_what_stays_is_said_once(self) -> None:
        job, complaints = self.joined(self.job(2), self.job(2), self.job(2))
        self.assertEqual((job.camera.fov, complaints), (32, []))
        self.assertEqual(len(job.objects["a"].transform), 1)

    def test_what_comes_and_goes_is_tiny_or_dark_meanwhile(self) -> None:
        lamp = lights.Point(power=50)
        first, second = self.job(0), self.job(0, late=objects.Sphere(radius=2))
        first.lights["lamp"] = lamp
        job, complaints = self.joined(first, second)
        self.assertEqual(job.objects["late"].transform[0].scale, Keys({1: 1e-6, 2: 1.0}, ease="step"))
        self.assertEqual(job.lights["lamp"].power, Keys({1: 50, 2: 0.0}, ease="step"))
        self.assertEqual(complaints, [])

    def test_a_mesh_that_deforms_is_a_file_for_each_frame(self) -> None:
        jobs = [self.job(0), self.job(0)]
        jobs[1].objects["a"].mesh.positions[:, 2] += 0.25
        job, _ = self.joined(*jobs, moments=(4, 4.5))
        meshes = job.objects["a"].mesh
        self.assertEqual(sorted(meshes), [4, 5])
        self.assertEqual(meshes[5].positions[:, 2].tolist(), [0.5, 0.5, 0.5])  # as far as it goes in a whole frame

    def test_what_a_job_cannot_say_is_told(self) -> None:
        jobs = [self.job(0), self.job(0)]
        jobs[1].objects["a"].normals = "flat"
        job, complaints = self.joined(*jobs)
        self.assertEqual([complaint.where for complaint in complaints], ["object 'a' > normals"])
        self.assertEqual(job.objects["a"].normals, "file")

    def test_every_matrix_comes_back(self) -> None:
        random = numpy.random.default_rng(7)
        for kind in ("any", "upright", "mirrored"):
            matrices = []
            for _ in range(2):
                linear = random.normal(size=(3, 3))
                if kind != "any":
                    turn, _ = numpy.linalg.qr(linear)
                    size = random.uniform(0.1, 3, 3) * ([-1, 1, 1] if kind == "mirrored" else 1)
                    linear = turn @ numpy.diag(size)
                matrix = numpy.eye(4)
                matrix[:3, :3], matrix[:3, 3] = linear, random.normal(size=3)
                matrices.append(matrix)
            given = [[Step(matrix=[float(x) for x in matrix.ravel()])] for matrix in matrices]
            steps = moving_transform.joined(given, lambda values: Keys(dict(enumerate(values))))
            for at, matrix in enumerate(matrices):
                whole = numpy.eye(4)
                for step in steps:
                    whole = self.as_matrix(step, at) @ whole
                numpy.testing.assert_allclose(whole, matrix, atol=2e-5, err_msg=kind)

    def as_matrix(self, step: Step, at: int) -> numpy.ndarray:
        def value(keys):
            return keys.keys[at] if isinstance(keys, Keys) else keys

        matrix = numpy.eye(4)
        if step.scale is not None:
            matrix[:3, :3] = numpy.diag(value(step.scale))
        elif step.translate is not None:
            matrix[:3, 3] = value(step.translate)
        else:
            x, y, z, w = value(step.rotate.quaternion)
            matrix[:3, :3] = [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        return matrix


class Scenes(AddOnTest):
    def test_settings_are_those_of_the_job(self) -> None:
        defaults = hyades.Sampling(), hyades.integrators.Path(), hyades.integrators.Mlt()
        for name in ("samples", "seed", "noise", "min_samples"):
            self.assertEqual(type(self.scene.hyades).bl_rna.properties[name].default, getattr(defaults[0], name), name)
        for name in ("max_depth", "roulette_depth", "clamp"):
            self.assertEqual(getattr(self.scene.hyades, name), getattr(defaults[1], name), name)
        self.assertAlmostEqual(self.scene.hyades.large_step, defaults[2].large_step)
        settings, job = self.scene.hyades, hyades.Job()
        settings.integrator, settings.noise, settings.denoise = "mlt", 0.05, "oidn"
        scene_job.apply_settings(job, settings)
        self.assertEqual((job.integrator.TYPE, job.denoise, job.sampling.min_samples), ("mlt", "oidn", 16))

    def test_what_is_baked_is_for_the_user_to_say(self) -> None:
        """A texture that the job does not have: a picture of the size that is asked for, or its mean."""
        made = bpy.data.materials["Material"]
        made.use_nodes = True
        nodes = made.node_tree.nodes
        magic = nodes.new("ShaderNodeTexMagic")
        made.node_tree.links.new(magic.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
        self.scene.hyades.bake_size = 128
        exported = animation.job_of(self.scene, frames=None, name="baked")
        color = exported.job.objects["Cube"].material.base_color
        self.assertEqual(getattr(color, "input", color).file.shape, (128, 128, 3))  # of Principled until 3.6 it is scaled
        self.assertEqual(exported.complaints, [])
        self.scene.hyades.bake = False
        exported = animation.job_of(self.scene, frames=None, name="mean")
        self.assertEqual(len(exported.job.objects["Cube"].material.base_color), 3)
        self.assertIn("node 'Magic Texture'", str(exported.complaints[0]))

    def test_files_are_called_as_the_output_says(self) -> None:
        render = self.scene.render
        for path, kind, numbered, expected in (
            ("/tmp/", "PNG", True, "shot.####.png"),
            ("/tmp/", "PNG", False, "shot.png"),
            ("/out/", "PNG", True, "####.png"),
            ("/tmp/s##_v##", "PNG", True, "s___v##.png"),
            ("/tmp/a_", "PNG", True, "a_####.png"),
            ("/tmp/a_##", "JPEG", True, "a_##.jpg"),
            ("/tmp/film.mp4", "FFMPEG", True, "film.mp4"),
            ("/tmp/a.exr", "OPEN_EXR", False, "a.exr"),
            ("/tmp/x", "TIFF", True, "x####.tif"),
        ):
            render.filepath = path
            render.image_settings.file_format = kind
            frames = range(1, 3) if numbered else None
            job = animation.job_of(self.scene, frames=frames, name="shot").job
            self.assertEqual([output.file for output in job.outputs], [expected])
        render.image_settings.file_format = "TARGA"
        complaints = animation.job_of(self.scene, frames=None, name="shot").complaints
        self.assertIn("output: files of type TARGA are not written; PNG is", [str(one) for one in complaints])
        render.use_border, render.use_freestyle, render.use_file_extension = True, True, False
        said = "\n".join(map(str, animation.job_of(self.scene, frames=None, name="shot").complaints))
        for part in ("size of the render region", "lines of Freestyle", "end with their extension"):
            self.assertIn(part, said)

    def test_a_still_scene_is_told_from_one_that_moves(self) -> None:
        self.assertIsNone(animation.moving_frames(self.scene))
        # Blender adds up normals by several threads, in another order each time.
        bpy.ops.mesh.primitive_uv_sphere_add(segments=128, ring_count=64)
        bpy.ops.object.shade_smooth()
        self.assertIsNone(animation.moving_frames(self.scene))
        cube = bpy.data.objects["Cube"]
        cube.keyframe_insert("location", frame=1)
        cube.location.z = 1
        cube.keyframe_insert("location", frame=250)
        self.assertEqual(animation.moving_frames(self.scene), range(1, 251))

    def test_what_moves_for_a_moment_is_no_still_scene(self) -> None:
        cube = bpy.data.objects["Cube"]
        self.scene.frame_start, self.scene.frame_end = 1, 40
        for frame, place in ((1, 0.0), (14, 0.0), (15, 1.0), (16, 0.0)):
            cube.location.z = place
            cube.keyframe_insert("location", frame=frame)
        self.assertEqual(animation.moving_frames(self.scene), range(1, 41))
        cube.animation_data_clear()
        # A driver alone moves nothing.
        cube.driver_add("location", 2).driver.expression = "1.5"
        self.assertIsNone(animation.moving_frames(self.scene))
        self.assertIn("nothing moves in frames 1-40: one picture of frame 1 is made", animation.still_note(self.scene))
        cube.driver_add("location", 2).driver.expression = "frame == 12"
        self.assertEqual(animation.moving_frames(self.scene), range(1, 41))

    def test_the_panel_takes_whatever_a_job_may_say(self) -> None:
        """A timer brings it, which an exception would end."""
        for whole, number in (((1 << 64) - 1, 1e300), (1 - (1 << 64), -1e300), (0, -1.0)):
            row = {"id": 7, "name": "a", "state": "b", "samples": 1, "samples_done": whole, "noise": number}
            row |= {"frames": whole, "frames_done": whole, "frames_failed": whole, "seconds_left": number}
            for said in (row, {**row, "noise": whole, "seconds_left": whole}):
                farm_state._take_jobs(Seen((read_state(JobState, said),)))
                self.assertEqual([job.job_id for job in bpy.context.window_manager.hyades_jobs], ["7"])
        farm_state._take_jobs(Seen())

    def test_names_are_those_that_jobs_take(self) -> None:
        for text, name in (("Küche 1", "K_che 1"), ("  ", "blender"), ("-a/b", "a_b"), ("x" * 200, "x" * 100)):
            self.assertEqual(scene_job.job_name(text), name)
            hyades.Job(name=name).yaml()

    def test_the_viewport_sees_what_its_matrices_say(self) -> None:
        """A point of the job's world lands on the film where Blender's matrices put it."""
        from mathutils import Matrix, Vector

        view = self.scene.camera.matrix_world.inverted()
        window = Matrix(((1.9, 0, 0.2, 0), (0, 3.1, -0.1, 0), (0, 0, -1, -0.2), (0, 0, -1, 0)))
        camera = view_camera.camera_of(view, window, 5.0)
        point = Vector((0.3, -0.4, 0.7, 1))
        clip = window @ (view @ point)
        at = numpy.array(camera.look_from)
        forward = numpy.array(camera.look_at) - at
        up = numpy.array(camera.up)
        right = numpy.cross(forward, up)
        ray = numpy.array([point.x, point.z, -point.y]) - at
        depth, tangent = ray @ forward, numpy.tan(numpy.radians(camera.fov / 2))
        aspect = 3.1 / 1.9
        # docs/job.md: with a shift of 0.5 what lies straight ahead is at the edge of the picture.
        x = ray @ right / (depth * tangent * aspect) - 2 * camera.shift[0]
        y = ray @ up / (depth * tangent) - 2 * camera.shift[1]
        numpy.testing.assert_allclose([x, y], [clip.x / clip.w, clip.y / clip.w], atol=1e-5)


class NamedFiles(AddOnTest):
    """Which files a .blend may have sent to a farm: it names what it likes."""

    def setUp(self) -> None:
        super().setUp()
        self.key = self.folder / "home/id_rsa"
        self.wood = self.folder / "textures/wood.png"
        for path in (self.key, self.wood):
            path.parent.mkdir()
        self.key.write_bytes(b"-----BEGIN OPENSSH PRIVATE KEY-----\n")
        self.picture(self.wood)
        made = bpy.data.materials["Material"]
        made.use_nodes = True
        self.tree = made.node_tree
        self.texture = self.tree.nodes.new("ShaderNodeTexImage")
        self.tree.links.new(self.texture.outputs["Color"], self.tree.nodes["Principled BSDF"].inputs["Base Color"])

    def picture(self, path) -> None:
        made = bpy.data.images.new("made", 4, 4)
        made.filepath_raw, made.file_format = str(path), "PNG"
        made.save()
        bpy.data.images.remove(made)

    def link(self, name: str, target):
        path = self.folder / "scene" / name
        path.parent.mkdir(exist_ok=True)
        path.symlink_to(target)
        return path

    def image(self, path, source: str = "FILE"):
        image = bpy.data.images.new("named", 4, 4)
        image.source, image.filepath = source, str(path)
        self.assertEqual((image.source, image.filepath), (source, str(path)))
        return image

    def exported(self):
        """The job, and complaints as text. In all that is written there is no key."""
        exported = animation.job_of(self.scene, frames=None, name="named")
        exported.job.write(self.folder / "job/job.yaml")
        self.assertNotRegex((self.folder / "job/job.yaml").read_text(), "id_rsa|stolen")
        self.assertFalse([p for p in self.folder.glob("job/assets/*") if b"OPENSSH" in p.read_bytes()])
        return exported.job, "\n".join(map(str, exported.complaints))

    def color(self, path, source: str = "FILE"):
        """What the material's colour has become, and complaints."""
        self.texture.image = self.image(path, source)
        job, complaints = self.exported()
        color = job.objects["Cube"].material.base_color
        return getattr(color, "input", color), complaints  # of Principled until 3.6 it is scaled

    def test_pictures_are_taken_wherever_they_lie(self) -> None:
        shelf = self.link("shelf", self.wood.parent)
        self.picture(self.wood.with_name("wood.1002.png"))
        self.link("tile.1011.png", self.wood)
        for path, source in (
            (self.wood, "FILE"),
            (shelf / "wood.png", "FILE"),
            (self.link("other.png", self.wood), "FILE"),
            (self.wood.with_name("wood.<UDIM>.png"), "TILED"),
            (self.folder / "scene/tile.<UDIM>.png", "TILED"),
        ):
            color, complaints = self.color(path, source)
            self.assertEqual((str(color.file), complaints), (str(path), ""))

    def test_links_to_other_files_are_not(self) -> None:
        color, complaints = self.color(self.link("stolen.png", self.key))
        self.assertIsInstance(color, (list, tuple))  # the default
        self.assertRegex(complaints, "Image Texture.*Blender reads no picture from the file .*stolen.png")

    def test_what_ends_otherwise_goes_as_what_blender_sees(self) -> None:
        """Of links into a store by content, too; and where the name is a pattern, of the file that is called so."""
        store = self.wood.with_name("2cf24dba")
        self.wood.rename(store)
        pattern = self.folder / "scene/a<UDIM>.png"
        for path in (self.link("wood.png", store), store, pattern):
            if path == pattern:
                self.picture(path)
                self.link("a1001.png", self.key)
            color, complaints = self.color(path)
            self.assertEqual((color.file.shape, complaints), ((4, 4, 3), ""))

    def test_tiles_are_pictures_with_a_mark_in_their_names(self) -> None:
        self.picture(self.folder / "scene-1001.png")
        self.link("stolen.1001.png", self.wood)
        self.link("stolen.1100.png", self.key)
        self.link("stolen.1001", self.key)
        for name in ("home/id_rsa", "textures/wood.png", "scene/stolen.<UDIM>.png", "scene/stolen.<UDIM>", "no.<UDIM>.png"):
            color, complaints = self.color(self.folder / name, "TILED")
            self.assertIsInstance(color, (list, tuple), name)
            self.assertRegex(complaints, f"Image Texture.*the tiles .*{name} are not taken: ")

    def test_the_world_takes_no_others_either(self) -> None:
        world = self.scene.world
        world.use_nodes = True
        texture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
        world.node_tree.links.new(texture.outputs["Color"], world.node_tree.nodes["Background"].inputs["Color"])
        texture.image = self.image(self.link("stolen.png", self.key))
        self.assertRegex(self.exported()[1], "Blender reads no picture from the file .*stolen.png; the world is black")
        texture.image = self.image(self.wood)
        self.assertEqual(str(self.exported()[0].environment.image), str(self.wood))

    def test_links_in_folders_too_deep_for_names_are_not_followed(self) -> None:
        steps = "/".join(["d" * 250] * 12)
        scene = self.folder / "scene"
        (scene / steps).mkdir(parents=True)
        (scene / "way1").symlink_to(steps)
        os.makedirs(scene / "way1" / steps)
        (scene / "way2").symlink_to(f"way1/{steps}")
        # For who does not ask the system, no link can be read down there, and 25 steps up from `up` is scene/p.png.
        below = self.key.parent / "/".join("e" * 25)
        below.mkdir(parents=True)
        self.key.rename(self.key.with_name("p.png"))
        self.picture(scene / "p.png")
        (scene / "way2/up").symlink_to(below)
        stolen = self.link("stolen.png", "way2/up/" + "../" * 25 + "p.png")
        self.assertIn(b"OPENSSH", stolen.read_bytes())
        color, complaints = self.color(stolen)
        self.assertIsInstance(color, (list, tuple))
        self.assertIn("stolen.png", complaints)

    def test_volumes_are_taken_where_links_lead_to_volumes(self) -> None:
        smoke = self.folder / "smoke.vdb"
        vdb_file.write(smoke, {"density": numpy.ones((8, 8, 8))})
        data = bpy.data.volumes.new("Smoke")
        self.scene.collection.objects.link(bpy.data.objects.new("Smoke", data))
        fog = bpy.data.materials.new("Fog")
        fog.use_nodes = True
        shader = fog.node_tree.nodes.new("ShaderNodeVolumePrincipled")
        fog.node_tree.links.new(shader.outputs[0], fog.node_tree.nodes["Material Output"].inputs["Volume"])
        data.materials.append(fog)
        for path in (smoke, self.link("link.vdb", smoke)):
            data.filepath = str(path)
            self.assertEqual(str(self.exported()[0].objects["Smoke"].interior.density.vdb), str(path))
        broken = self.folder / "broken.vdb"
        broken.write_bytes(b"no volume")
        words = "there is no file .*"
        for path in (self.link("stolen.vdb", self.key), self.key, broken):
            data.filepath = str(path)
            job, complaints = self.exported()
            self.assertNotIn("Smoke", job.objects)
            words = "Blender reads no volume from the file .*" if path == broken else words
            self.assertRegex(complaints, f"object 'Smoke': {words}{path.name}")


if __name__ == "__main__":
    unittest.main()
