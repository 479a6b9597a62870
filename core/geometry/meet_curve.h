#pragma once

#include <optional>

#include "core/geometry/curve_set.h"

namespace hyades::core {

/// Where a line meets the tube about a piece of a curve.
struct CurveHit {
  double t = 0.0;  ///< in lengths of the line's direction
  double u = 0.0;  ///< along the piece, 0..1
};

/// The least t in (t_min, t_max) at which origin + t * direction lies on the tube: at distance
/// radius(u) from the curve's place u, in the plane through it that the curve crosses at a right
/// angle. By Newton's method in double precision from the straight tubes about eight parts of the
/// piece.
std::optional<CurveHit> meet_curve(const CurvePiece& piece, const Vec3d& origin,
                                   const Vec3d& direction, double t_min, double t_max);

/// What lies at a point of the tube, in object space.
struct CurvePoint {
  Vec3d position;  ///< the given point, moved onto the tube
  Vec3d normal;    ///< unit, outward
  Vec3d outward;   ///< unit, from the axis to the point
  Vec3d tangent;   ///< along growing u, as long as the curve grows with u
  double radius;
};
CurvePoint curve_point(const CurvePiece& piece, double u, const Vec3d& near);

}  // namespace hyades::core
