#pragma once

#include <memory>

#include "core/base/vec.h"

namespace hyades::core {

enum class FilterShape { box, triangle, gaussian, mitchell, blackman_harris, center };

struct FilterSample {
  Vec2 offset{0.0F};    ///< from the pixel's centre, pixels
  float weight = 1.0F;  ///< 1 but for filters with negative lobes: f / pdf, mean 1
};

/// Filter importance sampling (Ernst, Stamminger, Greiner 2006): a sample counts for its own pixel
/// only, its place drawn in proportion to |filter|. `center` puts every sample on the centre (no
/// antialiasing). Filters are products of one-dimensional profiles; those other than box and
/// triangle are linear between 1025 points of their formula.
class PixelFilter {
 public:
  virtual ~PixelFilter() = default;
  virtual FilterSample sample(const Vec2& u) const = 0;
  virtual float evaluate(const Vec2& offset) const = 0;  ///< normalised to integral 1 (center: 0)
  /// The profile: evaluate({x, y}) is evaluate_along(x) * evaluate_along(y).
  virtual float evaluate_along(float x) const = 0;
};

/// `radius` in pixels (half the support): mitchell usually 2, triangle 1, box 0.5; 0 is `center`.
std::unique_ptr<PixelFilter> make_pixel_filter(FilterShape shape, float radius);

}  // namespace hyades::core
