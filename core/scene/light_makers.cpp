#include "core/scene/light_makers.h"

#include <cmath>

#include "core/base/elementary.h"
#include "core/scene/name_table.h"
#include "core/scene/transforms.h"

namespace hyades::core {
namespace {

constexpr float kRadians = kPi / 180.0F;

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

/// The same of a direction.
Vec3 turned(const LightDesc& desc, const Vec3& direction, const LightSetting& setting) {
  if (desc.transform.empty()) return direction;
  const Mat4 matrix = transform_at(desc.transform, Animated<Vec3>(Vec3(0.0F)), setting.time);
  return Vec3(matrix * Vec4(direction, 0.0F));
}

LightPtr point(const LightDesc& desc, const LightSetting& setting) {
  return make_point_light(moved(desc, desc.at.at(setting.time), setting) * setting.units,
                          desc.color.at(setting.time) * desc.power.at(setting.time));
}

LightPtr spot(const LightDesc& desc, const LightSetting& setting) {
  const Vec3 at = moved(desc, desc.at.at(setting.time), setting) * setting.units;
  const Vec3 towards = moved(desc, desc.look_at.at(setting.time), setting) * setting.units - at;
  const float outer = desc.angle.at(setting.time) * kRadians;
  const float inner = outer * (1.0F - desc.blend.at(setting.time));
  return make_spot_light(at, direction_of(towards),
                         desc.color.at(setting.time) * desc.power.at(setting.time), cos(inner),
                         cos(outer));
}

LightPtr sun(const LightDesc& desc, const LightSetting& setting) {
  return make_sun_light(direction_of(turned(desc, desc.direction.at(setting.time), setting)),
                        desc.color.at(setting.time) * desc.irradiance.at(setting.time),
                        desc.angle.at(setting.time) * kRadians, setting.world_radius);
}

using Maker = LightPtr (*)(const LightDesc&, const LightSetting&);
constexpr std::array<NameRow<Maker>, 3> kMakers = {{
    {"point", point},
    {"spot", spot},
    {"sun", sun},
}};

}  // namespace

Result<LightPtr> make_light(const LightDesc& desc, const LightSetting& setting) {
  const auto make = look_up(kMakers, desc.type, "type of light");
  if (!make) return make.error().in("light '" + desc.name + "'");
  return (*make)->value(desc, setting);
}

std::vector<std::string> made_light_types() { return names_of(kMakers); }

}  // namespace hyades::core
