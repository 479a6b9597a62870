#pragma once

#include "core/materials/make_material.h"

/// BSDFs of glass at one place, made in `arena`, for materials that are made of it.
namespace hyades::core {

/// Smooth interface; `ior` is the index of the side z < 0 over that of the other. Tints within
/// 0..1.
const Bsdf* smooth_dielectric_bsdf(float ior, const Rgb& transmission, const Rgb& reflection,
                                   bool scale_radiance, BsdfArena& arena);

/// An interface of GGX facets, other arguments as of smooth_dielectric_bsdf(); smooth where alpha
/// is below Ggx::kLeastAlpha.
const Bsdf* dielectric_bsdf(float ior, float alpha, const Rgb& transmission, const Rgb& reflection,
                            FacetScattering scattering, bool scale_radiance, BsdfArena& arena);

/// A sheet of that glass, smooth or rough on both sides alike.
const Bsdf* thin_dielectric_bsdf(float ior, float alpha, const Rgb& transmission,
                                 const Rgb& reflection, BsdfArena& arena);

}  // namespace hyades::core
