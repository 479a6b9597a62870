#pragma once

#include <optional>

#include "core/base/vec.h"
#include "core/geometry/shape.h"

namespace hyades::core {

/// A sphere, disk or cylinder in its object space, intersected exactly in double precision.
struct Quadric {
  Shape::Kind kind = Shape::Kind::sphere;
  double radius = 1.0;
  double height = 1.0;
};

/// The least t in (t_min, t_max) at which origin + t * direction lies on the quadric.
std::optional<double> meet_quadric(const Quadric& q, const Vec3d& origin, const Vec3d& direction,
                                   double t_min, double t_max);

/// What lies at a point of the quadric, in object space.
struct QuadricPoint {
  Vec3d position;  ///< the given point, moved onto the surface
  Vec3d normal;    ///< unit, outward
  Vec2 uv;         ///< as documented at Shape::Kind
  Vec3d dpdu;      ///< zero where the parametrisation is singular
  Vec3d dpdv;
};

QuadricPoint quadric_point(const Quadric& q, const Vec3d& near);

}  // namespace hyades::core
