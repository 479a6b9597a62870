"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from ..described import Described, key


@dataclass(kw_only=True, eq=False, repr=False)
class Output(Described):
    """Outputs."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("outputs",)
    file: str = key("text", required=True)
    """Where to, and in which format. Range: ends in .exr, .png, .tif, .tiff, .jpg, .jpeg, .mp4,
    .mov or .webm. Required."""
    denoise: Literal[True, False, "features", "oidn"] | None = key(
        "choice", names=(True, False, "features", "oidn"),
    )
    """Whether noise is taken out, and by what; see Denoising. Default: that of the job."""


@dataclass(kw_only=True, eq=False, repr=False)
class Exr(Output):
    """EXR."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("outputs.exr",)
    layers: Sequence[str] = key("texts", ("beauty", "alpha"))
    """What is in it. Range: the names in Layers."""
    half: bool = key("switch", False)
    """16 instead of 32 bits (but ids, whose bits are names)."""


@dataclass(kw_only=True, eq=False, repr=False)
class Png(Output):
    """PNG."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("outputs.png",)
    layer: str = key("text", "beauty")
    """Which layer it shows; light as beauty, by tone map and exposure, others as said in Layers.
    Range: a layer that does not stand for several."""
    tone_map: Literal["srgb", "filmic", "aces", "agx", "linear"] = key(
        "choice", "srgb", names=("srgb", "filmic", "aces", "agx", "linear"),
    )
    """How light becomes display values: clipped at 1; two film-like curves that keep highlights;
    AgX (Sobotka 2022), whose bright colours fade to white; the bare numbers."""
    exposure: float = key("number", 0, low=-64, high=64)
    """Each stop doubles the brightness. Unit: stops. Range: -64 to 64."""
    transparent: bool = key("switch", False)
    """With an alpha channel."""
    bits: Literal[8, 16] = key("choice", 8, names=(8, 16))
    """Per channel."""


@dataclass(kw_only=True, eq=False, repr=False)
class Tiff(Output):
    """TIFF."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("outputs.tiff",)
    layer: str = key("text", "beauty")
    """Which layer it shows; light as beauty, by tone map and exposure, others as said in Layers.
    Range: a layer that does not stand for several."""
    tone_map: Literal["srgb", "filmic", "aces", "agx", "linear"] = key(
        "choice", "srgb", names=("srgb", "filmic", "aces", "agx", "linear"),
    )
    """As for PNG."""
    exposure: float = key("number", 0, low=-64, high=64)
    """As for PNG. Unit: stops. Range: -64 to 64."""
    transparent: bool = key("switch", False)
    """With an alpha channel."""
    bits: Literal[8, 16] = key("choice", 8, names=(8, 16))
    """Per channel."""


@dataclass(kw_only=True, eq=False, repr=False)
class Jpg(Output):
    """JPEG."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("outputs.jpg",)
    layer: str = key("text", "beauty")
    """Which layer it shows; light as beauty, by tone map and exposure, others as said in Layers.
    Range: a layer that does not stand for several."""
    tone_map: Literal["srgb", "filmic", "aces", "agx", "linear"] = key(
        "choice", "srgb", names=("srgb", "filmic", "aces", "agx", "linear"),
    )
    """As for PNG."""
    exposure: float = key("number", 0, low=-64, high=64)
    """As for PNG. Unit: stops. Range: -64 to 64."""
    quality: int = key("whole number", 92, low=1, high=100)
    """Of the compression; from 90 on with full colour resolution. Range: 1 to 100."""


@dataclass(kw_only=True, eq=False, repr=False)
class Video(Output):
    """Videos."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("outputs.mp4",)
    layer: str = key("text", "beauty")
    """Which layer it shows; light as beauty, by tone map and exposure, others as said in Layers.
    Range: a layer that does not stand for several."""
    tone_map: Literal["srgb", "filmic", "aces", "agx", "linear"] = key(
        "choice", "srgb", names=("srgb", "filmic", "aces", "agx", "linear"),
    )
    """As for PNG."""
    exposure: float = key("number", 0, low=-64, high=64)
    """As for PNG. Unit: stops. Range: -64 to 64."""
    quality: int = key("whole number", 18, low=1, high=51)
    """Constant rate factor: smaller looks better and takes more room, 6 more take about half of it.
    Range: 1 to 51."""


@dataclass(kw_only=True, eq=False, repr=False)
class Webm(Output):
    """WebM."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("outputs.webm",)
    layer: str = key("text", "beauty")
    """Which layer it shows; light as beauty, by tone map and exposure, others as said in Layers.
    Range: a layer that does not stand for several."""
    tone_map: Literal["srgb", "filmic", "aces", "agx", "linear"] = key(
        "choice", "srgb", names=("srgb", "filmic", "aces", "agx", "linear"),
    )
    """As for PNG."""
    exposure: float = key("number", 0, low=-64, high=64)
    """As for PNG. Unit: stops. Range: -64 to 64."""
    quality: int = key("whole number", 24, low=0, high=63)
    """Constant quality of VP9: smaller looks better and takes more room; 0 loses nothing. Range: 0
    to 63."""
