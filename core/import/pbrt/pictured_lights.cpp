#include "core/import/pbrt/pictured_lights.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/image/read_image.h"
#include "core/import/pbrt/light_values.h"
#include "core/import/pbrt/panorama.h"
#include "core/import/pbrt/transforms.h"

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
Result<Layer> layer_of(const Context& context, const LightEntity& light, const std::string& file) {
  Layer layer;
  if (Status loaded = load_picture(context.loaded, light, file, layer); !loaded) {
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
Result<double> flux_of(const Context& context, const LightEntity& light, const std::string& file,
                       float fov) {
  const auto bytes = context.loaded.files.find(file);
  if (bytes == context.loaded.files.end()) return light.place.error("cannot open '" + file + "'");
  auto image = read_image(bytes->second, file);
  if (!image) return light.place.error(image.error().message);
  const auto channels = rgb_channels(*image);
  if (!channels) return light.place.error("'" + file + "' has no channels R, G and B");
  const double half = std::tan(0.5 * static_cast<double>(fov) * static_cast<double>(kPi) / 180.0);
  const double pixel = 2.0 * half / std::min(image->width, image->height);
  double sum = 0.0;
  for (int row = 0; row < image->height; ++row) {
    const double y = pixel * (row + 0.5 - 0.5 * image->height);
    for (int column = 0; column < image->width; ++column) {
      const double x = pixel * (column + 0.5 - 0.5 * image->width);
      const double distance2 = 1.0 + x * x + y * y;
      sum += static_cast<double>(luminance(rgb_at(*image, *channels, column, row))) /
             (distance2 * std::sqrt(distance2));
    }
  }
  return sum * pixel * pixel;
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
    const auto layer = layer_of(context, light, file);
    if (!layer) {
      context.report.errors.push_back(layer.error().message);
      return;
    }
    const double mean = mean_of(*layer->picture);
    if (power > 0.0F && mean > 0.0) intensity *= power / (kAllRound * static_cast<float>(mean));
    out.put("image", yaml_text(context.request.made + "lights/" + std::to_string(number) + ".exr"));
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
  const std::string file = context.beside(picture, light.place);
  if (file.empty()) return;
  const float fov = std::clamp(reader.number("fov", 90.0F), 0.01F, 179.99F);
  Rgb intensity = Rgb(reader.number("scale", 1.0F) * context.exposure);
  if (const float power = reader.number("power", -1.0F); power > 0.0F) {
    const auto flux = flux_of(context, light, picture, fov);
    if (!flux) {
      context.report.errors.push_back(flux.error().message);
      return;
    }
    if (*flux > 0.0) intensity *= power / static_cast<float>(*flux);
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
  auto layer = layer_of(context, light, read(context, light).text("filename"));
  if (!layer) return layer.error();
  return make_panorama({*layer});
}

}  // namespace hyades::core::pbrt
