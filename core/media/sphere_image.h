#pragma once

#include <cstddef>
#include <vector>

#include "core/image/image.h"

namespace hyades::core {

/// An image of all directions: (x, y, z) is at u = atan2(z, x) / 2pi + 0.5 from the left and
/// v = acos(y) / pi from the top, looked up bilinearly; columns wrap around, the outermost half
/// rows keep their value up to the poles. Negative values and NaN count as black, at most 1e15 is
/// seen. Immutable.
class SphereImage {
 public:
  /// `image` has channels R, G, B or Y and at least one pixel; `turn` is added to u.
  SphereImage(const Image& image, float turn);

  /// In a direction of any length but 0.
  Rgb at(const Vec3& direction) const;

  /// At least the luminance of every direction within `angle` radians of `direction`.
  float greatest_luminance(const Vec3& direction, float angle) const;

 private:
  static constexpr int kTile = 8;  ///< pixels along its sides

  const Rgb& pixel(int x, int y) const {
    return pixels_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
  }
  float column_of(const Vec3& direction) const;  ///< in pixels, 0 to width
  float row_of(const Vec3& direction) const;

  int width_;
  int height_;
  float turn_;
  std::vector<Rgb> pixels_;
  int tiles_across_;
  std::vector<float> tiles_;  ///< greatest luminance in each
};

}  // namespace hyades::core
