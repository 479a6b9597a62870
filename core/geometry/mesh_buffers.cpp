#include "core/geometry/mesh_buffers.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/geometry/chunks.h"
#include "core/geometry/triangle.h"

namespace hyades::core {
namespace {

/// At least so many straight ways take the place of one under a moving matrix of vertices that move
/// themselves.
constexpr size_t kCurvedWays = 32;

/// The vertices at shutter time `time` under `to_world`, with room for the padding that Embree
/// reads.
std::vector<Vec3> copy_positions(const Shape& shape, float time, const Affine& to_world) {
  const std::vector<Vec3>& from = shape.mesh->positions;
  const double f =
      shape.deforms() ? static_cast<double>(time) * static_cast<double>(shape.reach) : 0.0;
  std::vector<Vec3> out;
  out.reserve(from.size() + 1);
  out.resize(from.size());
  for_chunks(out.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      Vec3d p(from[i]);
      if (f > 0.0) p = p * (1.0 - f) + Vec3d(shape.next->positions[i]) * f;
      out[i] = Vec3(to_world.point(p));
    }
  });
  return out;
}

/// How many steps the vertices take.
size_t step_count(const Shape& shape, const Motion* motion) {
  const size_t matrices = motion == nullptr ? 1 : motion->steps().size();
  if (!shape.deforms()) return matrices;
  if (matrices == 1) return 2;
  const size_t ways = matrices - 1;
  return ways * std::max<size_t>(1, kCurvedWays / ways) + 1;
}

/// The vertices of the mesh itself that are what the buffers want at `time`, under the identity;
/// null where there are none that Embree may read.
const Vec3* ready_positions(const Shape& shape, float time) {
  const bool at_end = shape.deforms() && time > 0.0F;
  if (at_end && !(shape.reach == 1.0F && time == 1.0F)) return nullptr;
  const std::vector<Vec3>& positions = at_end ? shape.next->positions : shape.mesh->positions;
  return positions.capacity() > positions.size() ? positions.data() : nullptr;
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

/// Whether corners lie on one line. Differences of floats and their products are exact in double
/// (but for extreme ratios), so this is exact too.
bool is_degenerate(const std::array<Vec3d, 3>& corners) {
  const Vec3d n = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  return n.x == 0.0 && n.y == 0.0 && n.z == 0.0;
}

std::array<Vec3d, 3> corners_of(const Vec3* positions, const std::array<uint32_t, 3>& t) {
  return {Vec3d(positions[t[0]]), Vec3d(positions[t[1]]), Vec3d(positions[t[2]])};
}

bool is_identity(const Motion& motion) {
  const Affine& m = motion.steps()[0];
  return motion.still() && m.linear == glm::dmat3(1.0) && m.offset == Vec3d(0.0);
}

/// Whether a triangle is degenerate at all times: at every step, and half way to the next, as its
/// normal is a polynomial of second degree between two steps.
bool is_always_degenerate(const MeshBuffers& b, const std::array<uint32_t, 3>& t) {
  for (size_t i = 0; i < b.steps.size(); ++i) {
    const std::array<Vec3d, 3> here = corners_of(b.steps[i], t);
    if (!is_degenerate(here)) return false;
    if (i == 0) continue;
    const std::array<Vec3d, 3> before = corners_of(b.steps[i - 1], t);
    std::array<Vec3d, 3> between;
    for (size_t k = 0; k < 3; ++k) between[k] = 0.5 * (before[k] + here[k]);
    if (!is_degenerate(between)) return false;
  }
  return true;
}

/// Embree's float arithmetic can hit a triangle without area; one with an index out of range it
/// leaves out.
void leave_out_degenerate(MeshBuffers& b) {
  const auto& triangles = b.mesh().triangles;
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
  const auto& triangles = b.mesh().triangles;
  std::vector<float> errors(triangles.size());
  for_chunks(errors.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const auto corner = [&](size_t k) { return Vec3d(b.steps[0][triangles[i][k]]); };
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
                                                 float time) const {
  const auto [step, f] = step_place(time, steps.size());
  const Vec3* a = steps[step];
  const Vec3* b = steps[step + 1];
  std::array<Vec3d, 3> out;
  for (size_t k = 0; k < 3; ++k) {
    out[k] = Vec3d(a[triangle[k]]) * (1.0 - f) + Vec3d(b[triangle[k]]) * f;
  }
  return out;
}

std::shared_ptr<const MeshBuffers> make_mesh_buffers(const Shape& shape, const Motion* motion) {
  auto out = std::make_shared<MeshBuffers>();
  out->shape = shape;
  out->in_world = motion != nullptr;
  const bool stays = motion == nullptr || is_identity(*motion);
  const size_t count = step_count(shape, motion);
  out->own_positions.reserve(count);  // `steps` points into it
  for (size_t i = 0; i < count; ++i) {
    const float time = count > 1 ? static_cast<float>(i) / static_cast<float>(count - 1) : 0.0F;
    const Vec3* ready = stays ? ready_positions(shape, time) : nullptr;
    if (ready == nullptr) {
      const bool on_a_step = motion != nullptr && count == motion->steps().size();
      const Affine to_world = motion == nullptr ? Affine()
                              : on_a_step       ? motion->steps()[i]
                                                : motion->at(time);
      ready = out->own_positions.emplace_back(copy_positions(shape, time, to_world)).data();
    }
    out->steps.push_back(ready);
  }
  const size_t vertices = shape.mesh->positions.size();
  for (const Vec3* step : out->steps) {
    const bool known = step == shape.mesh->positions.data();
    out->bounds.include(known ? shape.mesh->bounds : bounds_of_positions(step, vertices));
  }
  leave_out_degenerate(*out);
  if (!out->vertices_move()) out->errors = triangle_errors(*out);
  return out;
}

}  // namespace hyades::core
