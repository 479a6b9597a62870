"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from ..described import Described, key
from ..values import ColorInput, File, FileOrSequence, GroupName, MaterialName, MediumName, Number, TextureInput, Vector
from .transforms import Step
from .materials import Material
from .lights import Linking


@dataclass(kw_only=True, eq=False, repr=False)
class Emit(Described):
    """Emission."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.emit",)
    color: ColorInput = key("colour or texture", 1, low=0)
    """Times radiance or power; a texture makes screens, slides and windows of stained glass: see
    docs/job.md. Range: >= 0."""
    radiance: Number = key("number, animated", 1, low=0)
    """How bright it looks. Unit: W/(m² sr). Range: >= 0."""
    power: Number | None = key("number, animated", low=0)
    """Instead of radiance: what the whole shape gives off, whatever its size, its texture and the
    opacity of its material. Unit: W. Range: >= 0. Default: none."""
    two_sided: bool = key("switch", False)
    """Shines on the inner side too (the back of a rectangle or disk)."""
    spread: Number = key("number, animated", 180, low=0, high=180, above=True)
    """Twice the angle from the normal beyond which there is no light, as through the grid of a soft
    box: 1 - tan(angle) / tan(spread / 2) of the light comes through, made brighter so that the
    watts stay. Unit: degrees. Range: above 0, at most 180."""
    light_group: str | None = key("text")
    """Which light group its light belongs to; see Layers. Range: letters, digits, _ and -. Default:
    none."""
    light_linking: Linking | None = key("map")
    """The objects that it lights; see Linking. Default: none."""
    shadow_linking: Linking | None = key("map")
    """The objects that cast shadows in its light. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Displacement(Described):
    """Displacement."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.mesh.displacement",)
    texture: TextureInput = key("texture", required=True)
    """How high; its luminance where it has colours. Images are read as finely as they can be. `uv`
    and places are those before anything moves, in world space those of the object when the shutter
    opens; a mesh without uv needs a mapping by object or world. Colours and second coordinates of
    vertices are not for displacement. Required."""
    height: Number = key("number, animated", 1)
    """How far the texture's 1 lies from its 0; below 0 inwards. In the space of the mesh, before
    its transform. As it is when the shutter opens. With 0 the mesh is left as it is, which costs
    nothing. Unit: length."""
    midlevel: Number = key("number, animated", 0, low=0, high=1)
    """The texture's number at which the surface stays where it is (Blender's default is 0.5).
    Range: 0 to 1."""
    max_edge: float | None = key("number", low=0, above=True)
    """No edge is longer before it is moved. Without it 1/256 of the longest side of the mesh's
    bounds. Unit: length. Range: above 0. Default: none."""
    budget: int = key("whole number", 4000000, low=1, high=200000000)
    """More are refused before they are made; a million takes about 125 MB while the scene is made.
    Unit: triangles. Range: 1 to 200000000."""


@dataclass(kw_only=True, eq=False, repr=False)
class Object(Described):
    """Objects."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("objects",)
    like: str | None = key("text")
    """Copies that one's keys. Range: another object of the same list. Default: none."""
    material: MaterialName | None = key("a material's name")
    """What it is made of. Without it, that of the group around it; without that, what the `index`
    of its interior makes of it, or grey lambert. Range: a material. Default: none."""
    override: Mapping[str, str | Material | Mapping[str, Any]] | None = key("overrides")
    """Changes materials within this object, group or instance only: under a material's name the
    keys that are other, or another material's name, as in `{bark: {roughness: 0.2}, leaf: autumn}`.
    Of several around an object the outermost counts. Not for parts of mixtures and layers. Default:
    none."""
    at: Vector = key("vector, animated", (0, 0, 0))
    """Moves it, after `transform`. Unit: length."""
    transform: Sequence[Step] | None = key("list of steps")
    """From top to bottom; see Transform. Default: none."""
    visible_to_camera: bool = key("switch", True)
    """Whether the camera sees it directly; mirrors, shadows and light stay."""
    visible_to_diffuse: bool = key("switch", True)
    """Whether rays meet it that the diffuse part of a surface reflected; see Which rays see
    what."""
    visible_to_glossy: bool = key("switch", True)
    """Whether rays meet it that the rest of a surface reflected: mirrors and highlights."""
    visible_to_transmission: bool = key("switch", True)
    """Whether rays meet it that went through a surface: glass, leaves."""
    visible_to_volume: bool = key("switch", True)
    """Whether rays meet it that were scattered in a medium."""
    visible_to_shadow: bool = key("switch", True)
    """Whether it casts shadows."""
    holdout: bool = key("switch", False)
    """Where the camera sees it, or what is in it, the picture is black and transparent: a hole for
    what another picture shows. Light, mirrors and shadows know nothing of it."""


