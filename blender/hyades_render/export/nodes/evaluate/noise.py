"""Nodes Noise Texture and White Noise: Perlin's gradient noise (2002) over Jenkins' hash (lookup3, in the public domain)."""

from __future__ import annotations

from typing import Any

import numpy

from ..graph import Output
from ..translator import Inexpressible
from .evaluator import Evaluator, computes, stacked

Array = Any
_SCALES = {1: 0.25, 2: 0.6616, 3: 0.982, 4: 0.8344}
"""Brings the noise of as many dimensions into -1..1."""


def _rotated(x: Array, bits: int) -> Array:
    return (x << numpy.uint32(bits)) | (x >> numpy.uint32(32 - bits))


def hashed(*keys: Array) -> Array:
    """A hash (uint32) of one to four arrays of uint32."""
    keys = tuple(numpy.broadcast_arrays(*(numpy.atleast_1d(numpy.asarray(key, "uint32")) for key in keys)))
    start = numpy.uint32((0xDEADBEEF + (len(keys) << 2) + 13) & 0xFFFFFFFF)
    with numpy.errstate(over="ignore"):
        a, b, c = ((start + keys[i]) if i < len(keys) else numpy.full_like(keys[0], start) for i in range(3))
        if len(keys) == 4:
            for back, bits in ((0, 4), (0, 6), (0, 8), (0, 16), (0, 19), (0, 4)):
                a, b, c = _mixed(a, b, c, bits)
            a = a + keys[3]
        for bits in (14, 11, 25, 16, 4, 14, 24):
            # Each round changes one of the three: c, a, b, c, a, b, c.
            c = (c ^ b) - _rotated(b, bits)
            a, b, c = b, c, a
    # Seven rounds have turned the names once more than twice around.
    return b


def _mixed(a: Array, b: Array, c: Array, bits: int) -> tuple[Array, Array, Array]:
    a = (a - c) ^ _rotated(c, bits)
    c = c + b
    return b, c, a


def unit(*values: Array) -> Array:
    """A random number 0..1 for one to four numbers, by their bits."""
    bits = [numpy.atleast_1d(numpy.asarray(value, "float32")).view("uint32") for value in values]
    return hashed(*bits).astype("float64") / 0xFFFFFFFF


def _table(count: int) -> Array:
    """The gradients (2^k, count) of as many dimensions, by the last bits of a hash."""
    if count == 1:
        return numpy.array([[(-1 if h & 8 else 1) * (1 + (h & 7))] for h in range(16)], "float32")
    bits, rows = {2: 8, 3: 16, 4: 32}[count], []
    for h in range(bits):
        if count == 2:
            parts = [(0, 1), (1, 2)] if h < 4 else [(1, 1), (0, 2)]
        elif count == 3:
            parts = [(0 if h < 8 else 1, 1), (1 if h < 4 else 0 if h in (12, 14) else 2, 1)]
        else:
            parts = [(0 if h < 24 else 1, 1), (1 if h < 16 else 2, 1), (2 if h < 8 else 3, 1)]
        row = [0] * count
        for bit, (axis, length) in enumerate(parts):
            row[axis] += -length if h >> bit & 1 else length
        rows.append(row)
    return numpy.array(rows, "float32")


_GRADIENTS = {count: _table(count).T.copy() for count in (1, 2, 3, 4)}


def _gradient(hash: Array, offsets: list[Array]) -> Array:
    table = _GRADIENTS[len(offsets)]
    which = hash & numpy.uint32(table.shape[1] - 1)
    result = table[0][which] * offsets[0]
    for axis in range(1, len(offsets)):
        result += table[axis][which] * offsets[axis]
    return result


def signed_noise(place: Array) -> Array:
    """Noise -1..1 at places (n, 1 to 4)."""
    count = place.shape[1]
    low, shares, fades = [], [], []
    with numpy.errstate(over="ignore"):
        for axis in range(count):
            cell = numpy.floor(place[:, axis])
            share = (place[:, axis] - cell).astype("float32")
            whole = cell.astype("int64").astype("uint32")
            fade = share * share * share * (share * (share * 6 - 15) + 10)
            low.append((whole, whole + numpy.uint32(1)))
            shares.append((share, share - 1))
            fades.append((1 - fade, fade))
        result = numpy.zeros(len(place), "float32")
        for corner in range(1 << count):
            at = [(corner >> axis) & 1 for axis in range(count)]
            weight = fades[0][at[0]]
            for axis in range(1, count):
                weight = weight * fades[axis][at[axis]]
            keys = [low[axis][at[axis]] for axis in range(count)]
            result += weight * _gradient(hashed(*keys), [shares[axis][at[axis]] for axis in range(count)])
    return result.astype("float64") * _SCALES[count]


