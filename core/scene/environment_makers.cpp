#include "core/scene/environment_makers.h"

#include <cmath>
#include <memory>

#include "core/base/elementary.h"
#include "core/scene/transforms.h"

namespace hyades::core {
namespace {

constexpr const char* kSky = "environment";

/// Towards the sun: where it stands above the horizon and counter-clockwise from -z [rad].
struct SunPlace {
  float elevation = 0.0F;
  float azimuth = 0.0F;
};

SunPlace place_of(const SkyDesc& desc, const JobTime& time) {
  if (!desc.sun_direction)
    return {desc.elevation.at(time) * kRadians, desc.azimuth.at(time) * kRadians};
  const Vec3 direction = desc.sun_direction->at(time);
  const float length = std::sqrt(glm::dot(direction, direction));
  const Vec3 sun = length > 0.0F ? direction / length : Vec3(0.0F, 1.0F, 0.0F);
  return {asin(sun.y), atan2(-sun.x, -sun.z)};
}

std::vector<NamedLight> make_clear_sky(const SkyDesc& desc, float turn, const Rgb& scale,
                                       const LightSetting& setting, SceneCache& cache) {
  const JobTime& time = setting.time;
  const SunPlace place = place_of(desc, time);
  SkySettings settings;
  settings.elevation = place.elevation;
  settings.turbidity = desc.turbidity.at(time);
  settings.ground_albedo = desc.ground_albedo.at(time);
  const float size = desc.sun_size.at(time) * kRadians;
  settings.sun_radius = 0.5F * size;
  settings.density = setting.sky_density;
  const std::shared_ptr<const Sky> sky = cache.sky(settings);
  const Rgb irradiance = scale * desc.irradiance.at(time);
  std::vector<NamedLight> lights;
  // The map's sun stands over +x; azimuths are counted from -z.
  lights.push_back({kSky, make_environment_map_light(sky->map, place.azimuth + turn + 0.5F * kPi,
                                                     irradiance, setting.world_radius)});
  if (!desc.sun || is_black(sky->sun)) return lights;
  const SinCos height = sin_cos(place.elevation);
  const SinCos compass = sin_cos(place.azimuth + turn);
  const Vec3 towards(-height.cos * compass.sin, height.sin, -height.cos * compass.cos);
  lights.push_back({"sun", make_sun_light(-towards, sky->sun * irradiance, size, kSunLimb,
                                          setting.world_radius)});
  return lights;
}

}  // namespace

SkyDensity sky_density(const IntegratorDesc& integrator) {
  return integrator.type == "path" ? SkyDensity::excess : SkyDensity::luminance;
}

Result<std::vector<NamedLight>> make_environment(const EnvironmentDesc& desc,
                                                 const LightSetting& setting, SceneCache& cache) {
  const Rgb scale = desc.color.at(setting.time) * desc.strength.at(setting.time);
  const float turn = desc.rotate_y.at(setting.time) * kRadians;
  if (desc.sky) return make_clear_sky(*desc.sky, turn, scale, setting, cache);
  std::vector<NamedLight> lights;
  if (desc.image.empty()) {
    lights.push_back({kSky, make_environment_light(nullptr, 0.0F, scale, setting.world_radius,
                                                   setting.sky_density)});
    return lights;
  }
  auto map = cache.environment_map(desc.image, setting.sky_density);
  if (!map) return map.error().in("environment");
  lights.push_back({kSky, make_environment_map_light(*map, turn, scale, setting.world_radius)});
  return lights;
}

}  // namespace hyades::core
