"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from ..described import Described, key


@dataclass(kw_only=True, eq=False, repr=False)
class Integrator(Described):
    """Integrator."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("integrator",)


@dataclass(kw_only=True, eq=False, repr=False)
class Path(Integrator):
    """Path tracing."""

    TYPE: ClassVar[str] = "path"
    SECTIONS: ClassVar[tuple[str, ...]] = ("integrator.path",)
    max_depth: int = key("whole number", 32, low=0, high=65536)
    """Most reflections and transmissions between light and camera; 0 shows only what shines itself.
    Unit: events. Range: 0 to 65536."""
    roulette_depth: int = key("whole number", 4, low=0, high=65536)
    """From this many events on, faint paths may end early (unbiased). Unit: events. Range: 0 to
    65536."""
    clamp: float = key("number", 0, low=0)
    """Biased: most light that one indirect sample may bring; removes fireflies and energy alike. 0
    = off. Unit: W/(m² sr). Range: >= 0."""


@dataclass(kw_only=True, eq=False, repr=False)
class Bdpt(Integrator):
    """Bidirectional path tracing."""

    TYPE: ClassVar[str] = "bdpt"
    SECTIONS: ClassVar[tuple[str, ...]] = ("integrator.bdpt",)
    max_depth: int = key("whole number", 32, low=0, high=65536)
    """Most reflections and transmissions between light and camera; 0 shows only what shines itself.
    Unit: events. Range: 0 to 65536."""
    roulette_depth: int = key("whole number", 4, low=0, high=65536)
    """From this many events on, faint paths may end early (unbiased). Unit: events. Range: 0 to
    65536."""
    strategy: Sequence[int] | None = key("2 whole numbers", low=0, high=65538)
    """Only paths with s vertices from the light and t from the camera: one technique's share of the
    picture, for a closer look. Unit: vertices. Range: 0 to 65538. Default: all."""
    mis: bool = key("switch", True)
    """Whether strategies are weighted. Together with `strategy` only: unweighted, each gives all of
    the light that it can find."""


@dataclass(kw_only=True, eq=False, repr=False)
class Mlt(Integrator):
    """Metropolis."""

    TYPE: ClassVar[str] = "mlt"
    SECTIONS: ClassVar[tuple[str, ...]] = ("integrator.mlt",)
    over: Literal["bdpt", "path"] = key("choice", "bdpt", names=("bdpt", "path"))
    """Whose samples the chains mutate."""
    max_depth: int = key("whole number", 32, low=0, high=65536)
    """Most reflections and transmissions between light and camera; 0 shows only what shines itself.
    Unit: events. Range: 0 to 65536."""
    roulette_depth: int = key("whole number", 4, low=0, high=65536)
    """From this many events on, faint paths may end early (unbiased). Unit: events. Range: 0 to
    65536."""
    large_step: float = key("number", 0.3, low=0.01, high=1)
    """How often a chain tries an independent sample, which may find light elsewhere; 1 is no chain
    at all. Range: 0.01 to 1."""
