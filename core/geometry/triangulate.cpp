#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/chunks.h"
#include "core/geometry/mesh_source.h"

namespace hyades::core {
namespace {

using Vec2d = glm::dvec2;

/// Twice the signed area of the triangle a, b, c.
double cross2(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Normal of a polygon with the length of twice its area (Newell's method).
Vec3d newell_normal(const std::vector<Vec3>& positions, std::span<const uint32_t> polygon) {
  Vec3d n(0.0);
  const Vec3d origin(positions[polygon[0]]);
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d a = Vec3d(positions[polygon[i]]) - origin;
    const Vec3d b = Vec3d(positions[polygon[(i + 1) % polygon.size()]]) - origin;
    n += glm::cross(a, b);
  }
  return n;
}

/// The corners in the coordinate plane in which the polygon is largest, turning counter-clockwise.
std::vector<Vec2d> flatten(const std::vector<Vec3>& positions, std::span<const uint32_t> polygon) {
  const Vec3d n = newell_normal(positions, polygon);
  const Vec3d size = glm::abs(n);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  int u = (axis + 1) % 3;
  int v = (axis + 2) % 3;
  if (n[axis] < 0.0) std::swap(u, v);
  std::vector<Vec2d> out;
  out.reserve(polygon.size());
  for (const uint32_t i : polygon) {
    out.emplace_back(static_cast<double>(positions[i][u]), static_cast<double>(positions[i][v]));
  }
  return out;
}

/// The ring of corners not cut off yet.
class Ring {
 public:
  explicit Ring(std::vector<Vec2d> points)
      : points_(std::move(points)), next_(points_.size()), previous_(points_.size()) {
    const size_t n = points_.size();
    for (size_t i = 0; i < n; ++i) {
      next_[i] = (i + 1) % n;
      previous_[i] = (i + n - 1) % n;
    }
    for (size_t i = 0; i < n; ++i) {
      if (turn(i) <= 0.0) reflex_.push_back(i);
    }
  }

  size_t next(size_t i) const { return next_[i]; }
  size_t previous(size_t i) const { return previous_[i]; }

  /// Whether corner i can be cut off: it turns left and no reflex corner lies in its triangle.
  bool is_ear(size_t i) const {
    if (!(turn(i) > 0.0)) return false;
    const Vec2d& a = points_[previous_[i]];
    const Vec2d& b = points_[i];
    const Vec2d& c = points_[next_[i]];
    return std::none_of(reflex_.begin(), reflex_.end(), [&](size_t r) {
      if (r == i || r == previous_[i] || r == next_[i]) return false;
      const Vec2d& p = points_[r];
      if (p == a || p == b || p == c) return false;
      return cross2(a, b, p) >= 0.0 && cross2(b, c, p) >= 0.0 && cross2(c, a, p) >= 0.0;
    });
  }

  void cut(size_t i) {
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    std::erase_if(reflex_, [&](size_t r) {
      return r == i || ((r == previous_[i] || r == next_[i]) && turn(r) > 0.0);
    });
  }

 private:
  double turn(size_t i) const {
    return cross2(points_[previous_[i]], points_[i], points_[next_[i]]);
  }

  std::vector<Vec2d> points_;
  std::vector<size_t> next_;
  std::vector<size_t> previous_;
  std::vector<size_t> reflex_;  // corners that do not turn left; cutting only removes from it
};

void clip_ears(const std::vector<Vec3>& positions, std::span<const uint32_t> polygon,
               std::vector<std::array<uint32_t, 3>>& out) {
  Ring ring(flatten(positions, polygon));
  size_t at = 0;
  size_t left = polygon.size();
  size_t tried = 0;
  while (left > 3) {
    // Self-crossing outlines may have no ear: then any corner is cut.
    if (!ring.is_ear(at) && tried < left) {
      at = ring.next(at);
      ++tried;
      continue;
    }
    out.push_back({polygon[ring.previous(at)], polygon[at], polygon[ring.next(at)]});
    ring.cut(at);
    // Going on two corners later spreads the cuts and avoids fans of slivers.
    at = ring.next(ring.next(at));
    --left;
    tried = 0;
  }
  out.push_back({polygon[ring.previous(at)], polygon[at], polygon[ring.next(at)]});
}

void cut_quad(const std::vector<Vec3>& positions, std::span<const uint32_t> q,
              std::vector<std::array<uint32_t, 3>>& out) {
  const auto normal = [&](int a, int b, int c) {
    const Vec3d p(positions[q[a]]);
    return glm::cross(Vec3d(positions[q[b]]) - p, Vec3d(positions[q[c]]) - p);
  };
  // The diagonal 0-2 is wrong where it leaves the quad: its two triangles then face apart.
  if (glm::dot(normal(0, 1, 2), normal(0, 2, 3)) >= 0.0) {
    out.push_back({q[0], q[1], q[2]});
    out.push_back({q[0], q[2], q[3]});
  } else {
    out.push_back({q[1], q[2], q[3]});
    out.push_back({q[1], q[3], q[0]});
  }
}

}  // namespace

void triangulate(const std::vector<Vec3>& positions, std::span<const uint32_t> polygon,
                 std::vector<std::array<uint32_t, 3>>& out) {
  if (polygon.size() < 3) return;
  if (polygon.size() == 3) {
    out.push_back({polygon[0], polygon[1], polygon[2]});
  } else if (polygon.size() == 4) {
    cut_quad(positions, polygon, out);
  } else {
    clip_ears(positions, polygon, out);
  }
}

void triangulate_all(const std::vector<Vec3>& positions, std::span<const uint32_t> corners,
                     std::span<const uint32_t> sizes, std::vector<std::array<uint32_t, 3>>& out) {
  // Where the corners and triangles of each chunk of polygons begin.
  struct Start {
    size_t corner = 0;
    size_t triangle = 0;
  };
  std::vector<Start> starts(chunk_count(sizes.size()) + 1);
  for_chunks(sizes.size(), [&](size_t begin, size_t end) {
    Start& after = starts[begin / kChunk + 1];
    for (size_t i = begin; i < end; ++i) {
      after.corner += sizes[i];
      after.triangle += std::max(sizes[i], 2U) - 2;
    }
  });
  starts[0].triangle = out.size();
  for (size_t i = 1; i < starts.size(); ++i) {
    starts[i].corner += starts[i - 1].corner;
    starts[i].triangle += starts[i - 1].triangle;
  }
  out.resize(starts.back().triangle);
  for_chunks(sizes.size(), [&](size_t begin, size_t end) {
    const Start& start = starts[begin / kChunk];
    // Most meshes have nothing to cut.
    if (std::all_of(&sizes[begin], &sizes[begin] + (end - begin),
                    [](uint32_t size) { return size == 3; })) {
      for (size_t i = 0; i < end - begin; ++i) {
        const uint32_t* c = &corners[start.corner + 3 * i];
        out[start.triangle + i] = {c[0], c[1], c[2]};
      }
      return;
    }
    std::vector<std::array<uint32_t, 3>> cut;
    cut.reserve(starts[begin / kChunk + 1].triangle - start.triangle);
    size_t at = start.corner;
    for (size_t i = begin; i < end; at += sizes[i++]) {
      triangulate(positions, corners.subspan(at, sizes[i]), cut);
    }
    std::copy(cut.begin(), cut.end(), out.begin() + static_cast<ptrdiff_t>(start.triangle));
  });
}

}  // namespace hyades::core
