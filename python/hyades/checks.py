"""Whether a value is one that a key takes. What only a whole job shows is left to its reader."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from .errors import KeyRefused
from .values import Keys

if TYPE_CHECKING:
    from .described import Key

_COLOR = re.compile(r"#(?:[0-9a-fA-F]{3}|[0-9a-fA-F]{6})|\d+(\.\d*)?K")
_FRAMES = re.compile(r"\d+(-\d+(x\d+)?)?")
_NAME = re.compile(r"[A-Za-z0-9_\u0080-\U0010ffff]([-A-Za-z0-9_. \u0080-\U0010ffff]*[-A-Za-z0-9_.\u0080-\U0010ffff])?")
_COUNTED = re.compile(r"(\d+) (whole )?numbers")


def refuse(expected: str) -> KeyRefused:
    return KeyRefused(f"expected {expected}")


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def is_expression(value: Any) -> bool:
    return isinstance(value, str) and value.startswith("=")


def checked_name(value: Any) -> str:
    """`value`, where a job may call something so; KeyRefused: it may not. Names become those of files."""
    if not isinstance(value, str) or not _NAME.fullmatch(value) or len(value.encode("utf-8", "surrogatepass")) > 100:
        letters = "letters, digits, _, -, . and inner spaces, beginning with a letter, digit or _"
        raise refuse(f"a name of 1 to 100 bytes: {letters}")
    return value


def plain(value: Any) -> Any:
    """Arrays and numbers of numpy as lists and numbers of Python; all else as it is."""
    return value.tolist() if hasattr(value, "tolist") else value


def range_in_words(key: Key) -> str:
    low = "" if key.low is None else f"{'above' if key.above else 'from'} {key.low:g}"
    high = "" if key.high is None else f"{'below' if key.below else 'up to'} {key.high:g}"
    return " ".join(part for part in (" a number", low, high) if part).strip()


def number(key: Key, value: Any) -> Any:
    if is_number(value):
        low, high = key.low, key.high
        too_low = low is not None and (value < low or (key.above and value == low))
        too_high = high is not None and (value > high or (key.below and value == high))
        if not too_low and not too_high:
            return value
    raise refuse(range_in_words(key))


def whole(key: Key, value: Any) -> Any:
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    if not isinstance(value, int):
        raise refuse("a whole number, " + range_in_words(key))
    return number(key, value)


def component(key: Key, value: Any) -> Any:
    return value if is_expression(value) else number(key, value)


def are_floats(values: Sequence[Any]) -> bool:
    """Whether all are plain floats: asked at once, for the numbers of large scenes."""
    return set(map(type, values)) == {float}


def several(count: int, one: Callable[[Key, Any], Any] = component) -> Callable[[Key, Any], Any]:
    def check(key: Key, value: Any) -> Any:
        if not isinstance(value, Sequence) or isinstance(value, str) or len(value) != count:
            raise refuse(f"{count} numbers")
        # Large scenes have a matrix for each of their objects.
        if one is not whole and key.low is None and key.high is None:
            if are_floats(value) and all(map(math.isfinite, value)):
                return list(value)
        return [one(key, item) for item in value]

    return check


def animated(one: Callable[[Key, Any], Any]) -> Callable[[Key, Any], Any]:
    def check(key: Key, value: Any) -> Any:
        if not isinstance(value, Keys):
            return one(key, value)
        if not value.keys:
            raise refuse("at least one key")
        return Keys({f: one(key, plain(v)) for f, v in value.keys.items()}, value.ease, value.repeat)

    return check


def scale(key: Key, value: Any) -> Any:
    if isinstance(value, (list, tuple)):
        return several(2 if len(value) == 2 else 3)(key, value)
    return component(key, value)


def color(key: Key, value: Any) -> Any:
    if isinstance(value, str) and _COLOR.fullmatch(value):
        return value
    if isinstance(value, (list, tuple)):
        return several(3)(key, value)
    return component(key, value)


def described(*modules: str) -> Callable[[Key, Any], Any]:
    """Something that a class of these modules describes, or the name of one."""

    def check(key: Key, value: Any) -> Any:
        if isinstance(value, str) and value:
            return value
        if type(value).__module__.rpartition(".")[2] in modules and hasattr(value, "said"):
            return value
        raise refuse(f"a name, or one of hyades.{modules[0]}")

    return check


def or_texture(plain_check: Callable[[Key, Any], Any]) -> Callable[[Key, Any], Any]:
    def check(key: Key, value: Any) -> Any:
        is_name = isinstance(value, str) and not value.startswith(("=", "#"))
        if (is_name and not _COLOR.fullmatch(value)) or hasattr(value, "said"):
            return described("textures")(key, value)
        return plain_check(key, value)

    return check


def choice(key: Key, value: Any) -> Any:
    if value in key.names and type(value) in {type(name) for name in key.names}:
        return value
    raise refuse("one of " + ", ".join(repr(name) for name in key.names))


def one_or_two_choices(key: Key, value: Any) -> Any:
    if isinstance(value, (list, tuple)) and len(value) == 2:
        return [choice(key, item) for item in value]
    return choice(key, value)


def of_type(kind: type, words: str) -> Callable[[Key, Any], Any]:
    def check(key: Key, value: Any) -> Any:
        if isinstance(value, kind):
            return value
        raise refuse(words)

    return check


@cache
def _classes_in(hint: str) -> frozenset[str]:
    return frozenset(re.findall(r"[A-Z]\w+", hint)) - {"None", "Any", "Mapping", "Sequence", "Color", "FrameRange"}


def map_of_keys(key: Key, value: Any) -> Any:
    """Something of a class that the key's hint names."""
    wanted = _classes_in(key.hint)
    if hasattr(value, "said") and any(one.__name__ in wanted for one in type(value).__mro__):
        return value
    raise refuse(f"one of class {' or '.join(sorted(wanted))}")


