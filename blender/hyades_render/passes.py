"""Passes of Blender and the layers of a job's EXR that they come from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy
from hyades import Layers

from .export import Complaint

_CALLED = {"motion": "forward"}  # layers by what their channels are called in files
_NO_LIGHT = ("Albedo", "Variance")  # colours that no exposure makes brighter
_FAR = 1e10  # what Blender holds for the depth of the background


@dataclass(frozen=True)
class Pass:
    """One pass: what Blender calls it, and which layers of a job (docs/job.md, Layers) make it."""

    name: str
    channels: str
    """R G B A, X Y Z W or Z: a letter for each."""
    kind: str
    """COLOR, VECTOR or VALUE."""
    layer: str
    """The job's; a Cryptomatte's is what the job calls all its ranks."""
    switch: str
    """Properties of the view layer that ask for it, any of them; `hyades.` and `cycles.` before those of the add-ons."""

    def wanted(self, view_layer: Any) -> bool:
        for switch in self.switch.split():
            owner, _, name = switch.rpartition(".")
            if getattr(getattr(view_layer, owner, None) if owner else view_layer, name, False):
                return True
        return False


def _light(name: str, layer: str, switch: str) -> Pass:
    return Pass(name, "RGB", "COLOR", layer, switch)


def _cryptomatte(thing: str) -> tuple[Pass, ...]:
    kind = f"crypto_{thing.lower()}"
    switch = f"use_pass_cryptomatte_{thing.lower()}"
    return tuple(Pass(f"Crypto{thing}{rank:02}", "RGBA", "COLOR", kind, switch) for rank in range(3))


PASSES = (
    Pass("Depth", "Z", "VALUE", "depth", "use_pass_z"),
    Pass("Position", "XYZ", "VECTOR", "position", "use_pass_position"),
    Pass("Normal", "XYZ", "VECTOR", "normal", "use_pass_normal"),
    Pass("Vector", "XYZW", "VECTOR", "motion", "use_pass_vector"),
    _light("DiffDir", "diffuse_direct", "use_pass_diffuse_direct"),
    _light("DiffInd", "diffuse_indirect", "use_pass_diffuse_indirect"),
    _light("GlossDir", "glossy_direct", "use_pass_glossy_direct"),
    _light("GlossInd", "glossy_indirect", "use_pass_glossy_indirect"),
    _light("TransDir", "transmission_direct", "use_pass_transmission_direct"),
    _light("TransInd", "transmission_indirect", "use_pass_transmission_indirect"),
    _light("VolumeDir", "volume_direct", "hyades.use_pass_volume_direct cycles.use_pass_volume_direct"),
    _light("VolumeInd", "volume_indirect", "hyades.use_pass_volume_indirect cycles.use_pass_volume_indirect"),
    _light("Emit", "emission", "use_pass_emit"),
    _light("Env", "environment", "use_pass_environment"),
    _light("Albedo", "albedo", "hyades.use_pass_albedo"),
    _light("Variance", "variance", "hyades.use_pass_variance"),
    Pass("Sample Count", "X", "VALUE", "samples", "hyades.use_pass_samples"),
    *_cryptomatte("Object"),
    *_cryptomatte("Material"),
)
_NOT_THERE = {
    "Mist": "use_pass_mist",
    "UV": "use_pass_uv",
    "Object Index": "use_pass_object_index",
    "Material Index": "use_pass_material_index",
    "DiffCol": "use_pass_diffuse_color",
    "GlossCol": "use_pass_glossy_color",
    "TransCol": "use_pass_transmission_color",
    "Shadow": "use_pass_shadow",
    "Ambient Occlusion": "use_pass_ambient_occlusion",
    "CryptoAsset": "use_pass_cryptomatte_asset",
    "Shadow Catcher": "cycles.use_pass_shadow_catcher",
    "Debug Sample Count": "cycles.pass_debug_sample_count",
    "Denoising Data": "cycles.denoising_store_passes",
}
"""Switches of a view layer for what jobs have not, by what Blender calls that."""
_COMBINED = Pass("Combined", "RGBA", "COLOR", "beauty", "use_pass_combined")
_NOISY = _light("Noisy Image", "beauty", "")


def asked_for(scene: Any, view_layer: Any) -> list[Pass]:
    """The passes of a view layer, Combined first."""
    noisy = [_NOISY] if scene.hyades.denoise != "none" else []
    return [_COMBINED, *noisy, *(one for one in PASSES if one.wanted(view_layer))]


def not_there(view_layer: Any) -> list[Complaint]:
    """What a view layer asks for that no job has."""
    names = [name for name, switch in _NOT_THERE.items() if Pass(name, "", "", "", switch).wanted(view_layer)]
    names += [f"AOV {one.name}" for one in getattr(view_layer, "aovs", ())]
    names += [f"light group {one.name}" for one in getattr(view_layer, "lightgroups", ())]
    where = f"view layer '{view_layer.name}'"
    return [Complaint(where, f"there are no passes {', '.join(names)}")] if names else []


def layers_for(passes: list[Pass]) -> list[str]:
    """The layers of the EXR that they are made of."""
    return list(dict.fromkeys(["beauty", "alpha", *(one.layer for one in passes)]))


def values(one: Pass, layers: Layers, transparent: bool, exposure: float = 1.0) -> numpy.ndarray | None:
    """A pass as Blender holds it: (pixels, channels) of floats, the bottom row first. None: the file has it not.
    `exposure`: by how much light is brighter than in the file."""
    if one.name == "Combined":
        light = layers.get("denoised", layers["beauty"]) * numpy.float32(exposure)
        return as_pixels(combined(light, layers["alpha"], transparent), 4)
    if one.name.startswith("Crypto"):
        picture = layers.get(one.name)
    else:
        picture = layers.get(_CALLED.get(one.layer, one.layer))
    if picture is None:
        return None
    if exposure != 1 and one.name not in _NO_LIGHT and one.kind == "COLOR" and not one.name.startswith("Crypto"):
        picture = picture * numpy.float32(exposure)
    change = _CHANGES.get(one.name)
    return as_pixels(change(picture) if change else picture, len(one.channels))


def combined(light: numpy.ndarray, alpha: numpy.ndarray, transparent: bool) -> numpy.ndarray:
    """Light and coverage as one picture of four channels; without `transparent` the background counts as covered."""
    picture = numpy.ones((*light.shape[:2], 4), numpy.float32)
    picture[:, :, :3] = light
    if transparent:
        picture[:, :, 3] = alpha
    return picture


def as_pixels(picture: numpy.ndarray, channels: int) -> numpy.ndarray:
    """(h, w[, channels]), top row first, as Blender's order of pixels."""
    shaped = picture.reshape(*picture.shape[:2], channels)
    return numpy.ascontiguousarray(shaped[::-1].reshape(-1, channels), numpy.float32)


