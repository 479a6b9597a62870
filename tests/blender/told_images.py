"""Pictures of textures, and their alpha. Run by test_export."""

import bpy
import hyades
from exporting import ExportTest

from hyades_render.export.nodes import graph


class Images(ExportTest):
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

    def test_images_without_alpha_are_there_everywhere(self) -> None:
        made, shader = self.material("Leaf", "ShaderNodeBsdfTransparent")
        texture = made.node_tree.nodes.new("ShaderNodeTexImage")
        made.node_tree.links.new(texture.outputs["Alpha"], shader.inputs[0])
        texture.image = bpy.data.images.new("Leaf", 4, 4, alpha=True)
        bpy.data.objects["Cube"].data.materials[0] = made
        for mode, kind in (("STRAIGHT", hyades.textures.Texture), ("NONE", float)):
            texture.image.alpha_mode = mode
            self.assertIsInstance(self.export()[0].objects["Cube"].material.opacity, kind)

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
