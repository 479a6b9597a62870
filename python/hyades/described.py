"""How the classes of a job hold their keys: what was said, and what holds where nothing was."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, ClassVar

from .checks import Entries, checked
from .errors import KeyRefused
from .words import documented

_UNSET: Any = type("Unset", (), {"__repr__": lambda self: "(not said)"})()
_COLLECTIONS = ("entries", "list")
_ENOUGH = ("like", "quaternion")  # beside them nothing else has to be said


@dataclass
class Key:
    """A key of a job as a class has it: a descriptor that checks what it is given.

    Reading a key that was not said gives its default. Only what was said is written to the job, so
    that a default which was said stands there too (`like` needs the difference).
    """

    takes: str
    default: Any = None
    low: float | None = None
    high: float | None = None
    above: bool = False  # low itself is refused
    below: bool = False  # high itself is refused
    names: tuple[Any, ...] = ()
    required: bool = False
    name: str = field(default="", init=False)
    owner: str = field(default="", init=False)
    hint: str = field(default="", init=False)
    """The type that the class says."""

    @property
    def in_job(self) -> str:
        """What the job calls it: without the underscore after words of Python's own."""
        return self.name.removesuffix("_")

    def __set_name__(self, owner: type, name: str) -> None:
        self.name, self.owner, self.hint = name, owner.__name__, str(vars(owner).get("__annotations__", {}).get(name, ""))

    def __get__(self, instance: Any, owner: type | None = None) -> Any:
        if instance is None:
            return _UNSET
        said = instance.__dict__
        if self.name not in said and self.takes in _COLLECTIONS:
            said[self.name] = Entries(self) if self.takes == "entries" else []
        if self.name not in said and self.required:
            raise AttributeError(f"{type(instance).__name__}.{self.name} has not been said")
        return said.get(self.name, self.default)

    def take(self, instance: Any, value: Any) -> None:
        """Keeps what `instance` says; KeyRefused: the key takes no such value."""
        try:
            instance.__dict__[self.name] = checked(self, value)
        except KeyRefused as error:
            raise KeyRefused(f"{type(instance).__name__}.{self.name} is {value!r}, {error}") from None


def key(takes: str, default: Any = None, **facts: Any) -> Any:
    """A key, for the body of a class: see Key."""
    return Key(takes, default, **facts)


class _Documented(type):
    """The class of classes whose documentation tells of their keys, too."""

    @property
    def __doc__(cls) -> str:  # type: ignore[override]
        own = [base for base in cls.__mro__ if isinstance(base, _Documented)]
        texts = (documented(b.__module__, b.__name__, [n for n, k in vars(b).items() if isinstance(k, Key)]) for b in own[:-1])
        return "\n\n".join(filter(None, texts)) or str(vars(cls).get("__doc__") or "")


class Described(metaclass=_Documented):
    """What a job describes by keys. A key that is None, or was not said, is not written."""

    TYPE: ClassVar[str] = ""
    """What the job calls this kind; empty: its keys tell."""
    SECTIONS: ClassVar[tuple[str, ...]] = ()
    """Where docs/job.md describes its keys."""

    _KEYS: ClassVar[dict[str, Key]] = {}

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        own = {name: k for name, k in vars(cls).items() if isinstance(k, Key)}
        cls._KEYS = {**cls._KEYS, **own}

    @classmethod
    def keys(cls) -> dict[str, Key]:
        """All keys by name, those of base classes first."""
        return cls._KEYS

    def said(self) -> Iterator[tuple[Key, Any]]:
        """The keys that were said, with their values."""
        for name, described in self.keys().items():
            value = self.__dict__.get(name)
            if value is not None and not (described.takes in _COLLECTIONS and not value):
                yield described, value

    def missing(self) -> list[str]:
        """Keys that must be there, and are not; none where `like` brings others' keys, or one key says it all."""
        if any(self.__dict__.get(name) is not None for name in _ENOUGH):
            return []
        return [n for n, k in self.keys().items() if k.required and n not in self.__dict__]

    def __setattr__(self, name: str, value: Any) -> None:
        known = self._KEYS
        described = known.get(name)
        if described is None:
            close = difflib.get_close_matches(name, known, 1)
            hint = f"; did you mean '{close[0]}'?" if close else f"; it has {', '.join(known)}"
            raise AttributeError(f"{type(self).__name__} has no key '{name}'{hint}")
        if value is None or value is _UNSET:
            self.__dict__.pop(name, None)
        else:
            described.take(self, value)

    def __repr__(self) -> str:
        said = ", ".join(f"{k.name}={value!r}" for k, value in self.said())
        return f"{type(self).__name__}({said})"
