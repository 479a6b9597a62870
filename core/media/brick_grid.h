#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/bounds.h"

namespace hyades::core {

/// Values at the integer points of a box, 0 everywhere else, interpolated trilinearly between them.
/// Stored in bricks of 8 x 8 x 8 cells, each with the values of its far sides too, so that a
/// look-up stays within one brick; bricks of nothing but zeros are not stored. T: float or Rgb.
template <class T>
class BrickGrid {
 public:
  static constexpr int kSide = 8;

  /// Integer points lower..upper, both included. `value(point)` is asked at most once or twice for
  /// each, and only for bricks that reach into one of the boxes for which `boxes(visit)` calls
  /// visit(first, last), of integer points, both included: outside of all of them is 0.
  template <class Value, class Boxes>
  BrickGrid(const Vec3i& lower, const Vec3i& upper, const Value& value, const Boxes& boxes);

  /// A grid of these integer points of which each may have a value.
  template <class Value>
  BrickGrid(const Vec3i& lower, const Vec3i& upper, const Value& value)
      : BrickGrid(lower, upper, value, [&](const auto& visit) { visit(lower, upper); }) {}

  T at(const Vec3& p) const;

  /// Outside of it at() is 0: one cell more than the points on each side.
  Bounds bounds() const { return {Vec3(lower_), Vec3(upper_ + 1)}; }

  /// Calls visit(least, greatest) or visit(value) for values of which at() is a mean anywhere in
  /// `box`: whatever bounds them bounds the field there.
  template <class Visit>
  void visit_values(const Bounds& box, const Visit& visit) const;

  size_t memory() const { return bricks_.size() * sizeof(Brick) + index_.size() * sizeof(int32_t); }
  size_t brick_count() const { return bricks_.size(); }

 private:
  static constexpr int kPoints = kSide + 1;
  static constexpr int32_t kNone = -1;
  static constexpr int32_t kAwaited = -2;  ///< while the bricks are made
  using Brick = std::array<T, kPoints * kPoints * kPoints>;

  static size_t place(const Vec3i& p) {
    return static_cast<size_t>((p.z * kPoints + p.y) * kPoints + p.x);
  }
  /// Makes the bricks that have one of the points first..last wait for their values.
  void await_bricks(const Vec3i& first, const Vec3i& last);
  size_t index_of(const Vec3i& brick) const {
    return (static_cast<size_t>(brick.z) * static_cast<size_t>(counts_.y) +
            static_cast<size_t>(brick.y)) *
               static_cast<size_t>(counts_.x) +
           static_cast<size_t>(brick.x);
  }

