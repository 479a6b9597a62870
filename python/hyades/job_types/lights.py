"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from ..described import Described, key
from ..values import Color, File, Number, Vector
from .transforms import Step


@dataclass(kw_only=True, eq=False, repr=False)
class Linking(Described):
    """Linking."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("linking",)
    include: Sequence[str] | None = key("texts")
    """Those that are lit, or cast shadows. Range: objects, and what is in them. Default: all."""
    exclude: Sequence[str] | None = key("texts")
    """Those that are not. Range: objects, and what is in them. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Light(Described):
    """Lights."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("lights",)
    like: str | None = key("text")
    """Copies that one's keys. Range: another light. Default: none."""
    transform: Sequence[Step] | None = key("list of steps")
    """Moves and turns it, after its place and direction; see Transform. Default: none."""
    visible_to_diffuse: bool = key("switch", True)
    """Whether it lights the diffuse part of surfaces; see Which rays see what."""
    visible_to_glossy: bool = key("switch", True)
    """Whether it lights the rest of them: highlights, and reflections of its ball."""
    visible_to_transmission: bool = key("switch", True)
    """Whether it lights surfaces from behind, and is seen through them."""
    visible_to_volume: bool = key("switch", True)
    """Whether it lights media."""
    light_linking: Linking | None = key("map")
    """The objects that it lights; see Linking. Default: none."""
    shadow_linking: Linking | None = key("map")
    """The objects that cast shadows in its light. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Point(Light):
    """Point."""

    TYPE: ClassVar[str] = "point"
    SECTIONS: ClassVar[tuple[str, ...]] = ("lights.point",)
    at: Vector = key("vector, animated", (0, 0, 0))
    """Where. Unit: length."""
    color: Color = key("colour, animated", 1, low=0)
    """Times power. Range: >= 0."""
    power: Number = key("number, animated", 10, low=0)
    """In all directions together. Unit: W. Range: >= 0."""
    radius: Number = key("number, animated", 0, low=0)
    """Of the ball that gives off the light: soft shadows, and highlights of its size. Cameras do
    not see it, mirrors do; within it there is no light. A `transform` moves it and leaves its size.
    Unit: length. Range: >= 0."""
    image: File | None = key("file")
    """How much goes where: a lat-long picture, laid around the light as that of the environment is
    around the scene and turned by the light's `transform`. Its colours multiply the light, 1 leaves
    it as it is. What a lamp's maker measures is said so: of an IES profile (`.ies`, LM-63,
    photometry of type C) with `power: 1` the light is the lamp itself, 177.83 lm being 1 W; down is
    -y, horizontal angles go from x towards -z. Range: a picture. Default: none."""
    light_group: str | None = key("text")
    """Which light group its light belongs to; see Layers. Range: letters, digits, _ and -. Default:
    none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Spot(Light):
    """Spot."""

    TYPE: ClassVar[str] = "spot"
    SECTIONS: ClassVar[tuple[str, ...]] = ("lights.spot",)
    at: Vector = key("vector, animated", (0, 0, 0))
    """Where. Unit: length."""
    color: Color = key("colour, animated", 1, low=0)
    """Times power. Range: >= 0."""
    power: Number = key("number, animated", 10, low=0)
    """As if it shone all round: narrowing the cone does not brighten it. Unit: W. Range: >= 0."""
    radius: Number = key("number, animated", 0, low=0)
    """Of the ball that gives off the light: soft shadows, and highlights of its size. Cameras do
    not see it, mirrors do; within it there is no light. A `transform` moves it and leaves its size.
    Unit: length. Range: >= 0."""
    look_at: Vector = key("vector, animated", (0, -1, 0))
    """The point in the middle of the cone. Unit: length. Range: not at."""
    angle: Number = key("number, animated", 30, low=0, high=180, above=True)
    """Between the axis and the edge of the cone. Unit: degrees. Range: above 0, at most 180."""
    blend: Number = key("number, animated", 0.2, low=0, high=1)
    """Outer share of the angle in which it fades. Range: 0 to 1."""
    light_group: str | None = key("text")
    """Which light group its light belongs to; see Layers. Range: letters, digits, _ and -. Default:
    none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Projector(Light):
    """Projector."""

    TYPE: ClassVar[str] = "projector"
    SECTIONS: ClassVar[tuple[str, ...]] = ("lights.projector",)
    at: Vector = key("vector, animated", (0, 0, 0))
    """Where. Unit: length."""
    color: Color = key("colour, animated", 1, low=0)
    """Times power. Range: >= 0."""
    power: Number = key("number, animated", 10, low=0)
    """As if it shone all round and in white: a smaller picture is not brighter. Unit: W. Range: >=
    0."""
    radius: Number = key("number, animated", 0, low=0)
    """Of the ball that gives off the light: soft shadows, and highlights of its size. Cameras do
    not see it, mirrors do; within it there is no light. A `transform` moves it and leaves its size.
    Unit: length. Range: >= 0."""
    look_at: Vector = key("vector, animated", (0, -1, 0))
    """The point in the middle of the picture. Unit: length. Range: not at."""
    up: Vector = key("vector, animated", (0, 1, 0))
    """Where the picture's top is, as far as that goes. Range: not [0, 0, 0]."""
    fov: Number = key("number, animated", 40, low=0, high=180, above=True, below=True)
    """Across the picture's shorter side. Unit: degrees. Range: above 0, below 180."""
    image: File = key("file", required=True)
    """What it throws; colours multiply the light. Range: a picture. Required."""
    light_group: str | None = key("text")
    """Which light group its light belongs to; see Layers. Range: letters, digits, _ and -. Default:
    none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Sun(Light):
    """Sun."""

    TYPE: ClassVar[str] = "sun"
    SECTIONS: ClassVar[tuple[str, ...]] = ("lights.sun",)
    direction: Vector = key("vector, animated", (0, -1, 0))
    """The way its light travels. Range: not [0, 0, 0]."""
    color: Color = key("colour, animated", 1, low=0)
    """Times irradiance. Range: >= 0."""
    irradiance: Number = key("number, animated", 1, low=0)
    """On a surface that faces it. Unit: W/m². Range: >= 0."""
    angle: Number = key("number, animated", 0.53, low=0, high=90)
    """Its diameter: soft shadows. 0 is a point infinitely far away. Unit: degrees. Range: 0 to
    90."""
    light_group: str | None = key("text")
    """Which light group its light belongs to; see Layers. Range: letters, digits, _ and -. Default:
    none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Sky(Described):
    """Sky."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("environment.sky",)
    elevation: Number = key("number, animated", 30, low=-90, high=90)
    """How high the sun stands above the horizon. Unit: degrees. Range: -90 to 90."""
    azimuth: Number = key("number, animated", 0)
    """Where it stands: 0 is -z, 90 is -x (counter-clockwise seen from above). Unit: degrees."""
    sun_direction: Vector | None = key("vector, animated")
    """Towards the sun; instead of elevation and azimuth. Range: not [0, 0, 0]. Default: none."""
    turbidity: Number = key("number, animated", 3, low=1, high=10)
    """How hazy: optical thickness of air and haze over that of air alone. 1 is pure air, 2 a clear
    day. Range: 1 to 10."""
    ground_albedo: Color = key("colour, animated", 0.3, low=0, high=1)
    """Share of light that the ground throws back: it is seen below the horizon and brightens the
    air. Range: 0 to 1."""
    irradiance: Number = key("number, animated", 4, low=0)
    """Of the sun above the air, on a surface that faces it, in each channel. The true one is 1361;
    4 suits pictures without `exposure`. Unit: W/m². Range: >= 0."""
    sun: bool = key("switch", True)
    """Whether the sun's disc shines."""
    sun_size: Number = key("number, animated", 0.53, low=0, high=90)
    """Its diameter; larger ones make softer shadows at the same light. Unit: degrees. Range: 0 to
    90."""


