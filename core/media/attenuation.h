#pragma once

#include <algorithm>

#include "core/base/elementary.h"
#include "core/base/ray.h"
#include "core/base/vec.h"

namespace hyades::core {

/// exp(-sigma t); 1 where sigma is 0, also over an infinite way.
inline float attenuation(float sigma, float t) { return sigma > 0.0F ? exp(-sigma * t) : 1.0F; }

inline Rgb attenuation(const Rgb& sigma, float t) {
  return {attenuation(sigma.x, t), attenuation(sigma.y, t), attenuation(sigma.z, t)};
}

/// What a way of length `t` lets through of each channel that `shares` can choose, 0 of others;
/// relative to the clearest of them: quotients stay, nothing underflows.
inline Rgb relative_attenuation(const Rgb& extinction, float t, const Rgb& shares) {
  float clearest = kInfinity;
  for (int c = 0; c < 3; ++c) {
    if (shares[c] > 0.0F) clearest = std::min(clearest, extinction[c]);
  }
  Rgb passed(0.0F);
  for (int c = 0; c < 3; ++c) {
    if (shares[c] > 0.0F) passed[c] = attenuation(extinction[c] - clearest, t);
  }
  return passed;
}

}  // namespace hyades::core
