#pragma once

#include "core/materials/make_material.h"

namespace hyades::core {

/// Two-sided matt surface of reflectance `color` whose facets lean by `roughness` (0: Lambert):
/// Oren and Nayar's (1994) in the form of Portsmouth, Kutz and Hill 2024, "EON: A Practical
/// Energy-Preserving Rough Diffuse BRDF", which keeps all light where `color` is white.
MaterialPtr make_rough_matt(const ColorParam& color, const ScalarParam& roughness);

/// Thin matt sheet: `color` is reflected, `transmitted` comes out on the other side, both evenly in
/// all directions. Where both add up to more than 1, they are scaled to 1.
MaterialPtr make_diffuse_transmission(const ColorParam& color, const ColorParam& transmitted);

}  // namespace hyades::core