def fill(render_pass: Any, pixels: numpy.ndarray) -> None:
    """Gives a pass its pixels. ValueError where they are not of its size."""
    expected = (len(render_pass.rect), render_pass.channels)
    if pixels.shape != expected:
        raise ValueError(f"pass {render_pass.name}: a picture of {pixels.shape}, expected {expected}")
    for shape in (expected, (-1,)):  # Blender 3 wants as many items as there are pixels, later ones all numbers
        try:
            render_pass.rect.foreach_set(pixels.reshape(shape))
            return
        except TypeError:
            continue
    render_pass.rect = pixels.tolist()


def cryptomattes(passes: list[Pass]) -> set[str]:
    """What the Cryptomattes among passes are called, without their ranks."""
    return {one.name[:-2] for one in passes if one.name.startswith("Crypto")}


def _depth(picture: numpy.ndarray) -> numpy.ndarray:
    return numpy.where(numpy.isfinite(picture), picture, _FAR)


def _z_up(picture: numpy.ndarray) -> numpy.ndarray:
    """Vectors of the job's world, where y is up, in Blender's."""
    return numpy.stack([picture[:, :, 0], -picture[:, :, 2], picture[:, :, 1]], axis=2)


def _speed(picture: numpy.ndarray) -> numpy.ndarray:
    """From the frame before and to the next one, as Cycles has them: where things were less where they will be.
    What the job tells is the way to the next frame; it counts for both."""
    return -numpy.concatenate([picture, picture], axis=2)


_CHANGES = {"Depth": _depth, "Position": _z_up, "Normal": _z_up, "Vector": _speed}
