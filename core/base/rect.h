#pragma once

#include <algorithm>
#include <cstdint>

namespace hyades::core {

/// A half-open rectangle of pixels [x0, x1) x [y0, y1) in full-frame coordinates. Row 0 is the top.
struct PixelRect {
  int32_t x0 = 0;
  int32_t y0 = 0;
  int32_t x1 = 0;
  int32_t y1 = 0;

  int32_t width() const { return x1 - x0; }
  int32_t height() const { return y1 - y0; }
  int64_t area() const { return empty() ? 0 : int64_t{width()} * height(); }
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  bool contains(int32_t x, int32_t y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  bool contains(const PixelRect& r) const {
    return r.x0 >= x0 && r.x1 <= x1 && r.y0 >= y0 && r.y1 <= y1;
  }
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// The common part of two rectangles; empty() where there is none.
inline PixelRect intersection(const PixelRect& a, const PixelRect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

}  // namespace hyades::core
