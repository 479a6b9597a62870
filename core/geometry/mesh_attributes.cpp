#include "core/geometry/mesh_attributes.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/curve_set.h"
#include "core/geometry/mesh.h"

namespace hyades::core {
namespace {

template <class T>
T between(const std::vector<T>& values, const SurfacePoint& point) {
  const std::array<uint32_t, 3>& t = point.mesh->triangles[point.primitive];
  const Vec2& b = point.barycentrics;
  return values[t[0]] * (1.0F - b.x - b.y) + values[t[1]] * b.x + values[t[2]] * b.y;
}

/// Vectors in the plane of the triangle whose products with its edges from corner 0 are (1, 0) and
/// (0, 1): the derivatives of the barycentrics by the place in object space.
std::array<Vec3d, 2> dual_edges(const SurfacePoint& point) {
  const std::array<uint32_t, 3>& t = point.mesh->triangles[point.primitive];
  const Vec3d a(point.mesh->positions[t[0]]);
  const Vec3d e1 = Vec3d(point.mesh->positions[t[1]]) - a;
  const Vec3d e2 = Vec3d(point.mesh->positions[t[2]]) - a;
  const double aa = glm::dot(e1, e1);
  const double ab = glm::dot(e1, e2);
  const double bb = glm::dot(e2, e2);
  const double determinant = aa * bb - ab * ab;
  if (!(determinant > 0.0)) return {Vec3d(0.0), Vec3d(0.0)};
  return {(e1 * bb - e2 * ab) / determinant, (e2 * aa - e1 * ab) / determinant};
}

}  // namespace

std::optional<Vec4> vertex_color(const SurfacePoint& point) {
  if (point.curves != nullptr && !point.curves->colors.empty()) {
    return Vec4(point.curves->color_at(point.primitive, point.barycentrics.x), 1.0F);
  }
  if (point.mesh == nullptr || point.mesh->colors.empty()) return std::nullopt;
  return between(point.mesh->colors, point);
}

std::array<Vec4, 3> vertex_color_gradient(const SurfacePoint& point) {
  std::array<Vec4, 3> result{Vec4(0.0F), Vec4(0.0F), Vec4(0.0F)};
  if (point.mesh == nullptr || point.mesh->colors.empty()) return result;
  const std::array<Vec3d, 2> dual = dual_edges(point);
  const std::array<uint32_t, 3>& t = point.mesh->triangles[point.primitive];
  const std::vector<Vec4>& colors = point.mesh->colors;
  const Vec4 d1 = colors[t[1]] - colors[t[0]];
  const Vec4 d2 = colors[t[2]] - colors[t[0]];
  for (int i = 0; i < 3; ++i) {
    result[static_cast<size_t>(i)] =
        d1 * static_cast<float>(dual[0][i]) + d2 * static_cast<float>(dual[1][i]);
  }
  return result;
}

Vec2 second_uv(const SurfacePoint& point) {
  if (point.mesh == nullptr || point.mesh->second_uvs.empty()) return Vec2(0.0F);
  return between(point.mesh->second_uvs, point);
}

std::array<Vec3, 2> second_uv_gradient(const SurfacePoint& point) {
  if (point.mesh == nullptr || point.mesh->second_uvs.empty()) return {};
  const std::array<Vec3d, 2> dual = dual_edges(point);
  const std::array<uint32_t, 3>& t = point.mesh->triangles[point.primitive];
  const std::vector<Vec2>& uvs = point.mesh->second_uvs;
  const Vec2 d1 = uvs[t[1]] - uvs[t[0]];
  const Vec2 d2 = uvs[t[2]] - uvs[t[0]];
  const auto along = [&](int c) {
    return Vec3(dual[0] * static_cast<double>(d1[c]) + dual[1] * static_cast<double>(d2[c]));
  };
  return {along(0), along(1)};
}

std::optional<bool> file_tangent_mirrored(const SurfacePoint& point) {
  if (point.mesh == nullptr || point.mesh->vertex_tangents.empty()) return std::nullopt;
  const bool turned = glm::determinant(Mat3(point.world_to_object)) < 0.0F;
  return (between(point.mesh->vertex_tangents, point).w < 0.0F) != turned;
}

}  // namespace hyades::core
