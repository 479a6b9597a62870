#pragma once

#include <memory>

#include "core/media/density_field.h"

namespace hyades::core {

/// A density made of noise, within the bounds of a body, whose space is the field's.
struct NoiseDensity {
  Vec3 scale{1.0F};  ///< cells of the first octave per length
  Vec3 offset{0.0F};
  int octaves = 5;
  float lacunarity = 2.0F;  ///< >= 0
  float gain = 0.5F;        ///< >= 0
  float time = 0.0F;        ///< the fourth coordinate
  float low = 0.5F;         ///< where the noise, 0 to 1, is below, the density is 0
  float high = 0.7F;        ///< from here on it is 1
  float fade = 0.0F;        ///< share of the way to the middle on which the noise sinks below `low`
};

/// clamp((n + thinning - low) / (high - low), 0, 1), n = 1/2 + 1/2 fbm; thinning goes from 0 to -1
/// on the last `fade` of the way from the middle of `bounds` to the ellipsoid that fits in. A step
/// where high <= low. Between 0 and 1 by construction, whatever the noise.
std::shared_ptr<const DensityField> make_noise_density(const NoiseDensity& noise,
                                                       const Bounds& bounds);

}  // namespace hyades::core
