#include "import/pbrt/panorama.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "core/base/elementary.h"
#include "core/base/parallel.h"
#include "core/image/read_image.h"
#include "core/image/write_image.h"

namespace hyades::core::pbrt {
namespace {

/// Each pixel of the panorama is the mean of this many places squared.
constexpr int kPlaces = 4;
constexpr int kMostWide = 8192;

}  // namespace

Rgb Layer::at(const Vec3d& direction) const {
  if (picture == nullptr) return color;
  const glm::dvec2 place = equal_area_square(glm::normalize(to_light * direction));
  const int x = std::clamp(static_cast<int>(place.x * picture->width), 0, picture->width - 1);
  const int y = std::clamp(static_cast<int>(place.y * picture->height), 0, picture->height - 1);
  return color * pixel(x, y);
}

Status load_picture(const LoadedScene& scene, const Entity& light, const std::string& file,
                    Layer& layer) {
  const auto bytes = scene.files.find(file);
  if (bytes == scene.files.end()) {
    const auto why = scene.missing.find(file);
    return light.place.error(why == scene.missing.end() ? "cannot open '" + file + "'"
                                                        : why->second);
  }
  auto image = read_image(bytes->second, file);
  if (!image) return light.place.error(image.error().message);
  const auto channels = rgb_channels(*image);
  if (!channels) return light.place.error("'" + file + "' has no channels R, G and B");
  layer.channels = *channels;
  for (float& value : image->data) value = std::isfinite(value) ? std::max(value, 0.0F) : 0.0F;
  layer.picture = std::make_shared<const Image>(std::move(*image));
  return {};
}

Status load_sphere(const LoadedScene& scene, const Entity& light, const std::string& file,
                   Layer& layer) {
  if (Status loaded = load_picture(scene, light, file, layer); !loaded) return loaded;
  if (layer.picture->width == layer.picture->height) return {};
  return light.place.error("'" + file +
                           "' is not square: a light's picture has the equal-area mapping of the "
                           "sphere");
}

glm::dvec2 equal_area_square(const Vec3d& direction) {
  const Vec3d d = glm::abs(direction);
  const double r = std::sqrt(std::max(0.0, 1.0 - d.z));
  const double turn =
      d.x == 0.0 && d.y == 0.0 ? 0.0 : std::atan2(d.y, d.x) * 2.0 / elementary::kPiD;
  double v = turn * r;
  double u = r - v;
  if (direction.z < 0.0) {
    std::swap(u, v);
    u = 1.0 - u;
    v = 1.0 - v;
  }
  return {(std::copysign(u, direction.x) + 1.0) * 0.5, (std::copysign(v, direction.y) + 1.0) * 0.5};
}

Vec3d equal_area_direction(const glm::dvec2& place) {
  const glm::dvec2 p = 2.0 * place - 1.0;
  const glm::dvec2 a = glm::abs(p);
  const double beyond = 1.0 - (a.x + a.y);
  const double r = 1.0 - std::abs(beyond);
  const double turn = (r == 0.0 ? 1.0 : (a.y - a.x) / r + 1.0) * elementary::kPiD / 4.0;
  const double across = r * std::sqrt(std::max(0.0, 2.0 - r * r));
  return {std::copysign(std::cos(turn), p.x) * across, std::copysign(std::sin(turn), p.y) * across,
          std::copysign(1.0 - r * r, beyond)};
}

Result<Bytes> make_panorama(const std::vector<Layer>& layers) {
  int side = 1;
  for (const Layer& layer : layers) {
    if (layer.picture != nullptr) side = std::max(side, layer.picture->width);
  }
  // As fine at the horizon as the pictures are everywhere, or a little finer.
  const int width = std::min(2 * side, kMostWide);
  const int height = std::max(width / 2, 1);
  Image out = make_image(width, height, {"R", "G", "B"});
  const Status done = parallel_for(static_cast<size_t>(height), 0, [&](size_t row) {
    for (int x = 0; x < width; ++x) {
      Rgb sum(0.0F);
      double whole = 0.0;
      for (int j = 0; j < kPlaces; ++j) {
        const double theta =
            elementary::kPiD * (static_cast<double>(row) + (j + 0.5) / kPlaces) / height;
        const double weight = std::sin(theta);
        for (int i = 0; i < kPlaces; ++i) {
          // As EnvironmentMap has it: u = atan2(z, x) / 2 pi + 1 / 2.
          const double phi = 2.0 * elementary::kPiD * ((x + (i + 0.5) / kPlaces) / width - 0.5);
          const Vec3d d(weight * std::cos(phi), std::cos(theta), weight * std::sin(phi));
          for (const Layer& layer : layers) sum += static_cast<float>(weight) * layer.at(d);
          whole += weight;
        }
      }
      for (int c = 0; c < 3; ++c) {
        out.at(x, static_cast<int>(row), c) = sum[c] / static_cast<float>(whole);
      }
    }
  });
  if (!done) return done.error();
  return encode_exr(out);
}

}  // namespace hyades::core::pbrt
