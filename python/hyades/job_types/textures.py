"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from ..described import Described, key
from ..values import ColorInput, File, Number, NumberInput, NumberOrVector
from .transforms import Step


@dataclass(kw_only=True, eq=False, repr=False)
class TextureMapping(Described):
    """Mappings."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.mapping",)
    type: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] = key(
        "choice", "default", names=("default", "uv", "uv1", "object", "world", "planar",
        "spherical", "cylindrical", "triplanar"),
    )
    """Which coordinates a texture reads: see docs/job.md."""
    space: Literal["object", "world"] = key("choice", "object", names=("object", "world"))
    """Of planar, spherical, cylindrical and triplanar: where they are fixed."""
    transform: Sequence[Step] | None = key("list of steps")
    """Moves the place before it is mapped; steps as of objects, without motion blur. Default:
    none."""
    blend: Number = key("number, animated", 0.3, low=0, high=1)
    """Triplanar: how softly one side goes over into the next. Range: 0 to 1."""


@dataclass(kw_only=True, eq=False, repr=False)
class Texture(Described):
    """Textures."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("textures",)
    like: str | None = key("text")
    """Copies that one's keys. Range: another texture. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Constant(Texture):
    """One colour."""

    TYPE: ClassVar[str] = "constant"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.constant",)
    value: ColorInput = key("colour or texture", low=0, required=True)
    """The colour everywhere. Range: >= 0. Required."""


@dataclass(kw_only=True, eq=False, repr=False)
class Image(Texture):
    """Image."""

    TYPE: ClassVar[str] = "image"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.image",)
    file: File = key("file", required=True)
    """The picture; uv (0, 0) is its lower left corner. With `<UDIM>` in its name, several: see
    docs/job.md. Range: PNG, JPEG, TIFF, EXR, HDR, TGA, BMP, QOI, PPM, PGM, PFM. Required."""
    color_space: Literal["auto", "srgb", "linear"] = key(
        "choice", "auto", names=("auto", "srgb", "linear"),
    )
    """How its numbers are meant; `auto`: linear for EXR, HDR, PFM and TIFF of floats, sRGB for all
    others. Bump maps, displacement and roughness want `linear`."""
    wrap: Literal["repeat", "clamp", "mirror", "black"] | Sequence[Literal["repeat", "clamp", "mirror", "black"]] = key(
        "one or two choices", "repeat", names=("repeat", "clamp", "mirror", "black"),
    )
    """What lies outside 0..1: along u and v alike, or `[repeat, clamp]`."""
    filter: Literal["trilinear", "anisotropic", "bilinear", "nearest"] = key(
        "choice", "trilinear", names=("trilinear", "anisotropic", "bilinear", "nearest"),
    )
    """Between the image's pixels, and where the picture's pixels cover many of them: see
    docs/job.md."""
    channel: Literal["color", "red", "green", "blue", "alpha", "luminance"] = key(
        "choice", "color", names=("color", "red", "green", "blue", "alpha", "luminance"),
    )
    """The colour, or one of its numbers as a grey; alpha is 1 where the file has none."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """How it lies on surfaces: see Mappings. `default` is uv. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: repeats per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: repeats."""


@dataclass(kw_only=True, eq=False, repr=False)
class VertexColor(Texture):
    """Colours of vertices."""

    TYPE: ClassVar[str] = "vertex-color"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.vertex-color",)
    channel: Literal["color", "red", "green", "blue", "alpha", "luminance"] = key(
        "choice", "color", names=("color", "red", "green", "blue", "alpha", "luminance"),
    )
    """The colour, or one of its numbers as a grey; alpha is 1 where the file has none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Checker(Texture):
    """Patterns."""

    TYPE: ClassVar[str] = "checker"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.checker",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""


