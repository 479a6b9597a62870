#pragma once

#include "core/base/bounds.h"
#include "core/base/vec.h"

namespace hyades::core {

/// Between which values something lies.
struct Extent {
  float least = 0.0F;
  float greatest = 0.0F;
};

/// How dense a medium is from place to place, in a space of the field's own: finite, >= 0, and 0
/// outside of bounds(). Immutable and thread-safe.
class DensityField {
 public:
  virtual ~DensityField() = default;

  virtual float at(const Vec3& p) const = 0;

  /// Values between which at() stays all over `box` (but for rounding); the closer the faster.
  virtual Extent over(const Bounds& box) const = 0;

  virtual Bounds bounds() const = 0;
};

/// A colour, or a triple of factors, from place to place; >= 0 and finite. Immutable, thread-safe.
class ColorField {
 public:
  virtual ~ColorField() = default;
  virtual Rgb at(const Vec3& p) const = 0;
};

}  // namespace hyades::core
