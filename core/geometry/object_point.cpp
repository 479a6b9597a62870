#include <cmath>
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

bool finite(const Vec3& v) { return (v.x - v.x) + (v.y - v.y) + (v.z - v.z) == 0.0F; }

/// v made a unit vector; +y for a zero vector (degenerate triangles have no better normal).
Vec3d unit(const Vec3d& v) {
  const double length2 = glm::dot(v, v);
  return length2 > 0.0 ? v / std::sqrt(length2) : Vec3d(0.0, 1.0, 0.0);
}

/// Makes the tangents usable where the parametrisation is singular or missing.
void set_tangents(SurfacePoint& p, const Vec3d& dpdu, const Vec3d& dpdv) {
  p.dpdu = Vec3(dpdu);
  p.dpdv = Vec3(dpdv);
  const Vec3 cross = glm::cross(p.dpdu, p.dpdv);
  if (finite(p.dpdu) && finite(p.dpdv) && glm::dot(cross, cross) > 0.0F && finite(cross)) return;
  const Frame frame = Frame::around(p.ng);
  p.dpdu = frame.s;
  p.dpdv = frame.t;
}

/// The unit shading normal from an interpolated one, on the side of ng; ng where there is none.
Vec3 shading_normal(const Vec3d& n, const Vec3& ng) {
  const double length2 = glm::dot(n, n);
  if (!(length2 > 0.0)) return ng;
  const Vec3 ns(n / std::sqrt(length2));
  if (!finite(ns)) return ng;
  return glm::dot(ns, ng) < 0.0F ? -ns : ns;
}

}  // namespace

SurfacePoint PlacedObject::point(const Ray& ray, const Hit& hit) const {
  SurfacePoint p =
      is_quadric() ? quadric_surface(ray, hit) : mesh_point(hit.primitive, hit.u, hit.v, ray.time);
  p.t = hit.t;
  return p;
}

SurfacePoint PlacedObject::mesh_point(uint32_t primitive, float u, float v, float time) const {
  const TriangleMesh& mesh = *buffers_->mesh;
  const auto& vertices = mesh.triangles[primitive];
  const auto [a, b, c] = corners(primitive, time);
  const Vec3d e1 = b - a;
  const Vec3d e2 = c - a;
  const double du = static_cast<double>(u);
  const double dv = static_cast<double>(v);
  const Vec3d offset = e1 * du + e2 * dv;

  SurfacePoint p;
  p.time = time;
  p.primitive = primitive;
  const bool still = !moves_;
  const Affine moving = still ? Affine() : motion_.at(time);
  const Affine moving_inverse = still ? Affine() : moving.inverse();
  const Affine& to_world = still ? to_world_ : moving;
  const Affine& to_object = still ? to_object_ : moving_inverse;
  p.world_to_object = still ? world_to_object_ : moving_inverse.to_mat4();
  const glm::dmat3 normal_to_world = glm::transpose(to_object.linear);

  // Normal and error bound in the space of the buffers, then in the world.
  const Vec3d n = unit(glm::cross(e1, e2));
  Vec3d position = a + offset;
  Vec3d ng = n;
  double embree_error = triangle_error(-offset, e1 - offset, e2 - offset, n);
  if (in_world_) {
    if (to_world.determinant() < 0.0) ng = -n;
    if (!still) embree_error += vertex_motion_error(a, b, c);
  } else {
    position = to_world.point(position);
    const Vec3d world_n = normal_to_world * n;
    const double stretch = std::sqrt(glm::dot(world_n, world_n));
    embree_error += transform_error(to_world, to_object, position, n);
    embree_error /= stretch;
    ng = world_n / stretch;
  }
  p.position = Vec3(position);
  p.ng = Vec3(ng);
  p.clearance = static_cast<float>(position_error(position, ng) + 2.0 * embree_error);

  p.ns = p.ng;
  if (!mesh.normals.empty()) {
    const Vec3d ns = Vec3d(mesh.normals[vertices[0]]) * (1.0 - du - dv) +
                     Vec3d(mesh.normals[vertices[1]]) * du + Vec3d(mesh.normals[vertices[2]]) * dv;
    p.ns = shading_normal(normal_to_world * ns, p.ng);
  }

  Vec3d dpdu(0.0);
  Vec3d dpdv(0.0);
  if (!mesh.uvs.empty()) {
    const glm::dvec2 uv0(mesh.uvs[vertices[0]]);
    const glm::dvec2 d1 = glm::dvec2(mesh.uvs[vertices[1]]) - uv0;
    const glm::dvec2 d2 = glm::dvec2(mesh.uvs[vertices[2]]) - uv0;
    p.uv = Vec2(uv0 + d1 * du + d2 * dv);
    const double determinant = d1.x * d2.y - d1.y * d2.x;
    if (determinant != 0.0) {
      dpdu = (e1 * d2.y - e2 * d1.y) / determinant;
      dpdv = (e2 * d1.x - e1 * d2.x) / determinant;
      if (!in_world_) {
        dpdu = to_world.vector(dpdu);
        dpdv = to_world.vector(dpdv);
      }
    }
  }
  set_tangents(p, dpdu, dpdv);
  return p;
}

SurfacePoint PlacedObject::quadric_surface(const Ray& ray, const Hit& hit) const {
  SurfacePoint p;
  p.time = ray.time;
  const Affine to_world = to_world_at(ray.time);
  const Affine to_object = to_object_at(ray.time);
  const Vec3d origin = to_object.point(Vec3d(ray.origin));
  const Vec3d direction = to_object.vector(Vec3d(ray.direction));
  // hit.t was rounded to float: the exact one is found again.
  const double t = meet_quadric(quadric_, origin, direction, 0.0, static_cast<double>(ray.t_max))
                       .value_or(static_cast<double>(hit.t));
  const QuadricPoint q = quadric_point(quadric_, origin + direction * t);

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
