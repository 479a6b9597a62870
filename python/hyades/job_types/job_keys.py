"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from ..described import Described, key
from ..values import File, MediumName, FrameRange
from .settings import ColorManagement, Film, Frames, Render, Sampling
from .integrators import Integrator
from .cameras import Camera
from .textures import Texture
from .materials import Material
from .media import Medium
from .objects import Group, Object
from .lights import Environment, Light
from .outputs import Output


@dataclass(kw_only=True, eq=False, repr=False)
class JobKeys(Described):
    """The job itself."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("job",)
    include: File | Sequence[File] | None = key("files")
    """See Several files. Default: none."""
    name: str | None = key("text")
    """What the job is called; without it, the file's name, with `_` for what names cannot have.
    Part of default outputs, never of the picture. Default: none."""
    units: str | float = key(
        "units", "m", low=1e-12, high=1000000000000, names=("mm", "cm", "m", "km", "in", "ft"),
    )
    """How long one unit is. Unit: m."""
    frames: FrameRange | Frames | None = key("frames or map")
    """Which frames; see Frames. Default: none."""
    film: Film | None = key("map")
    """See Film. Default: none."""
    sampling: Sampling | None = key("map")
    """See Sampling. Default: none."""
    integrator: Integrator | None = key("map")
    """See Integrator. Default: `path`."""
    render: Render | None = key("map")
    """See Classes of machines. Default: none."""
    camera: Camera | None = key("map")
    """See Camera. Default: none."""
    textures: dict[str, Texture] = key("entries")
    """See Textures. Default: none."""
    materials: dict[str, Material] = key("entries")
    """See Materials. Default: none."""
    media: dict[str, Medium] = key("entries")
    """See Media. Default: none."""
    groups: dict[str, Group] = key("entries")
    """See Groups. Default: none."""
    objects: dict[str, Object] = key("entries")
    """See Objects. Default: none."""
    lights: dict[str, Light] = key("entries")
    """See Lights. Default: none."""
    environment: Environment | None = key("map")
    """Light from all around; see Environment. Without it, black. Default: none."""
    atmosphere: MediumName | None = key("a medium's name")
    """What fills all space outside of bodies, around the camera too; see Media. Range: a medium.
    Default: none."""
    keep_films: bool = key("switch", False)
    """Keeps each finished frame's film beside its pictures, as `<name>.####.film.exr`; see
    Films."""
    denoise: Literal[True, False, "features", "oidn"] = key(
        "choice", False, names=(True, False, "features", "oidn"),
    )
    """For outputs that do not say themselves; see Denoising."""
    color: ColorManagement | None = key("map")
    """See Colour management. Default: none."""
    outputs: list[Output] = key("list")
    """See Outputs. Range: at most 100. Default: none."""
