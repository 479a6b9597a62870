#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/chunks.h"
#include "core/geometry/mesh_source.h"

namespace hyades::core {
namespace {

constexpr size_t kNone = std::numeric_limits<size_t>::max();

/// The least i in [0, n) for which bad(i), or kNone; in parallel.
template <class Bad>
size_t find_first(size_t n, const Bad& bad) {
  std::atomic<size_t> first{kNone};
  for_chunks(n, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      if (!bad(i)) continue;
      size_t known = first.load();
      while (i < known && !first.compare_exchange_weak(known, i)) {
      }
      return;
    }
  });
  return first.load();
}

bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const Vec2& v) { return std::isfinite(v.x) && std::isfinite(v.y); }

bool finite(const Vec4& v) { return finite(Vec3(v)) && std::isfinite(v.w); }

template <class Vec>
Status check_finite(const std::vector<Vec>& values, const char* what) {
  const size_t bad = find_first(values.size(), [&](size_t i) { return !finite(values[i]); });
  if (bad == kNone) return {};
  return Error{std::string(what) + " of vertex " + std::to_string(bad) + " is not finite"};
}

void normalize(std::vector<Vec3>& normals) {
  (void)find_first(normals.size(), [&](size_t i) {
    const Vec3d n(normals[i]);
    const double length2 = glm::dot(n, n);
    // Programs write such normals for facets of no area; there the facet's own one counts.
    normals[i] =
        length2 > 0.0 && std::isfinite(length2) ? Vec3(n / std::sqrt(length2)) : Vec3(0.0F);
    return false;
  });
}

template <class T>
void gather(std::vector<T>& values, const std::vector<uint32_t>& kept, size_t room) {
  if (values.empty()) return;
  std::vector<T> out;
  out.reserve(kept.size() + room);
  for (const uint32_t i : kept) out.push_back(values[i]);
  values = std::move(out);
}

}  // namespace

void drop_unused_vertices(TriangleMesh& mesh) {
  std::vector<uint8_t> used(mesh.positions.size(), 0);
  for_chunks(mesh.triangles.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      for (const uint32_t v : mesh.triangles[i]) {
        std::atomic_ref<uint8_t>(used[v]).store(1, std::memory_order_relaxed);
      }
    }
  });
  if (std::find(used.begin(), used.end(), 0) == used.end()) return;
  std::vector<uint32_t> kept;
  std::vector<uint32_t> place(used.size(), 0);
  for (size_t i = 0; i < used.size(); ++i) {
    place[i] = static_cast<uint32_t>(kept.size());
    if (used[i] != 0) kept.push_back(static_cast<uint32_t>(i));
  }
  for (auto& t : mesh.triangles) t = {place[t[0]], place[t[1]], place[t[2]]};
  gather(mesh.positions, kept, 1);
  gather(mesh.normals, kept, 0);
  gather(mesh.uvs, kept, 0);
  gather(mesh.second_uvs, kept, 0);
  gather(mesh.colors, kept, 0);
  gather(mesh.vertex_tangents, kept, 0);
}

Status complete_mesh(TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return Error{"it has no faces"};
  const size_t n = mesh.positions.size();
  const size_t bad = find_first(mesh.triangles.size(), [&](size_t i) {
    const auto& t = mesh.triangles[i];
    return t[0] >= n || t[1] >= n || t[2] >= n;
  });
  if (bad != kNone) {
    const auto& t = mesh.triangles[bad];
    return Error{"face " + std::to_string(bad) + " refers to vertex " +
                 std::to_string(std::max({t[0], t[1], t[2]})) + ", but there are only " +
                 std::to_string(n) + " (counted from 0)"};
  }
  if (Status s = check_finite(mesh.positions, "the position"); !s) return s;
  if (Status s = check_finite(mesh.uvs, "the texture coordinate"); !s) return s;
  if (Status s = check_finite(mesh.second_uvs, "the second texture coordinate"); !s) return s;
  if (Status s = check_finite(mesh.colors, "the colour"); !s) return s;
  if (Status s = check_finite(mesh.vertex_tangents, "the tangent"); !s) return s;
  normalize(mesh.normals);
  drop_unused_vertices(mesh);
  finish_mesh(mesh);
  return {};
}

}  // namespace hyades::core