@dataclass(kw_only=True, eq=False, repr=False)
class Brick(Texture):
    """Bricks."""

    TYPE: ClassVar[str] = "brick"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.brick",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    mortar: Number = key("number, animated", 0.1, low=0, high=1)
    """Part of a cell's width and height that is mortar. Range: 0 to 1."""
    shift: Number = key("number, animated", 0.5, low=0, high=1)
    """How far every other row is moved. Unit: cells. Range: 0 to 1."""
    softness: Number = key("number, animated", 0, low=0, high=1)
    """Part of the way from an edge to the cell's middle on which one colour goes over into the
    other; bump maps need some. Range: 0 to 1."""


@dataclass(kw_only=True, eq=False, repr=False)
class Stripes(Texture):
    """Lines."""

    TYPE: ClassVar[str] = "stripes"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.stripes",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    width: Number = key("number, animated", 0.1, low=0, high=1)
    """How wide they are. Unit: cells. Range: 0 to 1."""
    softness: Number = key("number, animated", 0, low=0, high=1)
    """Part of the way from an edge to the cell's middle on which one colour goes over into the
    other; bump maps need some. Range: 0 to 1."""


@dataclass(kw_only=True, eq=False, repr=False)
class Grid(Texture):
    """Lines."""

    TYPE: ClassVar[str] = "grid"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.grid",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    width: Number = key("number, animated", 0.1, low=0, high=1)
    """How wide they are. Unit: cells. Range: 0 to 1."""
    softness: Number = key("number, animated", 0, low=0, high=1)
    """Part of the way from an edge to the cell's middle on which one colour goes over into the
    other; bump maps need some. Range: 0 to 1."""


@dataclass(kw_only=True, eq=False, repr=False)
class Gradient(Texture):
    """Gradients."""

    TYPE: ClassVar[str] = "gradient"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.gradient",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    shape: Literal["linear", "radial", "cylindrical", "spherical", "angular"] = key(
        "choice", "linear", names=("linear", "radial", "cylindrical", "spherical", "angular"),
    )
    """What goes from 0 to 1 within a cell, and stays there: x; the distance from the z axis, from
    the y axis, from the origin; the turn around the z axis."""


@dataclass(kw_only=True, eq=False, repr=False)
class Perlin3d(Texture):
    """Single octave by default."""

    TYPE: ClassVar[str] = "perlin3d"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.perlin3d",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    octaves: int = key("whole number", 1, low=1, high=16)
    """How many octaves. Range: 1 to 16."""
    lacunarity: Number = key("number, animated", 2, low=1, high=16)
    """How much finer each octave is than the one before. Range: 1 to 16."""
    gain: Number = key("number, animated", 0.5, low=0, high=4)
    """How much weaker or stronger it is. Range: 0 to 4."""


@dataclass(kw_only=True, eq=False, repr=False)
class Perlin4d(Texture):
    """Single octave by default."""

    TYPE: ClassVar[str] = "perlin4d"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.perlin4d",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    octaves: int = key("whole number", 1, low=1, high=16)
    """How many octaves. Range: 1 to 16."""
    lacunarity: Number = key("number, animated", 2, low=1, high=16)
    """How much finer each octave is than the one before. Range: 1 to 16."""
    gain: Number = key("number, animated", 0.5, low=0, high=4)
    """How much weaker or stronger it is. Range: 0 to 4."""
    time: Number = key("number, animated", 0)
    """The fourth coordinate: the pattern changes in place. Unit: cells."""


@dataclass(kw_only=True, eq=False, repr=False)
class Fbm3d(Texture):
    """Several octaves by default."""

    TYPE: ClassVar[str] = "fbm3d"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.fbm3d",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    octaves: int = key("whole number", 4, low=1, high=16)
    """How many octaves. Range: 1 to 16."""
    lacunarity: Number = key("number, animated", 2, low=1, high=16)
    """How much finer each octave is than the one before. Range: 1 to 16."""
    gain: Number = key("number, animated", 0.5, low=0, high=4)
    """How much weaker or stronger it is. Range: 0 to 4."""


