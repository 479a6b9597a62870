"""What a coordinator must not be able to do to who fetches from it, and what a bad network may not break."""

import hashlib
import json
import os
import pathlib
import re
import socket
import tempfile
import time
import unittest
from unittest import mock
from urllib.parse import parse_qs, urlsplit

import environment  # noqa: F401
import numpy
from fake_farm import FakeFarm, Request

import hyades
from hyades.exr import decode_exr
from hyades.exr_header import Header
from hyades.farm import names, upload
from hyades.farm.events import parse_events
from hyades.farm.states import JobState, read_state

CONTENT = b"a picture" * 1000


def ok(message) -> tuple:
    return 200, {"Content-Type": "application/json"}, json.dumps(message).encode()


def output(name: str, content: bytes = CONTENT) -> dict:
    return {"id": name, "frame": 1, "size": len(content), "sha256": hashlib.sha256(content).hexdigest()}


def deep_folder(folder: pathlib.Path) -> pathlib.Path:
    """A link in `folder` to a folder that is deeper than any name is long."""
    steps = "/".join(["d" * 250] * 12)
    (folder / steps).mkdir(parents=True)
    os.symlink(steps, folder / "way1")
    os.makedirs(folder / "way1" / steps)
    os.symlink(f"way1/{steps}", folder / "way2")
    return folder / "way2"


