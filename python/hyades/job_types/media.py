"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from ..described import Described, key
from ..values import Color, File, FileOrSequence, Number, NumberOrVector, Vector
from .transforms import Step


@dataclass(kw_only=True, eq=False, repr=False)
class Noise(Described):
    """Noise."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("media.density.noise",)
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Cells of the coarsest octave per unit of length of the body. Unit: 1/length."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """Shifts the noise. Unit: cells."""
    octaves: int = key("whole number", 5, low=1, high=16)
    """How many sizes of detail. Range: 1 to 16."""
    lacunarity: Number = key("number, animated", 2, low=1, high=16)
    """How much finer each octave is than the one before. Range: 1 to 16."""
    gain: Number = key("number, animated", 0.5, low=0, high=4)
    """How much weaker. Range: 0 to 4."""
    time: Number = key("number, animated", 0)
    """Fourth coordinate: as it grows, the noise churns in its place."""
    low: Number = key("number, animated", 0.5, low=0, high=1)
    """Noise up to which there is nothing. Range: 0 to 1."""
    high: Number = key("number, animated", 0.7, low=0, high=1)
    """Noise from which on the density is 1; a sharp edge where it is not above `low`. Range: 0 to
    1."""
    fade: Number = key("number, animated", 0, low=0, high=1)
    """The share of the way from the middle of the body to the ellipsoid that fits into its bounds
    on which the noise sinks below `low`; 0: the density ends at the body. Range: 0 to 1."""


@dataclass(kw_only=True, eq=False, repr=False)
class Shell(Described):
    """An image around a planet."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("media.density.shell",)
    image: File = key("file", required=True)
    """All directions around the origin; +y is up. Range: an image. Required."""
    inner: Number = key("number, animated", 0.8, low=0)
    """Radius at which it begins. Unit: length. Range: >= 0, below `outer`."""
    outer: Number = key("number, animated", 1, low=0, above=True)
    """Radius at which it ends; the body should reach as far. Unit: length. Range: above 0."""
    rotate_y: Number = key("number, animated", 0)
    """Turns the image. Unit: degrees."""
    low: Number = key("number, animated", 0, low=0)
    """Luminance up to which there is nothing. Range: >= 0."""
    high: Number = key("number, animated", 1, low=0)
    """Luminance from which on the density is 1. Range: >= 0."""
    tint: bool = key("switch", True)
    """Whether scattered light takes the image's colour."""
    swirl: Number = key("number, animated", 0, low=0)
    """How far noise moves the image at most. Unit: length. Range: >= 0."""
    scale: Number = key("number, animated", 4, low=0)
    """Cells of that noise per length. Unit: 1/length. Range: >= 0."""
    octaves: int = key("whole number", 4, low=1, high=16)
    """Its sizes of detail. Range: 1 to 16."""
    time: Number = key("number, animated", 0)
    """Its fourth coordinate."""


@dataclass(kw_only=True, eq=False, repr=False)
class Density(Described):
    """Media that vary."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("media.density",)
    vdb: FileOrSequence | None = key("file or sequence")
    """A grid of numbers, interpolated linearly. Fog volumes in files of OpenVDB 3 and later, or of
    NanoVDB (`cloud.nvdb`, version 32 of its format, any compression, also quantized values); what
    is not active is 0. With `#` in its name, as in `fire.####.vdb`, a file for each frame. Range:
    OpenVDB, NanoVDB. Default: none."""
    grid: str = key("text", "density")
    """Which grid of the vdb."""
    tint: str | None = key("text")
    """A grid of vectors of the vdb: colours that scattered light is multiplied by, at most 1; what
    they take is absorbed. Default: none."""
    place: Literal["fit", "native"] = key("choice", "fit", names=("fit", "native"))
    """Where the vdb lies in the body. `fit`: in the middle of the body's bounds, as large as they
    allow; `native`: where the file says, its unit being the job's."""
    at: Vector = key("vector, animated", (0, 0, 0))
    """Moves it after that. Unit: length."""
    transform: Sequence[Step] | None = key("list of steps")
    """Moves the vdb within the body, after `place`; see Transforms. Default: none."""
    noise: Noise | None = key("map")
    """A density made of noise, see docs/job.md. Default: none."""
    shell: Shell | None = key("map")
    """An image around the body's origin, see docs/job.md. Default: none."""
    march: float = key("number", 0, low=0)
    """Biased, for comparison: goes in steps of this length, as if the density were that of a place
    of each step all along it. 0: unbiased tracking. Unit: length. Range: >= 0."""


