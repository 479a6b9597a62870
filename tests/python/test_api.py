"""What the farm's classes know is what the description of the HTTP API says, and the other way round."""

import dataclasses
import pathlib
import re
import unittest

from environment import ROOT

from hyades import Farm
from hyades.farm import states

try:
    import yaml
except ImportError:
    raise unittest.SkipTest("python3-yaml is not here") from None

API = yaml.safe_load((ROOT / "coordinator/web/api/openapi.yaml").read_text())
CLASSES = {
    "Job": states.JobState,
    "Frame": states.FrameState,
    "Worker": states.WorkerState,
    "Output": states.OutputFile,
    "LogLine": states.LogLine,
}


class Api(unittest.TestCase):
    def test_states_have_the_fields_of_the_api(self) -> None:
        for name, described in CLASSES.items():
            schema = API["components"]["schemas"][name]
            fields = {field.name: field for field in dataclasses.fields(described)}
            self.assertEqual(set(fields), set(schema["properties"]), name)
            optional = {key for key, field in fields.items() if field.default is None}
            self.assertEqual(optional, set(schema["properties"]) - set(schema["required"]), name)

    def test_every_call_is_one_of_the_api(self) -> None:
        known = [re.sub(r"\{\w+\}", "X", path) for path in API["paths"]]
        source = "".join(path.read_text() for path in pathlib.Path(states.__file__).parent.glob("*.py"))
        called = set(re.findall(r'"(/api/v1/[^"]+)"', source)) | {
            "/api/v1/jobs/{job}/" + below for below in re.findall(r'_path\(job, f?"([\w/{}()]+)"', source)
        }
        self.assertGreater(len(called), 12)
        for path in called:
            self.assertIn(re.sub(r"\{[^}]+\}", "X", path), known)

    def test_pages_of_the_dashboard_are_those_of_its_router(self) -> None:
        router = (ROOT / "coordinator/web/dashboard/router.js").read_text()
        self.assertIn("path = `#/jobs/${job}", router)
        self.assertEqual(Farm("127.0.0.1:8080").dashboard(12), "http://127.0.0.1:8080/#/jobs/12")
        self.assertEqual(Farm("http://[::1]:81").dashboard(), "http://[::1]:81/")


if __name__ == "__main__":
    unittest.main()