class Serves:
    """Outputs of a job: what is listed, and the bytes that come."""

    def __init__(self, *listed: dict, content: bytes = CONTENT, cut: int = 0, submitted_ms: int = 5) -> None:
        self.listed, self.content, self.cut, self.submitted_ms = list(listed), content, cut, submitted_ms

    def __call__(self, request: Request):
        if urlsplit(request.path).path.endswith("/outputs"):
            return ok({"outputs": self.listed, "after": 1, "more": False})
        if urlsplit(request.path).path == "/api/v1/jobs/1":
            return ok({"job": {"id": 1, "submitted_ms": self.submitted_ms}})
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
        wrong = [
            "../up.exr", "/tmp/hyades-absolute", "a/../../up", "..", ".", "", "a/", "a//b", "./a", "a/./b", "a/..",
            ".bashrc", "a/.git/hooks/post-checkout", "-rf", "a/-x", ".hyades/fetched", "a/.hyades/x",
            "json.py", "Makefile", "a/x.exr.sh", "a.EXR.", "a\\..\\b.exr", "\\\\host\\b.exr",
            "a\nb", "a\x1b[2J", "a\u202egpj.exr", "a\u200b", "a\udc80",
        ]  # fmt: skip
        for name in wrong:
            with self.subTest(name), self.assertRaises(hyades.FileRefused):
                self.fetch(Serves(output(name)))
            self.assertEqual(self.everything(), [])
            self.assertEqual(len(self.requests), 1, "no byte of it may be asked for")

    def test_what_jobs_write_is_what_may_come(self) -> None:
        rows = pathlib.Path(__file__).parents[2] / "core/job/read_outputs.cpp"
        formats = re.search(r"kFormats = (.*?)}};", rows.read_text(), re.DOTALL).group(1)
        self.assertEqual(list(names.ENDINGS), re.findall(r'{"(\.\w+)"', formats))
        for ending in (*names.ENDINGS, ".film.exr", ".PNG"):
            names.check_name("a/b.0001" + ending)

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
        # What a fetch has written another one of the same job may replace, unless somebody has changed it.
        self.fetch(Serves(output("mine.exr", b"new"), content=b"new"))
        self.assertEqual(mine.read_bytes(), b"new")
        with self.assertRaises(hyades.FileRefused):
            self.fetch(Serves(output("mine.exr"), submitted_ms=6))
        mine.write_bytes(b"edited")
        with self.assertRaises(hyades.FileRefused):
            self.fetch(Serves(output("mine.exr")))
        self.assertEqual(mine.read_bytes(), b"edited")
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

    def test_folders_that_lead_elsewhere_are_not_written_to(self) -> None:
        home = self.scratch / "home"
        home.mkdir()
        (home / "mine.exr").write_bytes(b"mine")
        (self.folder / ".hyades").mkdir()
        (self.folder / ".hyades/fetched").write_text("pics/mine.exr\n")
        os.symlink(home, self.folder / "pics")
        for overwrite in (False, True):
            with self.assertRaises(hyades.FileRefused):
                self.fetch(Serves(output("pics/mine.exr")), overwrite=overwrite)
        self.assertEqual((home / "mine.exr").read_bytes(), b"mine")
        for planted in ("link", "pipe", "folder"):
            (self.folder / ".hyades/fetched").unlink(missing_ok=True)
            if planted == "link":
                os.symlink(home / "fetched", self.folder / ".hyades/fetched")
            elif planted == "pipe":
                os.mkfifo(self.folder / ".hyades/fetched")
            else:
                (self.folder / ".hyades").rmdir()
                os.symlink(home, self.folder / ".hyades")
            with self.subTest(planted), self.assertRaises(hyades.FileRefused):
                self.fetch(Serves(output("a.exr")))
        self.assertEqual([one.name for one in home.iterdir()], ["mine.exr"])

    def test_folders_too_deep_for_names_are_not_written_to(self) -> None:
        home = self.scratch / "home"
        home.mkdir()
        deep = deep_folder(self.folder)
        os.symlink(home, deep / "pics")
        self.assertTrue(os.path.samefile(deep / "pics", home), "the links do not lead where the test needs them")
        self.folder = deep
        with self.assertRaises(hyades.FileRefused):
            self.fetch(Serves(output("pics/a.exr")))
        os.symlink(home, deep / "assets")
        with self.assertRaises(OSError):
            self.job_with_mesh().write(deep / "robot.yaml")
        self.assertEqual(list(home.iterdir()), [])

    def test_a_pipe_in_the_place_of_a_part_is_refused(self) -> None:
        os.mkfifo(self.folder / f".a.exr.{output('a.exr')['sha256'][:16]}.part")
        with self.assertRaises(hyades.FileRefused):
            self.fetch(Serves(output("a.exr")))

    def job_with_mesh(self) -> hyades.Job:
        job = hyades.Job(name="robot")
        corners = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype="float32")
        job.objects["a"] = hyades.objects.Mesh(mesh=hyades.MeshData(corners, numpy.array([[0, 1, 2]])))
        return job

    def test_a_job_is_written_through_no_link(self) -> None:
        victim = self.scratch / "victim"
        victim.write_bytes(b"dear")
        for pid in (os.getpid(), os.getpid() + 1):
            os.symlink(victim, self.folder / f".robot.yaml.{pid}.part")
        os.symlink(victim, self.folder / "robot.yaml")
        hyades.Job(name="robot").write(self.folder / "robot.yaml")
        self.assertEqual(victim.read_bytes(), b"dear")
        self.assertIn("robot", (self.folder / "robot.yaml").read_text())
        home = self.scratch / "home"
        home.mkdir()
        os.symlink(home, self.folder / "assets")
        with self.assertRaises(OSError):
            self.job_with_mesh().write(self.folder / "robot.yaml")
        self.assertEqual(list(home.iterdir()), [])

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
        pieces = [request for request in self.requests if "/outputs/" in request.path]
        self.assertEqual(pieces[-1].headers["Range"], "bytes=1000-")

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
        answers = [None, (503, {}, b"{}"), ok({"version": "1", "jobs": 5})]
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


