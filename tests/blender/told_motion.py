"""What moves, as the job says it. Run by test_export."""

from unittest import mock

import bpy
import hyades
from exporting import ExportTest

from hyades_render import animation, moving_copies


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
