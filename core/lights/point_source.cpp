#include "core/lights/point_source.h"

#include <cmath>
#include <optional>

namespace hyades::core {

std::optional<LightSample> PointSource::sample_direct(const Vec3& from, float /*time*/,
                                                      float /*pick*/, const Vec2& /*u*/) const {
  const Vec3 to_light = position_ - from;
  const float distance2 = glm::dot(to_light, to_light);
  if (!(distance2 > 0.0F)) return std::nullopt;
  LightSample sample;
  sample.distance = std::sqrt(distance2);
  sample.direction = to_light / sample.distance;
  sample.radiance = intensity_ * (value(-sample.direction) / distance2);
  if (is_black(sample.radiance)) return std::nullopt;
  sample.pdf = 1.0F;
  sample.position = position_;
  sample.delta = true;
  return sample;
}

float PointSource::pdf_direct(const Vec3& /*from*/, const Vec3& /*direction*/,
                              const SurfacePoint& /*on*/) const {
  return 0.0F;
}

Rgb PointSource::radiance(const SurfacePoint& /*on*/, const Vec3& /*outward*/) const {
  return Rgb(0.0F);
}

std::optional<LightBounds> PointSource::bounds() const {
  LightBounds bounds;
  bounds.box = {position_, position_};
  bounds.normals = cone();
  bounds.cos_beyond = 1.0F;
  bounds.set_power(power());
  return bounds.power > 0.0F ? std::optional(bounds) : std::nullopt;
}

std::optional<EmissionSample> PointSource::sample_emission(float time, float /*pick*/,
                                                           const Vec2& /*place*/,
                                                           const Vec2& direction) const {
  if (!(power() > 0.0F)) return std::nullopt;
  EmissionSample sample;
  sample.direction = glm::normalize(choose(direction));
  sample.pdf_place = 1.0F;
  // Of the rounded direction: the number that pdf_outward finds.
  sample.pdf_direction = pdf(sample.direction);
  if (!(sample.pdf_direction > 0.0F)) return std::nullopt;
  sample.weight = intensity_ * (value(sample.direction) / sample.pdf_direction);
  if (is_black(sample.weight)) return std::nullopt;
  sample.on.position = position_;
  sample.on.ng = Vec3(0.0F);
  sample.on.time = time;
  return sample;
}

float PointSource::pdf_place(const SurfacePoint& /*on*/, const Vec3& /*direction*/) const {
  return 1.0F;
}

float PointSource::pdf_outward(const Vec3& /*normal*/, const Vec3& outward) const {
  return power() > 0.0F ? pdf(outward) : 0.0F;
}

}  // namespace hyades::core
