"""Made by python/generator/generate of the reader's own list of keys and of docs/job.md. Do not edit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from ..described import Described, key
from ..values import Color, ColorInput, MaterialName, Number, NumberInput, TextureInput


@dataclass(kw_only=True, eq=False, repr=False)
class Bump(Described):
    """Bump."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.bump",)
    texture: TextureInput = key("texture", required=True)
    """The height. Required."""
    height: Number = key("number, animated", 0.01)
    """How high the texture's value 1 is; negative turns hills into dents. Unit: length."""
    strength: NumberInput = key("number or texture", 1, low=0, high=100)
    """How much of the way the normal turns: mixes the smooth normal (0) and the wrinkled one (1).
    Unlike less height it leaves steep slopes their shape. Range: 0 to 100."""


@dataclass(kw_only=True, eq=False, repr=False)
class NormalMap(Described):
    """Normal map."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.normal_map",)
    texture: TextureInput = key("texture", required=True)
    """The normals. Required."""
    strength: NumberInput = key("number or texture", 1, low=0, high=100)
    """Multiplies x and y. Range: 0 to 100."""


@dataclass(kw_only=True, eq=False, repr=False)
class Subsurface(Described):
    """What fills it."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.subsurface.body",)
    radius: Color = key("colour, animated", low=0, above=True, required=True)
    """How far light goes until it has lost its direction (the transport mean free path), per
    channel. Unit: length. Range: above 0. Required."""
    color: Color = key("colour, animated", 0.8, low=0, high=1)
    """What a thick body looks like. Range: 0 to 1."""
    scale: Number = key("number, animated", 1, low=0, above=True)
    """Multiplies radius. Range: above 0."""
    g: Number = key("number, animated", 0, low=-1, high=1, above=True, below=True)
    """Mean cosine of a scattering. Color and radius stay what they are. Range: above -1, below
    1."""


