#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/ray.h"
#include "core/media/density_field.h"

namespace hyades::core {

/// Bounds of a density field, cell by cell of a coarse grid over its bounds: what tracking needs to
/// know of a field before it looks closer.
class MajorantGrid {
 public:
  /// `cells` along each axis, at least 1. `slack` >= 1 widens the bounds upwards; results do not
  /// depend on it, only how fast they are had (for tests).
  MajorantGrid(const DensityField& field, const Vec3i& cells, float slack = 1.0F);

  /// About `along_longest` cells along the field's longest side, as many per length along others.
  static Vec3i cells_for(const Bounds& bounds, int along_longest);

  const Bounds& bounds() const { return bounds_; }
  const Vec3i& cells() const { return cells_; }
  const Extent& cell(const Vec3i& i) const {
    return extents_[static_cast<size_t>((i.z * cells_.y + i.y) * cells_.x + i.x)];
  }
  size_t memory() const { return extents_.size() * sizeof(Extent); }

  /// Goes from cell to cell along origin + t direction, t in (0, t_max) (Amanatides and Woo 1987),
  /// and calls visit(begin, end, extent) for each part of the way; visit returns whether to go on.
  /// The parts follow each other without gaps. Each step leaves a cell for good, so that there are
  /// at most as many as the sum of the cells along the axes.
  template <class Visit>
  void walk(const Vec3& origin, const Vec3& direction, float t_max, const Visit& visit) const;

  /// Where the way is within the bounds; empty (begin >= end) where it misses them.
  struct Span {
    float begin;
    float end;
  };
  Span inside(const Vec3& origin, const Vec3& direction, float t_max) const {
    Span span{0.0F, t_max};
    for (int a = 0; a < 3; ++a) {
      if (direction[a] == 0.0F) {
        if (!(origin[a] >= bounds_.lower[a] && origin[a] <= bounds_.upper[a])) return {0.0F, 0.0F};
        continue;
      }
      const float low = (bounds_.lower[a] - origin[a]) / direction[a];
      const float high = (bounds_.upper[a] - origin[a]) / direction[a];
      span.begin = std::max(span.begin, std::min(low, high));
      span.end = std::min(span.end, std::max(low, high));
    }
    return span;
  }

 private:
  Bounds bounds_;
  Vec3i cells_;
  Vec3 cell_size_;
  std::vector<Extent> extents_;
};

template <class Visit>
void MajorantGrid::walk(const Vec3& origin, const Vec3& direction, float t_max,
                        const Visit& visit) const {
  const Span span = inside(origin, direction, t_max);
  if (!(span.begin < span.end)) return;
  const Vec3 entry = origin + span.begin * direction - bounds_.lower;
  Vec3i at;
  Vec3i step;
  Vec3 next;  // t at which the way leaves the cell, per axis
  const auto leave = [&](int a) {
    const float plane =
        bounds_.lower[a] + static_cast<float>(at[a] + (step[a] > 0 ? 1 : 0)) * cell_size_[a];
    return step[a] == 0 ? kInfinity : (plane - origin[a]) / direction[a];
  };
  for (int a = 0; a < 3; ++a) {
    const float place = std::clamp(entry[a] / cell_size_[a], 0.0F, static_cast<float>(cells_[a]));
    at[a] = std::min(static_cast<int>(place), cells_[a] - 1);
    step[a] = direction[a] > 0.0F ? 1 : direction[a] < 0.0F ? -1 : 0;
    next[a] = leave(a);
  }
  float t = span.begin;
  while (true) {
    const int a = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    const float end = std::clamp(next[a], t, span.end);
    if (end > t && !visit(t, end, cell(at))) return;
    t = end;
    at[a] += step[a];
    if (!(t < span.end) || at[a] < 0 || at[a] >= cells_[a]) break;
    next[a] = leave(a);
  }
  // Rounding may end the cells a little before the bounds.
  at = glm::clamp(at, Vec3i(0), cells_ - 1);
  if (t < span.end) visit(t, span.end, cell(at));
}

}  // namespace hyades::core
