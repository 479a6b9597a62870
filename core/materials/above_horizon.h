#pragma once

#include <cmath>

#include "core/base/vec.h"

namespace hyades::core {

/// `n` turned towards unit `ng` until the two are less than a right angle apart: a normal below the
/// geometric horizon would reflect light into the surface.
inline Vec3 above_horizon(const Vec3& n, const Vec3& ng) {
  constexpr float kLeastCosine = 0.01F;
  const float cosine = glm::dot(n, ng);
  if (cosine >= kLeastCosine) return n;
  const Vec3 along = n - cosine * ng;
  const float length2 = glm::dot(along, along);
  if (!(length2 > 0.0F)) return ng;
  const float sine = std::sqrt(1.0F - kLeastCosine * kLeastCosine);
  return kLeastCosine * ng + along * (sine / std::sqrt(length2));
}

}  // namespace hyades::core
