#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "core/base/vec.h"

namespace hyades::core {

/// Whether lines go through triangles, without gaps or overlaps between neighbours (Woop, Benthin &
/// Wald 2013, "Watertight Ray/Triangle Intersection"): corners are sheared so that the line becomes
/// an axis, each by itself, and the sign of a difference of two products is exact.
class WatertightLine {
 public:
  WatertightLine(const Vec3d& origin, const Vec3d& direction) : origin_(origin) {
    const Vec3d size = glm::abs(direction);
    z_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    x_ = (z_ + 1) % 3;
    y_ = (z_ + 2) % 3;
    shear_x_ = direction[x_] / direction[z_];
    shear_y_ = direction[y_] / direction[z_];
  }

  /// Whether the line goes through the triangle or its edge. Never where it is seen edge-on.
  bool meets(const std::array<Vec3d, 3>& corners) const {
    const auto [ax, ay] = sheared(corners[0]);
    const auto [bx, by] = sheared(corners[1]);
    const auto [cx, cy] = sheared(corners[2]);
    const double u = cx * by - cy * bx;
    const double v = ax * cy - ay * cx;
    const double w = bx * ay - by * ax;
    const bool some_below = u < 0.0 || v < 0.0 || w < 0.0;
    const bool some_above = u > 0.0 || v > 0.0 || w > 0.0;
    return some_below != some_above;
  }

 private:
  std::pair<double, double> sheared(const Vec3d& corner) const {
    const Vec3d p = corner - origin_;
    return {p[x_] - shear_x_ * p[z_], p[y_] - shear_y_ * p[z_]};
  }

  Vec3d origin_;
  int x_;
  int y_;
  int z_;
  double shear_x_;
  double shear_y_;
};

}  // namespace hyades::core
