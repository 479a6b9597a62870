#pragma once

#include <array>
#include <vector>

#include "core/base/vec.h"
#include "core/textures/noise_octaves.h"

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

/// perlin(p).value: the same bits for less work.
float perlin_value(const Vec4& p);

/// The gradients of perlin() at the corners of the cell whose lowest corner is lattice point
/// `cell`; bits 0 to 3 of a corner's number say where it is along x, y, z, w.
std::array<Vec4, 16> corner_gradients(const Vec4& cell);

/// fbm() of four dimensions without its gradient, for those who ask for it often.
class FractalNoise {
 public:
  FractalNoise(int octaves, float lacunarity, float gain);

  /// The value of fbm(p): the same bits.
  float value(const Vec4& p) const;

  /// The value of fbm(p) where only what is between `low` and `high` >= `low` matters: of values
  /// certain to be below or above, -1 or 1 may stand for it, found from fewer octaves.
  float value_between(const Vec4& p, float low, float high) const;

 private:
  struct Term {
    Octave octave;
    float rest;  ///< the most that all terms after this one can add up to
  };
  std::vector<Term> terms_;
  float norm_;
};

}  // namespace hyades::core
