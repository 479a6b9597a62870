#pragma once

#include <bit>
#include <cstdint>

#include "core/base/elementary_kernels.h"
#include "core/base/hash.h"
#include "core/base/vec.h"

namespace hyades::core {

/// As many random numbers as a walk through a varying medium asks for, out of the four that it is
/// given: their bits name a sequence (a counter through a 64-bit mixer), so that a walk is a
/// function of them alone. Walks of different `purpose` from the same four are independent.
class CollisionNumbers {
 public:
  CollisionNumbers(const Vec4& u, uint64_t purpose)
      : state_(hash_combine(hash_combine(pair(u.x, u.y), pair(u.z, u.w)), purpose)) {}

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

  /// Exponentially distributed with mean 1, finite.
  double exponential() {
    // In (0, 1]: the logarithm is of a normal number.
    return -elementary::log_finite(static_cast<double>((bits() >> 11) + 1) * 0x1p-53);
  }

 private:
  uint64_t bits() { return mix64(state_ += 0x9E3779B97F4A7C15ULL); }

  static uint64_t pair(float a, float b) {
    return uint64_t{std::bit_cast<uint32_t>(a)} << 32U | std::bit_cast<uint32_t>(b);
  }

  uint64_t state_;
};

}  // namespace hyades::core
