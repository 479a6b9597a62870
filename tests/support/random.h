#pragma once

#include <cstdint>

#include "core/base/hash.h"
#include "core/base/vec.h"

namespace hyades::test {

/// Independent random numbers for tests: a counter through a 64-bit mixer (splitmix64), so that a
/// seed names one sequence for ever.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(core::mix64(seed + 0x9E3779B97F4A7C15ULL)) {}

  uint64_t bits() { return core::mix64(state_ += 0x9E3779B97F4A7C15ULL); }

  /// Uniform in [0, 1), a multiple of 2^-24.
  float uniform() { return static_cast<float>(bits() >> 40) * 0x1p-24F; }
  float uniform(float low, float high) { return low + (high - low) * uniform(); }
  double uniform_double() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

  core::Vec2 uniform2() {
    const float x = uniform();
    return {x, uniform()};
  }

  /// A unit vector, uniform over the sphere.
  core::Vec3 direction();

 private:
  uint64_t state_;
};

}  // namespace hyades::test
