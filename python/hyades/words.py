"""What the classes of jobs say of their keys, for help(): the texts below the keys in their source."""

from __future__ import annotations

import ast
import importlib.util
from functools import cache
from textwrap import indent

_Texts = dict[str, tuple[str, dict[str, str]]]


def documented(module: str, name: str, keys: list[str]) -> str:
    """The documentation of a class of this module, with that of its keys as far as the source is there."""
    own, of_keys = _texts_of(module).get(name, ("", {}))
    lines = [f"{key}:\n{indent(of_keys[key], '    ')}" for key in keys if key in of_keys]
    return "\n\n".join(filter(None, [own, *lines]))


@cache
def _texts_of(module: str) -> _Texts:
    """By class: its own text, and those of its keys."""
    spec = importlib.util.find_spec(module)
    source = getattr(spec.loader, "get_source", lambda _: None)(module) if spec else None
    found: _Texts = {}
    for node in ast.parse(source or "").body:
        if isinstance(node, ast.ClassDef):
            found[node.name] = ast.get_docstring(node) or "", dict(_of_keys(node))
    return found


def _of_keys(node: ast.ClassDef) -> list[tuple[str, str]]:
    found = []
    for key, text in zip(node.body, node.body[1:]):
        if isinstance(key, ast.AnnAssign) and isinstance(key.target, ast.Name) and isinstance(text, ast.Expr):
            if isinstance(text.value, ast.Constant) and isinstance(text.value.value, str):
                found.append((key.target.id, "\n".join(line.strip() for line in text.value.value.splitlines())))
    return found
