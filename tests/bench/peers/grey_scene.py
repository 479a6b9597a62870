"""Scenes that three renderers can be given exactly alike: meshes of matt grey facets, lamps that shine
on both sides, an even sky, a pinhole camera. Read from scenes of pbrt-v4 or made around one mesh."""
import os
import re
from dataclasses import dataclass, field

import numpy as np

PLY_TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "<i2", "int16": "<i2",
             "ushort": "<u2", "uint16": "<u2", "int": "<i4", "int32": "<i4", "uint": "<u4", "uint32": "<u4",
             "float": "<f4", "float32": "<f4", "double": "<f8", "float64": "<f8"}
GREY = 0.6


@dataclass
class Mesh:
    vertices: np.ndarray   # n x 3, float32
    triangles: np.ndarray  # n x 3, int32
    kind: str = "matt"     # matt, glass or lamp
    value: float = GREY    # matt: reflectance; lamp: radiance


@dataclass
class GreyScene:
    meshes: list = field(default_factory=list)
    sky: float = 0.0       # its radiance
    position: np.ndarray = None
    forward: np.ndarray = None
    up: np.ndarray = None
    fov: float = 40.0      # degrees, along the shorter side
    size: tuple = (320, 320)


def read_ply(path):
    """Vertices and triangles of a .ply of either binary kind; polygons are cut into fans."""
    with open(path, "rb") as file:
        elements, byte_order = [], "<"
        while (line := file.readline().decode("latin1").split()) != ["end_header"]:
            if not line:
                raise ValueError(f"{path}: no end_header")
            if line[0] == "format":
                if line[1] == "ascii":
                    raise ValueError(f"{path}: a .ply in text is not read here")
                byte_order = ">" if "big" in line[1] else "<"
            elif line[0] == "element":
                elements.append((line[1], int(line[2]), []))
            elif line[0] == "property":
                elements[-1][2].append(line[1:])
        data, at = file.read(), 0
    vertices = triangles = None
    for name, count, properties in elements:
        if name == "vertex":
            row = np.dtype([(p[1], PLY_TYPES[p[0]]) for p in properties]).newbyteorder(byte_order)
            rows = np.frombuffer(data, row, count, at)
            at += count * row.itemsize
            vertices = np.stack([rows["x"], rows["y"], rows["z"]], -1).astype(np.float32)
        elif name == "face":
            triangles = read_faces(data, at, count, properties, byte_order)
            break
    return vertices, triangles


def read_faces(data, at, count, properties, byte_order):
    length, index = (np.dtype(PLY_TYPES[t]).newbyteorder(byte_order) for t in properties[0][1:3])
    extra = sum(np.dtype(PLY_TYPES[p[0]]).itemsize for p in properties[1:])
    row = np.dtype([("n", length), ("i", index, 3), ("more", "V", extra)])
    if len(data) - at >= count * row.itemsize:
        rows = np.frombuffer(data, row, count, at)
        if (rows["n"] == 3).all():
            return rows["i"].astype(np.int32)
    fans = []
    for _ in range(count):
        corners = int(np.frombuffer(data, length, 1, at)[0])
        ring = np.frombuffer(data, index, corners, at + length.itemsize)
        at += length.itemsize + corners * index.itemsize + extra
        fans += [(ring[0], ring[i], ring[i + 1]) for i in range(1, corners - 1)]
    return np.array(fans, np.int32)


class PbrtReader:
    """What a scene file of pbrt-v4 shows: its meshes, in world space as the public scenes have them."""

    def __init__(self, path, width):
        self.folder = os.path.dirname(path)
        with open(path, errors="replace") as file:
            self.tokens = re.findall(r'"[^"]*"|\[|\]|[^\s\[\]]+', re.sub(r"#.*", "", file.read()))
        self.at = 0
        self.width = width
        self.resolution = (1280, 720)
        self.to_camera = np.eye(4)
        self.lamp = None
        self.stack = []
        self.scene = GreyScene()

    def read(self):
        in_world = False
        while self.at < len(self.tokens):
            word = self.next()
            if word == "WorldBegin":
                in_world = True
            elif word == "AttributeBegin":
                self.stack.append(self.lamp)
            elif word == "AttributeEnd":
                self.lamp = self.stack.pop()
            elif word == "Transform":
                numbers = self.value()
                if not in_world:
                    self.to_camera = np.array([float(x) for x in numbers]).reshape(4, 4).T
            elif word in ("AreaLightSource", "LightSource", "Camera", "Film", "Shape"):
                self.directive(word, self.next().strip('"'), self.parameters())
        self.place_camera()
        return self.scene

    def next(self):
        self.at += 1
        return self.tokens[self.at - 1]

    def value(self):
        if self.tokens[self.at] != "[":
            return [self.next().strip('"')]
        end = self.tokens.index("]", self.at)
        inside = self.tokens[self.at + 1:end]
        self.at = end + 1
        return [x.strip('"') for x in inside]

    def parameters(self):
        found = {}
        while self.at < len(self.tokens) and re.match(r'"\w+ \w+"', self.tokens[self.at]):
            name = self.next().strip('"').split()[1]
            found[name] = self.value()
        return found

    def directive(self, word, kind, parameters):
        if word == "AreaLightSource":
            self.lamp = float(np.mean([float(x) for x in parameters["L"]]))
        elif word == "LightSource" and kind == "infinite":
            self.scene.sky = 1.0
        elif word == "Camera":
            self.scene.fov = float(parameters["fov"][0])
        elif word == "Film":
            self.resolution = tuple(int(parameters[k][0]) for k in ("xresolution", "yresolution"))
        elif word == "Shape":
            self.shape(kind, parameters)

    def shape(self, kind, parameters):
        if kind == "plymesh":
            path = os.path.join(self.folder, parameters["filename"][0])
            if not os.path.exists(path):
                print(f"  without {path}, which is not there")
                return
            vertices, triangles = read_ply(path)
        elif kind == "trianglemesh":
            vertices = np.array(parameters["P"], np.float32).reshape(-1, 3)
            triangles = np.array(parameters["indices"], np.int32).reshape(-1, 3)
        else:
            return
        lit = self.lamp is not None
        self.scene.meshes.append(
            Mesh(vertices, triangles, "lamp" if lit else "matt", self.lamp if lit else GREY))

    def place_camera(self):
        turn = np.linalg.inv(self.to_camera[:3, :3])
        self.scene.position = -turn @ self.to_camera[:3, 3]
        self.scene.forward = turn @ [0.0, 0.0, 1.0]
        self.scene.up = turn @ [0.0, 1.0, 0.0]
        wide, high = self.resolution
        self.scene.size = (self.width, max(16, round(self.width * high / wide / 2) * 2))


