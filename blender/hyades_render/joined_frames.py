"""Jobs of single moments become one job that moves: what differs from moment to moment becomes keys."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from typing import Any

import hyades
import numpy
from hyades import Keys, MeshData, materials
from hyades.described import Described, Key

from . import moving_transform
from .export import Complaint

_GONE = 1e-6  # what an object that is not there is scaled by: everything has to have an inverse
_EXACT = 1e-6  # of the largest number of an array
_STRENGTHS = ("power", "irradiance", "strength")
_MESH = ("positions", "triangles", "normals", "uvs", "second_uvs", "colors", "tangents")


def share(before: hyades.Job, now: hyades.Job) -> None:
    """Puts what `before` has in the stead of what is equal at the same place of `now`: the frames of a film of one
    room need one room's memory, and what stays the same is one thing."""
    _share(before, now, {})


def alike(one: hyades.Job, other: hyades.Job) -> bool:
    """Whether two jobs say the same thing."""
    return _same(one, other)


def join(
    moments: Sequence[float], of_frames: Sequence[int | None], jobs: Sequence[hyades.Job]
) -> tuple[hyades.Job, list[Complaint]]:
    """One job that is each of `jobs` at its moment [frames, rising], and what of them it cannot say. Between
    moments values move on straight lines. What a job holds still while the shutter is open is as at the moment that
    is the frame's own: `of_frames` says of which frame each is, if of one. The range of frames is that of the first job."""
    joined = _Join(moments, of_frames)
    return joined.described(list(jobs), "scene"), joined.complaints