@dataclass(kw_only=True, eq=False, repr=False)
class Fbm4d(Texture):
    """In time too."""

    TYPE: ClassVar[str] = "fbm4d"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.fbm4d",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    octaves: int = key("whole number", 4, low=1, high=16)
    """How many octaves. Range: 1 to 16."""
    lacunarity: Number = key("number, animated", 2, low=1, high=16)
    """How much finer each octave is than the one before. Range: 1 to 16."""
    gain: Number = key("number, animated", 0.5, low=0, high=4)
    """How much weaker or stronger it is. Range: 0 to 4."""
    time: Number = key("number, animated", 0)
    """The fourth coordinate: the pattern changes in place. Unit: cells."""


@dataclass(kw_only=True, eq=False, repr=False)
class Turbulence(Texture):
    """In time where it is given."""

    TYPE: ClassVar[str] = "turbulence"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.turbulence",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    octaves: int = key("whole number", 4, low=1, high=16)
    """How many octaves. Range: 1 to 16."""
    lacunarity: Number = key("number, animated", 2, low=1, high=16)
    """How much finer each octave is than the one before. Range: 1 to 16."""
    gain: Number = key("number, animated", 0.5, low=0, high=4)
    """How much weaker or stronger it is. Range: 0 to 4."""
    time: Number | None = key("number, animated")
    """The fourth coordinate; without it there are three, and the pattern costs about half. Unit:
    cells. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Ridged(Texture):
    """In time where it is given."""

    TYPE: ClassVar[str] = "ridged"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.ridged",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    octaves: int = key("whole number", 4, low=1, high=16)
    """How many octaves. Range: 1 to 16."""
    lacunarity: Number = key("number, animated", 2, low=1, high=16)
    """How much finer each octave is than the one before. Range: 1 to 16."""
    gain: Number = key("number, animated", 0.5, low=0, high=4)
    """How much weaker or stronger it is. Range: 0 to 4."""
    time: Number | None = key("number, animated")
    """The fourth coordinate; without it there are three, and the pattern costs about half. Unit:
    cells. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Marble(Texture):
    """Bent layers."""

    TYPE: ClassVar[str] = "marble"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.marble",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    octaves: int = key("whole number", 4, low=1, high=16)
    """How many octaves. Range: 1 to 16."""
    lacunarity: Number = key("number, animated", 2, low=1, high=16)
    """How much finer each octave is than the one before. Range: 1 to 16."""
    gain: Number = key("number, animated", 0.5, low=0, high=4)
    """How much weaker or stronger it is. Range: 0 to 4."""
    time: Number | None = key("number, animated")
    """The fourth coordinate; without it there are three, and the pattern costs about half. Unit:
    cells. Default: none."""
    distortion: Number = key("number, animated", 1)
    """How far noise moves the layers. Unit: cells."""


@dataclass(kw_only=True, eq=False, repr=False)
class Wood(Texture):
    """Bent layers."""

    TYPE: ClassVar[str] = "wood"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.wood",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    octaves: int = key("whole number", 4, low=1, high=16)
    """How many octaves. Range: 1 to 16."""
    lacunarity: Number = key("number, animated", 2, low=1, high=16)
    """How much finer each octave is than the one before. Range: 1 to 16."""
    gain: Number = key("number, animated", 0.5, low=0, high=4)
    """How much weaker or stronger it is. Range: 0 to 4."""
    time: Number | None = key("number, animated")
    """The fourth coordinate; without it there are three, and the pattern costs about half. Unit:
    cells. Default: none."""
    distortion: Number = key("number, animated", 1)
    """How far noise moves the layers. Unit: cells."""


