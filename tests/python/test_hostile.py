"""What a coordinator must not be able to do to who fetches from it, and what a bad network may not break."""

import hashlib
import json
import os
import pathlib
import tempfile
import unittest
from urllib.parse import parse_qs, urlsplit

import environment  # noqa: F401
from fake_farm import FakeFarm, Request

import hyades
from hyades.farm import upload
from hyades.farm.events import parse_events

CONTENT = b"a picture" * 1000


def ok(message) -> tuple:
    return 200, {"Content-Type": "application/json"}, json.dumps(message).encode()


def output(name: str, content: bytes = CONTENT) -> dict:
    return {"id": name, "frame": 1, "size": len(content), "sha256": hashlib.sha256(content).hexdigest()}


class Serves:
    """Outputs of a job: what is listed, and the bytes that come."""

    def __init__(self, *listed: dict, content: bytes = CONTENT, cut: int = 0) -> None:
        self.listed, self.content, self.cut = list(listed), content, cut

    def __call__(self, request: Request):
        if urlsplit(request.path).path.endswith("/outputs"):
            return ok({"outputs": self.listed, "after": 1, "more": False})
        begin = int((request.headers.get("Range") or "bytes=0-").removeprefix("bytes=").removesuffix("-"))
        rest = self.content[begin:]
        if self.cut and begin == 0:  # promised whole, sent in part
            return 200, {"Content-Length": str(len(rest))}, rest[: self.cut]
        return (206 if begin else 200), {}, rest


class Fetch(unittest.TestCase):
    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.scratch = pathlib.Path(scratch.name)
        self.folder = self.scratch / "in/out"
        self.folder.mkdir(parents=True)

    def fetch(self, serves: Serves, **options) -> list:
        fake = FakeFarm(self, serves)
        self.requests = fake.requests
        return hyades.Farm(fake.address, patience=5).fetch(1, self.folder, **options)

    def everything(self) -> list:
        return sorted(str(p.relative_to(self.scratch)) for p in self.scratch.rglob("*") if not p.is_dir())

    def test_names_that_leave_the_folder_or_hide_are_refused(self) -> None:
        names = [
            "../up.exr", "/tmp/hyades-absolute", "a/../../up", "..", ".", "", "a/", "a//b", "./a", "a/./b", "a/..",
            ".bashrc", "a/.git/hooks/post-checkout", "-rf", "a/-x", ".hyades/fetched", "a/.hyades/x",
            "a\nb", "a\x1b[2J", "a\u202egpj.exr", "a\u200b", "a\udc80",
        ]  # fmt: skip
        for name in names:
            with self.subTest(name), self.assertRaises(hyades.FileRefused):
                self.fetch(Serves(output(name)))
            self.assertEqual(self.everything(), [])
            self.assertEqual(len(self.requests), 1, "no byte of it may be asked for")

    def test_what_is_kept_for_hyades_is_refused_even_to_who_asks_for_hidden_files(self) -> None:
        with self.assertRaises(hyades.FileRefused):
            self.fetch(Serves(output(".hyades/fetched")), hidden=True)
        (path,) = self.fetch(Serves(output(".a.exr")), hidden=True)
        self.assertEqual(path.read_bytes(), CONTENT)

    def test_files_that_no_fetch_has_written_are_not_replaced(self) -> None:
        mine = self.folder / "mine.exr"
        mine.write_bytes(b"mine")
        with self.assertRaises(hyades.FileRefused):
            self.fetch(Serves(output("mine.exr")))
        self.assertEqual(mine.read_bytes(), b"mine")
        self.fetch(Serves(output("mine.exr")), overwrite=True)
        self.assertEqual(mine.read_bytes(), CONTENT)
        # What a fetch has written another one may replace.
        self.fetch(Serves(output("mine.exr", b"new"), content=b"new"))
        self.assertEqual(mine.read_bytes(), b"new")
        # A link that leads nowhere is something that is there, too.
        os.symlink(self.scratch / "elsewhere", self.folder / "link.exr")
        with self.assertRaises(hyades.FileRefused):
            self.fetch(Serves(output("link.exr")))
        self.assertFalse((self.scratch / "elsewhere").exists())

    def test_a_part_that_is_a_link_is_not_followed(self) -> None:
        victim = self.scratch / "victim"
        victim.write_bytes(b"dear")
        part = f".a.exr.{output('a.exr')['sha256'][:16]}.part"
        os.symlink(victim, self.folder / part)
        with self.assertRaises((OSError, hyades.FarmError)):
            self.fetch(Serves(output("a.exr")))
        self.assertEqual(victim.read_bytes(), b"dear")

    def test_other_bytes_than_promised_get_no_name(self) -> None:
        with self.assertRaises(hyades.FileRefused):
            self.fetch(Serves(output("a.exr"), content=CONTENT[::-1]))
        self.assertFalse((self.folder / "a.exr").exists())
        with self.assertRaises(hyades.FileRefused):
            self.fetch(Serves({**output("a.exr"), "sha256": "../../x"}))

    def test_more_bytes_than_promised_are_not_taken(self) -> None:
        (path,) = self.fetch(Serves(output("a.exr"), content=CONTENT + b"more" * 100000))
        self.assertEqual(path.read_bytes(), CONTENT)

    def test_a_file_that_was_cut_off_goes_on(self) -> None:
        (path,) = self.fetch(Serves(output("a.exr"), cut=1000))
        self.assertEqual(path.read_bytes(), CONTENT)
        self.assertEqual(self.requests[-1].headers["Range"], "bytes=1000-")

    def test_a_damaged_part_of_an_earlier_run_is_begun_anew(self) -> None:
        part = self.folder / f".a.exr.{output('a.exr')['sha256'][:16]}.part"
        part.write_bytes(b"x" * 100)
        (path,) = self.fetch(Serves(output("a.exr")))
        self.assertEqual(path.read_bytes(), CONTENT)
        self.assertFalse(part.exists())