def or_map(plain_check: Callable[[Key, Any], Any]) -> Callable[[Key, Any], Any]:
    return lambda key, value: (map_of_keys if hasattr(value, "said") else plain_check)(key, value)


def list_of(kind: Callable[[Key, Any], Any]) -> Callable[[Key, Any], Any]:
    def check(key: Key, value: Any) -> Any:
        if isinstance(value, str) or not isinstance(value, Sequence):
            raise refuse("a list")
        return [kind(key, item) for item in value]

    return check


class Entries(dict[str, Any]):
    """Things of a job by name, which checks what it is given as keys do."""

    _key: Key | None = None

    def __init__(self, key: Key | None = None, values: Mapping[str, Any] | None = None) -> None:
        super().__init__()
        self._key = key
        self.update(values or {})

    def __setitem__(self, name: str, value: Any) -> None:
        if self._key is not None:
            try:
                checked_name(name)
            except KeyRefused as error:
                raise KeyRefused(f"{self._key.name} has {name!r}, {error}") from None
            try:
                map_of_keys(self._key, value)
            except KeyRefused as error:
                raise KeyRefused(f"{self._key.owner}.{self._key.name}[{name!r}] is {value!r}, {error}") from None
        super().__setitem__(name, value)

    def update(self, *values: Any, **named: Any) -> None:
        for name, value in dict(*values, **named).items():
            self[name] = value

    def setdefault(self, name: str, default: Any = None) -> Any:
        if name not in self:
            self[name] = default
        return self[name]

    def __ior__(self, values: Any) -> Entries:  # type: ignore[override,misc]
        self.update(values)
        return self


def entries(key: Key, value: Any) -> Any:
    if isinstance(value, Mapping):
        return Entries(key, value)
    raise refuse("a dict of names")


