"""What tests of the exporter share."""

import bpy
import hyades
from addon import AddOnTest

from hyades_render import animation


class ExportTest(AddOnTest):
    """A scene of the lit cube; `export` gives the job and what it complained about."""

    def export(self) -> tuple[hyades.Job, str]:
        exported = animation.job_of(self.scene, frames=None, name="export")
        return exported.job, "\n".join(map(str, exported.complaints))

    def material(self, name: str, shader: str = "ShaderNodeBsdfDiffuse", color=(0.5, 0.5, 0.5)):
        """A material of one shader, and that node."""
        made = bpy.data.materials.new(name)
        made.use_nodes = True
        made.node_tree.nodes.clear()
        output = made.node_tree.nodes.new("ShaderNodeOutputMaterial")
        node = made.node_tree.nodes.new(shader)
        node.inputs[0].default_value = (*color, 1)
        made.node_tree.links.new(node.outputs[0], output.inputs["Surface"])
        return made, node

    def collection(self, *things, copies: int):
        """Puts objects into a collection that empties show, two metres apart."""
        kit = bpy.data.collections.new("Kit")
        for thing in things:
            kit.objects.link(thing)
        for at in range(copies):
            empty = bpy.data.objects.new(f"Copy {at}", None)
            empty.instance_type, empty.instance_collection = "COLLECTION", kit
            empty.location.x = 2 * at
            self.scene.collection.objects.link(empty)
