"""How two colours are mixed."""

from __future__ import annotations

from typing import Any, Optional

import numpy

Array = Any


def _dodge(a: Array, b: Array, t: Array) -> Array:
    left = 1 - t * b
    return numpy.where(a == 0, 0, numpy.where(left <= 0, 1, numpy.minimum(a / numpy.where(left == 0, 1, left), 1)))


def _burn(a: Array, b: Array, t: Array) -> Array:
    under = 1 - t + t * b
    return numpy.where(under <= 0, 0, numpy.clip(1 - (1 - a) / numpy.where(under == 0, 1, under), 0, 1))


def _overlay(a: Array, b: Array, t: Array) -> Array:
    dark = a * (1 - t + 2 * t * b)
    return numpy.where(a < 0.5, dark, 1 - (1 - t + 2 * t * (1 - b)) * (1 - a))


def _soft(a: Array, b: Array, t: Array) -> Array:
    screen = 1 - (1 - b) * (1 - a)
    return (1 - t) * a + t * ((1 - a) * b * a + a * screen)


def _divide(a: Array, b: Array, t: Array) -> Array:
    return numpy.where(b != 0, (1 - t) * a + t * a / numpy.where(b == 0, 1, b), a)


def _of_hsv(part: str) -> Any:
    def mixed(a: Array, b: Array, t: Array) -> Array:
        from .colors import from_hsv, to_hsv

        x, y = to_hsv(a), to_hsv(b)
        x, y = numpy.broadcast_arrays(x, y)
        changed = x.copy()
        share = numpy.broadcast_to(t[..., 0], changed.shape[:-1])
        if part == "HUE":
            changed[..., 0] = y[..., 0]
        elif part == "COLOR":
            changed[..., :2] = y[..., :2]
        elif part == "SATURATION":
            changed[..., 1] = numpy.where(x[..., 1] != 0, (1 - share) * x[..., 1] + share * y[..., 1], x[..., 1])
            return from_hsv(changed)
        else:
            changed[..., 2] = (1 - share) * x[..., 2] + share * y[..., 2]
            return from_hsv(changed)
        # A grey has no hue to give.
        return numpy.where(y[..., 1:2] != 0, (1 - t) * a + t * from_hsv(changed), a)

    return mixed


_KINDS: dict[str, Any] = {
    "MIX": lambda a, b, t: a + (b - a) * t,
    "ADD": lambda a, b, t: a + b * t,
    "MULTIPLY": lambda a, b, t: a * (1 - t + t * b),
    "SCREEN": lambda a, b, t: 1 - (1 - t + t * (1 - b)) * (1 - a),
    "OVERLAY": _overlay,
    "SUBTRACT": lambda a, b, t: a - b * t,
    "DIVIDE": _divide,
    "DIFFERENCE": lambda a, b, t: (1 - t) * a + t * numpy.abs(a - b),
    "EXCLUSION": lambda a, b, t: numpy.maximum((1 - t) * a + t * (a + b - 2 * a * b), 0),
    "DARKEN": lambda a, b, t: (1 - t) * a + t * numpy.minimum(a, b),
    "LIGHTEN": lambda a, b, t: (1 - t) * a + t * numpy.maximum(a, b),
    "DODGE": _dodge,
    "BURN": _burn,
    "SOFT_LIGHT": _soft,
    "LINEAR_LIGHT": lambda a, b, t: a + t * (2 * b - 1),
    "HUE": _of_hsv("HUE"),
    "SATURATION": _of_hsv("SATURATION"),
    "VALUE": _of_hsv("VALUE"),
    "COLOR": _of_hsv("COLOR"),
}


def blended(kind: str, a: Array, b: Array, amount: Array) -> Optional[Array]:
    """a and b mixed as `kind` says, by `amount` (..., 1); None for a kind that is not known."""
    mix = _KINDS.get(kind)
    return None if mix is None else mix(a, b, amount)
