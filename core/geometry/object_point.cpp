#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/frame.h"
#include "core/geometry/placed_object.h"
#include "core/geometry/triangle.h"

namespace hyades::core {
namespace {

glm::dmat3 abs_matrix(const glm::dmat3& m) {
  return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])};
}

/// Distance along the unit normal `n` that rounding to float may move a point near `p`, twice: the
/// point itself and the origin of a ray that is offset from it. A little of the largest coordinate
/// is added for planes along the axes, where nothing else would be.
double position_error(const Vec3d& p, const Vec3d& n) {
  const Vec3d size = glm::abs(p);
  return kRoundoff *
         (2.0 * glm::dot(glm::abs(n), size) + std::max(size.x, std::max(size.y, size.z)));
}

/// By how much, along the object-space normal `n`, Embree may misplace world point `p` when it
/// transforms a ray into an instance: rounding in its inverse matrix (bounded by |W||M||W|, after
/// Higham 2002, "Accuracy and Stability of Numerical Algorithms", section 14.1) and in the product.
double transform_error(const Affine& to_world, const Affine& to_object, const Vec3d& p,
                       const Vec3d& n) {
  const glm::dmat3 w = abs_matrix(to_object.linear);
  const Vec3d moved = w * (glm::abs(p) + glm::abs(to_world.offset));
  const Vec3d error = 3.0 * moved + w * (abs_matrix(to_world.linear) * moved);
  // Half of the worst case: the largest error in fuzzing was a quarter of it.
  return 0.5 * kRoundoff * glm::dot(glm::abs(n), error);
}

/// By how much Embree may misplace a triangle whose vertices it interpolates between two steps.
double vertex_motion_error(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d size = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
  return 2.0 * kRoundoff * std::max(size.x, std::max(size.y, size.z));
}

bool is_finite(const Vec3& v) { return (v.x - v.x) + (v.y - v.y) + (v.z - v.z) == 0.0F; }

/// v made a unit vector; +y for a zero vector (degenerate triangles have no better normal).
Vec3d unit(const Vec3d& v) {
  const double length2 = glm::dot(v, v);
  return length2 > 0.0 ? v * (1.0 / std::sqrt(length2)) : Vec3d(0.0, 1.0, 0.0);
}

/// Tangents where the shape has no parametrisation.
void set_any_tangents(SurfacePoint& p) {
  const Frame frame = Frame::around(p.ng);
  p.dpdu = frame.s;
  p.dpdv = frame.t;
}

/// Makes the tangents usable where the parametrisation is singular or missing.
void set_tangents(SurfacePoint& p, const Vec3d& dpdu, const Vec3d& dpdv) {
  p.dpdu = Vec3(dpdu);
  p.dpdv = Vec3(dpdv);
  const Vec3 cross = glm::cross(p.dpdu, p.dpdv);
  if (is_finite(p.dpdu) && is_finite(p.dpdv) && glm::dot(cross, cross) > 0.0F && is_finite(cross))
    return;
  set_any_tangents(p);
}

/// The unit shading normal from an interpolated one, on the side of ng; ng where there is none.
Vec3 shading_normal(const Vec3d& n, const Vec3& ng) {
  const double length2 = glm::dot(n, n);
  if (!(length2 > 0.0)) return ng;
  const Vec3 ns(n / std::sqrt(length2));
  if (!is_finite(ns)) return ng;
  return glm::dot(ns, ng) < 0.0F ? -ns : ns;
}

}  // namespace

SurfacePoint PlacedObject::point(const Ray& ray, const Hit& hit, const CopyPose* copy) const {
  SurfacePoint p;
  if (is_curves()) {
    // Of a hit: it is met again, in the same place.
    (void)meet_piece(ray, hit.primitive, copy, &p);
    return p;
  }
  p = is_quadric() ? quadric_surface(ray, hit, copy)
                   : mesh_point(hit.primitive, hit.u, hit.v, ray.time, copy);
  p.t = hit.t;
  return p;
}

bool PlacedObject::meet(const Ray& ray, uint32_t primitive, SurfacePoint& point,
                        const CopyPose* copy) const {
  if (is_curves()) return meet_piece(ray, primitive, copy, &point).has_value();
  if (is_quadric()) {
    const auto hit = meet(ray, primitive, copy);
    if (hit) point = this->point(ray, *hit, copy);
    return hit.has_value();
  }
  const Triangle triangle = triangle_at(primitive, ray.time);
  const auto hit = meet_triangle_of(ray, primitive, triangle, copy);
  if (!hit) return false;
  fill_mesh_point(point, *hit, triangle, ray.time, copy);
  point.t = hit->t;
  return true;
}

