#include "core/lights/surface_emission.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/materials/params.h"

namespace hyades::core {
namespace {

constexpr float kLargestRadiance = 1e15F;  ///< its square must be finite

float clean(float x) { return x > 0.0F ? std::min(x, kLargestRadiance) : 0.0F; }

}  // namespace

Rgb SurfaceEmission::share(const SurfacePoint& on) const {
  Rgb share(1.0F);
  if (texture) {
    TexturePoint at = texture_point(on);
    at.finest = true;
    const Rgb color = texture->color(at);
    share = {clean(color.x), clean(color.y), clean(color.z)};
  }
  if (cutout) share *= cutout->opacity(on);
  return share;
}

double SurfaceEmission::brightness(const SurfacePoint& on) const {
  return static_cast<double>(luminance(radiance * share(on)));
}

BrightnessGrid::BrightnessGrid(const std::function<double(const Vec2&)>& brightness,
                               uint32_t look_ups) {
  const auto n =
      static_cast<uint32_t>(std::clamp(std::sqrt(static_cast<double>(look_ups) / 4.0), 8.0, 256.0));
  std::vector<float> weights;
  weights.reserve(size_t{n} * n);
  double sum = 0.0;
  for (uint32_t y = 0; y < n; ++y) {
    for (uint32_t x = 0; x < n; ++x) {
      double cell = 0.0;
      for (uint32_t i = 0; i < 4; ++i) {
        const Vec2 within(i % 2 == 0 ? 0.25F : 0.75F, i < 2 ? 0.25F : 0.75F);
        cell += 0.25 * brightness((Vec2(x, y) + within) / static_cast<float>(n));
      }
      sum += cell;
      weights.push_back(static_cast<float>(cell));
    }
  }
  mean_ = sum / (static_cast<double>(n) * n);
  const auto even = static_cast<float>(kEvenPart * mean_);
  for (float& weight : weights) weight = (1.0F - static_cast<float>(kEvenPart)) * weight + even;
  cells_ = Distribution2D(weights, n, n);
}

float BrightnessGrid::pdf(const Vec2& at) const {
  return mean_ > 0.0 ? cells_.pdf({std::clamp(at.x, 0.0F, 0x1.fffffep-1F),
                                   std::clamp(at.y, 0.0F, 0x1.fffffep-1F)})
                     : 0.0F;
}

}  // namespace hyades::core
