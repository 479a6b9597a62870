#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "core/job/time.h"

namespace hyades::core {

/// How a value moves between two keys. `spline` passes through the keys without stopping, and goes
/// nowhere beyond the two around it.
enum class Ease { linear, smooth, step, in, out, spline };

/// What comes before the first key and after the last: their values; or all again from the
/// beginning; or all again, there and back.
enum class Repeat { none, loop, mirror };

/// A compiled expression of `t` [s] and `frame`. Immutable; evaluate is thread-safe. Functions: sin
/// cos tan asin acos atan atan2 sqrt abs min max floor ceil round exp log pow mod clamp lerp
/// smoothstep noise; constants pi, e. Evaluated with the same bits on every machine (elementary.h).
class Expression {
 public:
  virtual ~Expression() = default;
  virtual double evaluate(const JobTime& time) const = 0;
  virtual const std::string& text() const = 0;
};

template <class T>
struct Key {
  double frame = 1.0;
  T value{};
};

/// A number, vector or colour that may change over the job: a constant, keys with an ease, or one
/// expression per component.
template <class T>
struct Animated {
  static constexpr int kComponents = static_cast<int>(sizeof(T) / sizeof(float));  // NOLINT: floats

  T constant{};
  std::vector<Key<T>> keys;  ///< sorted by frame; empty unless keyed
  Ease ease = Ease::linear;
  Repeat repeat = Repeat::none;
  /// Component i follows expressions[i] where it is set, else `constant`.
  std::array<std::shared_ptr<const Expression>, kComponents> expressions{};

  Animated() = default;
  Animated(T value) : constant(value) {}  // NOLINT: implicit on purpose: defaults read as values

  bool is_constant() const {
    for (const auto& e : expressions) {
      if (e) return false;
    }
    return keys.empty();
  }

  /// The value at `time`, component by component.
  T at(const JobTime& time) const;

  /// Two neighbouring keys and how far it is from the first to the second, eased (but linear where
  /// the ease is spline). Only where there are keys.
  struct Between {
    size_t first = 0;
    size_t second = 0;
    double u = 0.0;  ///< 0 to 1
  };
  Between between(const JobTime& time) const;
};

extern template struct Animated<float>;
extern template struct Animated<Vec2>;
extern template struct Animated<Vec3>;
extern template struct Animated<Vec4>;

/// A rotation by keyed quaternions (x, y, z, w), each of any length: from one to the next by the
/// shortest way at even speed (Shoemake 1985, "Animating Rotation with Quaternion Curves"), eased.
/// Unit length. Expressions are not rotations: there are none.
Vec4 rotation_at(const Animated<Vec4>& quaternion, const JobTime& time);

}  // namespace hyades::core
