"""Run by Blender: renders what grey_scene.write_numbers wrote with Cycles.

  blender -b --factory-startup --python cycles_scene.py -- SCENE.npz PICTURE.exr SAMPLES THREADS SEED"""
import math
import sys
import time

import bpy
import numpy as np
from mathutils import Matrix, Vector

path, picture, samples, threads, seed = sys.argv[sys.argv.index("--") + 1:]
given = np.load(path)
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene


def material(kind, value):
    made = bpy.data.materials.new(kind)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    if kind == "lamp":
        node = tree.nodes.new("ShaderNodeEmission")
        node.inputs["Color"].default_value = (1, 1, 1, 1)
        node.inputs["Strength"].default_value = value
    elif kind == "glass":
        node = tree.nodes.new("ShaderNodeBsdfGlass")
        node.inputs["Roughness"].default_value = 0
        node.inputs["IOR"].default_value = 1.5
    else:
        node = tree.nodes.new("ShaderNodeBsdfDiffuse")
        node.inputs["Color"].default_value = (value, value, value, 1)
    tree.links.new(node.outputs[0], output.inputs[0])
    return made


def add_mesh(name, vertices, triangles, look):
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", vertices.ravel())
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set("vertex_index", triangles.ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    mesh.polygons.foreach_set("loop_total", np.full(len(triangles), 3, np.int32))
    mesh.update()
    mesh.validate()
    mesh.materials.append(look)
    scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def place_camera():
    camera = bpy.data.cameras.new("camera")
    holder = bpy.data.objects.new("camera", camera)
    scene.collection.objects.link(holder)
    scene.camera = holder
    forward = Vector(given["forward"]).normalized()
    right = forward.cross(Vector(given["up"])).normalized()
    up = right.cross(forward)
    columns = (right, up, -forward, Vector(given["position"]))
    holder.matrix_world = Matrix([[c[row] for c in columns] for row in range(3)] + [(0, 0, 0, 1)])
    wide, high = (int(x) for x in given["size"])
    camera.sensor_fit = "VERTICAL" if wide >= high else "HORIZONTAL"
    camera.angle = math.radians(float(given["fov"]))
    camera.clip_end = 1e6
    scene.render.resolution_x, scene.render.resolution_y = wide, high
    scene.render.resolution_percentage = 100


for i in range(int(given["meshes"])):
    add_mesh(f"mesh{i}", given[f"vertices{i}"], given[f"triangles{i}"],
             material(str(given[f"kind{i}"]), float(given[f"value{i}"])))
place_camera()
world = bpy.data.worlds.new("world")
scene.world = world
world.use_nodes = True
sky = float(given["sky"])
world.node_tree.nodes["Background"].inputs["Color"].default_value = (sky, sky, sky, 1)

scene.render.engine = "CYCLES"
cycles = scene.cycles
cycles.device = "CPU"
cycles.samples, cycles.seed = int(samples), int(seed)
cycles.use_adaptive_sampling = cycles.use_denoising = False
cycles.sample_clamp_indirect = 0
cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
for bounces in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"):
    setattr(cycles, bounces, int(given["depth"]) - 1)
scene.render.threads_mode, scene.render.threads = "FIXED", int(threads)
image = scene.render.image_settings
image.file_format, image.color_depth, image.color_mode = "OPEN_EXR", "32", "RGB"
scene.view_settings.view_transform = "Raw"
scene.render.filepath = picture
start = time.process_time()
bpy.ops.render.render(write_still=True)
print("RENDER_SECONDS", time.process_time() - start)