@dataclass(kw_only=True, eq=False, repr=False)
class Cellular(Texture):
    """Cells."""

    TYPE: ClassVar[str] = "cellular"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.cellular",)
    a: ColorInput = key("colour or texture", 0, low=0)
    """Colour where the pattern is 0. Range: >= 0."""
    b: ColorInput = key("colour or texture", 1, low=0)
    """Colour where it is 1. Range: >= 0."""
    mapping: Literal["default", "uv", "uv1", "object", "world", "planar", "spherical", "cylindrical", "triplanar"] | TextureMapping | None = key(
        "type or map", names=("default", "uv", "uv1", "object", "world", "planar", "spherical",
        "cylindrical", "triplanar"),
    )
    """See Mappings. `default` is uv for checker, brick, stripes, grid and gradient, and object for
    the others. Default: `default`."""
    scale: NumberOrVector = key("scale, animated", (1, 1, 1))
    """Coordinate * scale + offset is looked up. Unit: cells per unit of the mapping."""
    offset: NumberOrVector = key("scale, animated", (0, 0, 0))
    """See scale. Unit: cells."""
    time: Number | None = key("number, animated")
    """The fourth coordinate; without it there are three, and the pattern costs about half. Unit:
    cells. Default: none."""
    metric: Literal["euclidean", "manhattan", "chebyshev"] = key(
        "choice", "euclidean", names=("euclidean", "manhattan", "chebyshev"),
    )
    """What distance is: as usual, the sum along the axes, or the largest of them."""
    feature: Literal["f1", "f2", "edges", "id"] = key(
        "choice", "f1", names=("f1", "f2", "edges", "id"),
    )
    """The distance to the nearest point, to the second nearest, what lies between the two (0 on the
    cells' edges), or a random number for each cell. What is above 1 counts as 1."""
    jitter: Number = key("number, animated", 1, low=0, high=1)
    """How irregular the points lie; 0: in the middles of the cells. Range: 0 to 1."""


@dataclass(kw_only=True, eq=False, repr=False)
class Scale(Texture):
    """Product."""

    TYPE: ClassVar[str] = "scale"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.scale",)
    input: ColorInput = key("colour or texture", low=0, required=True)
    """What is multiplied. Range: >= 0. Required."""
    factor: ColorInput = key("colour or texture", 1, low=0)
    """With what, channel by channel. Range: >= 0."""


@dataclass(kw_only=True, eq=False, repr=False)
class Add(Texture):
    """Of two."""

    TYPE: ClassVar[str] = "add"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.add",)
    a: ColorInput = key("colour or texture", low=0, required=True)
    """One. Range: >= 0. Required."""
    b: ColorInput = key("colour or texture", low=0, required=True)
    """The other. Range: >= 0. Required."""


@dataclass(kw_only=True, eq=False, repr=False)
class Divide(Texture):
    """Of two."""

    TYPE: ClassVar[str] = "divide"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.divide",)
    a: ColorInput = key("colour or texture", low=0, required=True)
    """One. Range: >= 0. Required."""
    b: ColorInput = key("colour or texture", low=0, required=True)
    """The other. Range: >= 0. Required."""


@dataclass(kw_only=True, eq=False, repr=False)
class Min(Texture):
    """Of two."""

    TYPE: ClassVar[str] = "min"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.min",)
    a: ColorInput = key("colour or texture", low=0, required=True)
    """One. Range: >= 0. Required."""
    b: ColorInput = key("colour or texture", low=0, required=True)
    """The other. Range: >= 0. Required."""


@dataclass(kw_only=True, eq=False, repr=False)
class Max(Texture):
    """Of two."""

    TYPE: ClassVar[str] = "max"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.max",)
    a: ColorInput = key("colour or texture", low=0, required=True)
    """One. Range: >= 0. Required."""
    b: ColorInput = key("colour or texture", low=0, required=True)
    """The other. Range: >= 0. Required."""


@dataclass(kw_only=True, eq=False, repr=False)
class Mix(Texture):
    """Mixture."""

    TYPE: ClassVar[str] = "mix"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.mix",)
    a: ColorInput = key("colour or texture", low=0, required=True)
    """One. Range: >= 0. Required."""
    b: ColorInput = key("colour or texture", low=0, required=True)
    """The other. Range: >= 0. Required."""
    amount: NumberInput = key("number or texture", 0.5, low=0, high=1)
    """Share of b. Range: 0 to 1."""


