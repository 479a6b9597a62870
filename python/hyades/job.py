"""A job: what to render and how, made of Python objects and arrays."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .checks import are_floats, checked_name
from .described import Described, Key
from .errors import JobError, KeyRefused
from .files import JobFiles, write_whole
from .job_types.job_keys import JobKeys
from .values import Keys
from .yaml_text import Node, YamlText

# Sections of a job that a key may point to: by what the key takes.
_SECTION_OF = {
    "a material's name": "materials",
    "a medium's name": "media",
    "a group's name": "groups",
}
_FILES = ("file", "file or sequence", "files")


@dataclass(kw_only=True, eq=False, repr=False)
class Job(JobKeys):
    """A job as docs/job.md describes it. Its keys are attributes; what is not said has its default.

    Where a key names a material, medium, group or texture, the thing itself may stand as well: it
    gets a name when the job is written.
    """

    def __setattr__(self, key: str, value: Any) -> None:
        if key == "name" and isinstance(value, str):
            try:
                checked_name(value)
            except KeyRefused as error:
                raise KeyRefused(f"Job.name is {value!r}, {error}") from None
        super().__setattr__(key, value)

    def document(self, folder: str | os.PathLike[str] = ".") -> Document:
        """The job as it is written into `folder`. KeyRefused: something that must be said is not."""
        return Document(self, Path(folder))

    def yaml(self) -> str:
        """The text of the job, as write() writes it into the current folder."""
        return str(self.document().text)

    def write(self, path: str | os.PathLike[str]) -> Path:
        """Writes the job to `path`, and what arrays have become to assets/ beside it."""
        target = Path(path)
        return self.document(target.parent).write(target)


class Document:
    """The text of a job, and the files that it brings along."""

    def __init__(self, job: Job, folder: Path) -> None:
        self.job = job
        self.files = JobFiles(folder)
        self._names: dict[int, str] = {}
        self._added: dict[str, dict[str, Any]] = {name: {} for name in ("materials", "media", "groups", "textures")}
        for section in self._added:
            for called, thing in getattr(job, section).items():
                self._names[id(thing)] = called
        root = self._node(job)
        for section, things in self._added.items():
            if things:
                root[section] = {**root.get(section, {}), **things}
        self.text = YamlText(_in_order(root))

    def write(self, target: Path) -> Path:
        self.files.write()
        target.parent.mkdir(parents=True, exist_ok=True)
        write_whole(target, str(self.text).encode())
        return target

    def error(self, text: str) -> JobError:
        """What a reader of this document complained about, with the object that wrote the line."""
        error = JobError(text)
        error.source = self.text.source_of(error.line)
        return error

    def _node(self, thing: Described) -> Node:
        missing = thing.missing()
        if missing:
            raise KeyRefused(f"{thing!r} has no {' and no '.join(missing)}, which must be said")
        node = Node()
        node.source = None if thing is self.job else thing
        is_object = type(thing).__module__.endswith(".objects")
        if thing is self.job:
            node["hyades"] = 1
        elif thing.TYPE and not is_object:
            node["type"] = thing.TYPE
        elif thing.TYPE and thing.TYPE not in thing.keys():
            node["shape"] = thing.TYPE
        for key, value in thing.said():
            node[key.in_job] = self._value(key, value)
        return node

    def _value(self, key: Key, value: Any) -> Any:
        if isinstance(value, Keys):
            return self._animation(value)
        if key.takes in _FILES:
            if key.takes == "files" and isinstance(value, list):
                return [self.files.reference(one) for one in value]
            return self.files.reference(value)
        if isinstance(value, Described):
            return self._described(key, value)
        if isinstance(value, (list, tuple)):
            return value if are_floats(value) else [self._value(key, item) for item in value]
        if isinstance(value, Mapping):
            return Node((entry, self._value(key, item)) for entry, item in value.items())
        return value

    def _animation(self, value: Keys) -> Node:
        node = Node(keys=dict(value.keys))
        if value.ease != "linear":
            node["ease"] = value.ease
        if value.repeat != "none":
            node["repeat"] = value.repeat
        return node

    def _described(self, key: Key, thing: Described) -> Any:
        """In place, or the name of what stands elsewhere in the job."""
        if key.takes == "overrides":
            return self._name_of("materials", thing)
        if key.takes in _SECTION_OF:
            return self._name_of(_SECTION_OF[key.takes], thing)
        is_named = key.takes not in ("entries", "list") and id(thing) in self._names
        return self._names[id(thing)] if is_named else self._node(thing)

    def _name_of(self, section: str, thing: Described) -> str:
        if id(thing) not in self._names:
            taken = {*getattr(self.job, section), *self._added[section]}
            kind = (thing.TYPE or section.rstrip("s")).removeprefix("media") or "medium"
            called = next(n for i in range(1, 1 << 30) if (n := f"{kind}-{i}") not in taken)
            self._names[id(thing)] = called
            self._added[section][called] = Node()  # before it is written: it may name itself
            self._added[section][called] = self._node(thing)
        return self._names[id(thing)]


def _in_order(root: Node) -> Node:
    """Sections as people expect them: what the job is, how it is rendered, the scene, what is written."""
    order = ["hyades", *JobKeys.keys()]
    ordered = Node((name, root[name]) for name in order if name in root)
    ordered.source = root.source
    return ordered
