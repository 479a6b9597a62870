#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/vec.h"

namespace hyades::core {

/// Unit roundoff of float: the largest relative error of one rounding.
inline constexpr double kRoundoff = 0x1p-24;

/// A triangle in double precision: a corner and the edges to the two others.
struct Triangle {
  Vec3d a;
  Vec3d e1;  ///< to corner 1
  Vec3d e2;  ///< to corner 2

  explicit Triangle(const std::array<Vec3d, 3>& corners)
      : a(corners[0]), e1(corners[1] - corners[0]), e2(corners[2] - corners[0]) {}
};

/// Where a line meets a triangle: distance in lengths of its direction and barycentrics of vertices
/// 1 and 2.
struct TriangleHit {
  double t;
  double u;
  double v;
};

/// Where the line through `origin` along `direction` meets the plane of a triangle (Moeller &
/// Trumbore 1997) in double precision with true divisions: the same bits on every processor. The
/// barycentrics are clamped onto the triangle. Nothing where the line is parallel to it.
inline std::optional<TriangleHit> meet_triangle(const Vec3d& origin, const Vec3d& direction,
                                                const Triangle& triangle) {
  const Vec3d& e1 = triangle.e1;
  const Vec3d& e2 = triangle.e2;
  const Vec3d h = glm::cross(direction, e2);
  const double determinant = glm::dot(e1, h);
  if (determinant == 0.0) return std::nullopt;
  const double scale = 1.0 / determinant;
  const Vec3d s = origin - triangle.a;
  const Vec3d q = glm::cross(s, e1);
  double u = std::max(glm::dot(s, h) * scale, 0.0);
  double v = std::max(glm::dot(direction, q) * scale, 0.0);
  if (u + v > 1.0) {
    const double sum = u + v;
    u /= sum;
    v /= sum;
  }
  return TriangleHit{glm::dot(e2, q) * scale, u, v};
}

/// How far Embree may misjudge the distance of a point, given by its offsets v0, v1, v2 to the
/// vertices of a triangle it lies on, from that triangle's plane with normal `n` (unit).
///
/// Embree's robust test rounds the offsets (which moves the plane by at most the largest rounding),
/// forms the normal from those two edges whose products are smaller, component by component, and
/// takes the sign of dot(v0, normal). The bound follows the rounding of each product: it vanishes
/// for planes that lie along the axes, and grows for triangles that are thin across their longest
/// edge.
inline double triangle_error(const Vec3d& v0, const Vec3d& v1, const Vec3d& v2, const Vec3d& n) {
  const Vec3d a = glm::abs(v2 - v0);
  const Vec3d b = glm::abs(v0 - v1);
  const Vec3d c = glm::abs(v1 - v2);
  const auto products = [&](int y, int z) {
    const double ab = a[z] * b[y];
    const double bc = b[z] * c[y];
    return ab < bc ? ab + a[y] * b[z] : bc + b[y] * c[z];
  };
  const Vec3d normal = glm::cross(v0 - v1, v1 - v2);
  const double area = std::sqrt(glm::dot(normal, normal));
  const Vec3d m = glm::abs(n);
  const double moved =
      std::max({glm::dot(m, glm::abs(v0)), glm::dot(m, glm::abs(v1)), glm::dot(m, glm::abs(v2))});
  const Vec3d rounding(products(1, 2), products(2, 0), products(0, 1));
  const double tilted = area > 0.0 ? glm::dot(glm::abs(v0), rounding) / area : 0.0;
  // Beyond this a point would be moved through whatever lies near.
  const double size = std::max({a.x, a.y, a.z, b.x, b.y, b.z});
  return kRoundoff * std::min(moved + 4.0 * tilted, 256.0 * size);
}

/// The largest triangle_error() of all points of the triangle with corners a, b, c: the bound is
/// convex in the point, so that is at a corner. Grown by what rounding it to float may take.
inline float largest_triangle_error(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d cross = glm::cross(b - a, c - a);
  const double area2 = glm::dot(cross, cross);
  const Vec3d n = area2 > 0.0 ? cross / std::sqrt(area2) : Vec3d(0.0, 1.0, 0.0);
  const auto error_at = [&](const Vec3d& p) { return triangle_error(a - p, b - p, c - p, n); };
  return static_cast<float>(std::max({error_at(a), error_at(b), error_at(c)}) * (1.0 + kRoundoff));
}

}  // namespace hyades::core