def overrides(key: Key, value: Any) -> Any:
    if isinstance(value, Mapping) and all(isinstance(name, str) for name in value):
        return value
    raise refuse("a dict of names")


def stops(key: Key, value: Any) -> Any:
    if not isinstance(value, Mapping) or len(value) < 2 or not all(map(is_number, value)):
        raise refuse("two or more numbers with their colours, such as {0: 0.1, 1: '#fd8'}")
    return {at: or_texture(color)(key, plain(v)) for at, v in value.items()}


def frames(key: Key, value: Any) -> Any:
    if isinstance(value, range) and value.start >= 0 and value.step > 0 and len(value) > 0:
        step = f"x{value.step}" if value.step > 1 else ""
        return f"{value[0]}-{value[-1]}{step}"
    if _FRAMES.fullmatch(str(value)) and not isinstance(value, bool):
        return str(value)
    raise refuse("a frame or range such as 7, '1-120', '1-120x2' or range(1, 121)")


def units(key: Key, value: Any) -> Any:
    return value if value in key.names else number(key, value)


def file(key: Key, value: Any) -> Any:
    is_array = hasattr(value, "dtype") and hasattr(value, "ndim")
    if is_array and key.name == "curves":
        raise refuse("hyades.Strands(points, widths) or a path")
    if isinstance(value, (str, os.PathLike)) or is_array or hasattr(value, "encode"):
        return value
    raise refuse("a path, an array of numpy, a MeshData, Places, Strands or Picture")


def file_or_sequence(key: Key, value: Any) -> Any:
    if isinstance(value, Mapping) and value and all(isinstance(frame, int) for frame in value):
        if len({isinstance(one, (str, os.PathLike)) for one in value.values()}) > 1:
            raise refuse("paths for all frames, or what is written for all of them")
        return {frame: file(key, one) for frame, one in value.items()}
    return file(key, value)


def files(key: Key, value: Any) -> Any:
    return list_of(file)(key, value) if isinstance(value, (list, tuple)) else file(key, value)


text = of_type(str, "a text")

_CHECKS: dict[str, Callable[[Key, Any], Any]] = {
    "number": number,
    "whole number": whole,
    "switch": of_type(bool, "True or False"),
    "text": text,
    "texts": list_of(text),
    "choice": choice,
    "one or two choices": one_or_two_choices,
    "number, animated": animated(component),
    "pair, animated": animated(several(2)),
    "vector, animated": animated(several(3)),
    "quaternion": animated(several(4)),
    "scale, animated": animated(scale),
    "colour, animated": animated(color),
    "colour or texture": or_texture(animated(color)),
    "number or texture": or_texture(animated(component)),
    "colour or map": or_map(animated(color)),
    "type or map": or_map(choice),
    "map": map_of_keys,
    "texture": described("textures"),
    "a material's name": described("materials"),
    "a medium's name": described("media"),
    "a group's name": described("objects"),
    "an object's name": text,
    "list of steps": list_of(map_of_keys),
    "list": list_of(map_of_keys),
    "entries": entries,
    "overrides": overrides,
    "stops": stops,
    "frames": frames,
    "frames or map": or_map(frames),
    "units": units,
    "file": file,
    "files": files,
    "file or sequence": file_or_sequence,
}


def focus(key: Key, value: Any) -> Any:
    is_name = isinstance(value, str) and not is_expression(value)
    return value if is_name else animated(component)(key, value)


_CHECKS["number, animated, or an object's name"] = focus


@cache
def _check(takes: str) -> Callable[[Key, Any], Any]:
    counted = _COUNTED.fullmatch(takes)
    if counted is None:
        return _CHECKS[takes]
    return several(int(counted[1]), whole if counted[2] else number)


def checked(key: Key, value: Any) -> Any:
    """`value` as it is kept, or KeyRefused with what was expected."""
    is_file = key.takes in ("file", "file or sequence", "files")
    return _check(key.takes)(key, value if is_file else plain(value))
