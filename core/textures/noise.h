#pragma once

#include "core/base/vec.h"

namespace hyades::core {

/// Noise and its analytic gradient.
struct Noise3 {
  float value = 0.0F;
  Vec3 gradient{0.0F};
};
struct Noise4 {
  float value = 0.0F;
  Vec4 gradient{0.0F};
};

/// Improved Perlin noise (Perlin 2002, "Improving Noise": quintic fade), gradients picked by an
/// integer hash instead of the 256-entry table, so that it does not repeat. Zero at lattice points,
/// mean 0, within [-1, 1], C2.
Noise3 perlin(const Vec3& p);
Noise4 perlin(const Vec4& p);

/// Fractal sum: sum gain^i perlin(p lacunarity^i), divided by sum gain^i (so within [-1, 1]); every
/// octave is shifted so that their lattices do not coincide at the origin.
Noise3 fbm(const Vec3& p, int octaves, float lacunarity, float gain);
Noise4 fbm(const Vec4& p, int octaves, float lacunarity, float gain);

}  // namespace hyades::core
