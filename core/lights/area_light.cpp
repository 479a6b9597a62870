#include "core/lights/area_light.h"

#include <cmath>

namespace hyades::core {

AreaLight::AreaLight(const Rgb& radiance, bool two_sided, double area)
    : radiance_(radiance), two_sided_(two_sided) {
  power_ = static_cast<float>(static_cast<double>(luminance(radiance)) * static_cast<double>(kPi) *
                              area * (two_sided ? 2.0 : 1.0));
  if (!(power_ > 0.0F)) power_ = 0.0F;
}

Rgb AreaLight::radiance(const SurfacePoint& on, const Vec3& outward) const {
  return emitted(on.ng, outward);
}

Rgb AreaLight::emitted(const Vec3& ng, const Vec3& outward) const {
  return two_sided_ || glm::dot(ng, outward) > 0.0F ? radiance_ : Rgb(0.0F);
}

std::optional<LightSample> AreaLight::seen_from(const Vec3& from, const Vec3& position,
                                                const Vec3& ng, float clearance,
                                                float pdf_area) const {
  const Vec3 to_light = position - from;
  const float distance2 = glm::dot(to_light, to_light);
  if (!(distance2 > 0.0F)) return std::nullopt;
  LightSample sample;
  sample.distance = std::sqrt(distance2);
  sample.direction = to_light / sample.distance;
  sample.radiance = emitted(ng, -sample.direction);
  sample.pdf = area_to_solid_angle(pdf_area, from, position, ng);
  if (is_black(sample.radiance) || !(sample.pdf > 0.0F)) return std::nullopt;
  sample.position = position + ng * std::copysign(clearance, -glm::dot(ng, to_light));
  return sample;
}

float area_to_solid_angle(float pdf_area, const Vec3& from, const Vec3& position, const Vec3& ng) {
  const Vec3 to_light = position - from;
  const float distance2 = glm::dot(to_light, to_light);
  const float facing = std::abs(glm::dot(ng, to_light));
  // distance^2 / cos = distance^3 / |n . to_light|
  const float pdf = pdf_area * distance2 * std::sqrt(distance2) / facing;
  return std::isfinite(pdf) ? pdf : 0.0F;
}

}  // namespace hyades::core