@dataclass(kw_only=True, eq=False, repr=False)
class Material(Described):
    """Materials."""

    SECTIONS: ClassVar[tuple[str, ...]] = ("materials",)
    like: str | None = key("text")
    """Copies that one's keys. Range: another material. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Lambert(Material):
    """Matt."""

    TYPE: ClassVar[str] = "lambert"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.lambert", "materials.solids", "materials.surfaces")
    color: ColorInput = key("colour or texture", 0.5, low=0, high=1)
    """Share of the light that comes back. Range: 0 to 1."""
    roughness: NumberInput = key("number or texture", 0, low=0, high=1)
    """Facets that throw light back to where it came from, as of clay, plaster or the moon: Oren and
    Nayar's, in the energy-preserving form of Portsmouth, Kutz and Hill (2024). Range: 0 to 1."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Principled(Material):
    """Principled."""

    TYPE: ClassVar[str] = "principled"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.principled", "materials.solids", "materials.surfaces", "materials.subsurface")
    base_color: ColorInput = key("colour or texture", 0.8, low=0, high=1)
    """Colour of the body; of metal seen straight on; of glass, once through it and out again.
    Range: 0 to 1."""
    metallic: NumberInput = key("number or texture", 0, low=0, high=1)
    """Share of metal. Range: 0 to 1."""
    roughness: NumberInput = key("number or texture", 0.5, low=0, high=1)
    """Of metal, glass, and the facets over the body; 0 is a mirror. Range: 0 to 1."""
    ior: Number = key("number, animated", 1.5, low=1, high=100)
    """Index of refraction of what is not metal. Range: 1 to 100."""
    specular: NumberInput = key("number or texture", 0.5, low=0, high=1)
    """How much the facets over the body reflect: 0 nothing, 0.5 what `ior` says, 1 twice that.
    Range: 0 to 1."""
    specular_tint: ColorInput = key("colour or texture", 1, low=0, high=1)
    """Tint of what these reflect, and of metal near its edge. Range: 0 to 1."""
    anisotropic: NumberInput = key("number or texture", 0, low=0, high=1)
    """Stretches highlights of metal and body across the tangent (of growing u), as on brushed
    metal. Range: 0 to 1."""
    anisotropic_rotation: NumberInput = key("number or texture", 0, low=0, high=1)
    """Turns the tangent. Unit: turns. Range: 0 to 1."""
    roughness_along: NumberInput | None = key("number or texture", low=0, high=1)
    """In place of anisotropic: roughness along the tangent, while `roughness` is that across it;
    facets of which one width is more than ten times the other count as ten times. Range: 0 to 1.
    Default: none."""
    transmission: NumberInput = key("number or texture", 0, low=0, high=1)
    """Share of glass in what is not metal; light goes into the body. Range: 0 to 1."""
    coat: NumberInput = key("number or texture", 0, low=0, high=1)
    """How much of it is covered with clear varnish. Range: 0 to 1."""
    coat_roughness: NumberInput = key("number or texture", 0.03, low=0, high=1)
    """Of the varnish. Range: 0 to 1."""
    coat_ior: Number = key("number, animated", 1.5, low=1, high=100)
    """Of the varnish. Range: 1 to 100."""
    sheen: NumberInput = key("number or texture", 0, low=0, high=1)
    """Fuzz that glows towards the edge, as of cloth. Range: 0 to 1."""
    sheen_tint: ColorInput = key("colour or texture", 1, low=0, high=1)
    """Its colour. Range: 0 to 1."""
    sheen_roughness: NumberInput = key("number or texture", 0.5, low=0, high=1)
    """How disorderly it is; below 0.3 as 0.3. Range: 0 to 1."""
    thin_walled: bool = key("switch", False)
    """A sheet without an inside: leaves, paper, bubbles. Its glass is that of `thin-dielectric`."""
    diffuse_transmission: NumberInput = key("number or texture", 0, low=0, high=1)
    """Share of the body's light that comes out on the other side. Range: 0 to 1; above 0 with
    thin_walled only."""
    emission_color: ColorInput = key("colour or texture", 1, low=0)
    """Times emission_strength; a texture as with `emit`. Range: >= 0."""
    emission_strength: Number = key("number, animated", 0, low=0)
    """Makes objects of this material lamps, as `emit` does, which comes first where an object has
    it; thin walls shine on both sides. Not for parts of other materials. Unit: W/(m² sr). Range: >=
    0."""
    multiple_scattering: bool = key("switch", True)
    """Gives back the light that facets of metal and glass throw onto each other; without it these
    darken where they are rough."""
    scale_radiance: bool = key("switch", True)
    """Of glass: see Frosted glass."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""
    subsurface: Subsurface | None = key("map")
    """Fills bodies of this material that have no `interior` of their own: wax, skin, marble.
    Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Dielectric(Material):
    """Frosted glass."""

    TYPE: ClassVar[str] = "dielectric"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.dielectric", "materials.solids", "materials.surfaces", "materials.subsurface")
    multiple_scattering: bool = key("switch", True)
    """Gives back the light that facets throw onto each other, nearly diffuse, on both sides (Kulla
    and Conty 2017); without it rough glass darkens."""
    scale_radiance: bool = key("switch", True)
    """Light that is refracted into glass of index n is n² times as bright there, and 1/n² when it
    leaves, as physics has it (Veach 1997, section 5.2). Off: it stays as it is, as in Cycles, which
    shows where the camera or a lamp is in the glass, or where glass has no other side."""
    roughness: NumberInput = key("number or texture", 0, low=0, high=1)
    """GGX microfacets with alpha = roughness²; 0 is smooth. A pane blurs alike what it reflects and
    what it lets through, and loses nothing. Range: 0 to 1."""
    ior: Number = key("number, animated", 1.5, low=0.01, high=100)
    """Index of refraction, inside against outside. Range: 0.01 to 100."""
    transmission: Color = key("colour, animated", 1, low=0, high=1)
    """Tint of what goes through, once per crossing. Range: 0 to 1."""
    reflection: Color = key("colour, animated", 1, low=0, high=1)
    """Tint of what is reflected; physical glass has 1. Range: 0 to 1."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""
    subsurface: Subsurface | None = key("map")
    """Fills bodies of this material that have no `interior` of their own: wax, skin, marble.
    Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class ThinDielectric(Material):
    """Glass and panes."""

    TYPE: ClassVar[str] = "thin-dielectric"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.thin-dielectric", "materials.solids", "materials.surfaces")
    roughness: NumberInput = key("number or texture", 0, low=0, high=1)
    """GGX microfacets with alpha = roughness²; 0 is smooth. A pane blurs alike what it reflects and
    what it lets through, and loses nothing. Range: 0 to 1."""
    ior: Number = key("number, animated", 1.5, low=0.01, high=100)
    """Index of refraction, inside against outside. Range: 0.01 to 100."""
    transmission: Color = key("colour, animated", 1, low=0, high=1)
    """Tint of what goes through, once per crossing. Range: 0 to 1."""
    reflection: Color = key("colour, animated", 1, low=0, high=1)
    """Tint of what is reflected; physical glass has 1. Range: 0 to 1."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Conductor(Material):
    """Metal."""

    TYPE: ClassVar[str] = "conductor"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.conductor", "materials.solids", "materials.surfaces")
    metal: Literal["aluminium", "brass", "chromium", "cobalt", "copper", "gold", "iron", "nickel", "palladium", "platinum", "silver", "titanium", "tungsten"] = key(
        "choice", "gold", names=("aluminium", "brass", "chromium", "cobalt", "copper", "gold",
        "iron", "nickel", "palladium", "platinum", "silver", "titanium", "tungsten"),
    )
    """Measured index of refraction."""
    eta: Color | None = key("colour, animated", low=0, high=100, above=True)
    """With k, instead of metal: real part of the index. Range: above 0, at most 100. Default:
    none."""
    k: Color | None = key("colour, animated", low=0, high=100)
    """Its imaginary part. Range: 0 to 100. Default: none."""
    color: ColorInput | None = key("colour or texture", low=0, high=1)
    """Instead of metal, eta and k: what it reflects straight on. Range: 0 to 1. Default: none."""
    edge: ColorInput = key("colour or texture", 1, low=0, high=1)
    """With color: how bright it grows towards the edge, from 0, where it hardly does, to 1
    (Gulbrandsen 2014). Range: 0 to 1."""
    roughness: NumberInput = key("number or texture", 0, low=0, high=1)
    """0 is a mirror. Range: 0 to 1."""
    multiple_scattering: bool = key("switch", True)
    """Gives back the light that facets reflect onto each other, nearly diffuse (Kulla and Conty
    2017); without it rough metals darken."""
    reflection: Color = key("colour, animated", 1, low=0, high=1)
    """Tint. Range: 0 to 1."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Glossy(Material):
    """Glossy."""

    TYPE: ClassVar[str] = "glossy"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.glossy", "materials.solids", "materials.surfaces")
    color: ColorInput = key("colour or texture", 0.5, low=0, high=1)
    """Share of the light that comes back. Range: 0 to 1."""
    reflectiveness: NumberInput = key("number or texture", 0.5, low=0, high=1)
    """0 is matt, 1 only mirrors. Range: 0 to 1."""
    glossiness: NumberInput = key("number or texture", 0.8, low=0, high=1)
    """How sharp the mirror image is; 1 is perfect. Range: 0 to 1."""
    multiple_scattering: bool = key("switch", False)
    """Gives back the light that facets reflect onto each other; without it dull lobes darken."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Mirror(Material):
    """Mirror."""

    TYPE: ClassVar[str] = "mirror"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.mirror", "materials.solids", "materials.surfaces")
    color: ColorInput = key("colour or texture", 1, low=0, high=1)
    """Share of the light that is reflected, at any angle. Range: 0 to 1."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class DiffuseTransmission(Material):
    """Leaf and paper."""

    TYPE: ClassVar[str] = "diffuse-transmission"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.diffuse-transmission", "materials.solids", "materials.surfaces")
    color: ColorInput = key("colour or texture", 0.5, low=0, high=1)
    """Share of the light that comes back. Range: 0 to 1."""
    transmitted: ColorInput = key("colour or texture", 0.5, low=0, high=1)
    """Share that goes through; where both are more than 1 together, both are scaled down. Range: 0
    to 1."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Mix(Material):
    """Mixture."""

    TYPE: ClassVar[str] = "mix"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.mix", "materials.solids", "materials.surfaces")
    first: MaterialName = key("a material's name", required=True)
    """One material. Range: a material. Required."""
    second: MaterialName = key("a material's name", required=True)
    """The other. Range: a material. Required."""
    amount: NumberInput = key("number or texture", 0.5, low=0, high=1)
    """Share of `second`. Range: 0 to 1."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Coat(Material):
    """Coat."""

    TYPE: ClassVar[str] = "coat"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.coat", "materials.solids", "materials.surfaces")
    base: MaterialName = key("a material's name", required=True)
    """What lies beneath, with its own bumps (where they lean away from the coat's own normal some
    light is lost: 2 to 5 % at 30 degrees, up to 7 % at 60). Range: a material. Required."""
    ior: Number = key("number, animated", 1.5, low=1, high=100)
    """Index of refraction. Range: 1 to 100."""
    roughness: NumberInput = key("number or texture", 0, low=0, high=1)
    """0 is a mirror. Range: 0 to 1."""
    amount: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much is covered. Range: 0 to 1."""
    color: ColorInput = key("colour or texture", 1, low=0, high=1)
    """What light keeps that goes straight in and out; less on slanted ways (Bouguer's law). Range:
    0 to 1."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Sheen(Material):
    """Sheen."""

    TYPE: ClassVar[str] = "sheen"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.sheen", "materials.solids", "materials.surfaces")
    base: MaterialName | None = key("a material's name")
    """What lies beneath; without it, black. Range: a material. Default: none."""
    color: ColorInput = key("colour or texture", 1, low=0, high=1)
    """Of the fuzz. Range: 0 to 1."""
    roughness: NumberInput = key("number or texture", 0.5, low=0, high=1)
    """How disorderly it is; below 0.3 as 0.3. Range: 0 to 1."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class TwoSided(Material):
    """Two sides."""

    TYPE: ClassVar[str] = "two-sided"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.two-sided", "materials.solids", "materials.surfaces")
    front: MaterialName = key("a material's name", required=True)
    """On the outer side, where normals point. Range: a material. Required."""
    back: MaterialName = key("a material's name", required=True)
    """On the other one. Range: a material. Required."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
    bump: Bump | None = key("map")
    """Wrinkles that turn the shading normal. Default: none."""
    normal_map: NormalMap | None = key("map")
    """An image of normals that turns the shading normal, after `bump`. Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Hair(Material):
    """Hair."""

    TYPE: ClassVar[str] = "hair"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.hair", "materials.solids")
    color: ColorInput | None = key("colour or texture", low=0, high=1)
    """What much of this hair looks like; of a single strand less is seen. Range: 0 to 1. Default:
    none."""
    absorption: Color | None = key("colour, animated", low=0)
    """What light loses on the way of a strand's radius. Range: >= 0. Default: none."""
    eumelanin: Number = key("number, animated", 1.3, low=0)
    """Pigment of brown and black hair: 0.3 is blond, 1.3 brown, 8 black. Range: >= 0."""
    pheomelanin: Number = key("number, animated", 0, low=0)
    """Pigment of red hair, beside an `eumelanin` of 0.3 or less. Range: >= 0."""
    roughness: NumberInput = key("number or texture", 0.3, low=0, high=1)
    """How widely light is spread along the strand. Range: 0 to 1."""
    radial_roughness: NumberInput = key("number or texture", 0.3, low=0, high=1)
    """How widely around it. Range: 0 to 1."""
    ior: Number = key("number, animated", 1.55, low=1, high=100)
    """Index of refraction. Range: 1 to 100."""
    tilt: Number = key("number, animated", 2, low=-45, high=45)
    """How far the scales stand off at their ends towards the tip, which moves the highlight towards
    the root. Unit: degrees. Range: -45 to 45."""
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""


@dataclass(kw_only=True, eq=False, repr=False)
class NullMaterial(Material):
    """NullMaterial."""

    TYPE: ClassVar[str] = "null"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.null", "materials.subsurface")
    subsurface: Subsurface | None = key("map")
    """Fills bodies of this material that have no `interior` of their own: wax, skin, marble.
    Default: none."""


@dataclass(kw_only=True, eq=False, repr=False)
class Black(Material):
    """Black."""

    TYPE: ClassVar[str] = "black"
    SECTIONS: ClassVar[tuple[str, ...]] = ("materials.black", "materials.solids")
    opacity: NumberInput = key("number or texture", 1, low=0, high=1)
    """How much of it is there: leaves from an image of a leaf, fading smoke. The rest of the light
    passes straight on, to the camera and in shadows, as if nothing were there, and counts no event.
    A mix of materials with an opacity has the mean of theirs. What is not there does not shine
    either: the opacity of a lamp scales its light. Range: 0 to 1."""
    sides: Literal["both", "front"] = key("choice", "both", names=("both", "front"))
    """Which sides of an object the camera sees; see docs/job.md."""