class Clock:
    """Time that passes only where somebody waits."""

    def __init__(self) -> None:
        self.now = 0.0

    def monotonic(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


class Coordinators(unittest.TestCase):
    """Several that stand by for one another."""

    INFO = ok({"version": "1", "jobs": 5})
    NOBODY = 503, {"Retry-After": "1"}, json.dumps({"error": {"code": "unavailable", "message": "none leads at the moment", "retry_after_ms": 1000}}).encode()

    def setUp(self) -> None:
        self.clock = Clock()
        patch = mock.patch.object(hyades.farm.http, "time", self.clock)
        patch.start()
        self.addCleanup(patch.stop)

    def leader(self) -> FakeFarm:
        return FakeFarm(self, lambda request: self.INFO)

    def stand_by(self, leader: str) -> FakeFarm:
        return FakeFarm(self, lambda request: (307, {"Location": leader + request.path}, b""))

    def dead(self) -> str:
        """Where connections are refused."""
        with socket.create_server(("127.0.0.1", 0)) as taken:
            return f"127.0.0.1:{taken.getsockname()[1]}"

    def test_the_one_that_leads_is_found_without_a_wait_and_kept(self) -> None:
        leader = self.leader()
        stand_by = self.stand_by(leader.address)
        farm = hyades.Farm(f"{self.dead()}, {stand_by.address},{leader.address}", token="secret", patience=5)
        for _ in range(3):
            self.assertEqual(farm.info()["jobs"], 5)
        self.assertEqual((len(stand_by.requests), len(leader.requests)), (1, 3))
        self.assertEqual(self.clock.now, 0.0)
        self.assertEqual(leader.requests[0].headers["Authorization"], "Bearer secret")
        self.assertEqual((farm.dashboard(), f"http://{farm._http.place}/"), (leader.address + "/",) * 2)

    def test_one_that_does_not_answer_is_passed_over_soon(self) -> None:
        full = socket.create_server(("127.0.0.1", 0), backlog=0)
        self.addCleanup(full.close)
        for _ in range(3):  # who comes after these hears nothing
            waiting = socket.socket()
            waiting.setblocking(False)
            waiting.connect_ex(full.getsockname())
            self.addCleanup(waiting.close)
        address = f"127.0.0.1:{full.getsockname()[1]},{self.leader().address}"
        begin = time.monotonic()
        with mock.patch.object(hyades.farm.http, "_SOON", 0.2):
            self.assertEqual(hyades.Farm(address, patience=5).info()["jobs"], 5)
        self.assertLess(time.monotonic() - begin, 5)

    def test_the_lead_may_pass_to_another_one(self) -> None:
        leads = "a"

        def of(name: str) -> FakeFarm:
            return FakeFarm(self, lambda request: self.INFO if leads == name else (307, {"Location": "http://127.0.0.1:9/"}, b""))

        a, b = of("a"), of("b")
        farm = hyades.Farm(f"{a.address},{b.address}", patience=5)
        for leads in "abba":
            self.assertEqual(farm.info()["jobs"], 5)
        self.assertEqual((len(a.requests), len(b.requests)), (3, 3))
        self.assertEqual(self.clock.now, 0.0)

    def test_a_moment_without_one_that_leads_is_waited_for(self) -> None:
        for nobody in (self.NOBODY, (307, {"Location": "http://127.0.0.1:9/"}, b""), None):
            with self.subTest(nobody):
                answers = [nobody] * 3 + [self.INFO]
                a, b = FakeFarm(self, lambda request: nobody), FakeFarm(self, lambda request: answers.pop(0))
                self.assertEqual(hyades.Farm(f"{a.address},{b.address}", patience=60).info()["jobs"], 5)
                self.assertEqual((len(a.requests), len(b.requests)), (4, 4))
                self.assertGreater(self.clock.now, 2.25 if nobody is self.NOBODY else 0.5)

    def test_patience_has_an_end(self) -> None:
        one, two = (f"http://{self.dead()}" for _ in range(2))
        # Waits double from 0.1 s on, by a quarter more or less.
        for address, patience, least, most in ((one, 300, 1, 3), (f"{one},{two}", 300, 6, 15), (f"{one},{two}", 2, 0.5, 2), (f"{one},{one}/", 300, 1, 3)):
            with self.subTest(address=address, patience=patience):
                self.clock.now = 0.0
                with self.assertRaises(hyades.FarmError) as caught:
                    hyades.Farm(address, patience=patience).info()
                self.assertEqual(caught.exception.code, "unavailable")
                self.assertEqual(str(caught.exception).count("no coordinator answers"), 2 if two in address else 1)
                self.assertTrue(least < self.clock.now < 1.25 * most, self.clock.now)
        # One that has answered may come back.
        answers = [self.INFO]
        gone = FakeFarm(self, lambda request: answers.pop() if answers else None)
        farm = hyades.Farm(f"{gone.address},{one}", patience=100)
        farm.info()
        self.clock.now = 0.0
        with self.assertRaises(hyades.FarmError):
            farm.info()
        self.assertGreater(self.clock.now, 80)

    def test_nobody_is_asked_who_was_not_named(self) -> None:
        stranger = self.leader()
        one, two = self.stand_by(stranger.address), self.stand_by(stranger.address)
        for address, code in ((f"{one.address},{two.address}", "moved"), (f"{one.address},{self.dead()}", "unavailable")):
            with self.assertRaisesRegex(hyades.FarmError, f"{one.address[7:]} stands by, and the one at {stranger.address} leads") as caught:
                hyades.Farm(address, token="secret", patience=5).info()
            self.assertEqual(caught.exception.code, code)
        self.assertEqual(stranger.requests, [])

    def test_what_the_one_that_leads_refuses_is_refused(self) -> None:
        refused = 403, {}, json.dumps({"error": {"code": "permission_denied", "message": "a viewer may not"}}).encode()
        busy = 429, {}, json.dumps({"error": {"code": "resource_exhausted", "message": "too much", "retry_after_ms": 500}}).encode()
        for answer, words, times in ((refused, "^a viewer may not$", 1), (busy, "^too much$", 3)):
            leader = FakeFarm(self, lambda request: answer)
            stand_by = self.stand_by(leader.address)
            with self.assertRaisesRegex(hyades.FarmError, words):
                hyades.Farm(f"{stand_by.address},{leader.address}", patience=2).info()
            self.assertGreaterEqual(len(leader.requests), times)

    def test_a_stand_by_alone_says_at_once_which_one_leads(self) -> None:
        for location, words in (
            ("https://b.example:8080/api/v1/info", "stands by, and the one at https://b.example:8080 leads"),
            ("http://u:p@[::1]/", r"stands by, and the one at http://\[::1\] leads"),
            ("http://b\x1bc.example", r"at http://b\?c.example leads"),
            ("/elsewhere", r"sends elsewhere \(status 307\), which is not followed"),
            ("http://b:x/", "sends elsewhere"),
            ("http://[/", "sends elsewhere"),
        ):
            fake = FakeFarm(self, lambda request: (307, {"Location": location}, b""))
            with self.subTest(location), self.assertRaisesRegex(hyades.FarmError, words) as caught:
                hyades.Farm(fake.address, patience=5).info()
            self.assertEqual((caught.exception.code, len(fake.requests), self.clock.now), ("moved", 1, 0.0))

    def test_each_address_has_to_be_right(self) -> None:
        with self.assertRaisesRegex(ValueError, "farm.example.*insecure=True"):
            hyades.Farm("http://127.0.0.1:8080,http://farm.example:8080", token="secret")
        hyades.Farm("http://127.0.0.1:8080,http://farm.example:8080", insecure=True)
        for address in ("a:1,", ",a:1", "a:1,,b:1", "a:1,ftp://b", "a:1;b:1"):
            with self.subTest(address), self.assertRaisesRegex(ValueError, "expected http"):
                hyades.Farm(address, insecure=True)

    def test_the_environment_names_them_as_it_does_for_workers(self) -> None:
        leader = self.leader()
        port = urlsplit(leader.address).port
        for variables in (
            {"HYADES_COORDINATOR": "127.0.0.2:7700,127.0.0.1:7700"},
            {"HYADES_COORDINATOR": "127.0.0.1:7700"},
            {"HYADES_HTTP": f"{self.dead()},{leader.address}", "HYADES_COORDINATOR": "127.0.0.2:7700"},
        ):
            with self.subTest(variables), mock.patch.dict(os.environ, variables), mock.patch.object(hyades.farm.http, "_DEFAULT_PORT", port):
                self.assertEqual(hyades.Farm(patience=0).info()["jobs"], 5)

    def test_what_one_has_begun_another_one_ends(self) -> None:
        cut = Serves(output("a.exr"), cut=1000)
        taken: list = []  # the lead, once part of the file has come
        job = {"id": 1, "name": "a", "state": "done", "samples": 1, "samples_done": 1}
        event = b"event: end\ndata: " + json.dumps({"job": job, "frames": []}).encode() + b"\n\n"

        def first(request: Request):
            if taken:
                return 307, {"Location": "http://127.0.0.1:9/"}, b""
            if "/outputs/" in request.path:
                taken.append(request)
            return cut(request) if not request.path.endswith("/events") else (200, {}, b"data: 1")

        def second(request: Request):
            return (200, {}, event) if request.path.endswith("/events") else Serves(output("a.exr"))(request)

        a, b = FakeFarm(self, first), FakeFarm(self, second)
        farm = hyades.Farm(f"{a.address},{b.address}", patience=5)
        with tempfile.TemporaryDirectory() as folder:
            (path,) = farm.fetch(1, folder)
            self.assertEqual(path.read_bytes(), CONTENT)
        self.assertEqual([r.headers["Range"] for r in b.requests if "/outputs/" in r.path], ["bytes=1000-"])
        farm = hyades.Farm(f"{a.address},{b.address}", patience=5)
        self.assertEqual([change.job.state for change in farm.watch(1)], ["done"])


class Bounds(unittest.TestCase):
    """Whatever it answers, the memory here is bounded, and what is raised is a FarmError that a terminal can show."""

    def refused(self, answer, call, code: str, words: str) -> None:
        fake = FakeFarm(self, answer if callable(answer) else lambda request: answer)
        with self.assertRaisesRegex(hyades.FarmError, words) as caught:
            call(hyades.Farm(fake.address, patience=2))
        self.assertEqual(caught.exception.code, code)

    def test_answers_have_an_end(self) -> None:
        with mock.patch.object(hyades.farm.http, "MOST_JSON", 1000):
            self.refused((200, {}, b"[" + b" " * 1000), lambda farm: farm.info(), "resource_exhausted", "an answer of more than")

    def test_what_is_no_answer_is_told(self) -> None:
        for body in (b"{", b"[" * 100_000, b"5", b'{"jobs": 5}', b'{"jobs": [5], "next_before": 0}', b'{"jobs": [], "next_before": "1"}',
                     b'{"jobs": [{"id": "x"}], "next_before": 0}'):  # fmt: skip
            with self.subTest(body[:40]):
                self.refused((200, {}, body), lambda farm: list(farm.jobs()), "unknown", "answer")

    def test_whole_numbers_are_those_that_others_can_take(self) -> None:
        """A share of numbers of 400 digits is no float."""
        row = {"id": 1, "name": "a", "state": "running", "samples": 1, "samples_done": (1 << 64) - 1}
        for name, number in (("samples_done", 10**400), ("samples", -(10**400)), ("seconds_left", 10**400), ("noise", -(10**30)), ("seconds_left", float("inf"))):
            with self.subTest(name):
                answer = ok({"jobs": [{**row, name: number}], "next_before": 0})
                self.refused(answer, lambda farm: [job.share for job in farm.jobs()], "unknown", f"has no JobState.*{name}")
        self.assertEqual(read_state(JobState, row).share, 2.0**64)

    def test_lists_that_do_not_go_on_end(self) -> None:
        self.refused(ok({"jobs": [], "next_before": 7}), lambda farm: list(farm.jobs()), "unknown", "does not go on")
        row = {"id": 3, "time_ms": 1, "level": "info", "text": "again"}
        for answer in ({"lines": [row], "more": True}, {"lines": [], "more": True}):
            self.refused(ok(answer), lambda farm: list(farm.logs(1)), "unknown", "does not go on")
        listed = {"outputs": [output("a.png")], "after": 1, "more": True}
        self.refused(ok(listed), lambda farm: list(farm.outputs(1)), "unknown", "does not go on")

    def film(self, width: int, height: int, planes: bytes) -> tuple:
        head = {"width": width, "height": height, "channels": ["R"], "layer": "beauty", "layers": ["beauty"], "samples": 1, "exact": True}
        return 200, {}, json.dumps(head).encode() + b"\n" + planes

    def test_films_take_no_more_than_they_may(self) -> None:
        fake = FakeFarm(self, lambda request: self.film(2, 2, b"\0\0" * 4))
        self.assertEqual(hyades.Farm(fake.address, patience=2).film(1, 1).array.shape, (2, 2))
        small = lambda farm: farm.film(1, 1, most_bytes=1000)
        self.refused(self.film(100, 100, b""), small, "resource_exhausted", "picture of 100 x 100")
        self.refused(self.film(1 << 40, 1 << 40, b""), lambda farm: farm.film(1, 1), "resource_exhausted", "which takes memory")
        for size in (0, -1, "2"):
            self.refused(self.film(size, 2, b"\0" * 8), small, "unknown", "picture|answer")
        self.refused(self.film(2, 2, b"\0" * 6), small, "unknown", "6 bytes of a picture, expected 8")
        self.refused(self.film(2, 2, b"\0" * 10), small, "resource_exhausted", "an answer of more than")

    def test_pictures_take_no_more_than_there_is(self) -> None:
        head = Header.written(["R", "G", "B"], 2, 1 << 14, 1 << 14)
        with mock.patch("hyades.exr.usable_memory", lambda: 1 << 32), self.assertRaisesRegex(ValueError, "6.0 GiB of memory"):
            decode_exr(head + b"\0" * 8 * (1 << 14))

    def test_events_have_an_end(self) -> None:
        with mock.patch.object(hyades.farm.events, "_MOST_EVENT", 1000):
            with self.assertRaisesRegex(hyades.FarmError, "an event of more than 1000 bytes"):
                list(parse_events([b"data: " + b"x" * 600] * 2))
            with self.assertRaisesRegex(hyades.FarmError, "JSON"):
                list(parse_events([b"data: [\n", b"\n"]))

    def test_answers_that_come_drop_by_drop_end(self) -> None:
        sent = []

        def drops():
            for drop in [b" "] * 600:
                time.sleep(0.1)
                sent.append(drop)
                yield drop

        with mock.patch.object(hyades.farm.http, "_LONGEST_CALL", 0.5):
            self.refused(lambda request: (200, {"Content-Length": "600"}, drops()), lambda farm: farm.info(), "unavailable", "answers")
        self.assertLess(len(sent), 600, "all of it was waited for")

    def test_messages_steer_no_terminal(self) -> None:
        said = json.dumps({"error": {"code": "not_\x1b[2Jfound", "message": "no \u202e job\x9b31m\nat all"}}).encode()
        fake = FakeFarm(self, lambda request: (404, {}, said))
        with self.assertRaises(hyades.FarmError) as caught:
            hyades.Farm(fake.address, patience=2).job(1)
        self.assertEqual((str(caught.exception), caught.exception.code), ("no ? job?31m\nat all", "not_?[2Jfound"))


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

    def test_odd_places_in_a_file_are_refused(self) -> None:
        for offset in (-1, 36, 1 << 70, "0", None):
            with self.subTest(offset), self.assertRaisesRegex(hyades.FarmError, "coordinator"):
                self.stored = b""
                self.trouble = [lambda offset=offset: ok({"offset": offset, "complete": False})]
                self.upload()
        with self.assertRaisesRegex(hyades.FarmError, "does not get on with it"):
            self.stored = b""
            self.trouble = [self.stuck] * 9
            self.upload()

    def stuck(self):
        self.stored = b""
        return ok({"offset": 0, "complete": False})


if __name__ == "__main__":
    unittest.main()
