#include "core/lights/area_light.h"

#include <cmath>

#include "core/base/frame.h"
#include "core/base/warp.h"

namespace hyades::core {

AreaLight::AreaLight(const SurfaceEmission& emission, double brightness) : emission_(emission) {
  power_ =
      static_cast<float>(brightness * static_cast<double>(kPi) * (emission.two_sided ? 2.0 : 1.0));
  if (emission.profile) power_ *= emission.profile->mean();
  if (!(power_ > 0.0F)) power_ = 0.0F;
}

void AreaLight::scale(float factor) {
  emission_.radiance *= factor;
  power_ *= factor;
}

void AreaLight::set_surface(const Bounds& box, const DirectionCone& normals) {
  LightBounds bounds;
  bounds.box = box;
  bounds.normals = normals;
  bounds.two_sided = emission_.two_sided;
  if (emission_.profile) emission_.profile->narrow(bounds);
  bounds.set_power(power_);
  bounds_ = bounds.power > 0.0F && !box.empty() ? std::optional(bounds) : std::nullopt;
}

Rgb AreaLight::radiance(const SurfacePoint& on, const Vec3& outward) const {
  const Rgb radiance = emitted(on.ng, outward);
  return emission_.varies() && !is_black(radiance) ? radiance * emission_.share(on) : radiance;
}

std::optional<EmissionSample> AreaLight::sample_emission(float time, float pick, const Vec2& place,
                                                         const Vec2& direction) const {
  if (is_dark()) return std::nullopt;
  const std::optional<Place> chosen = choose_place(time, pick, place);
  if (!chosen || !(chosen->pdf > 0.0F)) return std::nullopt;
  EmissionSample sample;
  sample.on = chosen->on;
  sample.pdf_place = chosen->pdf;
  Vec2 u = direction;
  Vec3 normal = sample.on.ng;
  if (emission_.two_sided) {
    const bool inner = u.x >= 0.5F;
    if (inner) normal = -normal;
    u.x = inner ? 2.0F * u.x - 1.0F : 2.0F * u.x;
  }
  sample.direction = glm::normalize(
      emission_.profile ? emission_.profile->choose(normal, u)
                        : Frame::around(normal).to_world(square_to_cosine_hemisphere(u)));
  const float cosine = std::abs(glm::dot(sample.direction, sample.on.ng));
  sample.pdf_direction = pdf_outward(sample.on.ng, sample.direction);
  if (!(sample.pdf_direction > 0.0F)) return std::nullopt;
  sample.weight = emitted(sample.on.ng, sample.direction) *
                  (cosine / (sample.pdf_place * sample.pdf_direction));
  if (is_black(sample.weight)) return std::nullopt;
  if (emission_.varies()) sample.weight *= emission_.share(sample.on);
  return sample;
}

float AreaLight::pdf_outward(const Vec3& normal, const Vec3& outward) const {
  const float cosine = glm::dot(normal, outward);
  const float sides = emission_.two_sided ? 0.5F : 1.0F;
  if (emission_.profile) {
    const bool inner = emission_.two_sided && cosine < 0.0F;
    return sides * emission_.profile->pdf(inner ? -normal : normal, outward);
  }
  return sides * cosine_hemisphere_pdf(emission_.two_sided ? std::abs(cosine) : cosine);
}

Rgb AreaLight::emitted(const Vec3& ng, const Vec3& outward) const {
  const float cosine = glm::dot(ng, outward);
  if (!emission_.two_sided && !(cosine > 0.0F)) return Rgb(0.0F);
  if (!emission_.profile) return emission_.radiance;
  return emission_.radiance * emission_.profile->share(cosine < 0.0F ? -ng : ng, outward);
}

std::optional<LightSample> AreaLight::seen_from(const Vec3& from, const Place& place) const {
  const SurfacePoint& on = place.on;
  auto sample = seen_from(from, on.position, on.ng, on.clearance, place.pdf);
  if (sample && emission_.varies()) sample->radiance *= emission_.share(on);
  if (sample && is_black(sample->radiance)) return std::nullopt;
  return sample;
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
  sample.normal = ng;
  sample.pdf_place = pdf_area;
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
