#pragma once

#include <string_view>

#include "core/base/vec.h"

namespace hyades::core::pbrt {

/// What an rgb triple means: pbrt-v4's ColorSpace, by its primaries and white.
struct RgbSpace {
  std::string_view name;
  glm::dmat3 to_xyz{1.0};  ///< columns: the primaries, of white (1, 1, 1) with Y = 1
};

/// srgb, dci-p3, rec2020 or aces2065-1, in any case; null for any other name.
const RgbSpace* find_rgb_space(std::string_view name);
const RgbSpace* srgb_space();

/// XYZ -> linear Rec.709; parts outside of it are negative.
Vec3d rec709_from_xyz(const Vec3d& xyz);

/// Light: rgb (1, 1, 1) is the space's own white, without adaptation. Negative parts become 0.
Rgb light_from_rgb(const RgbSpace& space, const Vec3d& rgb);

/// A reflectance or coefficient: rgb (1, 1, 1) is what leaves light's colour alone (adaptation of
/// Bradford from the space's white). Negative parts become 0.
Rgb surface_from_rgb(const RgbSpace& space, const Vec3d& rgb);

/// A colour with 0 where it has less: what lies outside of Rec.709.
Rgb without_negatives(const Vec3d& color);

/// XYZ of luminance 1 with chromaticity x, y.
Vec3d xyz_of_chromaticity(double x, double y);

}  // namespace hyades::core::pbrt
