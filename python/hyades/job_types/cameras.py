"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from ..described import Described, key
from ..values import Number, Vector


@dataclass(kw_only=True, eq=False, repr=False)
class Exposure(Described):
    """Exposure."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("camera.exposure",)
    iso: float = key("number", 100, low=1, high=10000000)
    """Speed of the film. Range: 1 to 1e7."""
    shutter: float = key("number", 0.008, low=1e-09, high=1000000)
    """How long it is exposed. Unit: s. Range: 1e-9 to 1e6."""
    f_number: float = key("number", 16, low=0.01, high=10000)
    """Focal length over the lens's diameter. Range: 0.01 to 1e4."""
    efficacy: float = key("number", 97.4, low=0.001, high=683)
    """Luminous flux that one watt of the job stands for; the default is about that of sunlight
    above the air: some 133 klx of 1366 W/m² (published figures differ by a few percent). Unit:
    lm/W. Range: 0.001 to 683."""


@dataclass(kw_only=True, eq=False, repr=False)
class Aperture(Described):
    """Aperture."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("camera.aperture",)
    radius: Number = key("number, animated", 0, low=0)
    """Radius of the lens. Unit: length. Range: >= 0."""
    f_stop: Number | None = key("number, animated", low=0, above=True)
    """Perspective only, instead of radius: focal length / (2 f_stop), for the focal length that
    `fov` means on a sensor 24 mm high. Range: above 0. Default: none."""
    blades: int = key("whole number", 0, low=0, high=64)
    """Corners of the aperture; 0 is round. Range: 0, or 3 to 64."""
    rotation: Number = key("number, animated", 0)
    """Turns the aperture. Unit: degrees."""


@dataclass(kw_only=True, eq=False, repr=False)
class Camera(Described):
    """Camera."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("camera",)
    exposure: Exposure | None = key("map")
    """How bright pictures are, as on a camera; see Exposure. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Perspective(Camera):
    """Perspective."""

    TYPE: ClassVar[str] = "perspective"
    SECTIONS: ClassVar[tuple[str, ...]] = ("camera.perspective",)
    look_from: Vector = key("vector, animated", (0, 1, 5))
    """Where the camera stands. Unit: length."""
    look_at: Vector = key("vector, animated", (0, 0, 0))
    """The point in the middle of the picture. Unit: length. Range: not look_from."""
    up: Vector = key("vector, animated", (0, 1, 0))
    """What is up in the picture. Where it is parallel to the view: -z when looking down, +z when
    looking up. Range: not [0, 0, 0]."""
    fov: Number = key("number, animated", 40, low=0, high=180, above=True, below=True)
    """Vertical field of view. Unit: degrees. Range: above 0, below 180."""
    shift: Vector = key("pair, animated", (0, 0), low=-100, high=100)
    """Moves the picture to the right and up in its plane, as a view camera's back does: a level
    camera sees a tower's top, and its walls stay upright. `[0, 0.5]` has what lies straight ahead
    at its lower edge. Unit: picture's width, height. Range: -100 to 100."""
    aperture: Aperture | None = key("map")
    """A lens that blurs what is out of focus; without it, everything is sharp. Default: none."""
    focus: Number | None = key("number, animated, or an object's name", low=0, above=True)
    """What is sharp: a distance along the view axis, or the centre of an object, which must lie in
    front of the camera. Without it, `look_at`. Unit: length. Range: above 0. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Orthographic(Camera):
    """Orthographic."""

    TYPE: ClassVar[str] = "orthographic"
    SECTIONS: ClassVar[tuple[str, ...]] = ("camera.orthographic",)
    look_from: Vector = key("vector, animated", (0, 1, 5))
    """The middle of the plane in which rays begin. Unit: length."""
    look_at: Vector = key("vector, animated", (0, 0, 0))
    """A point in the middle of the picture. Unit: length. Range: not look_from."""
    up: Vector = key("vector, animated", (0, 1, 0))
    """What is up in the picture, as for perspective cameras. Range: not [0, 0, 0]."""
    height: Number = key("number, animated", 5, low=0, above=True)
    """How much the picture shows from top to bottom; its width follows from the film's. Unit:
    length. Range: above 0."""
    aperture: Aperture | None = key("map")
    """Blurs what is out of focus, by `radius` at the camera's plane and by as much as it is far
    from the focus; `f_stop` would need a focal length and is refused. Default: none."""
    focus: Number | None = key("number, animated, or an object's name", low=0, above=True)
    """What is sharp, as for perspective cameras. Unit: length. Range: above 0. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Equirectangular(Camera):
    """Equirectangular."""

    TYPE: ClassVar[str] = "equirectangular"
    SECTIONS: ClassVar[tuple[str, ...]] = ("camera.equirectangular",)
    look_from: Vector = key("vector, animated", (0, 1, 5))
    """Where the camera stands. Unit: length."""
    look_at: Vector = key("vector, animated", (0, 0, 0))
    """In the middle column, as seen from above: it turns the camera and does not tilt it. Where it
    is straight above or below: -z. Unit: length. Range: not look_from."""
    up: Vector = key("vector, animated", (0, 1, 0))
    """The direction of the whole top row. Range: not [0, 0, 0]."""
