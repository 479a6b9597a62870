"""Pictures and meshes: to files and back, and files that are no pictures."""

import pathlib
import re
import struct
import tempfile
import unittest

import environment  # noqa: F401
import numpy

import hyades
from hyades.exr import decode_exr, encode_exr
from hyades.png import decode_png, encode_png

RANDOM = numpy.random.default_rng(7)


class Png(unittest.TestCase):
    def test_round_trip(self) -> None:
        for shape in ((5, 7), (5, 7, 2), (1, 1, 3), (5, 7, 4)):
            for kind in ("uint8", "uint16"):
                pixels = RANDOM.integers(0, numpy.iinfo(kind).max, shape).astype(kind)
                self.assertTrue((decode_png(encode_png(pixels)).reshape(shape) == pixels).all())

    def test_every_filter_is_undone(self) -> None:
        import zlib

        rows = RANDOM.integers(0, 255, (5, 12)).astype("uint8")
        # Each row is filtered by the definition, byte by byte.
        filtered = b""
        for kind in range(5):
            filtered += bytes([kind])
            for i in range(12):
                left, up = (rows[kind, i - 3] if i >= 3 else 0), (rows[kind - 1, i] if kind else 0)
                corner = rows[kind - 1, i - 3] if kind and i >= 3 else 0
                left, up, corner = int(left), int(up), int(corner)
                guess = left + up - corner
                paeth = min((left, up, corner), key=lambda v: abs(guess - v))
                predicted = [0, left, up, (left + up) // 2, paeth][kind]
                filtered += bytes([(int(rows[kind, i]) - predicted) & 255])
        plain = encode_png(rows.reshape(5, 4, 3))
        at = plain.index(b"IDAT") - 4
        size = struct.unpack_from(">I", plain, at)[0]
        packed = zlib.compress(filtered)
        chunk = struct.pack(">I", len(packed)) + b"IDAT" + packed + struct.pack(">I", zlib.crc32(b"IDAT" + packed))
        self.assertTrue((decode_png(plain[:at] + chunk + plain[at + 12 + size :]).reshape(5, 12) == rows).all())

    def test_broken_ones_are_refused(self) -> None:
        good = encode_png(numpy.zeros((4, 4, 3), "uint8"))
        for bad in (b"", good[:8], good[:40], b"GIF" + good):
            with self.assertRaises(Exception) as caught:
                decode_png(bad)
            self.assertNotIsInstance(caught.exception, MemoryError)


class Codes(unittest.TestCase):
    def test_are_no_light(self) -> None:
        picture = hyades.Picture(numpy.full((2, 2, 3), 7, "uint8"))
        with self.assertRaisesRegex(ValueError, "expected floats"):
            picture.exposed(1)
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(ValueError, "expected a file .png"):
            picture.save(pathlib.Path(folder) / "a.exr")
        self.assertEqual(hyades.Picture(numpy.full((1, 1), 300, ">u2")).array.dtype, numpy.uint16)
        for wrong in (numpy.zeros((0, 0, 3)), numpy.zeros((2, 2, 5)), numpy.zeros((2, 2), "int64"), numpy.array([["a"]])):
            with self.assertRaisesRegex(ValueError, "is no picture"):
                hyades.Picture(wrong)


class Exr(unittest.TestCase):
    def test_round_trip(self) -> None:
        light = RANDOM.random((6, 9, 3)).astype("float32") * 100
        layers = {"beauty": light, "alpha": light[:, :, 0], "normal": light}
        back = decode_exr(encode_exr(layers))
        self.assertEqual(sorted(back), ["alpha", "beauty", "normal"])
        for name, array in layers.items():
            self.assertTrue((back[name] == array).all(), name)
        self.assertEqual(back.data_window, (0, 0, 9, 6))
        half = decode_exr(encode_exr({"beauty": light}, half=True))["beauty"]
        self.assertTrue((half == light.astype("float16").astype("float32")).all())

    def test_broken_ones_are_refused(self) -> None:
        good = encode_exr({"beauty": numpy.ones((4, 4, 3), "float32")})
        with tempfile.TemporaryDirectory() as folder:
            for cut in range(0, len(good), 13):
                path = pathlib.Path(folder) / "cut.exr"
                path.write_bytes(good[:cut])
                with self.assertRaisesRegex(ValueError, "cut.exr"):
                    hyades.read_exr(path)
            huge = good.replace(struct.pack("<iiii", 0, 0, 3, 3), struct.pack("<iiii", 0, 0, 1 << 30, 1 << 30))
            path.write_bytes(huge)
            with self.assertRaisesRegex(ValueError, "no picture"):
                hyades.read_exr(path)


class Pictures(unittest.TestCase):
    def test_light_is_shown_as_srgb(self) -> None:
        shown = hyades.Picture(numpy.array([[[0.0, 0.5, 2.0]]])).codes
        self.assertEqual(shown.tolist(), [[[0, 188, 255]]])  # 0.5 is 187.5 of 255 in sRGB
        broken = hyades.Picture(numpy.array([[[numpy.nan, numpy.inf, -1.0]]])).codes
        self.assertEqual(broken.tolist(), [[[0, 255, 0]]])

    def test_alpha_is_not_light(self) -> None:
        self.assertEqual(hyades.Picture(numpy.full((1, 1, 4), 0.5)).codes[0, 0, 3], 128)

    def test_notebooks_show_it(self) -> None:
        png = hyades.Picture(numpy.full((2, 3, 3), 0.5))._repr_png_()
        self.assertEqual(decode_png(png).shape, (2, 3, 3))

    def test_save_and_read(self) -> None:
        light = hyades.Picture(RANDOM.random((4, 5, 3)).astype("float32"))
        with tempfile.TemporaryDirectory() as folder:
            for end, want in ((".exr", light.array), (".png", light.codes)):
                path = pathlib.Path(folder) / f"a{end}"
                light.save(path)
                self.assertTrue((hyades.Picture.read(path).array == want).all())
            with self.assertRaises(ValueError):
                light.save(path.with_suffix(".gif"))


class Meshes(unittest.TestCase):
    def test_shapes_are_checked(self) -> None:
        corner = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
        for wrong in (
            lambda: hyades.MeshData([[0, 0]], [[0, 0, 0]]),
            lambda: hyades.MeshData(corner, [[0, 1, 3]]),
            lambda: hyades.MeshData(corner, [[0.0, 1.0, 2.0]]),
            lambda: hyades.MeshData(corner, [[0, 1, 2]], uvs=[[0, 0]]),
            lambda: hyades.MeshData([[0, 0, float("nan")]], [[0, 0, 0]]),
            lambda: hyades.Places(corner, rotations=[[0, 0, 0]]),
            lambda: hyades.Strands([], 0.1),
            lambda: hyades.Strands([corner[:1]], 0.1),
            lambda: hyades.Strands([corner], -0.1),
            lambda: hyades.Strands([corner], [[0.1, 0.1]]),
            lambda: hyades.Strands([corner], 0.1, colors=corner),
            lambda: hyades.Strands([corner], 0.1, colors=[[255, 0, 0]]),
        ):
            self.assertRaises(ValueError, wrong)

    def test_equal_arrays_are_written_once(self) -> None:
        from hyades import objects, textures

        mesh = lambda: hyades.MeshData([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        job = hyades.Job(objects={"a": objects.Mesh(mesh=mesh()), "b": objects.Mesh(mesh=mesh())})
        pixels = numpy.zeros((2, 2, 3), "uint8")
        job.textures = {"c": textures.Image(file=pixels), "d": textures.Image(file=pixels.copy())}
        self.assertEqual(len(job.document().files.made), 2)

    def test_files_of_frames_are_named_by_their_pattern_or_copied(self) -> None:
        from hyades import media

        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            for name in ("fire_0009.vdb", "fire_0010.vdb", "other.vdb"):
                (folder / name).write_bytes(name.encode())

            def named(files: dict[int, str]) -> tuple[str, dict[str, bytes]]:
                paths = {frame: str(folder / name) for frame, name in files.items()}
                fire = media.Medium(absorption=1, density=media.Density(vdb=paths))
                document = hyades.Job(media={"fire": fire}).document(folder)
                document.write(folder / "job.yaml")
                found = re.search(r"vdb: ([^},]*)", str(document.text))
                self.assertIsNotNone(found, document.text)
                made = {path.name.partition(".")[2]: path.read_bytes() for path in (folder / "assets").glob("*")}
                return found[1].strip('"'), made

            self.assertEqual(named({9: "fire_0009.vdb", 10: "fire_0010.vdb"}), ("fire_####.vdb", {}))
            name, made = named({1: "fire_0009.vdb", 2: "other.vdb"})
            self.assertRegex(name, r"^assets/[0-9a-f]{16}\.####\.vdb$")
            self.assertEqual(made, {"0001.vdb": b"fire_0009.vdb", "0002.vdb": b"other.vdb"})
            with self.assertRaises(FileNotFoundError):
                named({1: "fire_0009.vdb", 2: "nothing.vdb"})
            named({2: "fire_0009.vdb", 3: "other.vdb"})  # later: no file of the others is replaced
            self.assertEqual(len(list((folder / "assets").glob("*.vdb"))), 4)

    def test_sequences_at_other_frames_have_other_names(self) -> None:
        from hyades import objects

        meshes = [hyades.MeshData([[0, 0, 0], [1, 0, 0], [0, size, 0]], [[0, 1, 2]]) for size in (1, 2)]
        first, later = (objects.Mesh(mesh=dict(enumerate(meshes, start=at))) for at in (1, 2))
        made = hyades.Job(objects={"first": first, "later": later}).document().files.made
        self.assertEqual(len(made), 4)


if __name__ == "__main__":
    unittest.main()
