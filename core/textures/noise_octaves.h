#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

namespace hyades::core {

/// One term of a fractal sum: amplitude * perlin(p * frequency + shift).
struct Octave {
  float frequency;
  float amplitude;
  Vec4 shift;  ///< cells: irrational steps (powers of the reciprocal of the generalised golden
               ///< ratio of four dimensions), nothing for the first octave
};

/// Calls visit(Octave) for the terms of fbm() in order; returns what their sum is divided by.
template <class Visit>
float for_each_octave(int octaves, float lacunarity, float gain, const Visit& visit) {
  constexpr int kMaxOctaves = 32;
  const Vec4 steps(17.85667488F, 31.73389186F, 47.62870672F, 59.53859726F);
  float frequency = 1.0F;
  float amplitude = 1.0F;
  float norm = 0.0F;
  for (int i = 0; i < std::clamp(octaves, 1, kMaxOctaves); ++i) {
    visit(Octave{frequency, amplitude, static_cast<float>(i) * steps});
    norm += std::fabs(amplitude);
    frequency *= lacunarity;
    amplitude *= gain;
  }
  return norm;
}

}  // namespace hyades::core
