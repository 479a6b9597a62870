#include "core/geometry/tessellate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "core/geometry/chunks.h"

namespace hyades::core {
namespace {

/// More than any budget leaves room for; edges that rounding keeps from growing shorter end here.
constexpr int kMostPasses = 40;

/// Symmetric in its ends to the last bit.
double squared_length(const Vec3& a, const Vec3& b) {
  const Vec3d d = Vec3d(a) - Vec3d(b);
  return glm::dot(d, d);
}

Vec3 middle(const Vec3& a, const Vec3& b) { return Vec3((Vec3d(a) + Vec3d(b)) * 0.5); }

Vec3 middle_direction(const Vec3& a, const Vec3& b) {
  const Vec3d sum = Vec3d(a) + Vec3d(b);
  const double length = std::sqrt(glm::dot(sum, sum));
  return length > 0.0 ? Vec3(sum / length) : Vec3(0.0F);
}

/// How often an edge is halved.
int halvings(double length, double max_edge) {
  int count = 0;
  for (; length > max_edge; length *= 0.5) ++count;
  return count;
}

Error over_budget(double found, size_t budget) {
  return {
      fmt::format("it would have about {:.4g} triangles, more than its budget of {}: expected a "
                  "larger max_edge or a larger budget",
                  found, budget)};
}

/// One pass over all triangles: what is longer than max_edge is halved.
class Pass {
 public:
  Pass(TriangleMesh& mesh, std::vector<Vec3>& along, double max_edge)
      : mesh_(mesh), along_(along), limit_(max_edge * max_edge) {}

  /// The number of triangles after it; 0 where nothing is to be done.
  size_t count() {
    size_t triangles = mesh_.triangles.size();
    for (const auto& t : mesh_.triangles) {
      for (size_t k = 0; k < 3; ++k) {
        if (is_long(t[k], t[(k + 1) % 3])) ++triangles;
      }
    }
    return triangles == mesh_.triangles.size() ? 0 : triangles;
  }

  void run(size_t triangles) {
    find_edges();
    add_vertices();
    std::vector<std::array<uint32_t, 3>> old;
    old.swap(mesh_.triangles);
    mesh_.triangles.reserve(triangles);
    for (const auto& t : old) split(t);
  }

 private:
  bool is_long(uint32_t a, uint32_t b) const {
    return squared_length(mesh_.positions[a], mesh_.positions[b]) > limit_;
  }

  static uint64_t key(uint32_t a, uint32_t b) {
    return (uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
  }

  void find_edges() {
    for (const auto& t : mesh_.triangles) {
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t a = t[k];
        const uint32_t b = t[(k + 1) % 3];
        if (is_long(a, b)) edges_.push_back(key(a, b));
      }
    }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  }

  /// The middles of edges, in the order of the edges.
  void add_vertices() {
    first_ = mesh_.positions.size();
    const size_t all = first_ + edges_.size();
    mesh_.positions.resize(all);
    along_.resize(all);
    if (!mesh_.normals.empty()) mesh_.normals.resize(all);
    if (!mesh_.uvs.empty()) mesh_.uvs.resize(all);
    if (!mesh_.second_uvs.empty()) mesh_.second_uvs.resize(all);
    if (!mesh_.colors.empty()) mesh_.colors.resize(all);
    for_chunks(edges_.size(), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const auto a = static_cast<uint32_t>(edges_[i] >> 32U);
        const auto b = static_cast<uint32_t>(edges_[i]);
        const size_t at = first_ + i;
        mesh_.positions[at] = middle(mesh_.positions[a], mesh_.positions[b]);
        along_[at] = middle_direction(along_[a], along_[b]);
        if (!mesh_.normals.empty())
          mesh_.normals[at] = middle_direction(mesh_.normals[a], mesh_.normals[b]);
        halve(mesh_.uvs, a, b, at);
        halve(mesh_.second_uvs, a, b, at);
        halve(mesh_.colors, a, b, at);
      }
    });
  }

  template <class T>
  static void halve(std::vector<T>& values, uint32_t a, uint32_t b, size_t at) {
    if (!values.empty()) values[at] = (values[a] + values[b]) * 0.5F;
  }

  uint32_t middle_of(uint32_t a, uint32_t b) const {
    const auto found = std::lower_bound(edges_.begin(), edges_.end(), key(a, b));
    return static_cast<uint32_t>(first_ + static_cast<size_t>(found - edges_.begin()));
  }

  void add(uint32_t a, uint32_t b, uint32_t c) { mesh_.triangles.push_back({a, b, c}); }

  void split(const std::array<uint32_t, 3>& t) {
    std::array<bool, 3> halved{};
    size_t count = 0;
    for (size_t k = 0; k < 3; ++k) {
      halved[k] = is_long(t[k], t[(k + 1) % 3]);
      if (halved[k]) ++count;
    }
    // Turned so that the first edge is the odd one out: the only one that is halved, or is not.
    const bool odd = count == 1;
    size_t turn = 0;
    if (count == 1 || count == 2) {
      while (halved[turn] != odd) ++turn;
    }
    const uint32_t a = t[turn];
    const uint32_t b = t[(turn + 1) % 3];
    const uint32_t c = t[(turn + 2) % 3];
    if (count == 0) return add(a, b, c);
    if (count == 1) {
      const uint32_t ab = middle_of(a, b);
      add(a, ab, c);
      return add(ab, b, c);
    }
    const uint32_t bc = middle_of(b, c);
    const uint32_t ca = middle_of(c, a);
    add(ca, bc, c);
    if (count == 3) {
      const uint32_t ab = middle_of(a, b);
      add(a, ab, ca);
      add(ab, b, bc);
      return add(ab, bc, ca);
    }
    const bool from_a = squared_length(mesh_.positions[a], mesh_.positions[bc]) <=
                        squared_length(mesh_.positions[b], mesh_.positions[ca]);
    add(a, b, from_a ? bc : ca);
    add(from_a ? a : b, bc, ca);
  }

  TriangleMesh& mesh_;
  std::vector<Vec3>& along_;
  double limit_;
  std::vector<uint64_t> edges_;  ///< that are halved, sorted
  size_t first_ = 0;             ///< number of the middle of the first of them
};

}  // namespace

double estimate_tessellation(const TriangleMesh& mesh, float max_edge) {
  double all = 0.0;
  for (const auto& t : mesh.triangles) {
    std::array<int, 3> n{};
    for (size_t k = 0; k < 3; ++k) {
      const double length2 = squared_length(mesh.positions[t[k]], mesh.positions[t[(k + 1) % 3]]);
      n[k] = halvings(std::sqrt(length2), double{max_edge});
    }
    std::sort(n.begin(), n.end());
    // Fours while all three are halved, then threes, then twos.
    double count = std::ldexp(1.0, 2 * n[0] + n[2] - n[1]);
    for (int i = n[0]; i < n[1]; ++i) count *= 3.0;
    all += count;
  }
  return all;
}

Status tessellate(TriangleMesh& mesh, std::vector<Vec3>& along, float max_edge, size_t budget) {
  mesh.tangents.clear();
  mesh.vertex_tangents.clear();
  const double estimate = estimate_tessellation(mesh, max_edge);
  if (estimate > static_cast<double>(budget)) return over_budget(estimate, budget);
  for (int i = 0; i < kMostPasses; ++i) {
    Pass pass(mesh, along, double{max_edge});
    const size_t triangles = pass.count();
    if (triangles == 0) break;
    if (triangles > budget) return over_budget(static_cast<double>(triangles), budget);
    pass.run(triangles);
  }
  return {};
}

}  // namespace hyades::core