class Calls(unittest.TestCase):
    def test_a_token_follows_no_redirect(self) -> None:
        other = FakeFarm(self, lambda request: ok({}))
        fake = FakeFarm(self, lambda request: (307, {"Location": other.address + "/api/v1/info"}, b""))
        with self.assertRaises(hyades.FarmError) as caught:
            hyades.Farm(fake.address, token="secret", patience=5).info()
        self.assertEqual(caught.exception.code, "moved")
        self.assertEqual(fake.requests[0].headers["Authorization"], "Bearer secret")
        self.assertEqual(other.requests, [])

    def test_plain_text_stays_on_this_machine(self) -> None:
        with self.assertRaisesRegex(ValueError, "insecure=True"):
            hyades.Farm("http://farm.example:8080", token="secret")
        hyades.Farm("http://farm.example:8080", insecure=True)
        for address in ("ftp://farm", "http://u:p@farm", "http://farm:8080/path", "http://farm:x", ""):
            with self.subTest(address), self.assertRaises(ValueError):
                hyades.Farm(address or "http://", insecure=True)

    def test_what_is_worth_another_try_is_tried_again(self) -> None:
        answers = [None, (503, {}, b"{}"), ok({"jobs": 5})]
        fake = FakeFarm(self, lambda request: answers.pop(0))
        self.assertEqual(hyades.Farm(fake.address, patience=10).info()["jobs"], 5)
        refused = json.dumps({"error": {"code": "permission_denied", "message": "a viewer may not"}}).encode()
        fake = FakeFarm(self, lambda request: (403, {}, refused))
        with self.assertRaisesRegex(hyades.FarmError, "a viewer may not"):
            hyades.Farm(fake.address, patience=10).pause(1)
        self.assertEqual(len(fake.requests), 1)

    def test_nobody_there(self) -> None:
        with self.assertRaises(hyades.FarmError) as caught:
            hyades.Farm("http://127.0.0.1:9", patience=0.2).info()
        self.assertEqual(caught.exception.code, "unavailable")

    def test_events_are_read_as_the_standard_has_them(self) -> None:
        lines = [b":\n", b"\n", b"event: a\r\n", b'data: {"x":\n', b"data: 1}\n", b"id: 7\n", b"\n", b"data: 2\n", b"\n", b"event: b\n", b"data: 3\n"]
        self.assertEqual(list(parse_events(lines)), [("a", {"x": 1}), ("message", 2)])


class Uploads(unittest.TestCase):
    """Pieces of ten bytes, so that a file has several."""

    def setUp(self) -> None:
        size, upload._PIECE = upload._PIECE, 10
        self.addCleanup(setattr, upload, "_PIECE", size)
        self.stored = b""
        self.trouble: list = []

    def answer(self, request: Request):
        if request.path.endswith("/missing"):
            (file,) = json.loads(request.body)["files"]
            there = len(self.stored)
            return ok({"missing": [] if there == file["size"] else [{"sha256": file["sha256"], "offset": there}]})
        query = {name: int(value[0]) for name, value in parse_qs(urlsplit(request.path).query).items()}
        self.assertEqual(query["offset"], len(self.stored), "pieces have to follow each other")
        self.stored += request.body
        if self.trouble and (trouble := self.trouble.pop(0)):
            return trouble()
        return ok({"offset": len(self.stored), "complete": len(self.stored) == query["size"]})

    def refuse(self):
        return 400, {}, json.dumps({"error": {"code": "failed_precondition", "message": "offset"}}).encode()

    def forget(self):
        self.stored = b""
        return 400, {}, json.dumps({"error": {"code": "data_loss", "message": "another SHA-256"}}).encode()

    def upload(self) -> None:
        content = bytes(range(35))
        file = upload.JobFile("a", content, hashlib.sha256(content).hexdigest(), len(content))
        fake = FakeFarm(self, self.answer)
        upload.upload_missing(hyades.Farm(fake.address, patience=5)._http, [file])
        self.assertEqual(self.stored, content)

    def test_what_is_there_is_not_sent_again(self) -> None:
        self.stored = bytes(range(20))
        self.upload()

    def test_after_trouble_it_is_asked_where_the_file_stands(self) -> None:
        self.trouble = [self.refuse]  # the piece has come, its answer was wrong
        self.upload()

    def test_once_it_begins_again_from_the_beginning(self) -> None:
        self.stored = b"wrong" * 2
        self.trouble = [self.forget]
        self.upload()
        self.stored, self.trouble = b"", [None, self.forget] * 9
        with self.assertRaises(hyades.FarmError):
            self.upload()


if __name__ == "__main__":
    unittest.main()