  Vec3i lower_;   ///< the cell of the lower corner begins at this integer point
  Vec3i upper_;   ///< the last cell begins here
  Vec3i counts_;  ///< bricks along each axis
  std::vector<int32_t> index_;
  std::vector<Brick> bricks_;
};

template <class T>
void BrickGrid<T>::await_bricks(const Vec3i& first, const Vec3i& last) {
  // The points of a brick are 0..8 from its corner: the last ones are those of the next one, too.
  const Vec3i begin = glm::max((first - lower_ - 1) / kSide, Vec3i(0));
  const Vec3i end = glm::min((last - lower_) / kSide, counts_ - 1);
  Vec3i b;
  for (b.z = begin.z; b.z <= end.z; ++b.z) {
    for (b.y = begin.y; b.y <= end.y; ++b.y) {
      for (b.x = begin.x; b.x <= end.x; ++b.x) index_[index_of(b)] = kAwaited;
    }
  }
}

template <class T>
template <class Value, class Boxes>
BrickGrid<T>::BrickGrid(const Vec3i& lower, const Vec3i& upper, const Value& value,
                        const Boxes& boxes)
    : lower_(lower - 1), upper_(upper), counts_((upper - lower_ + kSide) / kSide) {
  index_.assign(static_cast<size_t>(counts_.x) * static_cast<size_t>(counts_.y) *
                    static_cast<size_t>(counts_.z),
                kNone);
  boxes([&](const Vec3i& first, const Vec3i& last) {
    await_bricks(glm::max(first, lower), glm::min(last, upper));
  });
  Vec3i b;
  for (b.z = 0; b.z < counts_.z; ++b.z) {
    for (b.y = 0; b.y < counts_.y; ++b.y) {
      for (b.x = 0; b.x < counts_.x; ++b.x) {
        int32_t& entry = index_[index_of(b)];
        if (entry != kAwaited) continue;
        entry = kNone;
        Brick brick;
        bool empty = true;
        Vec3i p;
        for (p.z = 0; p.z < kPoints; ++p.z) {
          for (p.y = 0; p.y < kPoints; ++p.y) {
            for (p.x = 0; p.x < kPoints; ++p.x) {
              const Vec3i at = lower_ + b * kSide + p;
              const bool inside = at == glm::clamp(at, lower, upper);
              const T v = inside ? value(at) : T(0.0F);
              brick[place(p)] = v;
              empty = empty && v == T(0.0F);
            }
          }
        }
        if (empty) continue;
        entry = static_cast<int32_t>(bricks_.size());
        bricks_.push_back(brick);
      }
    }
  }
}

template <class T>
T BrickGrid<T>::at(const Vec3& p) const {
  const Vec3 from = p - Vec3(lower_);
  const Vec3 size = Vec3(upper_ + 1 - lower_);
  if (!(from.x >= 0.0F && from.y >= 0.0F && from.z >= 0.0F && from.x < size.x && from.y < size.y &&
        from.z < size.z)) {
    return T(0.0F);
  }
  const Vec3i cell(from);
  const int32_t brick = index_[index_of(cell / kSide)];
  if (brick == kNone) return T(0.0F);
  const T* v = &bricks_[static_cast<size_t>(brick)][place(cell % kSide)];
  const Vec3 f = from - Vec3(cell);
  const auto mix = [](const T& a, const T& b, float w) { return a + (b - a) * w; };
  const auto row = [&](const T* r) { return mix(r[0], r[1], f.x); };
  const auto square = [&](const T* s) { return mix(row(s), row(s + kPoints), f.y); };
  return mix(square(v), square(v + kPoints * kPoints), f.z);
}

template <class T>
template <class Visit>
void BrickGrid<T>::visit_values(const Bounds& box, const Visit& visit) const {
  const Vec3 reach(upper_ + 1);
  const Vec3 low = glm::clamp(glm::floor(box.lower), Vec3(lower_), reach);
  const Vec3 high = glm::clamp(glm::floor(box.upper) + 1.0F, Vec3(lower_), reach);
  if (low != glm::floor(box.lower) || high != glm::floor(box.upper) + 1.0F) visit(T(0.0F));
  const Vec3i first = Vec3i(low) - lower_;
  const Vec3i last = Vec3i(high) - lower_;  // included; a brick's far side belongs to the next too
  const Vec3i first_brick = glm::min(first / kSide, counts_ - 1);
  const Vec3i last_brick = glm::min(glm::max(last - 1, Vec3i(0)) / kSide, counts_ - 1);
  Vec3i b;
  for (b.z = first_brick.z; b.z <= last_brick.z; ++b.z) {
    for (b.y = first_brick.y; b.y <= last_brick.y; ++b.y) {
      for (b.x = first_brick.x; b.x <= last_brick.x; ++b.x) {
        const int32_t index = index_[index_of(b)];
        if (index == kNone) {
          visit(T(0.0F));
          continue;
        }
        const Brick& brick = bricks_[static_cast<size_t>(index)];
        const Vec3i begin = glm::max(first - b * kSide, Vec3i(0));
        const Vec3i end = glm::min(last - b * kSide, Vec3i(kSide));
        Vec3i p;
        for (p.z = begin.z; p.z <= end.z; ++p.z) {
          for (p.y = begin.y; p.y <= end.y; ++p.y) {
            for (p.x = begin.x; p.x <= end.x; ++p.x) visit(brick[place(p)]);
          }
        }
      }
    }
  }
}

}  // namespace hyades::core
