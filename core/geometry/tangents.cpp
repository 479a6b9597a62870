#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <unordered_map>
#include <vector>

#include "core/base/elementary.h"
#include "core/base/hash.h"
#include "core/geometry/mesh.h"

namespace hyades::core {
namespace {

/// What corners must share to share a tangent: position, normal and uv, bit by bit, and which way
/// round the triangle winds in uv.
using Key = std::array<uint32_t, 9>;

struct KeyHash {
  size_t operator()(const Key& key) const {
    uint64_t hash = 0;
    for (const uint32_t word : key) hash = hash_combine(hash, word);
    return static_cast<size_t>(hash);
  }
};

/// -0 counts as 0.
uint32_t bits_of(float x) {
  const float y = x == 0.0F ? 0.0F : x;
  uint32_t bits = 0;
  std::memcpy(&bits, &y, sizeof(bits));
  return bits;
}

Key key_of(const TriangleMesh& mesh, uint32_t vertex, bool winds_left) {
  const Vec3& p = mesh.positions[vertex];
  const Vec3& n = mesh.normals[vertex];
  const Vec2& uv = mesh.uvs[vertex];
  return {bits_of(p.x), bits_of(p.y),  bits_of(p.z),  bits_of(n.x),        bits_of(n.y),
          bits_of(n.z), bits_of(uv.x), bits_of(uv.y), winds_left ? 1U : 0U};
}

/// Unit, or zero.
Vec3d unit_or_zero(const Vec3d& v) {
  const double length2 = glm::dot(v, v);
  return length2 > 0.0 ? v / std::sqrt(length2) : Vec3d(0.0);
}

Vec3d in_plane(const Vec3d& v, const Vec3d& normal) { return v - normal * glm::dot(normal, v); }

}  // namespace

void compute_tangents(TriangleMesh& mesh) {
  mesh.tangents.clear();
  mesh.vertex_tangents.clear();
  if (mesh.normals.empty() || mesh.uvs.empty()) return;
  const size_t count = mesh.triangles.size();
  std::vector<std::array<uint32_t, 3>> group_of(count);
  std::vector<Vec3d> sums;
  std::unordered_map<Key, uint32_t, KeyHash> groups;
  groups.reserve(mesh.positions.size());
  // In the order of the triangles: the same bits everywhere.
  for (size_t i = 0; i < count; ++i) {
    const auto& t = mesh.triangles[i];
    const glm::dvec2 uv0(mesh.uvs[t[0]]);
    const glm::dvec2 d1 = glm::dvec2(mesh.uvs[t[1]]) - uv0;
    const glm::dvec2 d2 = glm::dvec2(mesh.uvs[t[2]]) - uv0;
    const double winding = d1.x * d2.y - d1.y * d2.x;
    const Vec3d p[3] = {Vec3d(mesh.positions[t[0]]), Vec3d(mesh.positions[t[1]]),
                        Vec3d(mesh.positions[t[2]])};
    // dp/du times the winding's size.
    const Vec3d along =
        unit_or_zero(((p[1] - p[0]) * d2.y - (p[2] - p[0]) * d1.y) * (winding < 0.0 ? -1.0 : 1.0));
    for (int k = 0; k < 3; ++k) {
      const auto [group, is_new] =
          groups.try_emplace(key_of(mesh, t[k], winding > 0.0), static_cast<uint32_t>(sums.size()));
      if (is_new) sums.emplace_back(0.0);
      group_of[i][k] = group->second;
      if (winding == 0.0) continue;
      const Vec3d normal(mesh.normals[t[k]]);
      const Vec3d next = unit_or_zero(in_plane(p[(k + 1) % 3] - p[k], normal));
      const Vec3d last = unit_or_zero(in_plane(p[(k + 2) % 3] - p[k], normal));
      const float cosine = static_cast<float>(glm::clamp(glm::dot(next, last), -1.0, 1.0));
      sums[group->second] +=
          unit_or_zero(in_plane(along, normal)) * static_cast<double>(acos(cosine));
    }
  }
  mesh.tangents.resize(count);
  for (size_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) mesh.tangents[i][k] = Vec3(unit_or_zero(sums[group_of[i][k]]));
  }
}

}  // namespace hyades::core
