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


def _gradient(hash: Array, offsets: list[Array]) -> Array:
    count = len(offsets)
    if count == 1:
        h = hash & 15
        return numpy.where(h & 8, -1.0, 1.0) * (1 + (h & 7)) * offsets[0]
    x, y = offsets[0], offsets[1]
    if count == 2:
        h = hash & 7
        u, v = numpy.where(h < 4, x, y), 2 * numpy.where(h < 4, y, x)
        return numpy.where(h & 1, -u, u) + numpy.where(h & 2, -v, v)
    z = offsets[2]
    if count == 3:
        h = hash & 15
        u = numpy.where(h < 8, x, y)
        v = numpy.where(h < 4, y, numpy.where((h == 12) | (h == 14), x, z))
        return numpy.where(h & 1, -u, u) + numpy.where(h & 2, -v, v)
    h = hash & 31
    u, v, s = numpy.where(h < 24, x, y), numpy.where(h < 16, y, z), numpy.where(h < 8, z, offsets[3])
    return numpy.where(h & 1, -u, u) + numpy.where(h & 2, -v, v) + numpy.where(h & 4, -s, s)


def signed_noise(place: Array) -> Array:
    """Noise -1..1 at places (n, 1 to 4)."""
    count = place.shape[1]
    cell = numpy.floor(place)
    share = place - cell
    whole = cell.astype("int64").astype("uint32")
    fade = share**3 * (share * (share * 6 - 15) + 10)
    result = numpy.zeros(len(place))
    with numpy.errstate(over="ignore"):
        for corner in range(1 << count):
            at = [(corner >> axis) & 1 for axis in range(count)]
            weight = numpy.ones(len(place))
            for axis in range(count):
                weight = weight * (fade[:, axis] if at[axis] else 1 - fade[:, axis])
            keys = [whole[:, axis] + numpy.uint32(at[axis]) for axis in range(count)]
            result += weight * _gradient(hashed(*keys), [share[:, axis] - at[axis] for axis in range(count)])
    return result * _SCALES[count]


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
