"""Cryptomattes by the names of things in Blender, which are not all names of a job."""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping

import numpy
from hyades import Layers

from .export import Names

_RANKS = 2  # of a layer, each an id and its share of the pixel


def rename(layers: Layers, names: Names) -> None:
    """Ids and manifests of what was read from a job's EXR become those of Blender's names; what is one thing there, as
    copies and parts are, becomes one."""
    for kind, known in (("CryptoObject", names.objects), ("CryptoMaterial", names.materials)):
        field = next((key for key, name in layers.attributes.items() if _is_name(key) and name == kind), None)
        ranks = sorted(name for name in layers if name.startswith(kind))
        if field is None or not ranks:
            continue
        manifest = field[: -len("name")] + "manifest"
        theirs = json.loads(layers.attributes.get(manifest, "{}"))
        # Of a copy the name is that of the whole, and of the part in it.
        called = {name: known.get(name.partition("/")[0], name) for name in theirs}
        if all(name == ours for name, ours in called.items()):
            continue
        codes = {name: hash_of(name) for name in called.values()}
        layers.attributes[manifest] = json.dumps({name: f"{code:08x}" for name, code in codes.items()}, ensure_ascii=False)
        changes = {int(theirs[name], 16): codes[ours] for name, ours in called.items()}
        joined = _joined(numpy.concatenate([layers[name] for name in ranks], axis=2), changes)
        for at, name in enumerate(ranks):
            layers[name] = joined[:, :, 2 * _RANKS * at : 2 * _RANKS * (at + 1)]


def fields(layers: Layers, view_layer: str, asked: set[str]) -> dict[str, str]:
    """What a file has to say of the Cryptomattes that were asked for, for RenderResult.stamp_data_add_field()."""
    found = {}
    for key, name in layers.attributes.items():
        if not (_is_name(key) and name in asked):
            continue
        theirs = f"{view_layer}.{name}"
        ours = f"cryptomatte/{zlib.crc32(theirs.encode()):08x}"[:-1]  # any 7 digits that no other layer has
        found[f"{ours}/name"] = theirs
        for what in ("hash", "conversion", "manifest"):
            found[f"{ours}/{what}"] = layers.attributes.get(key[: -len("name")] + what, "")
    return found


def _is_name(key: str) -> bool:
    return key.startswith("cryptomatte/") and key.endswith("/name")


def _joined(pairs: numpy.ndarray, changes: Mapping[int, int]) -> numpy.ndarray:
    """(h, w, 2 n): ids and shares with other ids; equal ones are one, and the largest come first again."""
    ids, shares = pairs[:, :, 0::2].copy(), pairs[:, :, 1::2].copy()
    before = ids.copy()
    for old, new in changes.items():
        ids[before == _as_float(old)] = _as_float(new)
    count = ids.shape[2]
    for first in range(count):
        for later in range(first + 1, count):
            same = (ids[:, :, first] == ids[:, :, later]) & (shares[:, :, later] > 0)
            shares[:, :, first] += numpy.where(same, shares[:, :, later], 0)
            ids[:, :, later][same] = 0
            shares[:, :, later][same] = 0
    order = numpy.argsort(-shares, axis=2, kind="stable")
    result = numpy.empty_like(pairs)
    result[:, :, 0::2] = numpy.take_along_axis(ids, order, axis=2)
    result[:, :, 1::2] = numpy.take_along_axis(shares, order, axis=2)
    return result


def _as_float(code: int) -> numpy.float32:
    """An id as Cryptomatte's specification has it: a float that is a number."""
    exponent = code >> 23 & 255
    if exponent in (0, 255):
        code ^= 1 << 23
    return numpy.array(code, "uint32").view("float32")[()]


def hash_of(name: str) -> int:
    """MurmurHash3 (32 bits, seed 0) of a name."""
    data, mask = name.encode(), 0xFFFFFFFF
    code, whole = 0, len(data) // 4 * 4
    for at in range(0, whole, 4):
        code ^= _scrambled(int.from_bytes(data[at : at + 4], "little"))
        code = (((code << 13) | (code >> 19)) * 5 + 0xE6546B64) & mask
    code ^= _scrambled(int.from_bytes(data[whole:], "little")) if whole < len(data) else 0
    code ^= len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
        code = ((code ^ (code >> shift)) * factor) & mask
    return code ^ (code >> 16)


def _scrambled(word: int) -> int:
    word = word * 0xCC9E2D51 & 0xFFFFFFFF
    return ((word << 15) | (word >> 17)) * 0x1B873593 & 0xFFFFFFFF
