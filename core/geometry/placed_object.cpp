#include "core/geometry/placed_object.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/geometry/triangle.h"

namespace hyades::core {
namespace {

/// A box in double precision, widened so that rounding it to float keeps everything inside.
Bounds round_outwards(const Vec3d& lower, const Vec3d& upper) {
  Bounds b;
  for (int i = 0; i < 3; ++i) {
    b.lower[i] =
        std::nextafter(static_cast<float>(lower[i]), -std::numeric_limits<float>::infinity());
    b.upper[i] =
        std::nextafter(static_cast<float>(upper[i]), std::numeric_limits<float>::infinity());
  }
  return b;
}

/// A distance above 0 as a float above 0.
float to_distance(double t) {
  return std::max(static_cast<float>(t), std::numeric_limits<float>::min());
}

/// Half extents of the image of a disk of radius r around the y axis.
Vec3d disk_extent(const Affine& m, double r) {
  Vec3d e;
  for (int i = 0; i < 3; ++i) {
    const double x = m.linear[0][i];
    const double z = m.linear[2][i];
    e[i] = r * std::sqrt(x * x + z * z);
  }
  return e;
}

}  // namespace

Bounds transform_bounds(const Affine& m, const Bounds& box) {
  if (box.empty()) return box;
  const Vec3d center = 0.5 * (Vec3d(box.lower) + Vec3d(box.upper));
  const Vec3d half = 0.5 * (Vec3d(box.upper) - Vec3d(box.lower));
  const Vec3d c = m.point(center);
  const Vec3d e = glm::abs(m.linear[0]) * half.x + glm::abs(m.linear[1]) * half.y +
                  glm::abs(m.linear[2]) * half.z;
  return round_outwards(c - e, c + e);
}

Bounds quadric_bounds(const Affine& m, const Shape& shape) {
  const double r = static_cast<double>(shape.radius);
  if (shape.kind == Shape::Kind::sphere) {
    Vec3d e;
    for (int i = 0; i < 3; ++i) {
      const Vec3d row(m.linear[0][i], m.linear[1][i], m.linear[2][i]);
      e[i] = r * std::sqrt(glm::dot(row, row));
    }
    return round_outwards(m.offset - e, m.offset + e);
  }
  const Vec3d e = disk_extent(m, r);
  Bounds b = round_outwards(m.offset - e, m.offset + e);
  if (shape.kind == Shape::Kind::cylinder) {
    const Vec3d top = m.point({0.0, static_cast<double>(shape.height), 0.0});
    b.include(round_outwards(top - e, top + e));
  }
  return b;
}

PlacedObject::PlacedObject(Placement placement, std::shared_ptr<const MeshBuffers> buffers)
    : buffers_(std::move(buffers)), motion_(placement.to_world), placement_(std::move(placement)) {
  moves_ = !motion_.still();
  if (buffers_ != nullptr) {
    indices_ = buffers_->indices;
    positions_ = buffers_->steps[0];
    vertices_move_ = buffers_->vertices_move();
    in_world_ = buffers_->in_world;
    if (!buffers_->errors.empty()) errors_ = buffers_->errors.data();
  }
  to_world_ = motion_.steps()[0];
  to_object_ = to_world_.inverse();
  world_to_object_ = to_object_.to_mat4();
  mirrors_ = to_world_.determinant() < 0.0;
  quadric_ = {placement_.shape.kind, static_cast<double>(placement_.shape.radius),
              static_cast<double>(placement_.shape.height)};
  if (in_world_) {
    bounds_ = buffers_->bounds;
    return;
  }
  for (size_t i = 0; i < motion_.steps().size(); ++i) bounds_.include(bounds_at_step(i));
}

Bounds PlacedObject::bounds_at_step(size_t step) const {
  const Affine& to_world = motion_.steps()[step];
  if (is_quadric()) return quadric_bounds(to_world, placement_.shape);
  return transform_bounds(to_world,
                          is_curves() ? placement_.shape.curves->bounds : buffers_->bounds);
}

std::optional<Hit> PlacedObject::meet(const Ray& ray, uint32_t primitive,
                                      const CopyPose* copy) const {
  if (is_curves()) return meet_piece(ray, primitive, copy, nullptr);
  if (!is_quadric()) {
    return meet_triangle_of(ray, primitive, triangle_at(primitive, ray.time), copy);
  }
  Affine m = to_object_at(ray.time);
  if (copy != nullptr) m = m * copy->to_copy;
  const double t_max = static_cast<double>(ray.t_max);
  const auto t = meet_quadric(quadric_, m.point(Vec3d(ray.origin)), m.vector(Vec3d(ray.direction)),
                              0.0, t_max);
  if (!t || !(*t > 0.0 && *t < t_max)) return std::nullopt;
  Hit hit;
  hit.primitive = primitive;
  hit.t = to_distance(*t);
  return hit;
}

std::optional<Hit> PlacedObject::meet_triangle_of(const Ray& ray, uint32_t primitive,
                                                  const Triangle& triangle,
                                                  const CopyPose* copy) const {
  Vec3d origin(ray.origin);
  Vec3d direction(ray.direction);
  if (copy != nullptr) {
    origin = copy->to_copy.point(origin);
    direction = copy->to_copy.vector(direction);
  }
  if (!in_world_) {
    const Affine m = to_object_at(ray.time);
    origin = m.point(origin);
    direction = m.vector(direction);
  }
  const auto met = meet_triangle(origin, direction, triangle);
  if (!met || !(met->t > 0.0 && met->t < static_cast<double>(ray.t_max))) return std::nullopt;
  Hit hit;
  hit.primitive = primitive;
  hit.t = to_distance(met->t);
  hit.u = static_cast<float>(met->u);
  hit.v = static_cast<float>(met->v);
  return hit;
}

}  // namespace hyades::core
