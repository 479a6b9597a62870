#include "core/scene/light_makers.h"

#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "core/base/elementary.h"
#include "core/cameras/axes.h"
#include "core/scene/transforms.h"

namespace hyades::core {
namespace {

/// `v` at length 1; down where it has none.
Vec3 direction_of(const Vec3& v) {
  const float length = std::sqrt(glm::dot(v, v));
  return length > 0.0F ? v / length : Vec3(0.0F, -1.0F, 0.0F);
}

/// Where a light stands and how it is turned.
class LightPlace {
 public:
  LightPlace(const TransformList& transform, const LightSetting& setting)
      : turned_(!transform.empty()), units_(setting.units) {
    if (turned_) matrix_ = transform_at(transform, Animated<Vec3>(Vec3(0.0F)), setting.time);
  }

  /// What the light's transform makes of a place [units], in metres.
  Vec3 place(const Vec3& at) const {
    return (turned_ ? Vec3(matrix_ * Vec4(at, 1.0F)) : at) * units_;
  }

  /// What it makes of a direction.
  Vec3 direction(const Vec3& v) const { return turned_ ? Vec3(matrix_ * Vec4(v, 0.0F)) : v; }

  /// What it makes of the axes of a picture: mirrored where it mirrors, at right angles again where
  /// it stretches or shears (z goes where it is sent, y as far as that allows).
  Mat3 axes(const Mat3& axes) const {
    if (!turned_) return axes;
    const Vec3 forward = direction_of(direction(axes[2]));
    const CameraAxes square = axes_along(forward, direction(axes[1]));
    const bool other_hand = glm::dot(square.right, direction(axes[0])) < 0.0F;
    return {other_hand ? -square.right : square.right, square.up, square.forward};
  }

 private:
  bool turned_;
  float units_;
  Mat4 matrix_{1.0F};
};

template <class Desc>
Rgb power_of(const Desc& desc, const JobTime& time) {
  return desc.color.at(time) * desc.power.at(time);
}

Result<PointSourcePtr> make(const PointLightDesc& desc, const LightPlace& place,
                            const LightSetting& setting, SceneCache& cache) {
  const Vec3 at = place.place(desc.at.at(setting.time));
  const Rgb power = power_of(desc, setting.time);
  if (desc.image.empty()) return make_point_light(at, power);
  auto map = cache.environment_map(desc.image, SkyDensity::luminance);
  if (!map) return map.error();
  return make_goniometric_light(at, place.axes(Mat3(1.0F)), power, std::move(*map));
}

Result<PointSourcePtr> make(const ProjectorLightDesc& desc, const LightPlace& place,
                            const LightSetting& setting, SceneCache& cache) {
  auto gobo = cache.gobo(desc.image);
  if (!gobo) return gobo.error();
  const JobTime& time = setting.time;
  const Vec3 at = desc.at.at(time);
  const CameraAxes view = axes_along(desc.look_at.at(time) - at, desc.up.at(time));
  return make_projector_light(place.place(at), place.axes({view.right, view.up, view.forward}),
                              power_of(desc, time), desc.fov.at(time) * kRadians, std::move(*gobo));
}

Result<PointSourcePtr> make(const SpotLightDesc& desc, const LightPlace& place,
                            const LightSetting& setting, SceneCache& /*cache*/) {
  const JobTime& time = setting.time;
  const Vec3 at = place.place(desc.at.at(time));
  const Vec3 towards = place.place(desc.look_at.at(time)) - at;
  const float outer = desc.angle.at(time) * kRadians;
  const float inner = outer * (1.0F - desc.blend.at(time));
  return make_spot_light(at, direction_of(towards), power_of(desc, time), cos(inner), cos(outer));
}

Result<LightPtr> make(const SunLightDesc& desc, const LightPlace& place,
                      const LightSetting& setting, SceneCache& /*cache*/) {
  const JobTime& time = setting.time;
  return make_sun_light(direction_of(place.direction(desc.direction.at(time))),
                        desc.color.at(time) * desc.irradiance.at(time),
                        desc.angle.at(time) * kRadians, setting.world_radius);
}

}  // namespace

Result<LightPtr> make_light(const LightDesc& desc, const LightSetting& setting, SceneCache& cache) {
  const LightPlace place(desc.transform, setting);
  return std::visit(
      [&](const auto& kind) -> Result<LightPtr> {
        auto light = make(kind, place, setting, cache);
        if (!light) return light.error().in("light '" + desc.name + "'");
        return LightPtr(std::move(*light));
      },
      desc.kind);
}

Result<std::optional<Lamp>> make_lamp(const LightDesc& desc, const LightSetting& setting,
                                      SceneCache& cache) {
  const LightPlace place(desc.transform, setting);
  return std::visit(
      [&](const auto& kind) -> Result<std::optional<Lamp>> {
        if constexpr (requires { kind.radius; }) {
          const float radius = kind.radius.at(setting.time) * setting.units;
          if (!(radius > 0.0F)) return std::optional<Lamp>();
          auto source = make(kind, place, setting, cache);
          if (!source) return source.error().in("light '" + desc.name + "'");
          const bool changes =
              !kind.at.is_constant() || !kind.radius.is_constant() || is_animated(desc.transform);
          return std::optional<Lamp>({std::move(*source), radius, changes});
        } else {
          return std::optional<Lamp>();
        }
      },
      desc.kind);
}

}  // namespace hyades::core
