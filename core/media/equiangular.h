#pragma once

#include "core/base/ray.h"

namespace hyades::core {

/// Places along a ray chosen so that they are seen from a point at equal angles: what light that
/// falls off with the squared distance from there asks for (Kulla and Fajardo 2012, "Importance
/// Sampling Techniques for Path Tracing in Participating Media", section 4).
class Equiangular {
 public:
  /// On the way of `ray` to `t_max` (may be infinite), as seen from `point`.
  Equiangular(const Ray& ray, float t_max, const Vec3& point);

  /// The angle under which the way is seen.
  float angle() const { return angle_; }

  /// The place on the way that is nearest to the point.
  float nearest() const;

  /// A place in [0, t_max] for u in [0, 1).
  float sample(float u) const;

  /// Density of sample() per length; 0 beyond the way's ends.
  float pdf(float t) const;

 private:
  float nearest_;   ///< where the ray is nearest to the point
  float distance_;  ///< then; at least a little of the way there, so that densities stay finite
  float t_max_;
  float begin_;  ///< angle at which the way begins, from the direction to the nearest place
  float angle_;  ///< under which all of it is seen
};

}  // namespace hyades::core
