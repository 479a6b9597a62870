#include "import/pbrt/pictured_lights.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "import/pbrt/light_values.h"
#include "import/pbrt/panorama.h"
#include "import/pbrt/transforms.h"

namespace hyades::core::pbrt {
namespace {

/// Of each pixel the mean of red, green and blue: the light's own colour is all that it has.
std::shared_ptr<const Image> grey(const Layer& layer) {
  const Image& image = *layer.picture;
  Image out = make_image(image.width, image.height, {"Y"});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Rgb value = layer.pixel(x, y);
      out.at(x, y, 0) = (value.x + value.y + value.z) / 3.0F;
    }
  }
  return std::make_shared<const Image>(std::move(out));
}

/// The picture of a goniometric light; its pole (z) is the light's y.
Result<Layer> goniometric_of(const Context& context, const LightEntity& light,
                             const std::string& file) {
  Layer layer;
  if (Status loaded = load_sphere(context.loaded, light, file, layer); !loaded) {
    return loaded.error();
  }
  layer.picture = grey(layer);
  layer.channels = {0, 0, 0};
  const glm::dmat3 swap(Vec3d(1.0, 0.0, 0.0), Vec3d(0.0, 0.0, 1.0), Vec3d(0.0, 1.0, 0.0));
  layer.to_light = swap * glm::inverse(glm::dmat3(context.to_job * light.to_world.at[0]));
  return layer;
}

double mean_of(const Image& image) {
  double sum = 0.0;
  for (const float value : image.data) sum += static_cast<double>(value);
  return sum / static_cast<double>(image.data.size());
}

/// The solid angle of a projection, each pixel times its luminance [sr].
double flux_of(const Layer& layer, float fov) {
  const int width = layer.picture->width;
  const int height = layer.picture->height;
  const double half = std::tan(0.5 * static_cast<double>(fov) * static_cast<double>(kPi) / 180.0);
  const double pixel = 2.0 * half / std::min(width, height);
  double sum = 0.0;
  for (int row = 0; row < height; ++row) {
    const double y = pixel * (row + 0.5 - 0.5 * height);
    for (int column = 0; column < width; ++column) {
      const double x = pixel * (column + 0.5 - 0.5 * width);
      const double distance2 = 1.0 + x * x + y * y;
      sum += static_cast<double>(luminance(layer.pixel(column, row))) /
             (distance2 * std::sqrt(distance2));
    }
  }
  return sum * pixel * pixel;
}

/// Scales a light so that `power` leaves it, where all that its picture lets through is `through`
/// at intensity 1.
void give_power(Context& context, const LightEntity& light, float power, double through,
                Rgb& intensity) {
  if (!(power > 0.0F)) return;
  if (through > 0.0) {
    intensity *= power / static_cast<float>(through);
  } else {
    context.report.note(light.place, "a light's picture is black, and its power is left out");
  }
}

/// The picture of a goniometric light among those of the context.
Result<Context::LightPicture> shared_picture(Context& context, size_t number,
                                             const std::string& file) {
  const LightEntity& light = context.scene.lights[number];
  const glm::dmat3 turn(light.to_world.at[0]);
  const std::span<const double> values(&turn[0].x, 9);
  const std::string key = fmt::format("{} {}", file, fmt::join(values, " "));
  if (const auto known = context.light_pictures.find(key); known != context.light_pictures.end()) {
    return known->second;
  }
  const auto layer = goniometric_of(context, light, file);
  if (!layer) return layer.error();
  return context.light_pictures[key] = {number, mean_of(*layer->picture)};
}

/// Whether the transform keeps right angles and lengths as they are to each other.
bool keeps_shapes(const glm::dmat3& m) {
  const double length2 = glm::dot(m[0], m[0]);
  const glm::dmat3 product = glm::transpose(m) * m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (std::abs(product[i][j] - (i == j ? length2 : 0.0)) > 1e-3 * length2) return false;
    }
  }
  return true;
}

}  // namespace

