#include "import/pbrt/lights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "import/pbrt/light_values.h"
#include "import/pbrt/pictured_lights.h"
#include "import/pbrt/sky.h"

namespace hyades::core::pbrt {
namespace {

void add_point(Context& context, const LightEntity& light, ParameterReader& reader) {
  Rgb intensity = light_value(context, light, reader, "I");
  if (const float power = reader.number("power", -1.0F); power > 0.0F) {
    intensity *= power / kAllRound;
  }
  const Vec3d from = reader.triple("point3", "from", Vec3d(0.0));
  context.lights.put(context.light_names.add("point"),
                     YamlMap{{"type", yaml_word("point")},
                             {"at", yaml_vector(place_of(context, light, from))},
                             {"color", color_node(intensity)},
                             {"power", yaml_number(kAllRound)}}
                         .node());
}

void add_spot(Context& context, const LightEntity& light, ParameterReader& reader) {
  Rgb intensity = light_value(context, light, reader, "I");
  const float angle = reader.number("coneangle", 30.0F);
  if (!(angle > 0.0F && angle <= 180.0F)) {
    context.report.error(light.place, "a spotlight's coneangle is above 0 and at most 180");
    return;
  }
  const float fading = std::clamp(reader.number("conedeltaangle", 5.0F), 0.0F, angle);
  if (const float power = reader.number("power", -1.0F); power > 0.0F) {
    const float outer = std::cos(angle * kPi / 180.0F);
    const float inner = std::cos((angle - fading) * kPi / 180.0F);
    intensity *= power / (2.0F * kPi * ((1.0F - inner) + (inner - outer) / 2.0F));
  }
  const Vec3d from = reader.triple("point3", "from", Vec3d(0.0));
  const Vec3d to = reader.triple("point3", "to", Vec3d(0.0, 0.0, 1.0));
  if (from == to) {
    context.report.error(light.place, "a spotlight's 'from' and 'to' are the same point");
    return;
  }
  context.lights.put(context.light_names.add("spot"),
                     YamlMap{{"type", yaml_word("spot")},
                             {"at", yaml_vector(place_of(context, light, from))},
                             {"look_at", yaml_vector(place_of(context, light, to))},
                             {"color", color_node(intensity)},
                             {"power", yaml_number(kAllRound)},
                             {"angle", yaml_number(angle)},
                             {"blend", yaml_number(fading / angle)}}
                         .node());
}

void add_distant(Context& context, const LightEntity& light, ParameterReader& reader) {
  Rgb irradiance = light_value(context, light, reader, "L");
  if (const float target = reader.number("illuminance", -1.0F); target > 0.0F) irradiance *= target;
  const Vec3d from = reader.triple("point3", "from", Vec3d(0.0));
  const Vec3d to = reader.triple("point3", "to", Vec3d(0.0, 0.0, 1.0));
  const Vec3d way =
      glm::dmat3(context.to_job * light.to_world.at[0]) * (from == to ? Vec3d(0.0) : to - from);
  if (!(glm::dot(way, way) > 0.0)) {
    context.report.error(light.place, "a distant light's 'from' and 'to' are the same point");
    return;
  }
  context.lights.put(context.light_names.add("distant"),
                     YamlMap{{"type", yaml_word("sun")},
                             {"direction", yaml_vector(Vec3(glm::normalize(way)))},
                             {"color", color_node(irradiance)},
                             {"irradiance", yaml_number(1.0F)},
                             {"angle", yaml_number(0.0F)}}
                         .node());
}

}  // namespace

void add_lights(Context& context, YamlMap& out) {
  std::vector<const LightEntity*> infinite;
  for (size_t i = 0; i < context.scene.lights.size(); ++i) {
    const LightEntity& light = context.scene.lights[i];
    if (light.type == "infinite") {
      infinite.push_back(&light);
      continue;
    }
    ParameterReader reader = read(context, light);
    if (light.to_world.moves()) {
      context.report.note(light.place, "lights stay where they are while the shutter is open");
    }
    if (light.type == "point") {
      add_point(context, light, reader);
    } else if (light.type == "spot") {
      add_spot(context, light, reader);
    } else if (light.type == "goniometric") {
      add_goniometric(context, i, reader);
    } else if (light.type == "projection") {
      add_projection(context, light, reader);
    } else if (light.type == "distant") {
      add_distant(context, light, reader);
    } else {
      const std::vector<std::string> names = {"distant", "goniometric", "infinite",
                                              "point",   "projection",  "spot"};
      context.report.error(
          light.place, "there is no light '" + light.type + "'" + did_you_mean(light.type, names));
      continue;
    }
    reader.note_unused();
  }
  if (!infinite.empty()) add_environment(context, infinite, out);
}

YamlPtr emission_node(Context& context, const Entity& light) {
  ParameterReader reader = read(context, light);
  if (light.type != "diffuse") {
    context.report.error(light.place, "there is no area light '" + light.type + "'");
    return nullptr;
  }
  const std::string picture = reader.text("filename");
  const bool two_sided = reader.flag("twosided", false);
  const float power = reader.number("power", -1.0F);
  YamlMap out;
  float strength = 1.0F;
  if (picture.empty()) {
    out.put("color", color_node(light_value(context, light, reader, "L")));
  } else {
    const std::string file = context.beside(picture, light.place);
    if (file.empty()) return nullptr;
    out.put("color", YamlMap{{"type", yaml_word("image")}, {"file", yaml_text(file)}});
    strength = light_scale(context, light, reader);
  }
  if (power > 0.0F) {
    out.put("power", yaml_number(power * strength));
  } else {
    out.put("radiance", yaml_number(strength));
  }
  if (two_sided) out.put("two_sided", yaml_flag(true));
  reader.note_unused();
  return out.node();
}

}  // namespace hyades::core::pbrt