class _Join:
    def __init__(self, moments: Sequence[float], of_frames: Sequence[int | None]) -> None:
        self._moments = list(moments)
        self._own = [at for at, frame in enumerate(of_frames) if frame is not None]
        self._frames = [frame for frame in of_frames if frame is not None]
        self._made: dict[tuple[int, ...], Any] = {}  # by what they are at each moment: others may name them
        self._is_lamp = False  # the object that is joined
        self.complaints: list[Complaint] = []

    def described(self, things: list[Any], where: str, blurs: bool = False) -> Any:
        """Things of one kind as one. `blurs`: all of it moves while the shutter is open."""
        first, those = things[0], tuple(map(id, things))
        if those in self._made:
            return self._made[those]
        if all(_same(first, thing) for thing in things[1:]) and not isinstance(first, hyades.Job):
            self._made[those] = first
            return first
        made = type(first)()
        self._made[those] = made
        for name, key in type(first).keys().items():
            if name == "frames":
                made.frames = first.frames
                continue
            values = [thing.__dict__.get(name) for thing in things]
            if any(value is not None for value in values):
                setattr(made, name, self._value(key, values, f"{where} > {name}", key.default, blurs or name == "camera"))
        return made

    def _value(self, key: Key, values: list[Any], where: str, default: Any, blurs: bool) -> Any:
        first = values[0]
        if key.takes == "entries":
            return self._entries(values, key.name)
        if all(_same(first, value) for value in values[1:]):
            return self.described(values, where, blurs) if isinstance(first, Described) else first
        if key.takes == "list of steps":
            return self._steps(key, values, where)
        if key.name == "emit":
            values = _shining(values, self._moments)
        values = [default if value is None else value for value in values]
        first = values[0]
        if isinstance(first, Described) and all(type(value) is type(first) for value in values):
            return self.described(values, where, blurs)
        if key.takes == "file or sequence":
            if all(isinstance(value, MeshData) for value in values):
                return self._meshes(values)
            if all(isinstance(value, str) for value in values):
                return self._files(values)
        if isinstance(first, (list, tuple)) and all(isinstance(v, (list, tuple)) for v in values):
            if len({len(value) for value in values}) == 1 and all(isinstance(v, Described) for v in first):
                return [self._value(key, list(column), where, None, blurs) for column in zip(*values)]
        held = self._at_own_times(values)
        ways = [(held, self._frames)] if not blurs else [(values, self._moments), (held, self._frames)]
        for some, moments in ways:
            if all(_same(some[0], value) for value in some[1:]):
                return some[0]
            if "animated" in key.takes or key.takes.startswith(("colour or", "number or")):
                if all(_is_plain(value) for value in some):
                    return self._keys(some, moments)
        return self._complain(where, held[0])

    def _at_own_times(self, values: list[Any]) -> list[Any]:
        """Of a value for each moment those of the frames' own."""
        return [values[at] for at in self._own]

    def _keys(self, values: list[Any], moments: Sequence[float]) -> Keys:
        """Values by moment, without those that lie between equal ones."""
        if any(isinstance(value, (list, tuple)) for value in values):
            width = max(len(value) for value in values if isinstance(value, (list, tuple)))
            values = [list(v) if isinstance(v, (list, tuple)) else [v] * width for v in values]
        last = len(values) - 1
        kept = {
            moment: value
            for at, (moment, value) in enumerate(zip(moments, values))
            if at in (0, last) or not (values[at - 1] == value == values[at + 1])
        }
        return Keys(kept)

    def _files(self, paths: list[str]) -> Any:
        """A file for each frame."""
        held = self._at_own_times(paths)
        return held[0] if len(set(held)) == 1 else dict(zip(self._frames, held))

    def _meshes(self, meshes: list[MeshData]) -> dict[int, MeshData]:
        """A mesh for each frame; while the shutter is open it moves on a straight line to that of the next one, which
        is made where it is not there."""
        by_time = dict(zip(self._moments, meshes))
        by_frame = {int(m): mesh for m, mesh in by_time.items() if float(m).is_integer()}
        for frame, own in zip(self._frames, self._at_own_times(meshes)):
            during = [mesh for m, mesh in by_time.items() if frame <= m < frame + 1]
            if any(not numpy.array_equal(mesh.triangles, own.triangles) for mesh in during):
                by_frame[frame] = own  # another one each time: it stands still
        for frame, mesh in list(by_frame.items()):
            closes = [m for m in by_time if frame < m < frame + 1]
            if closes and frame + 1 not in by_frame:
                by_frame[frame + 1] = _onwards(mesh, by_time[closes[-1]], closes[-1] - frame)
        return by_frame

    def _steps(self, key: Key, values: list[Any], where: str) -> Any:
        """A transform that moves. None: it does nothing."""
        held = self._at_own_times(values)
        if key.owner == "Object" and not self._is_lamp:
            moving = moving_transform.joined(values, lambda some: self._keys(some, self._moments))
        elif all(_same(held[0], value) for value in held[1:]):
            return held[0]
        else:  # lamps that have an area are objects, which stand still while the shutter is open
            moving = moving_transform.joined(held, lambda some: Keys(dict(zip(self._frames, some)), ease="step"))
        return self._complain(where, held[0]) if moving is None else moving

    def _entries(self, values: list[Any], section: str) -> dict[str, Any]:
        """A section: its things by name. What is not there all the time is made tiny or dark meanwhile."""
        names = dict.fromkeys(name for value in values for name in value or ())
        made = {}
        for name in names:
            there = [(value or {}).get(name) for value in values]
            present = [there[at] for at in self._own if there[at] is not None]
            where = f"{section.rstrip('s')} '{name}'"
            if not present:
                continue  # a shutter that opens before the frame sees it for the last time
            if any(type(thing) is not type(present[0]) for thing in present):
                made[name] = self._complain(where, present[0])
                continue
            there = [thing if type(thing) is type(present[0]) else None for thing in there]
            self._is_lamp = section == "objects" and isinstance(present[0].__dict__.get("material"), materials.NullMaterial)
            made[name] = self.described([_nearest(there, self._moments, at) for at in range(len(there))], where)
            self._is_lamp = False
            if len(present) < len(self._own):
                self._come_and_go(made[name], [there[at] is not None for at in self._own], section, where)
        return made

    def _come_and_go(self, thing: Any, there: list[bool], section: str, where: str) -> None:
        """`there`: in which frames it is."""
        if section == "objects":
            size = Keys({m: 1.0 if is_there else _GONE for m, is_there in zip(self._frames, there)}, ease="step")
            thing.transform = [hyades.Step(scale=size), *(thing.transform or [])]
        elif section == "lights":
            for name in _STRENGTHS:
                if name in thing.keys() and _is_plain(getattr(thing, name)):
                    full = getattr(thing, name)
                    values = [full if is_there else 0.0 for is_there in there]
                    setattr(thing, name, Keys(dict(zip(self._frames, values)), ease="step"))
                    return
            self._complain(where, None)

    def _complain(self, where: str, value: Any) -> Any:
        words = "changes over time in a way that a job cannot say; it stays as it is at first"
        complaint = Complaint(where.removeprefix("scene > "), words)
        if complaint not in self.complaints:
            self.complaints.append(complaint)
        return value