def around_mesh(path, kind, width):
    """The mesh of a .ply, 2 long, on a floor under an even sky."""
    vertices, triangles = read_ply(path)
    low, high = vertices.min(0), vertices.max(0)
    vertices = ((vertices - (low + high) / 2) * (2 / (high - low).max())).astype(np.float32)
    y = float(vertices[:, 1].min())
    floor = np.array([[-10, y, -10], [-10, y, 10], [10, y, 10], [10, y, -10]], np.float32)
    return GreyScene(
        meshes=[Mesh(vertices, triangles, kind, 0.8),
                Mesh(floor, np.array([[0, 1, 2], [0, 2, 3]], np.int32), "matt", 0.5)],
        sky=1.0, position=np.array([0, 1, 4.2]), forward=np.array([0, -1, -4.2]), up=np.array([0, 1.0, 0]),
        fov=40.0, size=(width, width))


def write_pbrt(scene, folder, depth):
    """scene.pbrt, which Hyades and pbrt-v4 read, and its meshes."""
    os.makedirs(folder, exist_ok=True)
    numbers = lambda values: " ".join(f"{v:.9g}" for v in values)
    lines = [
        f"LookAt {numbers(scene.position)}  {numbers(scene.position + scene.forward)}  {numbers(scene.up)}",
        f'Camera "perspective" "float fov" [ {scene.fov:g} ]',
        f'Integrator "path" "integer maxdepth" [ {depth} ]',
        'Sampler "sobol" "integer pixelsamples" [ SAMPLES ] "integer seed" [ SEED ]',
        'PixelFilter "box" "float xradius" .5 "float yradius" .5',
        'Film "rgb" "string filename" "x.exr" "integer xresolution" %d "integer yresolution" %d' % scene.size,
        "WorldBegin"]
    if scene.sky:
        lines.append(f'LightSource "infinite" "rgb L" [ {scene.sky} {scene.sky} {scene.sky} ]')
    for i, mesh in enumerate(scene.meshes):
        write_ply(mesh, f"{folder}/{i}.ply")
        v = mesh.value
        look = {"matt": f'Material "diffuse" "rgb reflectance" [ {v} {v} {v} ]',
                "glass": 'Material "dielectric" "float eta" 1.5',
                "lamp": f'AreaLightSource "diffuse" "rgb L" [ {v} {v} {v} ] "bool twosided" true '
                        'Material "diffuse" "rgb reflectance" [ 0 0 0 ]'}[mesh.kind]
        lines += ["AttributeBegin", look, f'Shape "plymesh" "string filename" "{i}.ply"', "AttributeEnd"]
    with open(f"{folder}/scene.pbrt", "w") as file:
        file.write("\n".join(lines) + "\n")


def write_ply(mesh, path):
    rows = np.empty(len(mesh.triangles), np.dtype([("n", "u1"), ("i", "<i4", 3)]))
    rows["n"], rows["i"] = 3, mesh.triangles
    with open(path, "wb") as file:
        file.write(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                   b"property float z\nelement face %d\nproperty list uint8 int vertex_indices\nend_header\n"
                   % (len(mesh.vertices), len(mesh.triangles)))
        file.write(mesh.vertices.astype("<f4").tobytes() + rows.tobytes())


def write_numbers(scene, path, depth):
    """The same for cycles_scene.py, in one .npz."""
    arrays = {}
    for i, mesh in enumerate(scene.meshes):
        arrays |= {f"vertices{i}": mesh.vertices, f"triangles{i}": mesh.triangles,
                   f"kind{i}": mesh.kind, f"value{i}": mesh.value}
    np.savez(path, meshes=len(scene.meshes), sky=scene.sky, position=scene.position, forward=scene.forward,
             up=scene.up, fov=scene.fov, size=scene.size, depth=depth, **arrays)
