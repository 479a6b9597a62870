"""Plain data as YAML that people can read: blocks, with short lists and maps on one line."""

from __future__ import annotations

import json
import re
from typing import Any

from .checks import are_floats

_WIDTH = 100
MADE_HERE = "# Made by hyades for Python."
_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_./-]*")
_OTHER_THAN_TEXT = {"null", "true", "false", "yes", "no", "on", "off", "y", "n"}


class Node(dict[Any, Any]):
    """A map, and what it was made of."""

    source: Any = None


def scalar(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(float(value)) if isinstance(value, float) else repr(value)  # numpy's are floats, too
    if _PLAIN.fullmatch(value) and value.lower() not in _OTHER_THAN_TEXT:
        return str(value)
    return json.dumps(value, ensure_ascii=False)


def flow(value: Any) -> str:
    """On one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{scalar(k)}: {flow(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(repr if are_floats(value) else flow, value)) + "]"
    return scalar(value)


def _may_be_short(value: Any) -> bool:
    """False where it cannot stand on one line: writing it down to see that would take long for large values."""
    left = _WIDTH
    heap = [value]
    while heap:
        one = heap.pop()
        left -= 2
        if left < 0:
            return _is_matrix(value)
        if isinstance(one, dict):
            heap.extend(one.values())
        elif isinstance(one, (list, tuple)):
            if are_floats(one):
                left -= 2 * len(one)
            else:
                heap.extend(one)
    return left >= 0 or _is_matrix(value)


def _is_matrix(value: Any) -> bool:
    """16 numbers stay on one line, however long."""
    return isinstance(value, (list, tuple)) and len(value) == 16 and all(isinstance(x, (int, float)) for x in value)


class YamlText:
    """A document that is written line by line; `sources` are what its lines were made of."""

    def __init__(self, document: Node) -> None:
        self.lines = [MADE_HERE]
        self.sources: dict[int, Any] = {}
        for name, value in document.items():
            self._add(f"{scalar(name)}:", value, 0, top=True)

    def __str__(self) -> str:
        return "\n".join(self.lines) + "\n"

    def source_of(self, line: int) -> Any:
        """What wrote a line, or the nearest line before that something wrote; None where nothing did."""
        before = [number for number in self.sources if number <= line]
        return self.sources[max(before)] if before else None

    def _line(self, text: str, value: Any) -> None:
        self.lines.append(text)
        source = getattr(value, "source", None)
        if source is not None:
            self.sources[len(self.lines)] = source

    def _add(self, start: str, value: Any, depth: int, top: bool = False) -> None:
        """`value` behind `start`, which stands `depth` steps from the margin."""
        is_section = top and isinstance(value, dict) and any(isinstance(v, dict) for v in value.values())
        if not is_section and _may_be_short(value):
            line = "  " * depth + start + " " + flow(value)
            if not isinstance(value, (dict, list)) or not value or len(line) <= _WIDTH or _is_matrix(value):
                self._line(line, value)
                return
        self._line("  " * depth + start, value)
        if isinstance(value, dict):
            for name, item in value.items():
                self._add(f"{scalar(name)}:", item, depth + 1)
        else:
            for item in value:
                self._add_item(item, depth + 1)

    def _add_item(self, item: Any, depth: int) -> None:
        line = "  " * depth + "- " + flow(item)
        if not isinstance(item, dict) or len(line) <= _WIDTH or (len(item) == 1 and _is_matrix(*item.values())):
            self._line(line, item)
            return
        for place, (name, value) in enumerate(item.items()):
            begin = len(self.lines)
            self._add(f"{scalar(name)}:", value, depth + 1)
            if place == 0:
                first = self.lines[begin]
                self.lines[begin] = "  " * depth + "- " + first.lstrip()
                self.sources.setdefault(begin + 1, getattr(item, "source", None))
