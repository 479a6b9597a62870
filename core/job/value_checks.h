#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/job/animated.h"
#include "core/job/source.h"

/// What a job's keys ask of values that are only known once a frame is: check_frame.h tries them.
namespace hyades::core {

/// The numbers that a key accepts, and what they count.
struct Range {
  double low = -1e18;  ///< squares of lengths still fit into a float
  double high = 1e18;
  bool low_open = false;   ///< low itself is refused
  bool high_open = false;  ///< high itself is refused
  const char* unit = "";   ///< as in docs/job.md: "length", "degrees"

  constexpr Range in(const char* of_unit) const {
    return {low, high, low_open, high_open, of_unit};
  }

  /// Also false for what leaves an open range by being rounded to float (1e-60 is above 0, its
  /// float is not), and for NaN.
  bool contains(double x) const;
  /// "a number", "a number from 0 to 1", "a number above 0 and below 180".
  std::string describe(const std::string& noun = "a number") const;
};

inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{0.0, 1e18, true, false};
inline constexpr Range kNotNegative{0.0, 1e18};
inline constexpr Range kUnitInterval{0.0, 1.0};

/// An expression whose values must lie in a range.
struct NumberCheck {
  std::shared_ptr<const Expression> expression;
  Range range;
  SourceLocation where;
  std::string label;        ///< "fov", "size[1]"
  bool in_shutter = false;  ///< the value counts all the while the shutter is open, not only first
};

/// Two vectors that must not be the same: a direction and zero, a point and where it looks.
struct VectorCheck {
  Animated<Vec3> value;
  Animated<Vec3> other;
  SourceLocation where;
  std::string label;     ///< "direction is", "look_from and look_at are both"
  std::string expected;  ///< "a direction, not [0, 0, 0]"
  bool in_shutter = false;
};

struct ValueChecks {
  std::vector<NumberCheck> numbers;
  std::vector<VectorCheck> vectors;
};

}  // namespace hyades::core
