#pragma once

#include <optional>

#include "core/job/animated.h"

namespace hyades::core {

/// A density made of noise, within the bounds of the body that it fills.
struct NoiseDensityDesc {
  Animated<Vec3> scale{Vec3(1.0F)};  ///< cells per length
  Animated<Vec3> offset{Vec3(0.0F)};
  int octaves = 5;
  float lacunarity = 2.0F;
  float gain = 0.5F;
  Animated<float> time{0.0F};  ///< the fourth coordinate
  Animated<float> low{0.5F};   ///< noise, 0 to 1, at which the density is 0
  Animated<float> high{0.7F};  ///< and from which on it is 1
  Animated<float> fade{0.0F};  ///< share of the way to the middle on which it thins out
};

/// How the density of a medium varies in a body; one of its kinds.
struct DensityDesc {
  std::optional<NoiseDensityDesc> noise;
};

}  // namespace hyades::core
