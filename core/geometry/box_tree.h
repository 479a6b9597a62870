#pragma once

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/bounds.h"
#include "core/base/vec.h"

namespace hyades::core {

/// A ray made ready for tests against boxes, in single precision. The tests never miss a box that
/// the ray meets: origins are moved by more than rounding may, and distances grown (Ize 2013,
/// "Robust BVH Ray Traversal"). And they are monotonic: what lies in a box is never nearer, nor
/// met where the box is missed, so that pruning by boxes decides nothing, however they are nested.
struct SlabRay {
  std::array<float, 3> near_origin;  ///< per axis, for the side where the ray comes in
  std::array<float, 3> far_origin;
  std::array<float, 3> inverse;       ///< of the direction; large where it has no such component
  std::array<uint32_t, 3> near_side;  ///< 1 where the ray comes in by the upper side

  SlabRay(const Vec3d& origin, const Vec3d& direction) {
    for (int i = 0; i < 3; ++i) {
      constexpr float kMost = std::numeric_limits<float>::infinity();
      const auto o = static_cast<float>(origin[i]);
      auto d = static_cast<float>(direction[i]);
      const bool along = std::abs(d) < kSmallest;
      if (along) d = std::copysign(kSmallest, d);
      // Both sides of the origin, from the nearest floats; in the world it is a float itself.
      const bool exact = static_cast<double>(o) == origin[i] && !along;
      const float below = (exact ? o : std::nextafter(o, -kMost)) - kLeastPad;
      const float above = (exact ? o : std::nextafter(o, kMost)) + kLeastPad;
      const auto axis = static_cast<size_t>(i);
      inverse[axis] = 1.0F / d;
      near_side[axis] = d < 0.0F ? 1 : 0;
      near_origin[axis] = d < 0.0F ? below : above;
      far_origin[axis] = d < 0.0F ? above : below;
    }
  }

  static constexpr float kSmallest = 1e-37F;
  static constexpr float kLeastPad = 1e-24F;
  static constexpr float kGrow = 1.0F + 0x1p-20F;
};

/// Where `ray` comes into a box, at least `t_min`; infinity where it misses it.
inline float enter_box(const SlabRay& ray, const Bounds& box, float t_min) {
  float near = t_min;
  float far = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<size_t>(i);
    const bool down = ray.near_side[axis] != 0;
    const float in = down ? box.upper[i] : box.lower[i];
    const float out = down ? box.lower[i] : box.upper[i];
    near = std::max(near, (in - ray.near_origin[axis]) * ray.inverse[axis]);
    far = std::min(far, (out - ray.far_origin[axis]) * ray.inverse[axis]);
  }
  return near <= far * SlabRay::kGrow ? near : std::numeric_limits<float>::infinity();
}

/// A box that moves on straight lines while the shutter is open.
struct MovingBounds {
  Bounds begin;  ///< when it opens
  Bounds end;    ///< when it closes

  /// Where `time` in [0, 1] finds it. Rounded so that a box in another stays in it.
  Bounds at(float time) const {
    return {begin.lower * (1.0F - time) + end.lower * time,
            begin.upper * (1.0F - time) + end.upper * time};
  }
};

/// A hierarchy of boxes, four to a node (Dammertz et al. 2008, "Shallow Bounding Volume Hierarchies
/// for Fast SIMD Ray Tracing"), as tables that hold no addresses.
class BoxTree {
 public:
  /// [side 0 lower, 1 upper][axis][child]; lower above upper where there is no child.
  using Sides = std::array<std::array<std::array<float, 4>, 3>, 2>;
  struct alignas(64) Node {
    Sides sides;                    ///< when the shutter opens
    std::array<uint32_t, 4> first;  ///< of a leaf's items in order(); or the number of the node
    std::array<uint32_t, 4> count;  ///< items of a leaf; 0: a node
  };

  /// Over `boxes`, none of them empty, by the surface area heuristic in bins (Wald 2007, "On fast
  /// Construction of SAH-based Bounding Volume Hierarchies"). The same tree whatever the threads.
  void build(const std::vector<Bounds>& boxes);

  /// Over boxes that move while the shutter is open: of the form that they suit half way, with
  /// nodes whose boxes move too.
  void build(const std::vector<MovingBounds>& boxes);

  /// The numbers of all boxes, those of a leaf side by side.
  const std::vector<uint32_t>& order() const { return order_; }
  const Bounds& bounds() const { return bounds_; }
  size_t memory() const {
    return nodes_.capacity() * sizeof(Node) + ends_.capacity() * sizeof(Sides);
  }
  /// Gives up order(), for those who keep their items in that order.
  void forget_order() { order_ = {}; }

