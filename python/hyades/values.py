"""What keys take: the types that hints name, and values that change over the frames of a job."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeAlias, Union, get_args, get_type_hints

from .errors import KeyRefused

if TYPE_CHECKING:
    import numpy

    from .job_types.materials import Material
    from .job_types.media import Medium
    from .job_types.objects import Group
    from .job_types.textures import Texture


@dataclass(frozen=True)
class Keys:
    """A value that moves from key to key: `Keys({1: 20, 48: 50}, ease="smooth")`.

    `keys` are values by frame number; `ease` says how the value moves between two of them, and
    `repeat` what comes before the first and after the last. See "Animation" in docs/job.md.
    """

    keys: Mapping[float, Any]
    ease: Literal["linear", "smooth", "step", "in", "out", "spline"] = "linear"
    repeat: Literal["none", "loop", "mirror"] = "none"

    def __post_init__(self) -> None:
        for name in ("ease", "repeat"):
            known = get_args(get_type_hints(Keys)[name])
            if getattr(self, name) not in known:
                raise KeyRefused(f"Keys.{name} is {getattr(self, name)!r}, expected one of {', '.join(map(repr, known))}")


class FileData(Protocol):
    """What can be written to a file beside the job: meshes, places and pictures."""

    def encode(self) -> tuple[bytes, str]:
        """The bytes of the file, and the end of its name: ".ply", say."""


# "Any" stands for arrays of numpy with as many numbers.
Number: TypeAlias = Union[float, str, Keys]
"""A number; an expression of the time `t` [s], such as "= 30 * t"; or Keys."""
Vector: TypeAlias = Union[Sequence[Union[float, str]], Keys, "numpy.ndarray[Any, Any]"]
"""Numbers or expressions, as many as the key says; or Keys of them."""
NumberOrVector: TypeAlias = Union[Number, Vector]
"""A vector, or one number for all axes."""
Color: TypeAlias = Union[Number, Vector]
"""Linear [r, g, b], one number (grey), "#d8c8a8" (sRGB), "3200K" (a black body), or Keys."""
ColorInput: TypeAlias = Union[Color, "Texture"]
"""A Color, a texture, or the name of one."""
NumberInput: TypeAlias = Union[Number, "Texture"]
"""A Number, a texture (whose luminance counts), or the name of one."""
TextureInput: TypeAlias = Union[str, "Texture"]
"""A texture, or the name of one."""
FrameRange: TypeAlias = Union[str, int, range]
"""A frame, "1-120", "1-120x2" or range(1, 121)."""
MaterialName: TypeAlias = Union[str, "Material"]
"""A material, or the name of one in the job."""
MediumName: TypeAlias = Union[str, "Medium"]
"""A medium, or the name of one in the job."""
GroupName: TypeAlias = Union[str, "Group"]
"""A group, or the name of one in the job."""
File: TypeAlias = Union[str, "os.PathLike[str]", FileData, "numpy.ndarray[Any, Any]"]
"""A path, relative to the current folder; or an array (h, w) or (h, w, c): a picture."""
FileOrSequence: TypeAlias = Union[File, Mapping[int, Union[FileData, str, "os.PathLike[str]"]]]
"""A path, a MeshData, or one for each frame: {1: MeshData(...), 2: ...}, {1: "fire1.vdb", 2: ...}."""
