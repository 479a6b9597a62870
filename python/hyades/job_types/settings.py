"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from ..described import Described, key
from ..values import File, FrameRange


@dataclass(kw_only=True, eq=False, repr=False)
class Frames(Described):
    """Frames."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("frames",)
    range: FrameRange = key("frames", "1")
    """A frame, first-last, or first-last x step. Unit: frames. Range: 0 to 9999999."""
    fps: float = key("number", 24, low=0, high=1000000, above=True)
    """Frames per second. Unit: 1/s. Range: above 0, at most 1e6."""
    shutter: float = key("number", 0, low=0, high=1)
    """How long the shutter is open: motion blur. It opens at the frame's time. Transforms and the
    camera move while it is open, colours and textures do not; see docs/job.md. Unit: frames. Range:
    0 to 1."""


@dataclass(kw_only=True, eq=False, repr=False)
class Filter(Described):
    """Filter."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("film.filter",)
    type: Literal["box", "triangle", "gaussian", "mitchell", "blackman-harris", "center"] = key(
        "choice", "blackman-harris", names=("box", "triangle", "gaussian", "mitchell",
        "blackman-harris", "center"),
    )
    """The filter's shape. `center` puts every sample on the pixel's centre: no antialiasing."""
    radius: float = key("number", 1.5, low=0, high=16, above=True)
    """Half the filter's width; not for `center`. The default is 0.5 for box, 1 for triangle, 2 for
    mitchell, 1.5 for the others. Unit: pixels. Range: above 0, at most 16."""


@dataclass(kw_only=True, eq=False, repr=False)
class Film(Described):
    """Film."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("film",)
    size: Sequence[int] = key("2 whole numbers", (640, 360), low=1, high=65536)
    """Size of the full frame. A film takes 128 to 320 bytes of memory per pixel; `hyades render`
    refuses one that takes more than half of what is there, a farm more than a third (`--film-
    memory`). Unit: pixels. Range: 1 to 65536 each, 2^28 pixels in all."""
    crop: Sequence[int] | None = key("4 whole numbers", low=0, high=65536)
    """Renders only x0 <= x < x1, y0 <= y < y1; row 0 is the top. Pixels have the same bits as in
    the whole frame (but for `bdpt` and `mlt`). EXR outputs keep the place: their display window is
    the frame, their data window the crop; PNG and JPEG hold the crop alone. Unit: pixels. Range:
    inside the frame. Default: none."""
    filter: Literal["box", "triangle", "gaussian", "mitchell", "blackman-harris", "center"] | Filter | None = key(
        "type or map", names=("box", "triangle", "gaussian", "mitchell", "blackman-harris",
        "center"),
    )
    """How samples make pixels. Default: `blackman-harris`."""


@dataclass(kw_only=True, eq=False, repr=False)
class Sampling(Described):
    """Sampling."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("sampling",)
    samples: int = key("whole number", 64, low=1, high=16777216)
    """More samples, less noise: four times as many halve it. With `noise` the most that a pixel
    gets, 4096 where nothing is said. Unit: per pixel. Range: 1 to 16777216."""
    seed: int = key("whole number", 0, low=0, high=1.8446744073709552e+19, below=True)
    """Another seed, another noise. Range: 0 to 2^64 - 1."""
    sampler: Literal["sobol", "independent"] = key(
        "choice", "sobol", names=("sobol", "independent"),
    )
    """Owen-scrambled Sobol points, or independent random numbers (noisier; for tests)."""
    noise: float = key("number", 0, low=0, high=1)
    """Noise at which the sampling of a tile stops, see Adaptive sampling. 0: every pixel gets all
    samples. Range: 0 to 1."""
    min_samples: int = key("whole number", 32, low=1, high=16777216)
    """Samples that every pixel gets before its tile is judged for the first time, at least 32; only
    with `noise`. Unit: per pixel. Range: 1 to 16777216."""


@dataclass(kw_only=True, eq=False, repr=False)
class Render(Described):
    """Classes of machines."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("render",)
    class_: Literal["native", "portable"] = key("choice", "native", names=("native", "portable"))
    """By which arithmetic rays meet surfaces: `native` by Embree, the fastest on processors;
    `portable` the same to the last bit on every machine."""


@dataclass(kw_only=True, eq=False, repr=False)
class ColorManagement(Described):
    """Colour management."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("color",)
    config: File = key("file", required=True)
    """What displays, views, looks and spaces there are. Range: a configuration of version 1 or 2.
    Required."""
    display: str | None = key("text")
    """For whose screen. Range: its displays. Default: that of the configuration."""
    view: str | None = key("text")
    """How light is shown on it. Range: the display's views. Default: that of the display."""
    look: str | None = key("text")
    """In place of the view's own. Range: its looks, as OpenColorIO writes several: `+a, -b`.
    Default: those of the view."""
    working_space: str | None = key("text")
    """In which light is given to the view. Range: its colour spaces and roles. Default: role
    scene_linear."""
