#include "core/geometry/quadric.h"

#include <cmath>
#include <numbers>

#include "core/base/elementary.h"

namespace hyades::core {
namespace {

/// Both t at which a line crosses a circle or sphere around the origin, in order.
struct Roots {
  double near;
  double far;
};

/// Solves |o + t d| = radius in two or three dimensions, without cancellation: the discriminant
/// from the point of closest approach (Haines et al. 2019, "Precision Improvements for Ray/Sphere
/// Intersection"), the smaller root from the product of both.
template <class Vec>
std::optional<Roots> meet_round(const Vec& o, const Vec& d, double radius) {
  const double a = glm::dot(d, d);
  if (!(a > 0.0)) return std::nullopt;
  const double closest = -glm::dot(o, d) / a;
  const Vec p = o + d * closest;
  const double p_length = std::sqrt(glm::dot(p, p));
  const double discriminant = (radius - p_length) * (radius + p_length);
  if (!(discriminant >= 0.0)) return std::nullopt;
  const double half = std::sqrt(discriminant / a);
  const double larger = closest >= 0.0 ? closest + half : closest - half;
  if (larger == 0.0) return std::nullopt;
  const double o_length = std::sqrt(glm::dot(o, o));
  const double smaller = (o_length - radius) * (o_length + radius) / (a * larger);
  return smaller < larger ? Roots{smaller, larger} : Roots{larger, smaller};
}

/// Angle around +y from +x towards -z as a fraction of a full turn, in [0, 1).
float turn(double x, double z) {
  const float angle = atan2(static_cast<float>(-z), static_cast<float>(x)) * (0.5F * kInvPi);
  if (angle >= 0.0F) return angle;
  return angle + 1.0F < 1.0F ? angle + 1.0F : 0.0F;
}

QuadricPoint sphere_point(const Quadric& q, const Vec3d& near) {
  const double length = std::sqrt(glm::dot(near, near));
  const Vec3d n = length > 0.0 ? near / length : Vec3d(0.0, 1.0, 0.0);
  const Vec3d p = n * q.radius;
  const double rho = std::sqrt(p.x * p.x + p.z * p.z);
  const float from_below = atan2(static_cast<float>(rho), static_cast<float>(-p.y));
  QuadricPoint out{p, n, {turn(p.x, p.z), from_below * kInvPi}, Vec3d(0.0), Vec3d(0.0)};
  if (rho > 0.0) {
    out.dpdu = 2.0 * std::numbers::pi * Vec3d(p.z, 0.0, -p.x);
    out.dpdv = std::numbers::pi * Vec3d(-p.y * p.x / rho, rho, -p.y * p.z / rho);
  }
  return out;
}

QuadricPoint disk_point(const Quadric& q, const Vec3d& near) {
  const double rho = std::sqrt(near.x * near.x + near.z * near.z);
  QuadricPoint out{{near.x, 0.0, near.z},
                   {0.0, 1.0, 0.0},
                   {turn(near.x, near.z), static_cast<float>(rho / q.radius)},
                   Vec3d(0.0),
                   Vec3d(0.0)};
  if (rho > 0.0) {
    out.dpdu = 2.0 * std::numbers::pi * Vec3d(near.z, 0.0, -near.x);
    out.dpdv = q.radius / rho * Vec3d(near.x, 0.0, near.z);
  }
  return out;
}

QuadricPoint cylinder_point(const Quadric& q, const Vec3d& near) {
  const double rho = std::sqrt(near.x * near.x + near.z * near.z);
  const Vec3d n = rho > 0.0 ? Vec3d(near.x / rho, 0.0, near.z / rho) : Vec3d(1.0, 0.0, 0.0);
  const Vec3d p(n.x * q.radius, near.y, n.z * q.radius);
  return {p,
          n,
          {turn(p.x, p.z), static_cast<float>(near.y / q.height)},
          2.0 * std::numbers::pi * Vec3d(p.z, 0.0, -p.x),
          {0.0, q.height, 0.0}};
}

}  // namespace

std::optional<double> meet_quadric(const Quadric& q, const Vec3d& origin, const Vec3d& direction,
                                   double t_min, double t_max) {
  const auto inside = [&](double t) { return t > t_min && t < t_max; };
  switch (q.kind) {
    case Shape::Kind::mesh:
    case Shape::Kind::curves:
      break;
    case Shape::Kind::sphere: {
      const auto roots = meet_round(origin, direction, q.radius);
      if (!roots) break;
      if (inside(roots->near)) return roots->near;
      if (inside(roots->far)) return roots->far;
      break;
    }
    case Shape::Kind::disk: {
      if (direction.y == 0.0) break;
      const double t = -origin.y / direction.y;
      const double x = origin.x + t * direction.x;
      const double z = origin.z + t * direction.z;
      if (inside(t) && x * x + z * z <= q.radius * q.radius) return t;
      break;
    }
    case Shape::Kind::cylinder: {
      const auto roots = meet_round(glm::dvec2(origin.x, origin.z),
                                    glm::dvec2(direction.x, direction.z), q.radius);
      if (!roots) break;
      for (const double t : {roots->near, roots->far}) {
        const double y = origin.y + t * direction.y;
        if (inside(t) && y >= 0.0 && y <= q.height) return t;
      }
      break;
    }
  }
  return std::nullopt;
}

QuadricPoint quadric_point(const Quadric& q, const Vec3d& near) {
  switch (q.kind) {
    case Shape::Kind::disk:
      return disk_point(q, near);
    case Shape::Kind::cylinder:
      return cylinder_point(q, near);
    default:
      return sphere_point(q, near);
  }
}

}  // namespace hyades::core