def fractal(place: Array, detail: Array, roughness: Array) -> Array:
    """Noise 0..1 of several octaves; `detail` may be a fraction, which counts the last octave in part."""
    detail, roughness = numpy.clip(detail, 0, 15), numpy.clip(roughness, 0, 1)
    whole = numpy.floor(detail)
    amplitude = numpy.ones(numpy.broadcast(roughness, place[:, 0]).shape)
    total, most, beyond = numpy.zeros(len(place)), numpy.zeros(len(place)), None
    size = 1.0
    for octave in range(int(numpy.max(whole)) + 2):
        needed = octave <= whole
        last = (octave == whole + 1) & (detail > whole)
        if not numpy.any(needed | last):
            break
        n = 0.5 * signed_noise(place * size) + 0.5
        if numpy.any(last):
            beyond = (total + n * amplitude) / (most + amplitude), last, detail - whole
        total = total + numpy.where(needed, n * amplitude, 0)
        most = most + numpy.where(needed, amplitude, 0)
        amplitude = amplitude * roughness
        size *= 2
    result = total / most
    if beyond is not None:
        more, last, share = beyond
        result = numpy.where(last, result * (1 - share) + more * share, result)
    return result


def offset(seed: int, count: int) -> Array:
    """Where the noise of another channel begins, far away."""
    if count == 1:
        return 100 + 100 * unit(float(seed))
    return 100 + 100 * numpy.concatenate([unit(float(seed), float(axis)) for axis in range(count)])


def place_of(at: Evaluator, output: Output, dimensions: str, name_of_w: str = "W") -> Array:
    """The coordinates (n, 1 to 4) that a texture of so many dimensions reads."""
    if dimensions == "1D":
        return numpy.atleast_1d(at.number(output, name_of_w))[:, None]
    vector = numpy.atleast_2d(at.place(output))
    if dimensions == "2D":
        return vector[:, :2]
    if dimensions == "3D":
        return vector
    w = numpy.broadcast_to(at.number(output, name_of_w), vector.shape[:1])
    return numpy.concatenate([vector, w[:, None]], axis=1)


@computes("TEX_NOISE")
def noise_texture(at: Evaluator, output: Output) -> Array:
    node = output.node
    if getattr(node, "noise_type", "FBM") != "FBM":
        raise Inexpressible(output, f"noise of type {node.noise_type.lower()} is not supported")
    if float(numpy.max(at.number(output, "Lacunarity", default=2.0))) != 2.0 or not getattr(node, "normalize", True):
        raise Inexpressible(output, "only a lacunarity of 2, normalized, is supported")
    place = place_of(at, output, node.noise_dimensions)
    count = place.shape[1]
    place = place * numpy.atleast_1d(at.number(output, "Scale"))[:, None]
    detail, roughness = at.number(output, "Detail"), at.number(output, "Roughness", default=0.5)
    distortion = at.number(output, "Distortion")
    if numpy.any(distortion != 0):
        moves = [signed_noise(place + offset(axis, count)) * distortion for axis in range(count)]
        place = place + numpy.stack(moves, axis=1)
    value = fractal(place, detail, roughness)
    if output.socket.type == "VALUE":
        return value
    others = [fractal(place + offset(count + i, count), detail, roughness) for i in range(2)]
    return stacked(value, *others)


@computes("TEX_WHITE_NOISE")
def white_noise(at: Evaluator, output: Output) -> Array:
    place = place_of(at, output, output.node.noise_dimensions)
    keys = [place[:, axis] for axis in range(place.shape[1])]
    if output.socket.type == "VALUE":
        return unit(*keys)
    return random_color(keys)


def random_color(keys: list[Array]) -> Array:
    """Three random numbers (n, 3) for the same numbers."""
    if len(keys) < 4:
        one = numpy.ones_like(keys[0])
        return stacked(unit(*keys), unit(*keys, one), unit(*keys, 2 * one))
    x, y, z, w = keys
    return stacked(unit(x, y, z, w), unit(z, x, w, y), unit(w, z, y, x))
