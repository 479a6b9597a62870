#include "core/cameras/aperture.h"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.h"

namespace hyades::core {

Aperture::Aperture(int blades, float rotation) {
  if (blades < 3) return;
  const int count = std::min(blades, 64);
  for (int i = 0; i < count; ++i) {
    const SinCos angle =
        sin_cos(rotation + 2.0F * kPi * static_cast<float>(i) / static_cast<float>(count));
    corners_.emplace_back(angle.cos, angle.sin);
  }
  corners_.push_back(corners_.front());
}

Vec2 Aperture::sample(const Vec2& u) const {
  // Walk the edge with u.x, and shrink towards the centre with the square root of u.y: scaling
  // about the centre by s covers area s^2.
  if (corners_.empty()) {
    const SinCos angle = sin_cos(2.0F * kPi * u.x);
    return std::sqrt(u.y) * Vec2(angle.cos, angle.sin);
  }
  const float along = u.x * static_cast<float>(corners_.size() - 1);
  const size_t side = std::min(static_cast<size_t>(along), corners_.size() - 2);
  const float within = along - static_cast<float>(side);
  return std::sqrt(u.y) * ((1.0F - within) * corners_[side] + within * corners_[side + 1]);
}

}  // namespace hyades::core