SurfacePoint PlacedObject::mesh_point(uint32_t primitive, float u, float v, float time,
                                      const CopyPose* copy) const {
  SurfacePoint p;
  Hit hit;
  hit.primitive = primitive;
  hit.u = u;
  hit.v = v;
  fill_mesh_point(p, hit, triangle_at(primitive, time), time, copy);
  return p;
}

void PlacedObject::fill_mesh_point(SurfacePoint& p, const Hit& hit, const Triangle& triangle,
                                   float time, const CopyPose* copy) const {
  p.time = time;
  if (!moves_) {
    fill_mesh_point(p, hit, triangle, {to_world_, to_object_, world_to_object_, mirrors_}, copy);
    return;
  }
  const Affine to_world = motion_.at(time);
  const Affine to_object = to_world.inverse();
  const Mat4 world_to_object = to_object.to_mat4();
  fill_mesh_point(p, hit, triangle,
                  {to_world, to_object, world_to_object, to_world.determinant() < 0.0}, copy);
}

void PlacedObject::fill_mesh_point(SurfacePoint& p, const Hit& hit, const Triangle& triangle,
                                   const Pose& pose, const CopyPose* copy) const {
  const TriangleMesh& mesh = buffers_->mesh();
  const auto& vertices = indices_[hit.primitive];
  const Vec3d& e1 = triangle.e1;
  const Vec3d& e2 = triangle.e2;
  const double du = static_cast<double>(hit.u);
  const double dv = static_cast<double>(hit.v);
  const Vec3d offset = e1 * du + e2 * dv;
  p.primitive = hit.primitive;
  p.mesh = &mesh;
  p.curves = nullptr;
  p.thickness = 0.0F;
  p.barycentrics = {hit.u, hit.v};
  p.world_to_object =
      copy == nullptr ? pose.world_to_object : (pose.to_object * copy->to_copy).to_mat4();

  // Normal and error bound in the space of the buffers, then in the world.
  Vec3d n = unit(glm::cross(e1, e2));
  Vec3d position = triangle.a + offset;
  double embree_error = errors_ != nullptr ? static_cast<double>(errors_[hit.primitive])
                                           : triangle_error(-offset, e1 - offset, e2 - offset, n);
  if (vertices_move_) {
    embree_error += vertex_motion_error(triangle.a, triangle.a + e1, triangle.a + e2);
  }
  const auto lift = [&](const Affine& out, const Affine& back) {
    position = out.point(position);
    const Vec3d normal = glm::transpose(back.linear) * n;
    const double stretch = std::sqrt(glm::dot(normal, normal));
    embree_error += transform_error(out, back, position, n);
    embree_error /= stretch;
    n = normal / stretch;
  };
  if (!in_world_) {
    lift(pose.to_world, pose.to_object);
  } else if (pose.mirrors) {
    n = -n;
  }
  if (copy != nullptr) lift(copy->to_world, copy->to_copy);
  const Vec3d& ng = n;
  p.position = Vec3(position);
  p.ng = Vec3(ng);
  p.clearance = static_cast<float>(position_error(position, ng) + 2.0 * embree_error);

  p.ns = p.ng;
  if (!mesh.normals.empty()) {
    Vec3d ns = mesh_normal(vertices, du, dv, p.time);
    ns = glm::transpose(pose.to_object.linear) * ns;
    if (copy != nullptr) ns = glm::transpose(copy->to_copy.linear) * ns;
    p.ns = shading_normal(ns, p.ng);
  }

  p.tangent = Vec3(0.0F);
  if (!mesh.tangents.empty() || !mesh.vertex_tangents.empty()) {
    Vec3d tangent = pose.to_world.vector(mesh_tangent(hit.primitive, du, dv, p.time));
    if (copy != nullptr) tangent = copy->to_world.vector(tangent);
    p.tangent = Vec3(tangent);
  }

  if (mesh.uvs.empty()) {
    p.uv = Vec2(0.0F);
    set_any_tangents(p);
    return;
  }
  const glm::dvec2 uv0(mesh.uvs[vertices[0]]);
  const glm::dvec2 d1 = glm::dvec2(mesh.uvs[vertices[1]]) - uv0;
  const glm::dvec2 d2 = glm::dvec2(mesh.uvs[vertices[2]]) - uv0;
  p.uv = Vec2(uv0 + d1 * du + d2 * dv);
  const double determinant = d1.x * d2.y - d1.y * d2.x;
  if (determinant == 0.0) {
    set_any_tangents(p);
    return;
  }
  Vec3d dpdu = (e1 * d2.y - e2 * d1.y) / determinant;
  Vec3d dpdv = (e2 * d1.x - e1 * d2.x) / determinant;
  if (!in_world_) {
    dpdu = pose.to_world.vector(dpdu);
    dpdv = pose.to_world.vector(dpdv);
  }
  if (copy != nullptr) {
    dpdu = copy->to_world.vector(dpdu);
    dpdv = copy->to_world.vector(dpdv);
  }
  set_tangents(p, dpdu, dpdv);
}

