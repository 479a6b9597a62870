#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/base/elementary.h"
#include "core/geometry/meet_curve.h"
#include "core/geometry/placed_object.h"
#include "core/geometry/triangle.h"

namespace hyades::core {
namespace {

/// How far Embree may misplace a tube, at most: as a part of its radius (its Newton's method ends
/// early), of its coordinates and of the length of its piece (rounding).
constexpr double kTubeError = 0.02;
constexpr double kPlaceError = 8.0 * kRoundoff;
constexpr double kLengthError = 64.0 * kRoundoff;

/// A ray in the space of strands, and the ways there and back.
struct LocalRay {
  Affine to_world;
  Affine to_object;
  Vec3d origin;
  Vec3d direction;

  LocalRay(const PlacedObject& object, const Ray& ray, const CopyPose* copy)
      : to_world(object.to_world_at(ray.time)), to_object(object.to_object_at(ray.time)) {
    if (copy != nullptr) {
      to_world = copy->to_world * to_world;
      to_object = to_object * copy->to_copy;
    }
    origin = to_object.point(Vec3d(ray.origin));
    direction = to_object.vector(Vec3d(ray.direction));
  }
};

/// By how much lengths grow at most.
double stretch_of(const Affine& m) {
  double most = 0.0;
  for (int i = 0; i < 3; ++i) most = std::max(most, glm::dot(m.linear[i], m.linear[i]));
  return std::sqrt(most);
}

Vec3d unit_or(const Vec3d& v, const Vec3d& other) {
  const double length2 = glm::dot(v, v);
  return length2 > 0.0 && std::isfinite(length2) ? v / std::sqrt(length2) : other;
}

/// How far around the strand, 0..1, from any beginning that does not change along it abruptly.
float turn_around(const Vec3d& outward, const Vec3d& tangent) {
  const Vec3d t = unit_or(tangent, Vec3d(0.0, 1.0, 0.0));
  const Vec3d start = std::abs(t.x) < 0.9 ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 0.0, 1.0);
  const Vec3d a = unit_or(start - t * glm::dot(start, t), Vec3d(0.0, 0.0, 1.0));
  const Vec3d b = glm::cross(t, a);
  const float angle =
      atan2(static_cast<float>(glm::dot(outward, b)), static_cast<float>(glm::dot(outward, a)));
  return angle * (0.5F * kInvPi) + 0.5F;
}

}  // namespace

std::optional<Hit> PlacedObject::meet_piece(const Ray& ray, uint32_t primitive,
                                            const CopyPose* copy, SurfacePoint* point) const {
  const LocalRay local(*this, ray, copy);
  const CurveSet& curves = *placement_.shape.curves;
  const CurvePiece piece = curves.piece(primitive);
  const auto met =
      meet_curve(piece, local.origin, local.direction, 0.0, static_cast<double>(ray.t_max));
  if (!met) return std::nullopt;
  Hit hit;
  hit.primitive = primitive;
  hit.t = std::max(static_cast<float>(met->t), std::numeric_limits<float>::min());
  hit.u = static_cast<float>(met->u);
  if (point == nullptr) return hit;

  const CurvePoint at = curve_point(piece, met->u, local.origin + local.direction * met->t);
  SurfacePoint p;
  p.t = hit.t;
  p.time = ray.time;
  p.primitive = primitive;
  p.curves = &curves;
  p.barycentrics = {hit.u, 0.0F};
  p.uv = {curves.along_strand(primitive, hit.u), turn_around(at.outward, at.tangent)};
  p.world_to_object = local.to_object.to_mat4();
  const Vec3d position = local.to_world.point(at.position);
  const Vec3d ng =
      unit_or(glm::transpose(local.to_object.linear) * at.normal, Vec3d(0.0, 1.0, 0.0));
  p.position = Vec3(position);
  p.ng = Vec3(ng);
  p.ns = p.ng;
  const Vec3d along = unit_or(local.to_world.vector(at.tangent), Vec3d(1.0, 0.0, 0.0));
  p.dpdu = Vec3(along - ng * glm::dot(ng, along));
  p.dpdv = Vec3(glm::cross(ng, along));
  const double stretch = stretch_of(local.to_world);
  const Vec3d size = glm::abs(position);
  const Vec3d chord = piece.at(1.0) - piece.at(0.0);
  const double radius = stretch * at.radius;
  p.clearance =
      static_cast<float>(kTubeError * radius + kPlaceError * std::max({size.x, size.y, size.z}) +
                         kLengthError * stretch * std::sqrt(glm::dot(chord, chord)));
  p.thickness = static_cast<float>(2.0 * radius);
  *point = p;
  return hit;
}

}  // namespace hyades::core
