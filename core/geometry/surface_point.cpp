#include "core/geometry/surface_point.h"

#include <algorithm>
#include <cmath>

namespace hyades::core {
namespace {

/// Part of a shadow ray's length that is left out at its end, for what rounding of its direction
/// does to a point that far away.
constexpr double kEndMargin = 0x1p-20;

/// Multiple of the target's clearance that is left out too. The ray meets the target's plane at a
/// slant, so one clearance along the ray is less than one along the normal.
constexpr double kTargetMargin = 8.0;

/// A ray between two places that are already clear of their surfaces; `gap` is left out at its end.
Ray segment(const Vec3& from, const Vec3& to, float time, double gap) {
  const Vec3d d = Vec3d(to) - Vec3d(from);
  const double length = std::sqrt(glm::dot(d, d));
  Ray ray;
  ray.origin = from;
  ray.time = time;
  ray.t_max = 0.0F;
  if (!(length > 0.0)) return ray;
  ray.direction = Vec3(d * (1.0 / length));
  ray.t_max = static_cast<float>(std::max(0.0, length * (1.0 - kEndMargin) - gap));
  return ray;
}

}  // namespace

Vec3 offset_position(const SurfacePoint& p, const Vec3& direction) {
  const float side = glm::dot(direction, p.ng) >= 0.0F ? p.clearance : -p.clearance - p.thickness;
  return p.position + p.ng * side;
}

Ray spawn_ray(const SurfacePoint& p, const Vec3& direction, float t_max) {
  return {offset_position(p, direction), direction, t_max, p.time};
}

Ray spawn_ray_to(const SurfacePoint& p, const Vec3& target, float target_clearance) {
  return segment(offset_position(p, target - p.position), target, p.time,
                 kTargetMargin * static_cast<double>(target_clearance));
}

Ray ray_between(const Vec3& from, const Vec3& target, float time) {
  return segment(from, target, time, 0.0);
}

Ray spawn_ray_to(const SurfacePoint& p, const SurfacePoint& target) {
  const Vec3 d = target.position - p.position;
  return segment(offset_position(p, d), offset_position(target, -d), p.time, 0.0);
}

}  // namespace hyades::core
