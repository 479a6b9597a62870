#include "core/geometry/mesh_buffers.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "core/geometry/chunks.h"
#include "core/geometry/triangle.h"

namespace hyades::core {
namespace {

/// A copy of the vertices, transformed, with room for the padding that Embree reads.
std::vector<Vec3> copy_positions(const TriangleMesh& mesh, const Affine& to_world) {
  std::vector<Vec3> out;
  out.reserve(mesh.positions.size() + 1);
  out.resize(mesh.positions.size());
  for_chunks(out.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      out[i] = Vec3(to_world.point(Vec3d(mesh.positions[i])));
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

bool is_identity(const Motion& motion) {
  const Affine& m = motion.steps()[0];
  return motion.still() && m.linear == glm::dmat3(1.0) && m.offset == Vec3d(0.0);
}

/// Whether a triangle is degenerate at every step.
bool is_always_degenerate(const MeshBuffers& b, const std::array<uint32_t, 3>& t) {
  if (b.own_positions.size() <= 1) return is_degenerate(b.positions, t);
  return std::all_of(b.own_positions.begin(), b.own_positions.end(),
                     [&](const std::vector<Vec3>& p) { return is_degenerate(p.data(), t); });
}

/// Embree's float arithmetic can hit a triangle without area; one with an index out of range it
/// leaves out.
void leave_out_degenerate(MeshBuffers& b) {
  const auto& triangles = b.mesh->triangles;
  b.indices = triangles.data();
  b.triangles = b.indices;
  std::atomic<bool> any{false};
  for_chunks(triangles.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end && !any; ++i) {
      if (is_always_degenerate(b, triangles[i])) any = true;
    }
  });
  if (!any) return;
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  b.own_triangles = triangles;
  for (auto& t : b.own_triangles) {
    if (is_always_degenerate(b, t)) t = {kNone, kNone, kNone};
  }
  b.triangles = b.own_triangles.data();
}

/// Computed once here, because every hit needs one.
std::vector<float> triangle_errors(const MeshBuffers& b) {
  const auto& triangles = b.mesh->triangles;
  std::vector<float> errors(triangles.size());
  for_chunks(errors.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto corner = [&](size_t k) { return Vec3d(b.positions[triangles[i][k]]); };
      errors[i] = largest_triangle_error(corner(0), corner(1), corner(2));
    }
  });
  return errors;
}

}  // namespace

size_t MeshBuffers::own_memory() const {
  size_t bytes =
      own_triangles.capacity() * sizeof(own_triangles[0]) + errors.capacity() * sizeof(errors[0]);
  for (const auto& p : own_positions) bytes += p.capacity() * sizeof(Vec3);
  return bytes;
}

std::array<Vec3d, 3> MeshBuffers::moving_corners(const std::array<uint32_t, 3>& triangle,
                                                 const Motion& motion, float time) const {
  const auto [step, f] = motion.place_of(time);
  const std::vector<Vec3>& a = own_positions[step];
  const std::vector<Vec3>& b = own_positions[step + 1];
  std::array<Vec3d, 3> out;
  for (size_t k = 0; k < 3; ++k) {
    out[k] = Vec3d(a[triangle[k]]) * (1.0 - f) + Vec3d(b[triangle[k]]) * f;
  }
  return out;
}

std::shared_ptr<const MeshBuffers> make_mesh_buffers(std::shared_ptr<const TriangleMesh> mesh,
                                                     const Motion* motion) {
  auto out = std::make_shared<MeshBuffers>();
  out->mesh = std::move(mesh);
  out->in_world = motion != nullptr;
  const TriangleMesh& m = *out->mesh;
  const bool padded = m.positions.capacity() > m.positions.size();
  if (motion != nullptr && !(padded && is_identity(*motion))) {
    for (const Affine& step : motion->steps()) {
      out->own_positions.push_back(copy_positions(m, step));
    }
  } else if (!padded) {
    out->own_positions.push_back(copy_positions(m, Affine()));
  }
  out->positions = out->own_positions.empty() ? m.positions.data() : out->own_positions[0].data();
  out->bounds = m.bounds;
  if (!out->own_positions.empty()) {
    out->bounds = Bounds();
    for (const auto& p : out->own_positions) {
      out->bounds.include(bounds_of_positions(p.data(), p.size()));
    }
  }
  leave_out_degenerate(*out);
  if (out->own_positions.size() <= 1) out->errors = triangle_errors(*out);
  return out;
}

}  // namespace hyades::core
