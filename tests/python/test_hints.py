"""mypy accepts the package's hints, and they refuse what jobs would."""

import re
import shutil
import subprocess
import tempfile
import unittest

from environment import ROOT

MYPY = "/usr/bin/mypy" if shutil.which("/usr/bin/mypy") else shutil.which("mypy")

RIGHT = """
import hyades
from hyades import materials, objects, media, textures
job = hyades.Job(name="a", film=hyades.Film(size=(4, 4)), frames=range(1, 3))
job.objects["a"] = objects.Sphere(radius="= t", material=materials.Lambert(color=[1, 0.5, "= t"]))
job.objects["b"] = objects.Box(interior=media.Medium(preset="cream"), at=hyades.Keys({1: [0, 0, 0]}))
job.materials["m"] = materials.Principled(base_color=textures.Checker(scale=[2, 2]), roughness=0.5)
picture = hyades.render(job, "out", frames=1).picture()
farm = hyades.Farm()
for change in farm.watch(farm.submit(job)):
    print(change.job.share + 1, change.frames[0].state.upper())
"""
WRONG = {
    'hyades.Film(siez=(4, 4))': "siez",
    'hyades.Film(size="large")': "arg-type",
    'materials.Lambert(sides="back")': "arg-type",
    'hyades.Job(film=hyades.Sampling())': "arg-type",
    'hyades.Sampling(samples="many")': "arg-type",
}


@unittest.skipIf(MYPY is None, "mypy is not here")
class Hints(unittest.TestCase):
    def mypy(self, *what: str) -> str:
        run = subprocess.run(
            [str(MYPY), "--strict", "--cache-dir", self.cache, *what], cwd=ROOT / "python", capture_output=True, text=True
        )
        return run.stdout + run.stderr

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.cache = folder.name

    def test_the_package_and_who_uses_it(self) -> None:
        self.assertIn("Success", self.mypy("hyades"))
        self.assertIn("Success", self.mypy("-c", RIGHT))
        head = "import hyades\nfrom hyades import materials\n"
        said = self.mypy("-c", head + "\n".join(WRONG))
        self.assertIn(f"Found {len(WRONG)} errors", said)
        errors = [line for line in said.splitlines() if " error: " in line]
        for line, expected in zip(errors, WRONG.values(), strict=True):
            self.assertIn(expected, line)

    def test_the_examples_of_the_page(self) -> None:
        examples = re.findall(r"```python\n(.*?)```", (ROOT / "docs/python.md").read_text(), re.DOTALL)
        self.assertEqual(len(examples), 4)
        for example in examples:
            self.assertIn("Success", self.mypy("-c", example))


if __name__ == "__main__":
    unittest.main()
