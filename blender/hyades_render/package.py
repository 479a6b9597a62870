"""Where the Python package `hyades` is that the add-on stands on."""

import importlib.util
import sys
from pathlib import Path

_HERE = Path(__file__).resolve().parent


def find_hyades() -> None:
    """Makes `import hyades` work: the package that the zip brought along, that of the source tree, or one
    that Python finds by itself, in this order. ImportError where there is none, or no numpy."""
    for folder in (_HERE / "vendor", _HERE.parents[1] / "python"):
        if (folder / "hyades" / "__init__.py").is_file():
            if str(folder) not in sys.path:
                sys.path.insert(0, str(folder))
            break
    if importlib.util.find_spec("numpy") is None:
        raise ImportError("Hyades needs numpy in Blender's Python (Debian: apt install python3-numpy)")
    if importlib.util.find_spec("hyades") is None:
        raise ImportError("Hyades' Python package is not there: install the add-on from its zip")
