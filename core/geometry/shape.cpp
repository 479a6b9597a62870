#include "core/geometry/shape.h"

#include <cstddef>
#include <cstdint>

namespace hyades::core {
namespace {

/// Adds the rectangle with corners o, o + a, o + a + b, o + b; its normal is a x b.
void add_quad(TriangleMesh& mesh, const Vec3& o, const Vec3& a, const Vec3& b) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const Vec3& p : {o, o + a, o + a + b, o + b}) mesh.positions.push_back(p);
  for (const Vec2& uv : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)}) mesh.uvs.push_back(uv);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

}  // namespace

std::array<Vec3d, 3> Shape::corners_at(uint32_t primitive, float time) const {
  const std::array<uint32_t, 3>& t = mesh->triangles[primitive];
  std::array<Vec3d, 3> out;
  for (size_t k = 0; k < 3; ++k) out[k] = Vec3d(mesh->positions[t[k]]);
  if (!deforms()) return out;
  const double f = static_cast<double>(time) * static_cast<double>(reach);
  for (size_t k = 0; k < 3; ++k) {
    out[k] = out[k] * (1.0 - f) + Vec3d(next->positions[t[k]]) * f;
  }
  return out;
}

bool same_topology(const TriangleMesh& a, const TriangleMesh& b) {
  return a.positions.size() == b.positions.size() && a.normals.empty() == b.normals.empty() &&
         a.triangles == b.triangles;
}

Bounds bounds_of(const Shape& shape) {
  const float r = shape.radius;
  Bounds b;
  switch (shape.kind) {
    case Shape::Kind::mesh:
      if (shape.mesh != nullptr) b = shape.mesh->bounds;
      if (shape.deforms()) b.include(shape.next->bounds);
      break;
    case Shape::Kind::sphere:
      b = {Vec3(-r), Vec3(r)};
      break;
    case Shape::Kind::disk:
      b = {{-r, 0.0F, -r}, {r, 0.0F, r}};
      break;
    case Shape::Kind::cylinder:
      b = {{-r, 0.0F, -r}, {r, shape.height, r}};
      break;
    case Shape::Kind::curves:
      if (shape.curves != nullptr) b = shape.curves->bounds;
      break;
  }
  return b;
}

std::shared_ptr<TriangleMesh> make_rectangle(const Vec2& size) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "rectangle";
  add_quad(*mesh, {-0.5F * size.x, 0.0F, 0.5F * size.y}, {size.x, 0.0F, 0.0F},
           {0.0F, 0.0F, -size.y});
  finish_mesh(*mesh);
  return mesh;
}

std::shared_ptr<TriangleMesh> make_box(const Vec3& size) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "box";
  const Vec3 h = 0.5F * size;
  const Vec3 x(size.x, 0.0F, 0.0F);
  const Vec3 y(0.0F, size.y, 0.0F);
  const Vec3 z(0.0F, 0.0F, size.z);
  add_quad(*mesh, {-h.x, -h.y, h.z}, x, y);   // front, +z
  add_quad(*mesh, {h.x, -h.y, -h.z}, -x, y);  // back, -z
  add_quad(*mesh, {h.x, -h.y, h.z}, -z, y);   // right, +x
  add_quad(*mesh, {-h.x, -h.y, -h.z}, z, y);  // left, -x
  add_quad(*mesh, {-h.x, h.y, h.z}, x, -z);   // top, +y
  add_quad(*mesh, {-h.x, -h.y, -h.z}, x, z);  // bottom, -y
  finish_mesh(*mesh);
  return mesh;
}

}  // namespace hyades::core
