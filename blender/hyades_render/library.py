"""Makes the package `hyades` importable: from vendor/ in an installed add-on, from python/ in the repository."""

import pathlib
import sys

_HERE = pathlib.Path(__file__).resolve().parent


def find() -> pathlib.Path:
    """The folder that holds the package `hyades`. ImportError where neither place has it."""
    for folder in (_HERE / "vendor", _HERE.parents[1] / "python"):
        if (folder / "hyades" / "__init__.py").exists():
            return folder
    raise ImportError(f"the package hyades is neither in {_HERE / 'vendor'} nor in {_HERE.parents[1] / 'python'}")


_folder = str(find())
if _folder not in sys.path:
    sys.path.append(_folder)
