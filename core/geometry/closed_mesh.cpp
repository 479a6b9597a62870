#include "core/geometry/closed_mesh.h"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "core/geometry/weld.h"

namespace hyades::core {
namespace {

/// A side of a triangle: its corners in order of their numbers, and whether it goes up that way.
struct Side {
  uint32_t low;
  uint32_t high;
  bool upwards;
  bool along(const Side& other) const { return low == other.low && high == other.high; }
};

std::vector<Side> sides_of(const TriangleMesh& mesh) {
  const std::vector<uint32_t> welded = weld(mesh.positions);
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t a = welded[triangle[i]];
      const uint32_t b = welded[triangle[(i + 1) % 3]];
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high) < std::tie(b.low, b.high);
  });
  return sides;
}

double signed_volume(const TriangleMesh& mesh) {
  const Vec3d origin(mesh.bounds.center());
  double volume = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const Vec3d a = Vec3d(mesh.positions[triangle[0]]) - origin;
    const Vec3d b = Vec3d(mesh.positions[triangle[1]]) - origin;
    const Vec3d c = Vec3d(mesh.positions[triangle[2]]) - origin;
    volume += glm::dot(a, glm::cross(b, c));
  }
  return volume / 6.0;
}

}  // namespace

MeshClosure examine_closure(const TriangleMesh& mesh) {
  const std::vector<Side> sides = sides_of(mesh);
  MeshClosure closure;
  for (size_t i = 0; i < sides.size();) {
    int64_t balance = 0;
    const Side& first = sides[i];
    for (; i < sides.size() && sides[i].along(first); ++i) balance += sides[i].upwards ? 1 : -1;
    if (balance != 0) ++closure.open_edges;
  }
  closure.volume = signed_volume(mesh);
  return closure;
}

}  // namespace hyades::core