void add_goniometric(Context& context, size_t number, ParameterReader& reader) {
  const LightEntity& light = context.scene.lights[number];
  const std::string file = reader.text("filename");
  const float power = reader.number("power", -1.0F);
  Rgb intensity = light_value(context, light, reader, "I");
  YamlMap out{{"type", yaml_word("point")},
              {"at", yaml_vector(place_of(context, light, Vec3d(0.0)))}};
  if (file.empty()) {
    context.report.note(light.place,
                        "a goniometric light without a picture shines alike in all directions");
    if (power > 0.0F) intensity *= power / kAllRound;
  } else {
    const auto picture = shared_picture(context, number, file);
    if (!picture) {
      context.report.errors.push_back(picture.error().message);
      return;
    }
    give_power(context, light, power, static_cast<double>(kAllRound) * picture->mean, intensity);
    out.put("image",
            yaml_text(fmt::format("{}lights/{}.exr", context.request.made, picture->light)));
  }
  out.put("color", color_node(intensity));
  out.put("power", yaml_number(kAllRound));
  context.lights.put(context.light_names.add("goniometric"), out.node());
}

void add_projection(Context& context, const LightEntity& light, ParameterReader& reader) {
  const std::string picture = reader.text("filename");
  if (picture.empty()) {
    context.report.error(light.place, "a projection has no 'filename', expected its picture");
    return;
  }
  const float fov = reader.number("fov", 90.0F);
  if (!(fov > 0.0F && fov < 180.0F)) {
    context.report.error(light.place, "a projection's fov is above 0 and below 180");
    return;
  }
  const std::string file = context.beside(picture, light.place);
  if (file.empty()) return;
  Rgb intensity(light_scale(context, light, reader));
  if (const float power = reader.number("power", -1.0F); power > 0.0F) {
    Layer layer;
    if (Status loaded = load_picture(context.loaded, light, picture, layer); !loaded) {
      context.report.errors.push_back(loaded.error().message);
      return;
    }
    give_power(context, light, power, flux_of(layer, fov), intensity);
  }
  const Mat4d to_job = context.to_job * light.to_world.at[0];
  if (!keeps_shapes(glm::dmat3(to_job))) {
    context.report.note(light.place, "what stretches a projection is left out: it is only turned");
  }
  YamlMap out{{"type", yaml_word("projector")}, {"image", yaml_text(file)}};
  // As a job's projector stands by itself: seen from it, its picture is the right way round.
  if (linear_determinant(to_job) < 0.0) {
    const Vec3 at = place_of(context, light, Vec3d(0.0));
    out.put("at", yaml_vector(at));
    out.put("look_at", yaml_vector(place_of(context, light, Vec3d(0.0, 0.0, 1.0))));
    out.put("up", yaml_vector(place_of(context, light, Vec3d(0.0, 1.0, 0.0)) - at));
  } else {
    out.put("look_at", yaml_vector(Vec3(0.0F, 0.0F, 1.0F)));
    out.put("transform", transform_node(to_job * scaling(Vec3d(-1.0, 1.0, 1.0))));
  }
  out.put("fov", yaml_number(fov));
  out.put("color", color_node(intensity));
  out.put("power", yaml_number(kAllRound));
  context.lights.put(context.light_names.add("projection"), out.node());
}

Result<Bytes> make_light_picture(const LoadedScene& scene, const std::string& name) {
  size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || std::string_view(end) != ".exr" ||
      number >= scene.scene.lights.size() || scene.scene.lights[number].type != "goniometric") {
    return Error{"the scene makes no file 'lights/" + name + "'"};
  }
  const SceneRequest request;
  Context context(scene, request);
  const LightEntity& light = scene.scene.lights[number];
  auto layer = goniometric_of(context, light, read(context, light).text("filename"));
  if (!layer) return layer.error();
  return make_panorama({*layer});
}

}  // namespace hyades::core::pbrt
