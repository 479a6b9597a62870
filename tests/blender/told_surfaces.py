"""Shaders and normals: the job says the same, or the exporter tells it by name. Run by test_export."""

from unittest import mock

import bpy
import numpy
from exporting import ExportTest
from hyades import textures

from hyades_render.export.nodes import principled_inputs
from hyades_render.export.nodes.evaluate.blackbody import color_of
from hyades_render.export.nodes.evaluate.maths import OPERATIONS

_IS_NEW = bpy.app.version >= (4, 0)


class Surfaces(ExportTest):
    def shaded(self, kind: str):
        """The cube's new shader."""
        made, node = self.material("Paint", kind)
        bpy.data.objects["Cube"].data.materials[0] = made
        return node

    def mixed(self, *shaders: str):
        """The cube's new shader that mixes two others, and those."""
        first = self.shaded(shaders[0])
        tree = first.id_data
        mix, second = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new(shaders[1])
        for output, end in ((first, mix.inputs[1]), (second, mix.inputs[2])):
            tree.links.new(output.outputs[0], end)
        tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        return mix, first, second

    def test_facets_that_jobs_have_not_are_told(self) -> None:
        node = self.shaded("ShaderNodeBsdfGlossy")
        for kind, words in (("GGX", ""), ("BECKMANN", "not Beckmann's"), ("ASHIKHMIN_SHIRLEY", "not Ashikhmin and Shirley's")):
            node.distribution, node.inputs["Roughness"].default_value = kind, 0.5
            said = self.export()[1]
            self.assertEqual("facets are those of GGX" in said, bool(words), kind)
            self.assertIn(words, said)
            node.inputs["Roughness"].default_value = 0
            self.assertEqual(self.export()[1], "", kind)

    def test_rough_matt_surfaces_that_lose_light_are_told(self) -> None:
        node = self.shaded("ShaderNodeBsdfDiffuse")
        for roughness in (0.2, 0.5):
            node.inputs["Roughness"].default_value = roughness
            job, said = self.export()
            self.assertAlmostEqual(job.objects["Cube"].material.roughness, roughness, places=6)
            self.assertEqual("loses no light" in said, roughness > 0.2 and bpy.app.version < (4, 3))

    def test_metal_loses_what_it_loses_in_blender(self) -> None:
        node = self.shaded("ShaderNodeBsdfPrincipled")
        for kind, metallic, keeps in (("GGX", 1, False), ("MULTI_GGX", 1, True)):
            node.distribution, node.inputs["Metallic"].default_value = kind, metallic
            self.assertEqual(self.export()[0].objects["Cube"].material.multiple_scattering, keeps)

    def test_indices_below_one_are_told(self) -> None:
        node = self.shaded("ShaderNodeBsdfPrincipled")
        node.inputs["Transmission Weight" if _IS_NEW else "Transmission"].default_value = 1
        for ior, told in ((1.2, False), (0.75, True)):
            node.inputs["IOR"].default_value = ior
            self.assertEqual("'IOR' is held at 1" in self.export()[1], told)

    def test_numbers_below_nothing_are_computed(self) -> None:
        """Textures of jobs are held at 0."""
        node = self.shaded("ShaderNodeEmission")
        tree = node.id_data
        checker, math = tree.nodes.new("ShaderNodeTexChecker"), tree.nodes.new("ShaderNodeMath")
        tree.links.new(checker.outputs["Color"], math.inputs[1])
        tree.links.new(math.outputs[0], node.inputs["Color"])
        math.operation, math.inputs[0].default_value = "SUBTRACT", 1
        for brightest, is_computed in ((0.9, False), (1.2, True)):
            checker.inputs["Color1"].default_value = (brightest, brightest, brightest, 1)
            made = self.export()[0].objects["Cube"].emit.color
            self.assertEqual(isinstance(made, textures.Image), is_computed, made)
        math.operation, math.inputs[0].default_value = "ADD", -1
        self.assertIsInstance(self.export()[0].objects["Cube"].emit.color, textures.Image)

    def test_colors_that_may_be_too_bright_are_held(self) -> None:
        node = self.shaded("ShaderNodeBsdfDiffuse")
        tree = node.id_data
        checker = tree.nodes.new("ShaderNodeTexChecker")
        tree.links.new(checker.outputs["Color"], node.inputs["Color"])
        for brightest, told in ((0.9, False), (1.5, True)):
            checker.inputs["Color1"].default_value = (brightest, 0.2, 0.2, 1)
            job, said = self.export()
            self.assertEqual("'Color' is held at 1" in said, told)
            self.assertEqual(isinstance(job.objects["Cube"].material.color, textures.Min), told)
        mesh = bpy.data.objects["Cube"].data
        colors = mesh.color_attributes.new("Bright", "FLOAT_COLOR", "POINT")
        attribute = tree.nodes.new("ShaderNodeVertexColor")
        attribute.layer_name = "Bright"
        tree.links.new(attribute.outputs["Color"], node.inputs["Color"])
        for brightest, told in ((0.9, False), (2.0, True)):
            colors.data.foreach_set("color", [brightest, 0.2, 0.2, 1] * len(mesh.vertices))
            self.assertEqual("'Color' is held at 1" in self.export()[1], told)

    def test_glass_is_no_flesh_and_no_metal(self) -> None:
        node = self.shaded("ShaderNodeBsdfPrincipled")
        through, below = (("Transmission Weight", "Subsurface Weight") if _IS_NEW else ("Transmission", "Subsurface"))
        node.inputs[below].default_value = 1
        for share, is_told in ((0, False), (0.5, True), (1, False)):
            node.inputs[through].default_value = share
            job, said = self.export()
            self.assertEqual(job.objects["Cube"].material.subsurface is not None, share == 0)
            self.assertEqual("with both Subsurface is left out" in said, is_told)
        node.inputs["Metallic"].default_value = 0.4
        self.assertIn("what is metal and glass at once", self.export()[1])

    def test_inputs_that_nobody_knows_are_told(self) -> None:
        node = self.shaded("ShaderNodeBsdfPrincipled")
        self.assertEqual(self.export()[1], "")
        with mock.patch.object(principled_inputs, "_TAKEN", principled_inputs._TAKEN - {"Metallic"}):
            self.assertEqual(self.export()[1], "")
            node.inputs["Metallic"].default_value = 0.5
            self.assertIn("the job has no 'Metallic' of it: it is left out", self.export()[1])
        for name in ("Thin Film Thickness", "Diffuse Roughness"):  # since 4.2 and 4.3
            if name in node.inputs:
                node.inputs[name].default_value = 1
                self.assertIn(f"the job has no '{name}' of it: it is left out", self.export()[1])
                node.inputs[name].default_value = 0

    def test_a_coat_with_normals_of_its_own_is_told(self) -> None:
        node = self.shaded("ShaderNodeBsdfPrincipled")
        bump = node.id_data.nodes.new("ShaderNodeBump")
        coat = "Coat" if _IS_NEW else "Clearcoat"
        node.id_data.links.new(bump.outputs[0], node.inputs[f"{coat} Normal"])
        self.assertNotIn("its coat has the normals", self.export()[1])
        node.inputs["Coat Weight" if _IS_NEW else coat].default_value = 1
        self.assertIn("its coat has the normals of what is below it", self.export()[1])
        node.id_data.links.new(bump.outputs[0], node.inputs["Normal"])
        self.assertNotIn("its coat has the normals", self.export()[1])

    def test_ways_below_a_surface_are_told(self) -> None:
        node = self.shaded("ShaderNodeBsdfPrincipled")
        self.scene.hyades.max_depth = 256
        node.inputs["Subsurface Weight" if _IS_NEW else "Subsurface"].default_value = 1
        for method, told in (("RANDOM_WALK", False), ("BURLEY", True)):
            node.subsurface_method = method
            self.assertEqual("Christensen and Burley's profile is left out" in self.export()[1], told)

    def test_layers_take_of_what_is_below_them(self) -> None:
        if not _IS_NEW:
            self.skipTest("since Blender 4.0")
        node = self.shaded("ShaderNodeBsdfPrincipled")
        node.inputs["Emission Strength"].default_value = 2
        node.inputs["Emission Color"].default_value = (1, 0.5, 0.25, 1)

        def shines():
            body = self.export()[0].objects["Cube"]
            return numpy.array(body.emit.color) / [1, 0.5, 0.25]

        numpy.testing.assert_allclose(shines(), 2, rtol=1e-5)
        node.inputs["Coat Weight"].default_value = 1  # of an even sky it reflects 9 %
        numpy.testing.assert_allclose(shines() / 2, 0.914, atol=0.002)
        node.inputs["Coat Tint"].default_value = (1, 0.5, 1, 1)
        numpy.testing.assert_allclose(shines() / 2, [0.914, 0.914 * 0.453, 0.914], atol=0.003)
        job, said = self.export()
        self.assertIn("what the tint of its coat takes does not depend on the angle of view", said)
        color = job.objects["Cube"].material.base_color
        self.assertAlmostEqual(color[1] / color[0], 0.453, delta=0.003)
        node.inputs["Coat Weight"].default_value, node.inputs["Sheen Weight"].default_value = 0, 1
        numpy.testing.assert_allclose(shines() / 2, 1 - 0.1052, atol=0.001)

    def test_fuzz_is_that_of_the_job_that_is_most_like_it(self) -> None:
        if not _IS_NEW:
            self.skipTest("since Blender 4.0")
        node = self.shaded("ShaderNodeBsdfPrincipled")
        node.inputs["Sheen Weight"].default_value = 0.5
        for roughness, weight, like, told in ((0.3, 0.1905, 0.3, False), (0.5, 0.5, 0.43, False), (1.0, 0.5, 1.0, True)):
            node.inputs["Sheen Roughness"].default_value = roughness
            job, said = self.export()
            made = job.objects["Cube"].material
            self.assertAlmostEqual(made.sheen, weight, places=4)
            self.assertAlmostEqual(made.sheen_roughness, like, places=4)
            self.assertIn("fuzz (sheen) is that of Estevez and Kulla", said)
            self.assertEqual("is less rough" in said, told)

    def test_what_shines_to_one_side(self) -> None:
        mix, front, back = self.mixed("ShaderNodeEmission", "ShaderNodeBsdfDiffuse")
        tree = mix.id_data
        side = tree.nodes.new("ShaderNodeNewGeometry")
        tree.links.new(side.outputs["Backfacing"], mix.inputs["Fac"])
        job, said = self.export()
        self.assertEqual((job.objects["Cube"].emit.two_sided, said), (False, ""))
        for at, node in ((1, back), (2, front)):
            tree.links.new(node.outputs[0], mix.inputs[at])
        job, said = self.export()
        self.assertTrue(job.objects["Cube"].emit.two_sided)
        self.assertIn("both sides shine alike", said)

    def test_normals_that_lean_far_are_told(self) -> None:
        cube = bpy.data.objects["Cube"]
        self.assertEqual(self.export()[1], "")
        cube.data.polygons.foreach_set("use_smooth", [True] * 6)
        self.assertIn("object 'Cube': its normals lean far from its faces", self.export()[1])
        cube.modifiers.new("Round", "SUBSURF").render_levels = 1
        self.assertEqual(self.export()[1], "")

    def test_normal_maps_of_one_color_are_told(self) -> None:
        node = self.shaded("ShaderNodeBsdfDiffuse")
        lean = node.id_data.nodes.new("ShaderNodeNormalMap")
        node.id_data.links.new(lean.outputs[0], node.inputs["Normal"])
        self.assertEqual(self.export()[1], "")
        lean.inputs["Color"].default_value = (0.7, 0.5, 0.9, 1)
        self.assertIn("node 'Normal Map': normals that lean the same everywhere", self.export()[1])

    def test_caustics_that_are_switched_off_are_told(self) -> None:
        cycles = self.scene.cycles
        cycles.caustics_refractive, cycles.blur_glossy = False, 2
        said = self.export()[1]
        self.assertIn("render: caustics are there, refractive ones too", said)
        self.assertIn("render: Filter Glossy is left out", said)

    def test_strands_without_a_radius_are_as_thick_as_those_of_cycles(self) -> None:
        made = bpy.data.hair_curves.new("Hair") if hasattr(bpy.data, "hair_curves") else None
        if made is None or not hasattr(made, "add_curves"):
            self.skipTest("since Blender 3.5")
        made.add_curves([2])
        made.attributes["position"].data.foreach_set("vector", [0, 0, 0, 0, 0, 1])
        self.scene.collection.objects.link(bpy.data.objects.new("Hair", made))
        self.assertAlmostEqual(float(self.export()[0].objects["Hair"].curves.widths[0][0]), 0.01, places=6)


class Values(ExportTest):
    def test_black_bodies_are_those_of_cycles(self) -> None:
        numpy.testing.assert_array_equal(color_of([500.0, 20000.0]), color_of([800.0, 12000.0]))
        numpy.testing.assert_allclose(color_of(1500.0), [3.2643, 0.434, 0], atol=1e-4)  # red as of Cycles' pictures
        for kelvin in (965.0, 1167.0, 1449.0, 1902.0, 3315.0, 6365.0):  # the pieces meet
            numpy.testing.assert_allclose(color_of(kelvin - 0.01), color_of(kelvin), atol=2e-3)

    def test_ping_pong_with_a_scale_below_nothing(self) -> None:
        for value in (-0.9, 0.2, 0.7):
            way, back = (OPERATIONS["PINGPONG"](numpy.array(value), numpy.array(scale), None) for scale in (0.5, -0.5))
            self.assertAlmostEqual(float(way), float(back))

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