@dataclass(kw_only=True, eq=False, repr=False)
class Emission(Described):
    """Glowing media."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("media.emission",)
    color: Color = key("colour, animated", 1, low=0)
    """Of the light. Range: >= 0."""
    strength: Number = key("number, animated", 1, low=0)
    """How much of it. Unit: W/(length³ sr). Range: >= 0."""
    grid: str | None = key("text")
    """A grid of numbers of the vdb that multiply it, instead of the density. Default: none."""
    temperature: str | None = key("text")
    """A grid of temperatures of the vdb: light of black bodies instead of the density, in
    proportion to the fourth power of the temperature; `strength` is that of 1500 K. Below 500 K
    there is none. Default: none."""
    kelvin: Number = key("number, animated", 1, low=0, above=True)
    """The temperature that a value of 1 stands for. Unit: K. Range: above 0."""


@dataclass(kw_only=True, eq=False, repr=False)
class Medium(Described):
    """Media."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("media",)
    like: str | None = key("text")
    """Copies that one's keys. Range: another medium. Default: none."""
    density: Color | Density | None = key("colour or map")
    """With `albedo`, instead of mean_free_path: scattering and absorption together. A map says how
    the medium varies from place to place, see docs/job.md. Unit: 1/length. Range: >= 0. Default:
    none."""
    preset: Literal["apple", "chicken-1", "chicken-2", "cream", "ketchup", "marble", "potato", "skim-milk", "skin-1", "skin-2", "spectralon", "whole-milk", "lowfat-milk", "reduced-milk", "regular-milk", "espresso", "mint-mocha-coffee", "lowfat-soy-milk", "regular-soy-milk", "lowfat-chocolate-milk", "regular-chocolate-milk", "coke", "pepsi", "sprite", "gatorade", "chardonnay", "white-zinfandel", "merlot", "budweiser-beer", "coors-light-beer", "clorox", "apple-juice", "cranberry-juice", "grape-juice", "ruby-grapefruit-juice", "white-grapefruit-juice", "shampoo", "strawberry-shampoo", "head-and-shoulders-shampoo", "lemon-tea-powder", "orange-juice-powder", "pink-lemonade-powder", "cappuccino-powder", "salt-powder", "sugar-powder", "suisse-mocha-powder", "pacific-ocean-surface-water"] | None = key(
        "choice", names=("apple", "chicken-1", "chicken-2", "cream", "ketchup", "marble",
        "potato", "skim-milk", "skin-1", "skin-2", "spectralon", "whole-milk", "lowfat-milk",
        "reduced-milk", "regular-milk", "espresso", "mint-mocha-coffee", "lowfat-soy-milk",
        "regular-soy-milk", "lowfat-chocolate-milk", "regular-chocolate-milk", "coke", "pepsi",
        "sprite", "gatorade", "chardonnay", "white-zinfandel", "merlot", "budweiser-beer",
        "coors-light-beer", "clorox", "apple-juice", "cranberry-juice", "grape-juice",
        "ruby-grapefruit-juice", "white-grapefruit-juice", "shampoo", "strawberry-shampoo",
        "head-and-shoulders-shampoo", "lemon-tea-powder", "orange-juice-powder",
        "pink-lemonade-powder", "cappuccino-powder", "salt-powder", "sugar-powder",
        "suisse-mocha-powder", "pacific-ocean-surface-water"),
    )
    """A measured material: absorption, scattering, `g` and `index`, whatever the job's `units`.
    Default: none."""
    absorption: Color = key("colour, animated", 0, low=0)
    """Share of the light that is swallowed per length. Unit: 1/length. Range: >= 0."""
    scattering: Color = key("colour, animated", 0, low=0)
    """Share of the light that is sent elsewhere per length. Unit: 1/length. Range: >= 0."""
    albedo: Color | None = key("colour, animated", low=0, high=1)
    """Instead of both: the share of scattering in scattering and absorption. Range: 0 to 1.
    Default: none."""
    mean_free_path: Color | None = key("colour, animated", low=0, above=True)
    """With `albedo`: how far light goes. Unit: length. Range: above 0. Default: none."""
    phase: Literal["henyey-greenstein", "rayleigh"] = key(
        "choice", "henyey-greenstein", names=("henyey-greenstein", "rayleigh"),
    )
    """Where light goes that is scattered. `rayleigh`: particles far smaller than the wavelength,
    such as air."""
    g: Color = key("colour, animated", 0, low=-1, high=1, above=True, below=True)
    """Mean cosine: 0 in all directions alike, towards 1 straight on, towards -1 back. Range: above
    -1, below 1."""
    g2: Color = key("colour, animated", 0, low=-1, high=1, above=True, below=True)
    """Of a second lobe. Range: above -1, below 1."""
    blend: Number = key("number, animated", 0, low=0, high=1)
    """Share of the second lobe. Range: 0 to 1."""
    index: Number | None = key("number, animated", low=0.01, high=100)
    """Index of refraction: a body of this medium that has no material is a smooth `dielectric` of
    it (`null` where it is 1). Range: 0.01 to 100. Default: none."""
    emission: Color | Emission | None = key("colour or map", low=0)
    """Light that the medium gives off itself, in all directions. Unit: W/(length³ sr). Range: >= 0.
    Default: `0`."""
    scale: Number = key("number, animated", 1, low=0)
    """Multiplies absorption and scattering, however they are given. Range: >= 0."""
    light_group: str | None = key("text")
    """Which light group that light belongs to; see Layers. Range: letters, digits, _ and -.
    Default: none."""
