#include "core/cameras/axes.h"

#include <cmath>

namespace hyades::core {
namespace {

/// The horizontal axis of a view along unit `forward`; zero where `up` is parallel to it.
Vec3 right_axis(const Vec3& forward, const Vec3& up) {
  const Vec3 right = glm::cross(forward, unit_or_zero(up));
  // Within 0.06 degrees of the view `up` says too little about what is up.
  if (!(glm::dot(right, right) > 1e-6F)) return Vec3(0.0F);
  return unit_or_zero(right);
}

}  // namespace

Vec3 unit_or_zero(const Vec3& v) {
  const float largest = max_component(glm::abs(v));
  if (!(largest > 0.0F) || !std::isfinite(largest)) return Vec3(0.0F);
  const Vec3 scaled = v / largest;
  return scaled / std::sqrt(glm::dot(scaled, scaled));
}

CameraAxes axes_along(const Vec3& view, const Vec3& up) {
  CameraAxes axes;
  const Vec3 forward = unit_or_zero(view);
  if (glm::dot(forward, forward) > 0.0F) axes.forward = forward;
  const Vec3 candidates[] = {up, Vec3(0.0F, 0.0F, axes.forward.y > 0.0F ? 1.0F : -1.0F),
                             Vec3(0.0F, 1.0F, 0.0F)};
  for (const Vec3& candidate : candidates) {
    const Vec3 right = right_axis(axes.forward, candidate);
    if (glm::dot(right, right) > 0.0F) {
      axes.right = right;
      break;
    }
  }
  axes.up = glm::cross(axes.right, axes.forward);
  return axes;
}

CameraAxes axes_upright(const Vec3& view, const Vec3& up) {
  CameraAxes axes;
  const Vec3 top = unit_or_zero(up);
  if (glm::dot(top, top) > 0.0F) axes.up = top;
  const Vec3 candidates[] = {view, Vec3(0.0F, 0.0F, -1.0F), Vec3(1.0F, 0.0F, 0.0F)};
  for (const Vec3& candidate : candidates) {
    const Vec3 right = right_axis(unit_or_zero(candidate), axes.up);
    if (glm::dot(right, right) > 0.0F) {
      axes.right = right;
      break;
    }
  }
  axes.forward = glm::cross(axes.up, axes.right);
  return axes;
}

}  // namespace hyades::core
