"""What an input of a shader may be: a number, a colour, or a texture of the job; and arithmetic with them."""

from __future__ import annotations

import math
from typing import Any, Union
from weakref import WeakKeyDictionary

import numpy
from hyades import textures

Value = Union[float, "tuple[float, float, float]", textures.Texture]
"""A number; linear [r, g, b]; or a texture."""

_LUMINANCE = (0.2126, 0.7152, 0.0722)
_LIMITS: WeakKeyDictionary[textures.Texture, float] = WeakKeyDictionary()
"""What no part of some textures is above."""


def is_texture(value: Value) -> bool:
    return isinstance(value, textures.Texture)


def color(value: Any) -> tuple[float, float, float]:
    """A constant as three numbers."""
    if isinstance(value, (int, float)):
        return (float(value),) * 3
    return (float(value[0]), float(value[1]), float(value[2]))


def number(value: Value) -> Any:
    """A constant as one number, its luminance; a texture as it is, whose luminance counts."""
    if is_texture(value):
        return value
    if isinstance(value, (int, float)):
        return float(value)
    return sum(part * share for part, share in zip(value, _LUMINANCE))


def grey(value: Value) -> Value:
    """The luminance of a value."""
    return textures.Channel(input=value, channel="luminance") if is_texture(value) else number(value)


def held(value: Value, low: float = 0.0, high: float = 1.0) -> Any:
    """A constant within these ends; of textures the renderer sees to it."""
    if is_texture(value):
        return value
    if isinstance(value, (int, float)):
        return min(max(float(value), low), high)
    return [min(max(part, low), high) for part in value]


def is_constant(value: Value, what: float) -> bool:
    """Whether a value is this number everywhere."""
    return not is_texture(value) and all(part == what for part in color(value))


def product(a: Value, b: Value) -> Value:
    if is_constant(a, 0) or is_constant(b, 0):
        return 0.0
    if is_constant(a, 1):
        return b
    if is_constant(b, 1):
        return a
    if is_texture(a) or is_texture(b):
        texture, factor = (a, b) if is_texture(a) else (b, a)
        return textures.Scale(input=texture, factor=_plain(factor))
    if isinstance(a, (int, float)) and isinstance(b, (int, float)):
        return float(a * b)
    x, y = color(a), color(b)
    return (x[0] * y[0], x[1] * y[1], x[2] * y[2])


def total(a: Value, b: Value) -> Value:
    if is_constant(a, 0):
        return b
    if is_constant(b, 0):
        return a
    if is_texture(a) or is_texture(b):
        return textures.Add(a=_plain(a), b=_plain(b))
    if isinstance(a, (int, float)) and isinstance(b, (int, float)):
        return float(a + b)
    x, y = color(a), color(b)
    return (x[0] + y[0], x[1] + y[1], x[2] + y[2])


def rest(a: Value) -> Value:
    """1 - a."""
    if is_texture(a):
        return textures.Invert(input=a)
    if isinstance(a, (int, float)):
        return 1.0 - a
    return (1 - a[0], 1 - a[1], 1 - a[2])


def mixed(a: Value, b: Value, amount: Value, whole: bool = False) -> Value:
    """a where amount is 0, b where it is 1. `whole`: as a mixture of both, though the amount is 0 or 1."""
    if whole and (is_texture(a) or is_texture(b)):
        return textures.Mix(a=_plain(a), b=_plain(b), amount=held(number(amount)))
    if is_constant(amount, 0) or a is b:
        return a
    if is_constant(amount, 1):
        return b
    if is_texture(a) or is_texture(b) or is_texture(amount):
        return textures.Mix(a=_plain(a), b=_plain(b), amount=held(number(amount)))
    return total(product(a, 1.0 - number(amount)), product(b, number(amount)))


def quotient(a: Value, b: Value) -> Value:
    """a / b, 0 where b is 0."""
    if is_constant(b, 1):
        return a
    if is_texture(a) or is_texture(b):
        return textures.Divide(a=_plain(a), b=_plain(b))
    x, y = color(a), color(b)
    return tuple(p / q if q else 0.0 for p, q in zip(x, y))  # type: ignore[return-value]


def bounded(texture: textures.Texture, limit: float) -> textures.Texture:
    """A texture of which it is known that no part of it is above `limit`."""
    _LIMITS[texture] = limit
    return texture


def most(value: Any) -> float:
    """What no part of a value is above, as far as it is known; else infinity."""
    if not is_texture(value):
        return max(color(value))
    if value in _LIMITS:
        return _LIMITS[value]
    pixels = getattr(value, "file", None)
    if isinstance(pixels, numpy.ndarray):
        return float(pixels.max(initial=0.0)) if pixels.dtype.kind == "f" else 1.0
    if isinstance(value, textures.Ramp):
        return max(map(most, value.stops.values()))
    if isinstance(value, textures.Invert):
        return 1.0
    parts = [most(part) for part in (getattr(value, name, None) for name in ("a", "b", "input", "factor")) if part is not None]
    if isinstance(value, textures.Add):
        return sum(parts)
    if isinstance(value, textures.Scale):
        return parts[0] * parts[1]
    if isinstance(value, textures.Min):
        return min(parts)
    if isinstance(value, textures.Power):
        return max(parts[0] ** value.exponent, 1.0) if math.isfinite(parts[0]) else parts[0]
    is_within_parts = isinstance(value, (textures.Checker, textures.Mix, textures.Max, textures.Channel))
    return max(parts) if is_within_parts else math.inf


def _plain(value: Value) -> Any:
    """As a key of a texture takes it: not below 0."""
    return held(value, 0.0, 1e18)
