"""Runs in Blender for `speed`: makes a large scene, and has it taken over by Cycles or exported."""

import pathlib
import resource
import sys
import time
import types

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "python")]
sys.modules["hyades_render"] = types.ModuleType("hyades_render")
sys.modules["hyades_render"].__path__ = [str(HERE.parents[1] / "blender/hyades_render")]

import bpy  # noqa: E402
import numpy  # noqa: E402
from both import Exporting  # noqa: E402
from scene import add, begin, floor, light, material, world  # noqa: E402

from hyades_render import export  # noqa: E402


def grid(side: int, name: str = "Grid", uv: bool = False):
    """A mesh of 2 side² triangles with waves, in a square of one metre."""
    steps = numpy.linspace(-0.5, 0.5, side + 1, dtype="float32")
    x, y = numpy.meshgrid(steps, steps)
    z = 0.05 * numpy.sin(9 * x) * numpy.cos(7 * y)
    positions = numpy.stack([x, y, z], axis=2).reshape(-1, 3)
    low = (numpy.arange(side)[:, None] * (side + 1) + numpy.arange(side)).reshape(-1)
    corners = numpy.stack([low, low + 1, low + side + 2, low, low + side + 2, low + side + 1], axis=1).astype("int32")
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set("co", positions.reshape(-1))
    count = 2 * side * side
    mesh.loops.add(3 * count)
    mesh.loops.foreach_set("vertex_index", corners.reshape(-1))
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", numpy.arange(0, 3 * count, 3, dtype="int32"))
    mesh.polygons.foreach_set("loop_total", numpy.full(count, 3, "int32"))
    mesh.polygons.foreach_set("use_smooth", numpy.ones(count, bool))
    if uv:
        layer = mesh.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", (positions[corners.reshape(-1), :2] + 0.5).reshape(-1))
    mesh.update(calc_edges=True)
    return mesh


def triangles(uv: bool = False) -> None:
    """Ten million triangles in one mesh."""
    made = material(Color=0.6)
    if uv:
        texture = made.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = bpy.data.images.new("Picture", 64, 64)
        made.node_tree.links.new(texture.outputs[0], made.node_tree.nodes["Diffuse BSDF"].inputs["Color"])
    mesh = grid(2237, uv=uv)
    mesh.materials.append(made)
    add(mesh, scale=(8, 8, 8))


def textured() -> None:
    """The same with a UV map that a texture looks at."""
    triangles(uv=True)


def objects() -> None:
    """Ten thousand objects, each with a mesh of its own of 1,058 triangles: ten million in all."""
    made = material(Color=0.6)
    first = grid(23)
    first.materials.append(made)
    for i in range(10000):
        add(first if i == 0 else first.copy(), at=(i % 100 - 50, i // 100 - 50, 0))


def shared() -> None:
    """Ten thousand objects with one mesh."""
    mesh = grid(23)
    mesh.materials.append(material(Color=0.6))
    for i in range(10000):
        add(mesh, at=(i % 100 - 50, i // 100 - 50, 0))


def instances() -> None:
    """A million copies, on the vertices of a grid."""
    mesh = grid(8)
    mesh.materials.append(material(Color=0.6))
    small = add(mesh)
    places = bpy.data.meshes.new("Places")
    x, y = numpy.meshgrid(numpy.arange(1000.0), numpy.arange(1000.0))
    places.vertices.add(1000000)
    places.vertices.foreach_set("co", numpy.stack([x, y, 0 * x], axis=2).reshape(-1).astype("float32"))
    places.update()
    small.parent = parent = add(places)
    parent.instance_type = "VERTS"


def memory() -> float:
    """The most that this process had [GB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6


def main(name: str, by: str, folder: str) -> None:
    bpy.utils.register_class(Exporting)
    begin()
    floor()
    world(0.5)
    light("SUN", 2)
    globals()[name]()
    render = bpy.context.scene.render
    render.resolution_x = render.resolution_y = 8
    bpy.context.view_layer.update()
    print(f"before: {memory():.3f} GB")
    if by == "cycles":
        render.engine = "CYCLES"
        cycles = bpy.context.scene.cycles
        cycles.samples, cycles.use_denoising = 1, False
        bpy.ops.render.render()
    else:
        render.engine = "HYADES_TRUTH"
        took = []
        exported = export.export_job

        def timed(*arguments, **keys):
            began = time.perf_counter()
            result = exported(*arguments, **keys)
            took.append(time.perf_counter() - began)
            return result

        export.export_job = timed
        bpy.ops.render.render()
        if isinstance(Exporting.exported, Exception):
            raise Exporting.exported
        began = time.perf_counter()
        Exporting.exported.job.write(pathlib.Path(folder) / "job.yaml")
        print(f"exported in {took[0]:.3f} s, written in {time.perf_counter() - began:.3f} s")
    print(f"after: {memory():.3f} GB")


if __name__ == "__main__":
    main(*sys.argv[sys.argv.index("--") + 1 :])