@dataclass(kw_only=True, eq=False, repr=False)
class Invert(Texture):
    """Of one."""

    TYPE: ClassVar[str] = "invert"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.invert",)
    input: ColorInput = key("colour or texture", low=0, required=True)
    """What is changed. `invert`: 1 - input. Range: >= 0. Required."""


@dataclass(kw_only=True, eq=False, repr=False)
class Remap(Texture):
    """Other ranges."""

    TYPE: ClassVar[str] = "remap"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.remap",)
    input: ColorInput = key("colour or texture", low=0, required=True)
    """What is changed. `invert`: 1 - input. Range: >= 0. Required."""
    low: Number = key("number, animated", 0)
    """Becomes to_low."""
    high: Number = key("number, animated", 1)
    """Becomes to_high; where it is low, there is a step."""
    to_low: Number = key("number, animated", 0)
    """See low."""
    to_high: Number = key("number, animated", 1)
    """See high."""
    ends: Literal["clamp", "smooth", "open"] = key(
        "choice", "clamp", names=("clamp", "smooth", "open"),
    )
    """What lies outside of low..high is held (`smooth`: without a kink), or goes on (`open`)."""


@dataclass(kw_only=True, eq=False, repr=False)
class Power(Texture):
    """Powers."""

    TYPE: ClassVar[str] = "power"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.power",)
    input: ColorInput = key("colour or texture", low=0, required=True)
    """What is changed. `invert`: 1 - input. Range: >= 0. Required."""
    exponent: Number = key("number, animated", low=0, required=True)
    """Input to the power of this, channel by channel. Range: >= 0. Required."""


@dataclass(kw_only=True, eq=False, repr=False)
class Threshold(Texture):
    """Steps."""

    TYPE: ClassVar[str] = "threshold"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.threshold",)
    input: ColorInput = key("colour or texture", low=0, required=True)
    """What is changed. `invert`: 1 - input. Range: >= 0. Required."""
    level: Number = key("number, animated", 0.5)
    """0 below, 1 above, channel by channel."""
    softness: Number = key("number, animated", 0, low=0)
    """Width over which it goes from 0 to 1. Range: >= 0."""


@dataclass(kw_only=True, eq=False, repr=False)
class Ramp(Texture):
    """Colour ramps."""

    TYPE: ClassVar[str] = "ramp"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.ramp",)
    input: NumberInput = key("number or texture", required=True)
    """The number. Required."""
    stops: Mapping[float, ColorInput] = key("stops", low=0, required=True)
    """What colours numbers get; beyond the first and last those of these. Range: two or more.
    Required."""
    between: Literal["linear", "smooth", "steps"] = key(
        "choice", "linear", names=("linear", "smooth", "steps"),
    )
    """How numbers between two stops mix them; `steps`: the lower one's colour."""


@dataclass(kw_only=True, eq=False, repr=False)
class HueSaturation(Texture):
    """Hue, saturation, value."""

    TYPE: ClassVar[str] = "hue-saturation"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.hue-saturation",)
    input: ColorInput = key("colour or texture", low=0, required=True)
    """What is changed. `invert`: 1 - input. Range: >= 0. Required."""
    hue: Number = key("number, animated", 0)
    """Turns the hue from red to green to blue. Unit: degrees."""
    saturation: Number = key("number, animated", 1, low=0)
    """Factor; 0 is grey, more than all colour is not possible. Range: >= 0."""
    value: Number = key("number, animated", 1, low=0)
    """Factor of the brightness. Range: >= 0."""


@dataclass(kw_only=True, eq=False, repr=False)
class Channel(Texture):
    """One channel."""

    TYPE: ClassVar[str] = "channel"
    SECTIONS: ClassVar[tuple[str, ...]] = ("textures.channel",)
    input: ColorInput = key("colour or texture", low=0, required=True)
    """What is changed. `invert`: 1 - input. Range: >= 0. Required."""
    channel: Literal["red", "green", "blue", "alpha", "luminance"] = key(
        "choice", required=True, names=("red", "green", "blue", "alpha", "luminance"),
    )
    """Which number becomes a grey; alpha is that of images, 1 of all else. Required."""
