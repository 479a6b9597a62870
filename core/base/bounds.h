#pragma once

#include "core/base/vec.h"

namespace hyades::core {

/// An axis-aligned box; empty (lower > upper) by default.
struct Bounds {
  Vec3 lower{3.0e38F};
  Vec3 upper{-3.0e38F};
  bool empty() const { return lower.x > upper.x; }
  void include(const Vec3& p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  void include(const Bounds& b) {
    lower = glm::min(lower, b.lower);
    upper = glm::max(upper, b.upper);
  }
  Vec3 center() const { return 0.5F * (lower + upper); }
  Vec3 size() const { return upper - lower; }
};

}  // namespace hyades::core
