#include "core/scene/light_makers.h"

#include <cmath>

#include "core/base/elementary.h"
#include "core/cameras/axes.h"
#include "core/scene/name_table.h"
#include "core/scene/transforms.h"

namespace hyades::core {
namespace {

/// `v` at length 1; down where it has none.
Vec3 direction_of(const Vec3& v) {
  const float length = std::sqrt(glm::dot(v, v));
  return length > 0.0F ? v / length : Vec3(0.0F, -1.0F, 0.0F);
}

/// What the light's transform makes of a place [units].
Vec3 moved(const LightDesc& desc, const Vec3& place, const LightSetting& setting) {
  if (desc.transform.empty()) return place;
  const Mat4 matrix = transform_at(desc.transform, Animated<Vec3>(Vec3(0.0F)), setting.time);
  return Vec3(matrix * Vec4(place, 1.0F));
}

/// What the light's transform makes of a direction.
Vec3 turned(const LightDesc& desc, const Vec3& direction, const LightSetting& setting) {
  if (desc.transform.empty()) return direction;
  const Mat4 matrix = transform_at(desc.transform, Animated<Vec3>(Vec3(0.0F)), setting.time);
  return Vec3(matrix * Vec4(direction, 0.0F));
}

Vec3 place_of(const LightDesc& desc, const LightSetting& setting) {
  return moved(desc, desc.at.at(setting.time), setting) * setting.units;
}

Rgb power_of(const LightDesc& desc, const LightSetting& setting) {
  return desc.color.at(setting.time) * desc.power.at(setting.time);
}

/// What the light's transform makes of the axes of its picture: mirrored where it mirrors, at right
/// angles again where it stretches or shears (z goes where it is sent, y as far as that allows).
Mat3 turned_axes(const LightDesc& desc, const Mat3& axes, const LightSetting& setting) {
  if (desc.transform.empty()) return axes;
  const Vec3 forward = direction_of(turned(desc, axes[2], setting));
  const CameraAxes square = axes_along(forward, turned(desc, axes[1], setting));
  const bool other_hand = glm::dot(square.right, turned(desc, axes[0], setting)) < 0.0F;
  return {other_hand ? -square.right : square.right, square.up, square.forward};
}

Result<LightPtr> point(const LightDesc& desc, const LightSetting& setting, SceneCache& cache) {
  const Vec3 at = place_of(desc, setting);
  if (desc.image.empty()) return make_point_light(at, power_of(desc, setting));
  auto map = cache.environment_map(desc.image);
  if (!map) return map.error();
  return make_goniometric_light(at, turned_axes(desc, Mat3(1.0F), setting), power_of(desc, setting),
                                std::move(*map));
}

Result<LightPtr> projector(const LightDesc& desc, const LightSetting& setting, SceneCache& cache) {
  auto gobo = cache.gobo(desc.image);
  if (!gobo) return gobo.error();
  const JobTime& time = setting.time;
  const CameraAxes view = axes_along(desc.look_at.at(time) - desc.at.at(time), desc.up.at(time));
  return make_projector_light(
      place_of(desc, setting), turned_axes(desc, Mat3(view.right, view.up, view.forward), setting),
      power_of(desc, setting), desc.fov.at(time) * kRadians, std::move(*gobo));
}

Result<LightPtr> spot(const LightDesc& desc, const LightSetting& setting, SceneCache& /*cache*/) {
  const Vec3 at = place_of(desc, setting);
  const Vec3 towards = moved(desc, desc.look_at.at(setting.time), setting) * setting.units - at;
  const float outer = desc.angle.at(setting.time) * kRadians;
  const float inner = outer * (1.0F - desc.blend.at(setting.time));
  return make_spot_light(at, direction_of(towards), power_of(desc, setting), cos(inner),
                         cos(outer));
}

Result<LightPtr> sun(const LightDesc& desc, const LightSetting& setting, SceneCache& /*cache*/) {
  return make_sun_light(direction_of(turned(desc, desc.direction.at(setting.time), setting)),
                        desc.color.at(setting.time) * desc.irradiance.at(setting.time),
                        desc.angle.at(setting.time) * kRadians, setting.world_radius);
}

using LightMaker = Result<LightPtr> (*)(const LightDesc&, const LightSetting&, SceneCache&);
constexpr std::array<NameRow<LightMaker>, 4> kLightMakers = {{
    {"point", point},
    {"spot", spot},
    {"projector", projector},
    {"sun", sun},
}};

}  // namespace

Result<LightPtr> make_light(const LightDesc& desc, const LightSetting& setting, SceneCache& cache) {
  const auto make = look_up(kLightMakers, desc.type, "type of light");
  if (!make) return make.error().in("light '" + desc.name + "'");
  auto light = (*make)->value(desc, setting, cache);
  if (!light) return light.error().in("light '" + desc.name + "'");
  return light;
}

std::vector<std::string> made_light_types() { return names_of(kLightMakers); }

}  // namespace hyades::core
