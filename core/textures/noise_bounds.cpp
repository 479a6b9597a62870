#include "core/textures/noise_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/textures/noise.h"
#include "core/textures/noise_octaves.h"

namespace hyades::core {
namespace {

constexpr float kMostCells = 4.0F;  ///< that a box may touch
constexpr float kMargin = 1e-4F;

float fade(float t) { return t * t * t * (t * (6.0F * t - 15.0F) + 10.0F); }

/// Over the part `from`..`to` (each 0..1 along every axis) of the cell at `cell`. Noise mixes, axis
/// after axis, what the corners' gradients would make of the place; a mean of two intervals is
/// greatest where both are, at one end of the weight's own interval.
NoiseBounds in_cell(const Vec4& cell, const Vec4& from, const Vec4& to) {
  std::array<NoiseBounds, 16> values;
  const std::array<Vec4, 16> gradients = corner_gradients(cell);
  for (int corner = 0; corner < 16; ++corner) {
    const Vec4 offset((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0, (corner & 8) != 0);
    const Vec4& gradient = gradients[static_cast<size_t>(corner)];
    const Vec4 a = gradient * (from - offset);
    const Vec4 b = gradient * (to - offset);
    const Vec4 low = glm::min(a, b);
    const Vec4 high = glm::max(a, b);
    values[static_cast<size_t>(corner)] = {(low.x + low.y) + (low.z + low.w),
                                           (high.x + high.y) + (high.z + high.w)};
  }
  size_t count = 16;
  for (int axis = 0; axis < 4; ++axis) {
    const float w0 = fade(from[axis]);
    const float w1 = fade(to[axis]);
    count /= 2;
    for (size_t i = 0; i < count; ++i) {
      const NoiseBounds& a = values[2 * i];
      const NoiseBounds& b = values[2 * i + 1];
      const auto mix = [](float x, float y, float w) { return x * (1.0F - w) + y * w; };
      values[i] = {std::min(mix(a.least, b.least, w0), mix(a.least, b.least, w1)),
                   std::max(mix(a.greatest, b.greatest, w0), mix(a.greatest, b.greatest, w1))};
    }
  }
  return values[0];
}

}  // namespace

NoiseBounds perlin_bounds(const Vec4& lower, const Vec4& upper) {
  const Vec4 first = glm::floor(lower);
  const Vec4 last = glm::floor(upper);
  const Vec4 count = last - first + 1.0F;
  if (!(count.x * count.y * count.z * count.w <= kMostCells)) return {};
  NoiseBounds bounds{1.0F, -1.0F};
  Vec4 cell;
  for (cell.w = first.w; cell.w <= last.w; ++cell.w) {
    for (cell.z = first.z; cell.z <= last.z; ++cell.z) {
      for (cell.y = first.y; cell.y <= last.y; ++cell.y) {
        for (cell.x = first.x; cell.x <= last.x; ++cell.x) {
          const Vec4 from = glm::clamp(lower - cell, Vec4(0.0F), Vec4(1.0F));
          const Vec4 to = glm::clamp(upper - cell, Vec4(0.0F), Vec4(1.0F));
          const NoiseBounds part = in_cell(cell, from, to);
          bounds.least = std::min(bounds.least, part.least);
          bounds.greatest = std::max(bounds.greatest, part.greatest);
        }
      }
    }
  }
  return {std::max(bounds.least - kMargin, -1.0F), std::min(bounds.greatest + kMargin, 1.0F)};
}

NoiseBounds fbm_bounds(const Vec4& lower, const Vec4& upper, int octaves, float lacunarity,
                       float gain) {
  NoiseBounds total{0.0F, 0.0F};
  const float norm = for_each_octave(octaves, lacunarity, gain, [&](const Octave& octave) {
    const NoiseBounds one = perlin_bounds(lower * octave.frequency + octave.shift,
                                          upper * octave.frequency + octave.shift);
    total.least += octave.amplitude * one.least;
    total.greatest += octave.amplitude * one.greatest;
  });
  return {total.least / norm, total.greatest / norm};
}

}  // namespace hyades::core
