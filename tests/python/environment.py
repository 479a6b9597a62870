"""Where tests find the repository, the package and the programs; ctest says it (tests/CMakeLists.txt)."""

import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = pathlib.Path(os.environ.get("HYADES_PROGRAMS", ROOT / "build/bin"))
PRINT_JOB_KEYS = PROGRAMS / "print-job-keys"
HYADES = PROGRAMS / "hyades"

os.environ["HYADES"] = str(HYADES)
for variable in ("HYADES_HTTP", "HYADES_COORDINATOR", "HYADES_TOKEN_FILE", "HYADES_TLS_CA"):
    os.environ.pop(variable, None)
sys.path.insert(0, str(ROOT / "python"))
sys.dont_write_bytecode = True
