#include "core/lights/sky.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/elementary.h"
#include "core/lights/sky_model.h"

namespace hyades::core {
namespace {

constexpr int kWidth = 512;
constexpr int kHeight = 256;

/// The share of a disc of `radius` whose middle is `elevation` above the horizon that is above it.
float share_above(float elevation, float radius) {
  if (!(radius > 0.0F)) return elevation >= 0.0F ? 1.0F : 0.0F;
  const float x = std::clamp(elevation / radius, -1.0F, 1.0F);
  return 0.5F + (x * std::sqrt(1.0F - x * x) + asin(x)) * kInvPi;
}

void put(Image& image, int x, int y, const Rgb& value) {
  for (int c = 0; c < 3; ++c) image.at(x, y, c) = value[c];
}

}  // namespace

Sky make_sky(const SkySettings& settings) {
  const SkyModel model(settings.turbidity, settings.ground_albedo);
  const SinCos height = sin_cos(settings.elevation);
  const Vec3 sun(height.cos, height.sin, 0.0F);
  Sky sky;
  // A sun that sets: what is left of it shines along the horizon.
  const float share = share_above(settings.elevation, settings.sun_radius);
  sky.sun = model.transmittance(std::max(height.sin, 0.0F)) * share;

  auto image = std::make_shared<Image>(make_image(kWidth, kHeight, {"R", "G", "B"}));
  Rgb from_above(0.0F);  // irradiance of the sky on the ground
  for (int y = 0; y < kHeight; ++y) {
    const SinCos down = sin_cos(kPi * (static_cast<float>(y) + 0.5F) / kHeight);
    const float cell = 2.0F * kPi / kWidth * kPi / kHeight * down.sin;
    if (y == kHeight / 2) {
      // The ground is lit by the sky too; seen through the air below the horizon, which is thin.
      from_above *= settings.ground_albedo * kInvPi;
    }
    for (int x = 0; x < kWidth / 2; ++x) {  // both halves are alike
      const SinCos turn = sin_cos(2.0F * kPi * ((static_cast<float>(x) + 0.5F) / kWidth - 0.5F));
      const Vec3 direction(down.sin * turn.cos, down.cos, down.sin * turn.sin);
      Rgb radiance = model.radiance(direction, sun);
      if (y < kHeight / 2) {
        from_above += radiance * (2.0F * cell * down.cos);
      } else {
        radiance += from_above;
      }
      put(*image, x, y, radiance);
      put(*image, kWidth - 1 - x, y, radiance);
    }
  }
  sky.map = std::make_shared<const EnvironmentMap>(std::move(image), settings.density);
  return sky;
}

}  // namespace hyades::core
