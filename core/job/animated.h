#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "core/job/time.h"

namespace hyades::core {

/// How a value moves between two keys.
enum class Ease { linear, smooth, step, in, out };

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

  /// The value at `time`. Before the first key and after the last, their values.
  T at(const JobTime& time) const;
};

extern template struct Animated<float>;
extern template struct Animated<Vec2>;
extern template struct Animated<Vec3>;

}  // namespace hyades::core
