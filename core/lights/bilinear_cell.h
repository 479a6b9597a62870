#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/vec.h"

namespace hyades::core {

/// The colours at the corners of a cell of a picture, bilinear in between, and how places in it are
/// chosen in proportion to luminance. Places are (across, down) in [0, 1]^2 from the top left.
struct BilinearCell {
  Rgb top_left{0.0F};
  Rgb top_right{0.0F};
  Rgb bottom_left{0.0F};
  Rgb bottom_right{0.0F};

  Rgb at(const Vec2& place) const {
    return blend(blend(top_left, top_right, place.x), blend(bottom_left, bottom_right, place.x),
                 place.y);
  }

  /// Luminance over the whole cell.
  float mean() const {
    return 0.25F * luminance(top_left + top_right + bottom_left + bottom_right);
  }

  /// A place for `u` in [0, 1)^2, its density luminance(at(place)) / mean(): first the height,
  /// whose marginal is linear, then the column given that.
  Vec2 sample(const Vec2& u) const {
    const float down =
        sample_linear(u.y, luminance(top_left + top_right), luminance(bottom_left + bottom_right));
    const float across = sample_linear(u.x, luminance(blend(top_left, bottom_left, down)),
                                       luminance(blend(top_right, bottom_right, down)));
    return {across, down};
  }

 private:
  static Rgb blend(const Rgb& a, const Rgb& b, float t) { return (1.0F - t) * a + t * b; }

  /// A place in [0, 1] with density in proportion to a at 0, b at 1, linear in between: the root of
  /// the quadratic distribution function in the form that does not cancel.
  static float sample_linear(float u, float a, float b) {
    const float divisor = a + std::sqrt((1.0F - u) * a * a + u * b * b);
    return divisor > 0.0F ? std::min(u * (a + b) / divisor, 1.0F) : u;
  }
};

}  // namespace hyades::core
