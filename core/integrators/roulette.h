#pragma once

#include <algorithm>

#include "core/base/vec.h"

namespace hyades::core {

/// Russian roulette: false where a path that still carries the part `left` of what it began with
/// ends, decided by `u` in [0, 1); else `throughput` makes up for those that do. `left` is without
/// the factor of refraction, which is undone when the path leaves the glass again.
inline bool survives_roulette(float left, float u, Rgb& throughput) {
  constexpr float kLeast = 0.05F;  // a path that survives less often would be all noise
  const float keep = std::max(left, kLeast);
  if (keep >= 1.0F) return true;
  if (u >= keep) return false;
  throughput /= keep;
  return true;
}

}  // namespace hyades::core
