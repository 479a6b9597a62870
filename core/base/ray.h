#pragma once

#include <limits>

#include "core/base/vec.h"

namespace hyades::core {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A ray in world space. `direction` is of unit length, so t is a distance in world units.
struct Ray {
  Vec3 origin{0.0F};
  Vec3 direction{0.0F, 0.0F, 1.0F};
  float t_max = kInfinity;  ///< hits with 0 < t < t_max count
  float time = 0.0F;        ///< place within the shutter interval, 0 (opens) to 1 (closes)

  Vec3 at(float t) const { return origin + t * direction; }
};

}  // namespace hyades::core
