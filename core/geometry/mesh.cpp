#include "core/geometry/mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/elementary.h"
#include "core/geometry/chunks.h"

namespace hyades::core {
namespace {

/// Interior angle between two edges, in radians.
float angle_between(const Vec3d& a, const Vec3d& b) {
  const double lengths = std::sqrt(glm::dot(a, a) * glm::dot(b, b));
  return lengths > 0.0 ? acos(static_cast<float>(glm::dot(a, b) / lengths)) : 0.0F;
}

/// Unit normal of one triangle and its angles at the three corners.
struct Corners {
  Vec3d normal{0.0};
  Vec3 angles{0.0F};
};

Corners corners_of(const TriangleMesh& mesh, size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3d p0(mesh.positions[t[0]]);
  const Vec3d p1(mesh.positions[t[1]]);
  const Vec3d p2(mesh.positions[t[2]]);
  const Vec3d n = glm::cross(p1 - p0, p2 - p0);
  const double length = std::sqrt(glm::dot(n, n));
  if (!(length > 0.0)) return {};
  return {n / length,
          {angle_between(p1 - p0, p2 - p0), angle_between(p2 - p1, p0 - p1),
           angle_between(p0 - p2, p1 - p2)}};
}

}  // namespace

size_t TriangleMesh::memory() const {
  return positions.size() * sizeof(Vec3) + triangles.size() * sizeof(triangles[0]) +
         normals.size() * sizeof(Vec3) + (uvs.size() + second_uvs.size()) * sizeof(Vec2) +
         (colors.size() + vertex_tangents.size()) * sizeof(Vec4) +
         tangents.size() * sizeof(tangents[0]);
}

void finish_mesh(TriangleMesh& mesh) {
  mesh.positions.reserve(mesh.positions.size() + 1);
  const size_t n = mesh.positions.size();
  std::vector<Bounds> parts(chunk_count(n));
  for_chunks(n, [&](size_t begin, size_t end) {
    Bounds b;
    for (size_t i = begin; i < end; ++i) b.include(mesh.positions[i]);
    parts[begin / kChunk] = b;
  });
  mesh.bounds = Bounds();
  for (const Bounds& b : parts) mesh.bounds.include(b);
}

std::vector<Vec3> smooth_normals(const TriangleMesh& mesh, const std::vector<uint32_t>& group) {
  const size_t n = mesh.triangles.size();
  std::vector<Vec3d> sums(mesh.positions.size(), Vec3d(0.0));
  std::vector<Corners> corners(std::min(n, 32 * kChunk));
  // Angles and face normals in parallel, sums in the order of the triangles: the same bits for any
  // number of threads.
  for (size_t begin = 0; begin < n; begin += corners.size()) {
    const size_t count = std::min(corners.size(), n - begin);
    for_chunks(count, [&](size_t from, size_t to) {
      for (size_t i = from; i < to; ++i) corners[i] = corners_of(mesh, begin + i);
    });
    for (size_t i = 0; i < count; ++i) {
      for (int k = 0; k < 3; ++k) {
        const uint32_t vertex = mesh.triangles[begin + i][k];
        sums[group.empty() ? vertex : group[vertex]] +=
            corners[i].normal * static_cast<double>(corners[i].angles[k]);
      }
    }
  }
  std::vector<Vec3> normals(sums.size());
  for (size_t i = 0; i < sums.size(); ++i) {
    const Vec3d& sum = sums[group.empty() ? i : group[i]];
    const double length = std::sqrt(glm::dot(sum, sum));
    normals[i] = length > 0.0 ? Vec3(sum / length) : Vec3(0.0F, 0.0F, 0.0F);
  }
  return normals;
}

void compute_smooth_normals(TriangleMesh& mesh) { mesh.normals = smooth_normals(mesh, {}); }

}  // namespace hyades::core