@dataclass(kw_only=True, eq=False, repr=False)
class Environment(Described):
    """Environment."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("environment",)
    image: File | None = key("file")
    """A panorama (longitude, latitude); its top is +y. Range: as of image textures. Default:
    none."""
    sky: Sky | None = key("map")
    """A clear sky with its sun, instead of an image; see Sky. Default: none."""
    color: Color = key("colour, animated", 1, low=0)
    """Light from everywhere, or a tint of the image. Unit: W/(m² sr). Range: >= 0."""
    rotate_y: Number = key("number, animated", 0)
    """Turns it, counter-clockwise seen from above. Unit: degrees."""
    strength: Number = key("number, animated", 1, low=0)
    """Makes it brighter or darker. Range: >= 0."""
    visible_to_camera: bool = key("switch", True)
    """Whether the camera sees it directly; where not, the picture is transparent."""
    visible_to_diffuse: bool = key("switch", True)
    """Whether it lights the diffuse part of surfaces; see Which rays see what."""
    visible_to_glossy: bool = key("switch", True)
    """Whether the rest of them reflects it."""
    visible_to_transmission: bool = key("switch", True)
    """Whether it is seen through surfaces."""
    visible_to_volume: bool = key("switch", True)
    """Whether it lights media."""
    light_group: str | None = key("text")
    """Which light group its light belongs to; see Layers. Range: letters, digits, _ and -. Default:
    none."""
    light_linking: Linking | None = key("map")
    """The objects that it lights; see Linking. Default: none."""
    shadow_linking: Linking | None = key("map")
    """The objects that cast shadows in its light. Default: none."""
