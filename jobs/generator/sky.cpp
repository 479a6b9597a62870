#include "jobs/generator/sky.h"

#include <algorithm>
#include <cmath>

#include "core/textures/noise.h"

namespace hyades::gallery {
namespace {

using core::Rgb;
using core::Vec3;

Rgb mix(const Rgb& a, const Rgb& b, float w) { return a + (b - a) * std::clamp(w, 0.0F, 1.0F); }

Rgb sky_color(const Vec3& d, const Vec3& sun) {
  const float toward = std::max(glm::dot(d, sun), 0.0F);
  const float height = std::max(d.y, 0.0F);
  Rgb color = mix({0.95F, 0.55F, 0.30F}, {0.10F, 0.19F, 0.42F}, std::pow(height, 0.45F) * 1.15F);
  color += Rgb(1.6F, 0.7F, 0.25F) * std::pow(toward, 8.0F) * 0.8F;
  color += Rgb(6.0F, 3.2F, 1.4F) * std::pow(toward, 200.0F);

  // Clouds live on a plane above; their coordinates stretch towards the horizon as a real deck
  // does.
  const float above = std::max(d.y, 0.0F) + 0.12F;
  const Vec3 place(d.x / above * 1.1F, 4.0F, d.z / above * 1.1F);
  const float here = core::fbm(place, 6, 2.1F, 0.55F).value;
  const float towards_sun =
      core::fbm(place + Vec3(sun.x, 0.0F, sun.z) * 0.25F, 6, 2.1F, 0.55F).value;
  const float cover =
      std::clamp((here - 0.02F) * 3.5F, 0.0F, 1.0F) * std::clamp(d.y * 9.0F, 0.0F, 1.0F);
  const float lit = std::clamp(0.5F + (here - towards_sun) * 2.5F, 0.0F, 1.0F);
  const Rgb cloud =
      mix({0.20F, 0.17F, 0.24F}, Rgb(1.7F, 0.95F, 0.60F) * (0.7F + 0.9F * toward), lit);
  return mix(color, cloud, cover * 0.85F);
}

}  // namespace

core::Image make_sky(const SkyShape& shape) {
  const int height = shape.width / 2;
  core::Image image = core::make_image(shape.width, height, {"R", "G", "B"});
  const Vec3 sun(std::cos(shape.sun_elevation) * std::cos(shape.sun_azimuth),
                 std::sin(shape.sun_elevation),
                 std::cos(shape.sun_elevation) * std::sin(shape.sun_azimuth));
  for (int y = 0; y < height; ++y) {
    const float polar = core::kPi * (static_cast<float>(y) + 0.5F) / static_cast<float>(height);
    for (int x = 0; x < shape.width; ++x) {
      const float azimuth =
          2.0F * core::kPi *
          ((static_cast<float>(x) + 0.5F) / static_cast<float>(shape.width) - 0.5F);
      const Vec3 d(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                   std::sin(polar) * std::sin(azimuth));
      Rgb color = sky_color(d, sun);
      if (glm::dot(d, sun) > std::cos(shape.sun_radius)) {
        const float narrower = 0.035F / shape.sun_radius;
        color = Rgb(900.0F, 520.0F, 260.0F) * (narrower * narrower);
      }
      if (d.y < 0.0F) color = mix(color, {0.09F, 0.075F, 0.07F}, std::min(1.0F, -d.y * 12.0F));
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = color[c];
    }
  }
  return image;
}

}  // namespace hyades::gallery