  /// Calls visit(first, count) with ranges of order(), about the nearest first, until it returns
  /// true, then returns true. Boxes that begin beyond `limit`, which visit() may lower, are left
  /// out. `time` is that of the ray, 0 to 1.
  template <class Visit>
  bool traverse(const SlabRay& ray, float time, float t_min, const float& limit,
                Visit&& visit) const {
    return ends_.empty() ? traverse_as<false>(ray, time, t_min, limit, visit)
                         : traverse_as<true>(ray, time, t_min, limit, visit);
  }

 private:
  /// Nodes below the root have at most three neighbours that wait, on each of their levels.
  static constexpr size_t kDeepest = 96;

  template <bool kMoves, class Visit>
  bool traverse_as(const SlabRay& ray, float time, float t_min, const float& limit,
                   Visit& visit) const;

  /// Gives the node's children their boxes; returns that of them all.
  MovingBounds fit(uint32_t number, const std::vector<MovingBounds>& boxes);

  std::vector<Node> nodes_;
  std::vector<Sides> ends_;  ///< of the nodes, when the shutter closes; empty: nothing moves
  std::vector<uint32_t> order_;
  Bounds bounds_;
};

template <bool kMoves, class Visit>
bool BoxTree::traverse_as(const SlabRay& ray, float time, float t_min, const float& limit,
                          Visit& visit) const {
  if (nodes_.empty()) return false;
  struct Waiting {
    float near;
    uint32_t first;
    uint32_t count;
  };
  std::array<Waiting, 3 * kDeepest + 4> stack;
  size_t depth = 0;
  stack[depth++] = {t_min, 0, 0};
  const __m128 grow = _mm_set1_ps(SlabRay::kGrow);
  struct Axis {
    __m128 near_origin;
    __m128 far_origin;
    __m128 inverse;
    size_t near_side;
  };
  std::array<Axis, 3> axes;
  for (size_t i = 0; i < 3; ++i) {
    axes[i] = {_mm_set1_ps(ray.near_origin[i]), _mm_set1_ps(ray.far_origin[i]),
               _mm_set1_ps(ray.inverse[i]), ray.near_side[i]};
  }
  const __m128 late = _mm_set1_ps(time);
  const __m128 early = _mm_set1_ps(1.0F - time);
  while (depth > 0) {
    const Waiting next = stack[--depth];
    if (next.near > limit) continue;
    if (next.count > 0) {
      if (visit(next.first, next.count)) return true;
      continue;
    }
    const Node& node = nodes_[next.first];
    __m128 near = _mm_set1_ps(t_min);
    __m128 far = _mm_set1_ps(std::numeric_limits<float>::infinity());
    for (size_t i = 0; i < 3; ++i) {
      const Axis& axis = axes[i];
      __m128 in = _mm_loadu_ps(node.sides[axis.near_side][i].data());
      __m128 out = _mm_loadu_ps(node.sides[1 - axis.near_side][i].data());
      if constexpr (kMoves) {
        const Sides& end = ends_[next.first];
        const auto between = [&](__m128 from, size_t side) {
          const __m128 to = _mm_loadu_ps(end[side][i].data());
          return _mm_add_ps(_mm_mul_ps(from, early), _mm_mul_ps(to, late));
        };
        in = between(in, axis.near_side);
        out = between(out, 1 - axis.near_side);
      }
      near = _mm_max_ps(near, _mm_mul_ps(_mm_sub_ps(in, axis.near_origin), axis.inverse));
      far = _mm_min_ps(far, _mm_mul_ps(_mm_sub_ps(out, axis.far_origin), axis.inverse));
    }
    far = _mm_min_ps(_mm_mul_ps(far, grow), _mm_set1_ps(limit));
    auto met = static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(near, far)));
    if (met == 0) continue;
    alignas(16) std::array<float, 4> nears;
    _mm_store_ps(nears.data(), near);
    // The farthest first onto the stack.
    const size_t base = depth;
    for (; met != 0; met &= met - 1) {
      const auto child = static_cast<size_t>(__builtin_ctz(met));
      size_t place = depth++;
      const float at = nears[child];
      for (; place > base && stack[place - 1].near < at; --place) stack[place] = stack[place - 1];
      stack[place] = {at, node.first[child], node.count[child]};
    }
    if (stack[depth - 1].count == 0) {
      const char* nearest = reinterpret_cast<const char*>(&nodes_[stack[depth - 1].first]);
      _mm_prefetch(nearest, _MM_HINT_T0);
      _mm_prefetch(nearest + 64, _MM_HINT_T0);
    }
  }
  return false;
}

}  // namespace hyades::core
