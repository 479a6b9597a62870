#include "core/textures/noise.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/base/ray.h"
#include "core/textures/noise_octaves.h"

namespace hyades::core {
namespace {

// Four cell corners at a time, one per lane (GCC and Clang vector types): + - * are exact lane by
// lane, so the bits do not depend on it.
using F4 = float __attribute__((vector_size(16)));
using U4 = uint32_t __attribute__((vector_size(16)));

F4 all(float x) { return F4{x, x, x, x}; }

float sum(F4 x) { return (x[0] + x[1]) + (x[2] + x[3]); }

/// A coordinate's cell (wrapped to 32 bits), the place in it, and the quintic fade there with its
/// derivative: 6 t^5 - 15 t^4 + 10 t^3.
struct Axis {
  uint32_t cell;
  float t;
  float fade;
  float slope;
};

Axis locate(float x) {
  // From 2^24 on every float is a lattice point; the guard keeps the conversion defined.
  const float floor = std::floor(x);
  const bool inside = std::fabs(x) < 0x1p62F;
  const float t = inside ? x - floor : 0.0F;
  const auto cell = static_cast<uint32_t>(static_cast<int64_t>(inside ? floor : 0.0F));
  return {cell, t, t * t * t * (t * (6.0F * t - 15.0F) + 10.0F),
          30.0F * (t * t) * ((t - 1.0F) * (t - 1.0F))};
}

/// Folds one more lattice coordinate into a hash (the first half of lowbias32, Wellons 2018, "Hash
/// Function Prospector"); nested, not added up, so that no lattice vector maps the noise to itself.
U4 fold(U4 hash, U4 cell) {
  U4 h = hash + cell * 0x9E3779B9U;
  h ^= h >> 16;
  h *= 0x7FEB352DU;
  return h ^ (h >> 15);
}

U4 finish(U4 h) {
  h *= 0x846CA68BU;
  return h ^ (h >> 16);
}

/// +1 or -1 by bit `bit` of the hash.
F4 sign(U4 hash, int bit) {
  const U4 one = {0x3F800000U, 0x3F800000U, 0x3F800000U, 0x3F800000U};
  const U4 bits = one | ((hash << (31 - bit)) & 0x80000000U);
  return std::bit_cast<F4>(bits);
}

/// x where mask (0 or all ones) is unset, else 0.
F4 unless(U4 mask, F4 x) {
  const U4 bits = std::bit_cast<U4>(x) & ~mask;
  return std::bit_cast<F4>(bits);
}

template <class Comparison>
U4 as_mask(Comparison c) {
  return std::bit_cast<U4>(c);
}

/// The four corners of a cell's xy square: hashes, distances and bilinear weights.
struct Square {
  U4 hash;
  F4 x;
  F4 y;
  F4 weight;
  F4 weight_x;  ///< derivative by x
  F4 weight_y;
};

Square square_of(const Axis& x, const Axis& y, uint32_t salt) {
  const U4 cx = {x.cell, x.cell + 1, x.cell, x.cell + 1};
  const U4 cy = {y.cell, y.cell, y.cell + 1, y.cell + 1};
  const float u = x.fade;
  const float v = y.fade;
  Square s;
  s.hash = fold(fold(U4{salt, salt, salt, salt}, cx), cy);
  s.x = F4{x.t, x.t - 1.0F, x.t, x.t - 1.0F};
  s.y = F4{y.t, y.t, y.t - 1.0F, y.t - 1.0F};
  const F4 across = {1.0F - u, u, 1.0F - u, u};
  const F4 along = {1.0F - v, 1.0F - v, v, v};
  s.weight = across * along;
  s.weight_x = F4{-x.slope, x.slope, -x.slope, x.slope} * along;
  s.weight_y = across * F4{-y.slope, -y.slope, y.slope, y.slope};
  return s;
}

/// Gradients of four corners, and their products with the distances from the corners.
struct Corners3 {
  F4 value;
  F4 gx, gy, gz;
};

/// One of the twelve edge vectors of a cube (Perlin 2002): signs by three bits, and one component,
/// chosen by the upper bits, is zero.
Corners3 corners(const Square& s, uint32_t cell_z, float z) {
  const U4 h = finish(fold(s.hash, U4{cell_z, cell_z, cell_z, cell_z}));
  const U4 third = (h >> 16) * 3U >> 16;
  Corners3 c;
  c.gx = unless(as_mask(third == 0U), sign(h, 0));
  c.gy = unless(as_mask(third == 1U), sign(h, 1));
  c.gz = unless(as_mask(third == 2U), sign(h, 2));
  c.value = c.gx * s.x + c.gy * s.y + c.gz * all(z);
  return c;
}

struct Corners4 {
  F4 value;
  F4 gx, gy, gz, gw;
};

/// One of the 32 vectors with one zero component and three of +-1.
inline Corners4 corners(const Square& s, uint32_t cell_z, float z, uint32_t cell_w, float w) {
  const U4 folded = fold(s.hash, U4{cell_z, cell_z, cell_z, cell_z});
  const U4 h = finish(fold(folded, U4{cell_w, cell_w, cell_w, cell_w}));
  const U4 quarter = h >> 30;
  Corners4 c;
  c.gx = unless(as_mask(quarter == 0U), sign(h, 0));
  c.gy = unless(as_mask(quarter == 1U), sign(h, 1));
  c.gz = unless(as_mask(quarter == 2U), sign(h, 2));
  c.gw = unless(as_mask(quarter == 3U), sign(h, 3));
  c.value = (c.gx * s.x + c.gy * s.y) + (c.gz * all(z) + c.gw * all(w));
  return c;
}

F4 mix(F4 a, F4 b, float t) { return a * all(1.0F - t) + b * all(t); }

/// Reciprocals of the largest values that any choice of gradients can make (found by optimisation
/// over the cell), so that the noise stays within [-1, 1].
constexpr float kScale3 = 1.0F / 1.0363539F;
constexpr float kScale4 = 1.0F / 1.5365825F;

}  // namespace

Noise3 perlin(const Vec3& p) {
  const Axis x = locate(p.x);
  const Axis y = locate(p.y);
  const Axis z = locate(p.z);
  const Square s = square_of(x, y, 0x3D3D3D3DU);
  const Corners3 a = corners(s, z.cell, z.t);
  const Corners3 b = corners(s, z.cell + 1, z.t - 1.0F);

  const F4 value = mix(a.value, b.value, z.fade);
  const F4 slope_z = (b.value - a.value) * all(z.slope);
  Noise3 noise;
  noise.value = kScale3 * sum(s.weight * value);
  noise.gradient.x = kScale3 * sum(s.weight_x * value + s.weight * mix(a.gx, b.gx, z.fade));
  noise.gradient.y = kScale3 * sum(s.weight_y * value + s.weight * mix(a.gy, b.gy, z.fade));
  noise.gradient.z = kScale3 * sum(s.weight * (slope_z + mix(a.gz, b.gz, z.fade)));
  return noise;
}

Noise4 perlin(const Vec4& p) {
  const Axis x = locate(p.x);
  const Axis y = locate(p.y);
  const Axis z = locate(p.z);
  const Axis w = locate(p.w);
  const Square s = square_of(x, y, 0x4D4D4D4DU);
  Corners4 layer[2];  // at w = 0 and 1 of the cell, interpolated along z
  F4 slope_z[2];
  for (int k = 0; k < 2; ++k) {
    const uint32_t cell_w = w.cell + static_cast<uint32_t>(k);
    const float tw = w.t - static_cast<float>(k);
    const Corners4 a = corners(s, z.cell, z.t, cell_w, tw);
    const Corners4 b = corners(s, z.cell + 1, z.t - 1.0F, cell_w, tw);
    slope_z[k] = (b.value - a.value) * all(z.slope);
    layer[k] = {mix(a.value, b.value, z.fade), mix(a.gx, b.gx, z.fade), mix(a.gy, b.gy, z.fade),
                mix(a.gz, b.gz, z.fade), mix(a.gw, b.gw, z.fade)};
  }
  const F4 value = mix(layer[0].value, layer[1].value, w.fade);
  const F4 slope_w = (layer[1].value - layer[0].value) * all(w.slope);
  const F4 gx = mix(layer[0].gx, layer[1].gx, w.fade);
  const F4 gy = mix(layer[0].gy, layer[1].gy, w.fade);
  const F4 gz = mix(layer[0].gz + slope_z[0], layer[1].gz + slope_z[1], w.fade);
  const F4 gw = mix(layer[0].gw, layer[1].gw, w.fade);
  Noise4 noise;
  noise.value = kScale4 * sum(s.weight * value);
  noise.gradient.x = kScale4 * sum(s.weight_x * value + s.weight * gx);
  noise.gradient.y = kScale4 * sum(s.weight_y * value + s.weight * gy);
  noise.gradient.z = kScale4 * sum(s.weight * gz);
  noise.gradient.w = kScale4 * sum(s.weight * (slope_w + gw));
  return noise;
}

float perlin_value(const Vec4& p) {
  const Axis x = locate(p.x);
  const Axis y = locate(p.y);
  const Axis z = locate(p.z);
  const Axis w = locate(p.w);
  const Square s = square_of(x, y, 0x4D4D4D4DU);
  F4 layer[2];
  for (int k = 0; k < 2; ++k) {
    const uint32_t cell_w = w.cell + static_cast<uint32_t>(k);
    const float tw = w.t - static_cast<float>(k);
    layer[k] = mix(corners(s, z.cell, z.t, cell_w, tw).value,
                   corners(s, z.cell + 1, z.t - 1.0F, cell_w, tw).value, z.fade);
  }
  return kScale4 * sum(s.weight * mix(layer[0], layer[1], w.fade));
}

std::array<Vec4, 16> corner_gradients(const Vec4& cell) {
  const Square s = square_of(locate(cell.x), locate(cell.y), 0x4D4D4D4DU);
  const uint32_t z = locate(cell.z).cell;
  const uint32_t w = locate(cell.w).cell;
  std::array<Vec4, 16> gradients;
  for (uint32_t high = 0; high < 4; ++high) {
    const Corners4 c = corners(s, z + (high & 1U), 0.0F, w + (high >> 1U), 0.0F);
    for (int low = 0; low < 4; ++low)
      gradients[4 * high + static_cast<size_t>(low)] =
          kScale4 * Vec4(c.gx[low], c.gy[low], c.gz[low], c.gw[low]);
  }
  return gradients;
}

FractalNoise::FractalNoise(int octaves, float lacunarity, float gain) {
  norm_ = for_each_octave(octaves, lacunarity, gain, [&](const Octave& octave) {
    terms_.push_back({octave, 0.0F});
  });
  float rest = 0.0F;
  for (auto term = terms_.rbegin(); term != terms_.rend(); ++term) {
    term->rest = rest;
    rest += std::fabs(term->octave.amplitude);
  }
}

float FractalNoise::value(const Vec4& p) const { return value_between(p, -kInfinity, kInfinity); }

float FractalNoise::value_between(const Vec4& p, float low, float high) const {
  constexpr float kMargin = 1e-5F;  // for the rounding of sums
  const float below = (low - kMargin) * norm_;
  const float above = (high + kMargin) * norm_;
  float total = 0.0F;
  for (const Term& term : terms_) {
    const Octave& octave = term.octave;
    total += octave.amplitude * perlin_value(p * octave.frequency + octave.shift);
    if (total + term.rest < below) return -1.0F;
    if (total - term.rest > above) return 1.0F;
  }
  return total / norm_;
}

Noise3 fbm(const Vec3& p, int octaves, float lacunarity, float gain) {
  Noise3 total;
  const float norm = for_each_octave(octaves, lacunarity, gain, [&](const Octave& octave) {
    const Noise3 n = perlin(p * octave.frequency + Vec3(octave.shift));
    total.value += octave.amplitude * n.value;
    total.gradient += octave.amplitude * octave.frequency * n.gradient;
  });
  total.value /= norm;
  total.gradient /= norm;
  return total;
}

Noise4 fbm(const Vec4& p, int octaves, float lacunarity, float gain) {
  Noise4 total;
  const float norm = for_each_octave(octaves, lacunarity, gain, [&](const Octave& octave) {
    const Noise4 n = perlin(p * octave.frequency + octave.shift);
    total.value += octave.amplitude * n.value;
    total.gradient += octave.amplitude * octave.frequency * n.gradient;
  });
  total.value /= norm;
  total.gradient /= norm;
  return total;
}

}  // namespace hyades::core
