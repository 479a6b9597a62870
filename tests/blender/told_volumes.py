"""Volumes as the exporter has them: files of OpenVDB, and shaders. Run by test_export."""

import bpy
import numpy
import vdb_file
from exporting import ExportTest

from hyades_render import animation

_FULL = numpy.ones((8, 8, 8))
_RED = _FULL[..., None] * [0.75, 0.25, 0.25]


class Volumes(ExportTest):
    def smoke(self, shader: str = "ShaderNodeVolumePrincipled", **grids: numpy.ndarray):
        """An object of type Volume, and the shader that it is made of."""
        self.path = vdb_file.write(self.folder / "smoke_0001.vdb", grids or {"density": _FULL})
        data = bpy.data.volumes.new("Smoke")
        data.filepath = str(self.path)
        body = bpy.data.objects.new("Smoke", data)
        self.scene.collection.objects.link(body)
        made = bpy.data.materials.new("Fog")
        made.use_nodes = True
        made.node_tree.nodes.remove(made.node_tree.nodes["Principled BSDF"])
        node = made.node_tree.nodes.new(shader)
        made.node_tree.links.new(node.outputs[0], made.node_tree.nodes["Material Output"].inputs["Volume"])
        data.materials.append(made)
        return body, node

    def test_densities_are_those_of_the_objects_own_space(self) -> None:
        body, node = self.smoke()
        node.inputs["Density"].default_value = 3
        for scale, space, expected in (((1, 1, 1), "OBJECT", 1.5), ((2, 2, 2), "OBJECT", 0.75), ((2, 2, 2), "WORLD", 1.5)):
            body.scale, body.data.render.space = scale, space
            job, said = self.export()
            self.assertEqual(said, "")
            numpy.testing.assert_allclose(job.objects["Smoke"].interior.scattering, [expected] * 3, rtol=1e-5)

    def test_surfaces_of_files_are_told(self) -> None:
        body, _ = self.smoke()
        tree = body.data.materials[0].node_tree
        tree.links.new(tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        self.assertEqual(self.export()[1], "material 'Fog': volumes of files have no surface: that of the material is left out")

    def test_grids_that_are_not_there_are_told(self) -> None:
        _, node = self.smoke(smoke=_FULL, Cd=_RED)
        job, said = self.export()
        self.assertNotIn("Smoke", job.objects)
        words = "object 'Smoke': its file has no grid 'density' of numbers, expected one of 'smoke': it is left out"
        self.assertEqual(said, words)
        node.inputs["Density Attribute"].default_value = "smoke"
        node.inputs["Color Attribute"].default_value = "Cd"
        job, said = self.export()
        density = job.objects["Smoke"].interior.density
        self.assertEqual((density.grid, density.tint, said), ("smoke", "Cd", ""))
        self.assertEqual(density.at, [0.125] * 3)  # by half a voxel: Cycles has values in the middle of those
        node.inputs["Color Attribute"].default_value = "smoke"
        job, said = self.export()
        self.assertIsNone(job.objects["Smoke"].interior.density.tint)
        self.assertIn("no grid 'smoke' of colours, expected one of 'Cd': its colour is left out", said)
        node.inputs["Density Attribute"].default_value = ""
        self.assertIn("it asks for no grid of the file", self.export()[1])

    def test_black_bodies_are_as_bright_in_files_as_elsewhere(self) -> None:
        body, node = self.smoke(density=_FULL, temperature=_FULL)
        node.inputs["Blackbody Intensity"].default_value = 0.5
        node.inputs["Temperature"].default_value = 1500
        node.inputs["Blackbody Tint"].default_value = (1, 0.5, 0.25, 1)
        job, said = self.export()
        glow = job.objects["Smoke"].interior.emission
        self.assertEqual((glow.temperature, glow.kelvin, glow.color, said), ("temperature", 1500, [1, 0.5, 0.25], ""))
        cube = bpy.data.objects["Cube"]
        cube.data.materials[0] = body.data.materials[0]
        even = self.export()[0].objects["Cube"].interior.emission
        luminance = even[0] * 0.2126 + even[1] / 0.5 * 0.7152 + even[2] / 0.25 * 0.0722
        self.assertAlmostEqual(glow.strength / luminance, 1, places=2)

    def test_a_sequence_is_read_without_being_looked_at_before(self) -> None:
        body, _ = self.smoke()
        body.data.is_sequence = True
        body.data.frame_duration = 5
        body.data.grids.unload()
        job, said = self.export()
        self.assertEqual((str(job.objects["Smoke"].interior.density.vdb), said), (str(self.path), ""))

    def test_a_sequence_is_a_file_for_each_frame(self) -> None:
        body, _ = self.smoke()
        second = vdb_file.write(self.path.with_name("smoke_0002.vdb"), {"density": 2 * _FULL})
        body.data.is_sequence, body.data.frame_duration = True, 2
        for blurs, start, expected in (
            (False, 1, {1: self.path, 2: second}),
            (True, 1, {1: self.path, 2: second}),
            (False, 2, {2: self.path, 3: second}),
        ):
            body.data.frame_start, self.scene.render.use_motion_blur = start, blurs
            exported = animation.job_of(self.scene, frames=range(start, start + 2), name="film")
            made = exported.job.objects["Smoke"].interior.density.vdb
            self.assertEqual({frame: str(path) for frame, path in made.items()}, {f: str(p) for f, p in expected.items()})
            self.assertEqual("\n".join(map(str, exported.complaints)), "")

    def test_nothing_is_there_before_a_sequence(self) -> None:
        body, _ = self.smoke()
        body.data.is_sequence, body.data.frame_duration, body.data.frame_start = True, 1, 3
        job, said = self.export()
        self.assertEqual(("Smoke" in job.objects, said), (False, ""))

    def test_names_that_would_mean_a_sequence_are_copied(self) -> None:
        body, _ = self.smoke()
        odd = self.folder / "take #1"
        odd.mkdir()
        body.data.filepath = str(self.path.rename(odd / self.path.name))
        job, _ = self.export()
        job.write(self.folder / "job.yaml")
        self.assertRegex((self.folder / "job.yaml").read_text("utf-8"), r"vdb: assets/[0-9a-f]{16}\.vdb")

    def test_phase_functions_are_the_jobs_or_told(self) -> None:
        made = bpy.data.materials.new("Haze")
        made.use_nodes = True
        node = made.node_tree.nodes.new("ShaderNodeVolumeScatter")
        if not hasattr(node, "phase"):
            self.skipTest("since Blender 4.3")
        made.node_tree.links.new(node.outputs[0], made.node_tree.nodes["Material Output"].inputs["Volume"])
        bpy.data.objects["Cube"].data.materials[0] = made
        node.inputs["Anisotropy"].default_value = 0.5
        for kind, phase, g in (
            ("HENYEY_GREENSTEIN", None, 0.5),
            ("RAYLEIGH", "rayleigh", None),
            ("DRAINE", None, 0.54),
            ("MIE", None, 0.879),
            ("FOURNIER_FORAND", None, 0.658),
        ):
            node.phase = kind
            job, said = self.export()
            medium = job.objects["Cube"].interior
            self.assertEqual((medium.__dict__.get("phase"), g and round(medium.g, 3)), (phase, g), kind)
            self.assertEqual("jobs have no phase function" in said, kind not in ("HENYEY_GREENSTEIN", "RAYLEIGH"))