@dataclass(kw_only=True, eq=False, repr=False)
class Sphere(Object):
    """Sphere and disk."""

    TYPE: ClassVar[str] = "sphere"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.sphere", "objects.shapes", "objects.bodies")
    emit: Emit | None = key("map")
    """Makes it a lamp. Default: none."""
    radius: Number = key("number, animated", 1, low=0, above=True)
    """Unit: length. Range: above 0."""
    interior: MediumName | None = key("a medium's name")
    """What fills it; see Media. Range: a medium. Default: none."""
    exterior: MediumName | None = key("a medium's name")
    """What its author takes to be around it: the `atmosphere`, or what fills the body that it
    stands in. Where it is something else at any of some points around its surface, that is an
    error: nothing is changed by it. Range: a medium. Default: none."""
    priority: int = key("whole number", 0, low=-1000, high=1000)
    """Where bodies overlap, the one of the highest priority is there; see Bodies that overlap.
    Range: -1000 to 1000."""


@dataclass(kw_only=True, eq=False, repr=False)
class Rectangle(Object):
    """Rectangle."""

    TYPE: ClassVar[str] = "rectangle"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.rectangle", "objects.shapes", "objects.bodies")
    emit: Emit | None = key("map")
    """Makes it a lamp. Default: none."""
    size: Vector = key("pair, animated", (1, 1), low=0, above=True)
    """Extent along x and z. Unit: length. Range: above 0."""
    interior: MediumName | None = key("a medium's name")
    """What fills it; see Media. Range: a medium. Default: none."""
    exterior: MediumName | None = key("a medium's name")
    """What its author takes to be around it: the `atmosphere`, or what fills the body that it
    stands in. Where it is something else at any of some points around its surface, that is an
    error: nothing is changed by it. Range: a medium. Default: none."""
    priority: int = key("whole number", 0, low=-1000, high=1000)
    """Where bodies overlap, the one of the highest priority is there; see Bodies that overlap.
    Range: -1000 to 1000."""


@dataclass(kw_only=True, eq=False, repr=False)
class Disk(Object):
    """Sphere and disk."""

    TYPE: ClassVar[str] = "disk"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.disk", "objects.shapes", "objects.bodies")
    emit: Emit | None = key("map")
    """Makes it a lamp. Default: none."""
    radius: Number = key("number, animated", 1, low=0, above=True)
    """Unit: length. Range: above 0."""
    interior: MediumName | None = key("a medium's name")
    """What fills it; see Media. Range: a medium. Default: none."""
    exterior: MediumName | None = key("a medium's name")
    """What its author takes to be around it: the `atmosphere`, or what fills the body that it
    stands in. Where it is something else at any of some points around its surface, that is an
    error: nothing is changed by it. Range: a medium. Default: none."""
    priority: int = key("whole number", 0, low=-1000, high=1000)
    """Where bodies overlap, the one of the highest priority is there; see Bodies that overlap.
    Range: -1000 to 1000."""


@dataclass(kw_only=True, eq=False, repr=False)
class Box(Object):
    """Box."""

    TYPE: ClassVar[str] = "box"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.box", "objects.shapes", "objects.bodies")
    emit: Emit | None = key("map")
    """Makes it a lamp. Default: none."""
    size: Vector = key("vector, animated", (1, 1, 1), low=0, above=True)
    """Extent, centred on the origin. Unit: length. Range: above 0."""
    interior: MediumName | None = key("a medium's name")
    """What fills it; see Media. Range: a medium. Default: none."""
    exterior: MediumName | None = key("a medium's name")
    """What its author takes to be around it: the `atmosphere`, or what fills the body that it
    stands in. Where it is something else at any of some points around its surface, that is an
    error: nothing is changed by it. Range: a medium. Default: none."""
    priority: int = key("whole number", 0, low=-1000, high=1000)
    """Where bodies overlap, the one of the highest priority is there; see Bodies that overlap.
    Range: -1000 to 1000."""


@dataclass(kw_only=True, eq=False, repr=False)
class Cylinder(Object):
    """Cylinder."""

    TYPE: ClassVar[str] = "cylinder"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.cylinder", "objects.shapes", "objects.bodies")
    emit: Emit | None = key("map")
    """Makes it a lamp. Default: none."""
    radius: Number = key("number, animated", 1, low=0, above=True)
    """Unit: length. Range: above 0."""
    height: Number = key("number, animated", 1, low=0, above=True)
    """Unit: length. Range: above 0."""
    caps: bool = key("switch", True)
    """Closed at both ends."""
    interior: MediumName | None = key("a medium's name")
    """What fills it; see Media. Range: a medium. Default: none."""
    exterior: MediumName | None = key("a medium's name")
    """What its author takes to be around it: the `atmosphere`, or what fills the body that it
    stands in. Where it is something else at any of some points around its surface, that is an
    error: nothing is changed by it. Range: a medium. Default: none."""
    priority: int = key("whole number", 0, low=-1000, high=1000)
    """Where bodies overlap, the one of the highest priority is there; see Bodies that overlap.
    Range: -1000 to 1000."""


