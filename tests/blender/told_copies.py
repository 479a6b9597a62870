"""What there is, once or many times: the job has it as often. Run by test_export."""

from unittest import mock

import bpy
from exporting import ExportTest

from hyades_render.export import objects


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
        self.assertEqual(said, "material 'Place' > node 'Diffuse BSDF': 'Color' is held at 1 where it is above: nothing reflects more light than it gets")
        with mock.patch.object(objects, "_MOST_OWN", 2):
            job, said = self.export()
        self.assertEqual(len(job.objects["Thing"].places.matrices), 3)
        self.assertIn("object 'Thing': its looks depend on where it is, or on the object: copies beyond 2", said)

    def test_what_becomes_a_mesh_is_there_once(self) -> None:
        bpy.ops.curve.primitive_bezier_circle_add()
        bpy.ops.object.text_add()
        bpy.ops.object.metaball_add()
        bpy.ops.surface.primitive_nurbs_surface_sphere_add()
        bpy.data.objects["BezierCircle" if "BezierCircle" in bpy.data.objects else "BézierCircle"].data.bevel_depth = 0.1
        for thing in (bpy.data.objects["Text"], bpy.data.objects["Mball"]):
            thing.data.materials.append(self.material(thing.name)[0])
        job, _ = self.export()
        self.assertEqual(len([name for name in job.objects if name not in ("Cube", "Light")]), 4, list(job.objects))
        self.assertEqual((job.objects["Text"].material, job.objects["Mball"].material), tuple(map(job.materials.get, ("Text", "Mball"))))

    def test_a_view_layer_may_override_all_materials(self) -> None:
        bpy.data.objects["Cube"].data.materials.clear()
        bpy.context.view_layer.material_override = self.material("Clay", color=(0.25, 0.5, 0.75))[0]
        job, _ = self.export()
        self.assertEqual(job.objects["Cube"].material.color, [0.25, 0.5, 0.75])
