#include "core/media/field_place.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace hyades::core {
namespace {

/// The inverse of `m`; where there is none, a matrix that takes everything to one place far away.
Mat4 inverse(const Mat4& m) {
  const Mat4 inverted = glm::inverse(m);
  bool finite = true;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) finite = finite && std::isfinite(inverted[c][r]);
  }
  if (finite) return inverted;
  Mat4 nowhere(0.0F);
  nowhere[3] = Vec4(3.0e38F, 3.0e38F, 3.0e38F, 1.0F);
  return nowhere;
}

}  // namespace

FieldPlace::FieldPlace(std::vector<Mat4> to_world)
    : to_world_(std::move(to_world)), to_field_(inverse(to_world_.front())) {}

Mat4 FieldPlace::moving(float time) const {
  const float place = std::clamp(time, 0.0F, 1.0F) * static_cast<float>(to_world_.size() - 1);
  const size_t step = std::min(static_cast<size_t>(place), to_world_.size() - 2);
  const float w = place - static_cast<float>(step);
  return inverse(to_world_[step] * (1.0F - w) + to_world_[step + 1] * w);
}

}  // namespace hyades::core
