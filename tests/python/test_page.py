"""The examples of docs/python.md, as they stand there; and what the page says that there is."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from environment import HYADES, PROGRAMS, ROOT
from farm_process import FarmProcess

import hyades

PAGE = (ROOT / "docs/python.md").read_text()
SCRIPTS = dict(re.findall(r"```python\n# (\w+\.py)\n(.*?)```", PAGE, re.DOTALL))


class Examples(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_script(self, name: str, *arguments: str) -> str:
        path = self.folder / name
        path.write_text(SCRIPTS[name])
        where = {**os.environ, "PYTHONPATH": str(ROOT / "python"), "HYADES": str(HYADES), "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run([sys.executable, path, *arguments], cwd=self.folder, env=where, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_there_are_three(self) -> None:
        self.assertEqual(sorted(SCRIPTS), ["media_sweep.py", "two_farms.py", "waves.py"])

    def test_a_sweep_over_measured_media(self) -> None:
        said = [line.split() for line in self.run_script("media_sweep.py").splitlines()]
        light = {row[0]: sum(map(float, row[1:])) for row in said}
        self.assertEqual(len(light), 5)
        self.assertGreater(light["whole-milk"], light["apple-juice"])
        self.assertGreater(light["apple-juice"], light["espresso"])
        self.assertEqual(hyades.Picture.read(self.folder / "sweep.png").array.shape, (64, 320, 3))

    def test_a_procedural_animation(self) -> None:
        said = self.run_script("waves.py")
        self.assertIn("4 waves/waves.0004.png", said)
        pictures = [hyades.Picture.read(self.folder / f"waves/waves.000{n}.png").array for n in (1, 2)]
        self.assertGreater(abs(pictures[0].astype(int) - pictures[1]).max(), 20)

    def test_the_beginning(self) -> None:
        SCRIPTS["beginning.py"] = re.search(r"```python\n(import hyades.*?)```", PAGE, re.DOTALL)[1]
        self.addCleanup(SCRIPTS.pop, "beginning.py")
        self.run_script("beginning.py")
        self.assertTrue((self.folder / "out/ball.png").exists())

    @unittest.skipUnless((PROGRAMS / "hyades-coordinator").exists(), "built without the farm")
    def test_what_differs_between_two_farms(self) -> None:
        farms = [FarmProcess(self, self.folder / name) for name in ("old", "new")]
        for farm in farms:
            farm.worker()
        said = self.run_script("two_farms.py", *(farm.address for farm in farms)).splitlines()
        self.assertEqual(len(said), 3)
        for line in said:
            self.assertIn("differs by at most 0, by 0 in the mean", line)


class Page(unittest.TestCase):
    def test_every_class_that_it_names_is_there(self) -> None:
        table = re.findall(r"^\| `(hyades[.\w]*)` \| (.*) \|$", PAGE, re.MULTILINE)
        self.assertEqual(len(table), 9)
        for module, classes in table:
            place = hyades if module == "hyades" else getattr(hyades, module.partition(".")[2])
            for name in re.findall(r"`(\w+)`", classes):
                self.assertTrue(hasattr(place, name), f"{module}.{name}")


if __name__ == "__main__":
    unittest.main()