def _nearest(things: list[Any], moments: Sequence[float], at: int) -> Any:
    """What is there at this moment, else at the nearest one."""
    near = sorted(range(len(things)), key=lambda other: abs(moments[other] - moments[at]))
    return next(things[other] for other in near if things[other] is not None)


def _shining(values: list[Any], moments: Sequence[float]) -> list[Any]:
    """What things shine at each moment: where they do not, as at the nearest one at which they do, but dark."""
    filled = []
    for at, value in enumerate(values):
        if value is None:
            value = copy(_nearest(values, moments, at))
            for name in ("radiance", "power"):
                if value.__dict__.get(name) is not None:
                    setattr(value, name, 0.0)
        filled.append(value)
    return filled


def _onwards(start: MeshData, end: MeshData, span: float) -> MeshData:
    """Where a mesh is a frame after `start`, if it goes on as it does within `span` frames, when it is `end`."""
    if not numpy.array_equal(start.triangles, end.triangles) or start.positions.shape != end.positions.shape:
        return end  # another mesh: it stands still while the shutter is open
    made = MeshData(start.positions + (end.positions - start.positions) / span, start.triangles)
    for name in _MESH[2:]:
        setattr(made, name, getattr(start, name))
    if start.normals is not None and end.normals is not None:
        made.normals = start.normals + (end.normals - start.normals) / span
    return made


def _is_plain(value: Any) -> bool:
    """A number or several."""
    if isinstance(value, (list, tuple)):
        return all(isinstance(part, (int, float)) for part in value)
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _same(a: Any, b: Any) -> bool:
    """Whether two values say the same thing."""
    if a is b:
        return True
    if type(a) is not type(b):
        return False
    if isinstance(a, Described):
        names = {key.name for key, _ in (*a.said(), *b.said())}
        return all(_same(a.__dict__.get(name), b.__dict__.get(name)) for name in names)
    if isinstance(a, numpy.ndarray):
        return a.shape == b.shape and a.dtype == b.dtype and _same_numbers(a, b)
    if isinstance(a, Mapping):
        return a.keys() == b.keys() and all(_same(value, b[name]) for name, value in a.items())
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(map(_same, a, b))
    if hasattr(a, "encode") and not isinstance(a, str):
        return _same(vars(a), vars(b))
    return bool(a == b)


def _same_numbers(a: numpy.ndarray, b: numpy.ndarray) -> bool:
    """Normals of one and the same mesh differ in their last digits: Blender's threads add them up in any order."""
    if numpy.array_equal(a, b):
        return True
    return a.dtype.kind == "f" and bool(numpy.abs(a - b).max() <= _EXACT * numpy.abs(a).max())


def _share(before: Any, now: Any, done: dict[int, tuple[Any, Any]]) -> Any:
    """`now`, or the equal value of `before`. `done`: what became of things, by their ids; others may name them."""
    if id(now) in done:
        return done[id(now)][1]
    if not isinstance(now, Described):
        is_array = isinstance(now, numpy.ndarray) or (hasattr(now, "encode") and not isinstance(now, str))
        return before if is_array and _same(before, now) else now
    result = before if _same(before, now) and not isinstance(now, hyades.Job) else now
    done[id(now)] = now, result
    if result is before:
        return result
    for name, value in list(now.__dict__.items()):
        theirs = before.__dict__.get(name) if type(before) is type(now) else None
        if isinstance(value, dict):
            for entry in value:
                value[entry] = _share(theirs.get(entry) if isinstance(theirs, dict) else None, value[entry], done)
        else:
            now.__dict__[name] = _share(theirs, value, done)
    return now
