#include "core/import/pbrt/sky.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/image/read_image.h"
#include "core/image/write_image.h"
#include "core/import/pbrt/render_sections.h"

namespace hyades::core::pbrt {
namespace {

constexpr double kTurn = 3.14159265358979323846;
/// Each pixel of the panorama is the mean of this many places squared.
constexpr int kPlaces = 4;
constexpr int kMostWide = 8192;

/// One light: a colour, or a picture times it.
struct Layer {
  Rgb color{1.0F};
  std::shared_ptr<const Image> picture;
  std::array<int, 3> channels{};
  glm::dmat3 to_light{1.0};  ///< from the job's world

  Rgb at(const Vec3d& direction) const {
    if (picture == nullptr) return color;
    const glm::dvec2 place = equal_area_square(glm::normalize(to_light * direction));
    const int x = std::clamp(static_cast<int>(place.x * picture->width), 0, picture->width - 1);
    const int y = std::clamp(static_cast<int>(place.y * picture->height), 0, picture->height - 1);
    return color * Rgb(picture->at(x, y, channels[0]), picture->at(x, y, channels[1]),
                       picture->at(x, y, channels[2]));
  }
};

/// The light that a level surface gets from the upper half of an equal-area picture (z is up).
double illuminance_of(const Layer& layer) {
  const Image& image = *layer.picture;
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double up = equal_area_direction({(x + 0.5) / image.width, (y + 0.5) / image.height}).z;
      if (up <= 0.0) continue;
      const Rgb value(image.at(x, y, layer.channels[0]), image.at(x, y, layer.channels[1]),
                      image.at(x, y, layer.channels[2]));
      sum += up * static_cast<double>(luminance(value));
    }
  }
  return sum * 4.0 * kTurn / (static_cast<double>(image.width) * image.height);
}

Result<Layer> layer_of(Context& context, const LightEntity& light, bool with_picture) {
  ParameterReader reader = read(context, light);
  Layer layer;
  const float scale = reader.number("scale", 1.0F) * context.exposure;
  const float target = reader.number("illuminance", -1.0F);
  const std::string file = reader.text("filename");
  if (!reader.numbers("point3", "portal").empty()) {
    context.report.note(light.place, "a portal is left out: it changes noise, not light");
  }
  const Parameter* color = reader.find("L");
  if (color != nullptr && !file.empty()) {
    return light.place.error("a light has both L and a filename, expected one");
  }
  reader.note_unused();
  layer.color = light_from_rgb(*light.space, Vec3d(1.0)) * scale;
  if (color != nullptr) {
    layer.color = color_of(context, *color, ColorUse::light).value_or(Rgb(0.0F)) * scale;
  }
  if (file.empty()) {
    if (target > 0.0F) layer.color *= target / kPi;
    return layer;
  }
  layer.color = Rgb(scale);
  layer.to_light = glm::inverse(glm::dmat3(context.to_job * light.to_world.at[0]));
  if (!with_picture) return layer;
  const auto bytes = context.loaded.files.find(file);
  if (bytes == context.loaded.files.end()) {
    const auto why = context.loaded.missing.find(file);
    return light.place.error(why == context.loaded.missing.end() ? "cannot open '" + file + "'"
                                                                 : why->second);
  }
  auto image = read_image(bytes->second, file);
  if (!image) return light.place.error(image.error().message);
  if (image->width != image->height) {
    return light.place.error("'" + file +
                             "' is not square: a light's picture has the equal-area "
                             "mapping of the sphere");
  }
  const std::array<const char*, 3> names{"R", "G", "B"};
  for (size_t i = 0; i < 3; ++i) {
    int c = image->find_channel(names[i]);
    if (c < 0) c = image->find_channel("Y");
    if (c < 0) return light.place.error("'" + file + "' has no channels R, G and B");
    layer.channels[i] = c;
  }
  for (float& value : image->data) value = std::isfinite(value) ? std::max(value, 0.0F) : 0.0F;
  layer.picture = std::make_shared<const Image>(std::move(*image));
  if (target > 0.0F) {
    const double has = illuminance_of(layer);
    if (has > 0.0) layer.color *= static_cast<float>(static_cast<double>(target) / has);
  }
  return layer;
}

}  // namespace

glm::dvec2 equal_area_square(const Vec3d& direction) {
  const Vec3d d = glm::abs(direction);
  const double r = std::sqrt(std::max(0.0, 1.0 - d.z));
  const double turn = d.x == 0.0 && d.y == 0.0 ? 0.0 : std::atan2(d.y, d.x) * 2.0 / kTurn;
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
  const double turn = (r == 0.0 ? 1.0 : (a.y - a.x) / r + 1.0) * kTurn / 4.0;
  const double across = r * std::sqrt(std::max(0.0, 2.0 - r * r));
  return {std::copysign(std::cos(turn), p.x) * across, std::copysign(std::sin(turn), p.y) * across,
          std::copysign(1.0 - r * r, beyond)};
}

void add_environment(Context& context, const std::vector<const LightEntity*>& lights,
                     YamlMap& out) {
  Rgb color(0.0F);
  bool pictures = false;
  for (const LightEntity* light : lights) {
    const auto layer = layer_of(context, *light, false);
    if (!layer) {
      context.report.errors.push_back(layer.error().message);
      return;
    }
    ParameterReader reader = read(context, *light);
    pictures |= !reader.text("filename").empty();
    color += layer->color;
  }
  YamlMap node;
  if (pictures) {
    node.put("image", yaml_text(context.request.made + "sky.exr"));
  } else {
    node.put("color", color_node(color));
  }
  out.put("environment", node);
}

Result<Bytes> make_sky(const LoadedScene& scene) {
  const SceneRequest request;
  Context context(scene, request);
  YamlMap unused;
  add_render_sections(context, unused);  // says the exposure
  std::vector<Layer> layers;
  int side = 1;
  for (const LightEntity& light : scene.scene.lights) {
    if (light.type != "infinite") continue;
    auto layer = layer_of(context, light, true);
    if (!layer) return layer.error();
    if (layer->picture != nullptr) side = std::max(side, layer->picture->width);
    layers.push_back(std::move(*layer));
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
        const double theta = kTurn * (static_cast<double>(row) + (j + 0.5) / kPlaces) / height;
        const double weight = std::sin(theta);
        for (int i = 0; i < kPlaces; ++i) {
          // As EnvironmentMap has it: u = atan2(z, x) / 2 pi + 1 / 2.
          const double phi = 2.0 * kTurn * ((x + (i + 0.5) / kPlaces) / width - 0.5);
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