/// The interpolated normal, not of unit length, in object space.
Vec3d PlacedObject::mesh_normal(const std::array<uint32_t, 3>& vertices, double u, double v,
                                float time) const {
  const Shape& shape = buffers_->shape;
  const auto between = [&](const TriangleMesh& mesh) {
    return Vec3d(mesh.normals[vertices[0]]) * (1.0 - u - v) + Vec3d(mesh.normals[vertices[1]]) * u +
           Vec3d(mesh.normals[vertices[2]]) * v;
  };
  const Vec3d here = between(*shape.mesh);
  if (!shape.deforms()) return here;
  const double f = static_cast<double>(time) * static_cast<double>(shape.reach);
  return here * (1.0 - f) + between(*shape.next) * f;
}

/// The tangent of a deforming mesh at `time`, between those of the triangle's corners.
Vec3d PlacedObject::mesh_tangent(uint32_t primitive, double u, double v, float time) const {
  const Shape& shape = buffers_->shape;
  const auto between = [&](const TriangleMesh& mesh) {
    const std::array<uint32_t, 3>& t = indices_[primitive];
    const auto corner = [&](size_t k) {
      return Vec3d(mesh.tangents.empty() ? Vec3(mesh.vertex_tangents[t[k]])
                                         : mesh.tangents[primitive][k]);
    };
    return corner(0) * (1.0 - u - v) + corner(1) * u + corner(2) * v;
  };
  const Vec3d here = between(*shape.mesh);
  if (!shape.deforms() || (shape.next->tangents.empty() && shape.next->vertex_tangents.empty())) {
    return here;
  }
  const double f = static_cast<double>(time) * static_cast<double>(shape.reach);
  return here * (1.0 - f) + between(*shape.next) * f;
}

SurfacePoint PlacedObject::quadric_surface(const Ray& ray, const Hit& hit,
                                           const CopyPose* copy) const {
  Affine to_world = to_world_at(ray.time);
  Affine to_object = to_object_at(ray.time);
  if (copy != nullptr) {
    to_world = copy->to_world * to_world;
    to_object = to_object * copy->to_copy;
  }
  const Vec3d origin = to_object.point(Vec3d(ray.origin));
  const Vec3d direction = to_object.vector(Vec3d(ray.direction));
  // hit.t was rounded to float: the exact one is found again.
  const double t = meet_quadric(quadric_, origin, direction, 0.0, static_cast<double>(ray.t_max))
                       .value_or(static_cast<double>(hit.t));
  SurfacePoint p = quadric_place(origin + direction * t, ray.time, to_world, to_object);
  if (copy != nullptr) {
    // Rays are rounded in the space of the copy.
    const Vec3d n = unit(glm::transpose(copy->to_world.linear) * Vec3d(p.ng));
    const Vec3d normal = glm::transpose(copy->to_copy.linear) * n;
    const double error = transform_error(copy->to_world, copy->to_copy, Vec3d(p.position), n);
    p.clearance += static_cast<float>(2.0 * error / std::sqrt(glm::dot(normal, normal)));
  }
  return p;
}

SurfacePoint PlacedObject::quadric_place(const Vec3d& near, float time) const {
  return quadric_place(near, time, to_world_at(time), to_object_at(time));
}

SurfacePoint PlacedObject::quadric_place(const Vec3d& near, float time, const Affine& to_world,
                                         const Affine& to_object) const {
  SurfacePoint p;
  p.time = time;
  const QuadricPoint q = quadric_point(quadric_, near);

  const Vec3d position = to_world.point(q.position);
  const Vec3d ng = unit(glm::transpose(to_object.linear) * q.normal);
  p.position = Vec3(position);
  p.ng = Vec3(ng);
  p.ns = p.ng;
  p.uv = q.uv;
  p.clearance = static_cast<float>(position_error(position, ng));
  p.world_to_object = to_object.to_mat4();
  set_tangents(p, to_world.vector(q.dpdu), to_world.vector(q.dpdv));
  return p;
}

}  // namespace hyades::core
