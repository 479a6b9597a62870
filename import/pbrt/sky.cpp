#include "import/pbrt/sky.h"

#include <string>
#include <utility>
#include <vector>

#include "core/base/elementary.h"
#include "import/pbrt/light_values.h"
#include "import/pbrt/panorama.h"
#include "import/pbrt/render_sections.h"

namespace hyades::core::pbrt {
namespace {

/// The light that a level surface gets from the upper half of an equal-area picture (z is up).
double illuminance_of(const Layer& layer) {
  const Image& image = *layer.picture;
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double up = equal_area_direction({(x + 0.5) / image.width, (y + 0.5) / image.height}).z;
      if (up <= 0.0) continue;
      sum += up * static_cast<double>(luminance(layer.pixel(x, y)));
    }
  }
  return sum * 4.0 * elementary::kPiD / (static_cast<double>(image.width) * image.height);
}

Result<Layer> sky_of(Context& context, const LightEntity& light, bool with_picture) {
  ParameterReader reader = read(context, light);
  Layer layer;
  const float scale = light_scale(context, light, reader);
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
  if (Status loaded = load_sphere(context.loaded, light, file, layer); !loaded) {
    return loaded.error();
  }
  if (target > 0.0F) {
    const double has = illuminance_of(layer);
    if (has > 0.0) layer.color *= static_cast<float>(static_cast<double>(target) / has);
  }
  return layer;
}

}  // namespace

void add_environment(Context& context, const std::vector<const LightEntity*>& lights,
                     YamlMap& out) {
  Rgb color(0.0F);
  bool pictures = false;
  for (const LightEntity* light : lights) {
    const auto layer = sky_of(context, *light, false);
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
  for (const LightEntity& light : scene.scene.lights) {
    if (light.type != "infinite") continue;
    auto layer = sky_of(context, light, true);
    if (!layer) return layer.error();
    layers.push_back(std::move(*layer));
  }
  return make_panorama(layers);
}

}  // namespace hyades::core::pbrt