@dataclass(kw_only=True, eq=False, repr=False)
class Mesh(Object):
    """Mesh."""

    TYPE: ClassVar[str] = "mesh"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.mesh", "objects", "objects.shapes", "objects.bodies")
    mesh: FileOrSequence = key("file or sequence", required=True)
    """Triangles; with `#` in its name, as in `walk.####.ply`, a file for each frame. Range: OBJ,
    PLY. Default: none."""
    emit: Emit | None = key("map")
    """Makes it a lamp. Default: none."""
    normals: Literal["file", "flat", "smooth"] = key(
        "choice", "file", names=("file", "flat", "smooth"),
    )
    """Those of the file (flat where it has none, or some that are no numbers), facets, or averaged
    at the vertices."""
    part: str | None = key("text")
    """Only the triangles that an OBJ file puts behind `usemtl glass` (`default`: behind none).
    Range: a material of the file. Default: none."""
    displacement: Displacement | None = key("map")
    """Moves its surface by a texture; see Displacement. Default: none."""
    interior: MediumName | None = key("a medium's name")
    """What fills it; see Media. Range: a medium. Default: none."""
    exterior: MediumName | None = key("a medium's name")
    """What its author takes to be around it: the `atmosphere`, or what fills the body that it
    stands in. Where it is something else at any of some points around its surface, that is an
    error: nothing is changed by it. Range: a medium. Default: none."""
    priority: int = key("whole number", 0, low=-1000, high=1000)
    """Where bodies overlap, the one of the highest priority is there; see Bodies that overlap.
    Range: -1000 to 1000."""


@dataclass(kw_only=True, eq=False, repr=False)
class Curves(Object):
    """Curves."""

    TYPE: ClassVar[str] = "curves"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.curves", "objects")
    curves: File = key("file", required=True)
    """Strands of hair, fur or grass: see Curves. Range: HAIR. Default: none."""
    basis: Literal["catmull-rom", "bezier", "b-spline"] = key(
        "choice", "catmull-rom", names=("catmull-rom", "bezier", "b-spline"),
    )
    """What a strand's points mean: the curve goes through all of them (at least 2); cubic pieces of
    Bezier's that share their ends (4, 7, 10, ...); a uniform cubic B-spline (at least 4)."""


@dataclass(kw_only=True, eq=False, repr=False)
class Instance(Object):
    """Instance."""

    TYPE: ClassVar[str] = "instance"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.instance", "objects")
    instance: GroupName = key("a group's name", required=True)
    """All that the group holds, once more. Range: a group. Default: none."""
    places: File | None = key("file")
    """Copies of the group at all places of a file, up to millions; without it one, where the object
    is. Range: PLY. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class InPlaceGroup(Object):
    """Group."""

    TYPE: ClassVar[str] = "group"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.group", "objects")
    group: Group = key("map", required=True)
    """Objects that move together, written in place. Default: none."""
    objects: dict[str, Object] = key("entries")
    """As at the top level. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class GltfScene(Object):
    """GltfScene."""

    TYPE: ClassVar[str] = "gltf"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.gltf", "objects")
    gltf: File = key("file", required=True)
    """All objects of a glTF file, with their materials, pictures and lights; see Scenes of other
    tools. Range: .glb, .gltf. Default: none."""
    animation: str | None = key("text")
    """Of several animations the one that is meant: without it, the first; `none`: all stands still.
    Range: an animation of the glTF file, or none. Default: none."""
    loop: bool = key("switch", False)
    """Whether the animation of a glTF file begins again where it ends; else its last pose stays."""


@dataclass(kw_only=True, eq=False, repr=False)
class PbrtScene(Object):
    """PbrtScene."""

    TYPE: ClassVar[str] = "pbrt"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.pbrt", "objects")
    pbrt: File = key("file", required=True)
    """All objects of a pbrt-v4 file. Range: .pbrt. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class ObjScene(Object):
    """ObjScene."""

    TYPE: ClassVar[str] = "obj"
    SECTIONS: ClassVar[tuple[str, ...]] = ("objects.obj", "objects")
    obj: File = key("file", required=True)
    """All of an OBJ file, with the materials of its .mtl. Range: .obj. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Group(Described):
    """Groups."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("groups",)
    like: str | None = key("text")
    """Copies that one's keys. Range: another group. Default: none."""
    objects: dict[str, Object] = key("entries", required=True)
    """As at the top level. Required."""
