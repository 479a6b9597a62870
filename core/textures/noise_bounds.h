#pragma once

#include "core/base/vec.h"

namespace hyades::core {

struct NoiseBounds {
  float least = -1.0F;
  float greatest = 1.0F;
};

/// Values between which perlin() stays over the box lower..upper: exact as the box shrinks to a
/// point, -1 and 1 where it is larger than a few cells. Proven, not sampled (up to the rounding of
/// perlin itself, for which there is a margin).
NoiseBounds perlin_bounds(const Vec4& lower, const Vec4& upper);

/// Values between which fbm() stays over the box lower..upper, as perlin_bounds() tells them.
NoiseBounds fbm_bounds(const Vec4& lower, const Vec4& upper, int octaves, float lacunarity,
                       float gain);

}  // namespace hyades::core
