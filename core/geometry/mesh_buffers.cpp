#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "core/geometry/chunks.h"
#include "core/geometry/placed_object.h"

namespace hyades::core {
namespace {

/// World-space copies of the vertices, with room for the padding that Embree reads.
std::vector<Vec3> copy_positions(const TriangleMesh& mesh, const Affine* to_world) {
  std::vector<Vec3> out;
  out.reserve(mesh.positions.size() + 1);
  out.resize(mesh.positions.size());
  for_chunks(out.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Vec3& p = mesh.positions[i];
      out[i] = to_world != nullptr ? Vec3(to_world->point(Vec3d(p))) : p;
    }
  });
  return out;
}

Bounds bounds_of_positions(const Vec3* positions, size_t n) {
  std::vector<Bounds> parts(chunk_count(n));
  for_chunks(n, [&](size_t begin, size_t end) {
    Bounds b;
    for (size_t i = begin; i < end; ++i) b.include(positions[i]);
    parts[begin / kChunk] = b;
  });
  Bounds all;
  for (const Bounds& b : parts) all.include(b);
  return all;
}

/// Whether the corners lie on one line. Differences of floats and their products are exact in
/// double (but for extreme ratios), so this is exact too.
bool is_degenerate(const Vec3* positions, const std::array<uint32_t, 3>& t) {
  const Vec3d a(positions[t[0]]);
  const Vec3d n = glm::cross(Vec3d(positions[t[1]]) - a, Vec3d(positions[t[2]]) - a);
  return n.x == 0.0 && n.y == 0.0 && n.z == 0.0;
}

bool is_identity(const Affine& m) { return m.linear == glm::dmat3(1.0) && m.offset == Vec3d(0.0); }

}  // namespace

std::shared_ptr<const MeshBuffers> make_mesh_buffers(std::shared_ptr<const TriangleMesh> mesh,
                                                     const Affine* to_world) {
  auto out = std::make_shared<MeshBuffers>();
  out->mesh = std::move(mesh);
  const TriangleMesh& m = *out->mesh;
  const bool moved = to_world != nullptr && !is_identity(*to_world);
  if (moved || m.positions.capacity() <= m.positions.size()) {
    out->own_positions = copy_positions(m, moved ? to_world : nullptr);
  }
  out->positions = out->own_positions.empty() ? m.positions.data() : out->own_positions.data();
  out->bounds = moved ? bounds_of_positions(out->positions, m.positions.size()) : m.bounds;

  // Embree's float arithmetic can hit a triangle without area; one with an index out of range it
  // leaves out.
  std::atomic<bool> any{false};
  for_chunks(m.triangles.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      if (is_degenerate(out->positions, m.triangles[i])) {
        any = true;
        return;
      }
    }
  });
  if (any) {
    out->own_triangles = m.triangles;
    constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
    for (auto& t : out->own_triangles) {
      if (is_degenerate(out->positions, t)) t = {kNone, kNone, kNone};
    }
  }
  out->triangles = any ? out->own_triangles.data() : m.triangles.data();
  return out;
}

}  // namespace hyades::core
