#include "import/pbrt/light_values.h"

#include <algorithm>

namespace hyades::core::pbrt {

float light_scale(Context& context, const Entity& light, ParameterReader& reader) {
  const float scale = reader.number("scale", 1.0F);
  if (scale < 0.0F) context.report.error(light.place, "a light's scale is below 0");
  return std::max(scale, 0.0F) * context.exposure;
}

Rgb light_value(Context& context, const Entity& light, ParameterReader& reader, const char* name) {
  const float scale = light_scale(context, light, reader);
  const Parameter* p = reader.find(name);
  if (p == nullptr) return light_from_rgb(*light.space, Vec3d(1.0)) * scale;
  return color_of(context, *p, ColorUse::light).value_or(Rgb(0.0F)) * scale;
}

Vec3 place_of(Context& context, const LightEntity& light, const Vec3d& at) {
  return Vec3(Vec3d(context.to_job * light.to_world.at[0] * glm::dvec4(at, 1.0)));
}

}  // namespace hyades::core::pbrt
