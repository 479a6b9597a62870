#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/cameras/make_camera.h"

namespace hyades::core {

/// `t` of the way from `a` to `b`.
inline CameraPose mix(const CameraPose& a, const CameraPose& b, float t) {
  const auto blend = [t](const auto& x, const auto& y) { return (1.0F - t) * x + t * y; };
  return {blend(a.from, b.from),
          blend(a.at, b.at),
          blend(a.up, b.up),
          blend(a.fov, b.fov),
          blend(a.lens_radius, b.lens_radius),
          blend(a.focus_distance, b.focus_distance),
          blend(a.shift, b.shift),
          blend(a.height, b.height)};
}

/// Poses over the shutter interval, made ready for rays: `View` can be made of a pose.
template <class View>
class ShutterViews {
 public:
  /// No poses: those of a default one.
  explicit ShutterViews(std::vector<CameraPose> poses)
      : poses_(std::move(poses)), first_(poses_.empty() ? CameraPose{} : poses_.front()) {}

  /// At shutter time `time`, held outside of 0..1.
  View at(float time) const {
    if (poses_.size() <= 1) return first_;
    const size_t last = poses_.size() - 1;
    const float place = std::clamp(time, 0.0F, 1.0F) * static_cast<float>(last);
    const size_t i = std::min(static_cast<size_t>(place), last - 1);
    return View(mix(poses_[i], poses_[i + 1], place - static_cast<float>(i)));
  }

 private:
  std::vector<CameraPose> poses_;
  View first_;
};

}  // namespace hyades::core
