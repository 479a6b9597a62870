#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/frame.h"
#include "core/base/warp.h"
#include "core/lights/quadric_light.h"

namespace hyades::core {

namespace {

/// What a point outside sees of a ball.
struct Cap {
  Vec3d center{0.0};
  double radius = 0.0;
  Vec3d axis{0.0};             ///< unit, from the point to the centre
  double sin_max = 0.0;        ///< of the angle between the axis and the rim
  double one_minus_cos = 0.0;  ///< of the same angle; the solid angle is 2 pi times this

  float pdf() const {
    return static_cast<float>(1.0 / (2.0 * static_cast<double>(kPi) * one_minus_cos));
  }
};

/// The cap of the sphere around the origin with `radius`, under `matrix`, as seen from `from`.
/// Nothing where the matrix makes an ellipsoid of it, or where `from` is inside or so near the
/// surface that rounding decides on which side it is. All in double: the difference of distance and
/// radius counts near the surface, the smallness of the cap far away.
std::optional<Cap> cap_from(const Mat4& matrix, float radius, const Vec3& from) {
  const Vec3 a(matrix[0]);
  const Vec3 b(matrix[1]);
  const Vec3 c(matrix[2]);
  const float scale2 = glm::dot(a, a);
  constexpr float kRound = 1e-5F;  // unevenness that is still a sphere
  const Vec3 lengths2(scale2, glm::dot(b, b), glm::dot(c, c));
  const Vec3 angles(glm::dot(a, b), glm::dot(b, c), glm::dot(c, a));
  if (!(max_component(glm::abs(lengths2 - scale2)) <= kRound * scale2) ||
      !(max_component(glm::abs(angles)) <= kRound * scale2)) {
    return std::nullopt;
  }
  Cap cap;
  cap.center = Vec3d(matrix[3]);
  cap.radius = std::sqrt(static_cast<double>(scale2)) * static_cast<double>(radius);
  const Vec3d to_center = cap.center - Vec3d(from);
  const double distance = std::sqrt(glm::dot(to_center, to_center));
  const Vec3 reach = glm::abs(Vec3(matrix[3]));
  const double rounding =
      2e-6 * (static_cast<double>(max_component(reach)) + cap.radius + distance);
  if (!(distance > cap.radius + rounding)) return std::nullopt;
  cap.axis = to_center / distance;
  cap.sin_max = cap.radius / distance;
  const double cos_max = std::sqrt((distance - cap.radius) * (distance + cap.radius)) / distance;
  cap.one_minus_cos = cap.sin_max * cap.sin_max / (1.0 + cos_max);
  if (!(cap.one_minus_cos > 0.0)) return std::nullopt;
  return cap;
}

/// The normal of the place that is seen in a direction of the cap chosen by the equal-area map of a
/// disc.
Vec3d normal_of_place(const Cap& cap, const Vec2& u) {
  // 1 - cos of the angle theta from the axis grows with the square of the disc's radius. On the
  // sphere the direction meets the place at angle alpha from the axis, seen from the centre: with
  // sin(beta) = sin(theta) / sin_max (law of sines), alpha = beta - theta.
  const Vec2 disc = square_to_disk(u);
  const double r2 = std::min(static_cast<double>(glm::dot(disc, disc)), 1.0);
  const double drop = r2 * cap.one_minus_cos;
  const double sin_beta_over_r = std::sqrt((2.0 - drop) / (2.0 - cap.one_minus_cos));
  const double sin_beta2 = std::min(r2 * sin_beta_over_r * sin_beta_over_r, 1.0);
  const double cos_beta = std::sqrt(1.0 - sin_beta2);
  const double cos_theta = 1.0 - drop;
  const double cos_alpha = cos_beta * cos_theta + sin_beta2 * cap.sin_max;
  const double sin_alpha_over_r = sin_beta_over_r * (cos_theta - cos_beta * cap.sin_max);

  const Frame frame = Frame::around(Vec3(cap.axis));
  const Vec3d across(frame.s * disc.x + frame.t * disc.y);
  return glm::normalize(sin_alpha_over_r * across - cos_alpha * cap.axis);
}

}  // namespace

std::optional<LightSample> SphereLight::sample_direct(const Vec3& from, float time, float pick,
                                                      const Vec2& u) const {
  const Mat4 matrix = to_world(time);
  const std::optional<Cap> cap = cap_from(matrix, shape().radius, from);
  if (!cap) return QuadricLight::sample_direct(from, time, pick, u);
  if (is_dark()) return std::nullopt;
  if (emission().varies()) {
    const bool by_angle = u.x < 0.5F;
    const Vec2 left(by_angle ? 2.0F * u.x : 2.0F * u.x - 1.0F, u.y);
    Place place;
    if (by_angle) {
      const Vec3d position = cap->center + cap->radius * normal_of_place(*cap, left);
      place = place_near(transform_point(glm::inverse(matrix), Vec3(position)), time);
    } else {
      place = place_at(time, left);
    }
    auto sample = seen_from(from, place);
    if (sample) sample->pdf = pdf_direct(from, sample->direction, place.on);
    return sample;
  }

  const Vec3d normal = normal_of_place(*cap, u);
  LightSample sample;
  const Vec3d position = cap->center + cap->radius * normal;
  const Vec3d to_light = position - Vec3d(from);
  const double distance = std::sqrt(glm::dot(to_light, to_light));
  if (!(distance > 0.0)) return std::nullopt;
  sample.direction = Vec3(to_light / distance);
  const Vec3 ng(normal);
  // The rim is seen too, edge-on.
  sample.radiance = emission().profile ? emitted(ng, -sample.direction) : emission().radiance;
  if (is_black(sample.radiance)) return std::nullopt;
  sample.pdf = cap->pdf();
  sample.distance = static_cast<float>(distance);
  sample.position = Vec3(position);
  sample.position += ng * quadric_clearance(sample.position, ng);
  sample.normal = ng;
  sample.pdf_place =
      static_cast<float>(0.25 / (static_cast<double>(kPi) * cap->radius * cap->radius));
  return sample;
}

float SphereLight::pdf_direct(const Vec3& from, const Vec3& direction,
                              const SurfacePoint& on) const {
  const std::optional<Cap> cap = cap_from(to_world(on.time), shape().radius, from);
  if (!cap) return QuadricLight::pdf_direct(from, direction, on);
  if (is_dark()) return 0.0F;
  // From outside only the near side is chosen by angle.
  const float by_angle = glm::dot(direction, on.ng) > 0.0F ? 0.0F : cap->pdf();
  return emission().varies() ? 0.5F * (by_angle + QuadricLight::pdf_direct(from, direction, on))
                             : by_angle;
}

}  // namespace hyades::core
