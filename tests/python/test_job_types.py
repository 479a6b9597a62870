"""Holds the classes of jobs against the reader's list of keys and against docs/job.md."""

import importlib
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from environment import PRINT_JOB_KEYS, ROOT

sys.path.insert(0, str(ROOT / "python/generator"))
import job_page  # noqa: E402
from hyades.described import Described  # noqa: E402

MODULES = [path.stem for path in (ROOT / "python/hyades/job_types").glob("[a-z]*.py")]
# What Python has in another way than by a key: the class tells it, or it is always the same.
OTHERWISE = {("job", "hyades"), ("objects", "shape")} | {
    (family, "type") for family in ("integrator", "camera", "textures", "materials", "lights")
}


def all_classes() -> list:
    found = []
    for name in MODULES:
        module = importlib.import_module(f"hyades.job_types.{name}")
        found += [c for c in vars(module).values() if isinstance(c, type) and c.__module__ == module.__name__]
    return [c for c in found if issubclass(c, Described)]


def keys_of_classes() -> set:
    """Section and key of all that classes have; a key belongs to the section that documents it."""
    page = job_page.read(ROOT / "docs/job.md")
    found = set()
    for described in all_classes():
        for base in described.__mro__:
            sections = vars(base).get("SECTIONS", ())
            for name in (key.in_job for key in described.keys().values()):
                found |= {(section, name) for section in sections if (section, name) in page.rows}
    return found


class Generated(unittest.TestCase):
    def test_the_checked_in_classes_are_those_that_the_generator_makes(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, ROOT / "python/generator/generate", PRINT_JOB_KEYS, folder], check=True)
            made = {path.name: path.read_text() for path in pathlib.Path(folder).iterdir()}
        there = {path.name: path.read_text() for path in (ROOT / "python/hyades/job_types").glob("*.py")}
        self.assertEqual(made.keys(), there.keys())
        for name, text in made.items():
            self.assertEqual(text, there[name], f"run python/generator/generate {PRINT_JOB_KEYS}")


class Documented(unittest.TestCase):
    def setUp(self) -> None:
        self.page = job_page.read(ROOT / "docs/job.md")
        listed = subprocess.run([PRINT_JOB_KEYS], check=True, capture_output=True).stdout
        self.listed = json.loads(listed)

    def test_every_documented_key_is_one_of_a_class(self) -> None:
        animation = {("animation", key) for key in ("keys", "ease", "repeat")}  # hyades.Keys
        # What is written in place of a group is a Group, described in section groups.
        wanted = self.page.rows.keys() - animation - OTHERWISE - {("objects.group", "objects")}
        self.assertEqual(sorted(wanted - keys_of_classes()), [])

    def test_every_key_of_a_class_is_documented(self) -> None:
        for described in all_classes():
            for name in (key.in_job for key in described.keys().values()):
                sections = [s for base in described.__mro__ for s in vars(base).get("SECTIONS", ())]
                where = [section for section in sections if (section, name) in self.page.rows]
                self.assertTrue(where, f"{described.__name__}.{name} is not in docs/job.md")

    def test_every_type_has_a_class(self) -> None:
        types = {c.TYPE for c in all_classes()}
        for entry in self.listed:
            if entry["key"] in ("type", "shape") and (entry["section"], entry["key"]) in OTHERWISE:
                self.assertEqual(set(entry["names"]) - types, set(), entry["section"])

    def test_defaults_are_those_of_the_page(self) -> None:
        compared = 0
        for entry in self.listed:
            said = job_page.quoted_default(self.page.rows[entry["section"], entry["key"]])
            by_class = (entry["section"], entry["key"]) in OTHERWISE or entry["takes"].endswith("map")
            if said is None or by_class:
                continue
            if entry["key"] == "radius" and entry["section"] == "film.filter":
                said = "1.5"  # of the default type
            self.assertEqual(normal(entry.get("default")), normal(said), f"{entry['section']}.{entry['key']}")
            compared += 1
        self.assertGreater(compared, 300)

    def test_keys_of_an_animation_are_those_of_the_page(self) -> None:
        from hyades import Keys

        documented = {key for section, key in self.page.rows if section == "animation"}
        self.assertEqual(documented, set(Keys.__dataclass_fields__))
        for entry in self.listed:
            if entry["section"] == "animation" and "names" in entry:
                hint = Keys.__annotations__[entry["key"]]
                self.assertEqual(hint, "Literal[" + ", ".join(map(repr, entry["names"])) + "]")


def normal(value) -> object:
    """A default as both sides can be compared: numbers of YAML, vectors whose parts are equal as one."""
    if isinstance(value, str):
        try:
            value = json.loads(value.replace("beauty, alpha", '"beauty", "alpha"'))
        except ValueError:
            return value.strip('"')
    if isinstance(value, list) and len(set(map(str, value))) == 1:
        value = value[0]
    return [float(v) if isinstance(v, int) else v for v in value] if isinstance(value, list) else value


if __name__ == "__main__":
    unittest.main()
