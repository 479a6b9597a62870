#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/elementary.h"
#include "core/base/warp.h"
#include "core/cameras/camera.h"

namespace hyades::core {

namespace {

/// Directions further from the view axis are behind the film's edge for any field of view.
constexpr float kLeastCosine = 1e-4F;

/// A pose made ready for rays: orthonormal axes and the size of half the picture at distance 1.
struct View {
  Vec3 from{0.0F};
  Vec3 right{1.0F, 0.0F, 0.0F};
  Vec3 up{0.0F, 1.0F, 0.0F};
  Vec3 forward{0.0F, 0.0F, -1.0F};
  float half_height = 1.0F;
  float lens_radius = 0.0F;
  float inverse_focus = 0.0F;
};

/// `v` scaled to unit length, or zero where it has no direction. Works for any finite length.
Vec3 unit_or_zero(const Vec3& v) {
  const float largest = max_component(glm::abs(v));
  if (!(largest > 0.0F) || !std::isfinite(largest)) return Vec3(0.0F);
  const Vec3 scaled = v / largest;
  return scaled / std::sqrt(glm::dot(scaled, scaled));
}

/// The horizontal axis of a view along unit `forward`; zero where `up` is parallel to it.
Vec3 right_axis(const Vec3& forward, const Vec3& up) {
  const Vec3 right = glm::cross(forward, unit_or_zero(up));
  // Within 0.06 degrees of the view `up` says too little about what is up.
  if (!(glm::dot(right, right) > 1e-6F)) return Vec3(0.0F);
  return unit_or_zero(right);
}

/// A camera that looks nowhere looks along -z. Where `up` says nothing, straight down has -z on
/// top and straight up has +z, so that +x stays on the right as for a camera that looks ahead.
View make_view(const CameraPose& pose) {
  View view;
  view.from = pose.from;
  const Vec3 forward = unit_or_zero(pose.at - pose.from);
  if (glm::dot(forward, forward) > 0.0F) view.forward = forward;
  const Vec3 candidates[] = {pose.up, Vec3(0.0F, 0.0F, view.forward.y > 0.0F ? 1.0F : -1.0F),
                             Vec3(0.0F, 1.0F, 0.0F)};
  for (const Vec3& up : candidates) {
    const Vec3 right = right_axis(view.forward, up);
    if (glm::dot(right, right) > 0.0F) {
      view.right = right;
      break;
    }
  }
  view.up = glm::cross(view.right, view.forward);
  view.half_height = tan(0.5F * std::clamp(pose.fov, 1e-4F, 0.999F * kPi));
  view.lens_radius = std::max(pose.lens_radius, 0.0F);
  // A focus distance that is not positive means nothing: everything is sharp.
  if (pose.focus_distance > 0.0F) {
    view.inverse_focus = 1.0F / pose.focus_distance;
  } else {
    view.lens_radius = 0.0F;
  }
  return view;
}

CameraPose mix(const CameraPose& a, const CameraPose& b, float t) {
  const auto blend = [t](const auto& x, const auto& y) { return (1.0F - t) * x + t * y; };
  return {blend(a.from, b.from),
          blend(a.at, b.at),
          blend(a.up, b.up),
          blend(a.fov, b.fov),
          blend(a.lens_radius, b.lens_radius),
          blend(a.focus_distance, b.focus_distance)};
}

class PerspectiveCamera : public Camera {
 public:
  PerspectiveCamera(std::vector<CameraPose> poses, Vec2i resolution, int blades, float rotation)
      : poses_(std::move(poses)),
        first_(make_view(poses_.front())),
        resolution_(glm::max(resolution, Vec2i(1))),
        blades_(blades),
        rotation_(rotation) {}

  Ray generate(const Vec2& film, const Vec2& lens, float time) const override {
    const View view = view_at(time);
    // Both axes are measured in half heights, so pixels are square.
    const float to_plane = view.half_height / resolution_.y;
    const float x = (2.0F * film.x - resolution_.x) * to_plane;
    const float y = (resolution_.y - 2.0F * film.y) * to_plane;
    Ray ray;
    ray.time = time;
    ray.origin = view.from;
    // The ray meets the pinhole's ray in the plane of focus; divided by the focus distance, so
    // that a focus at infinity needs no special case.
    Vec2 slope(x, y);
    if (view.lens_radius > 0.0F) {
      const Vec2 on_lens = view.lens_radius * place_in_aperture(lens);
      ray.origin += on_lens.x * view.right + on_lens.y * view.up;
      slope -= on_lens * view.inverse_focus;
    }
    ray.direction = glm::normalize(view.forward + slope.x * view.right + slope.y * view.up);
    return ray;
  }

  std::optional<CameraConnection> connect(const Vec3& point, const Vec2& lens,
                                          float time) const override {
    const View view = view_at(time);
    CameraConnection seen;
    seen.position = view.from;
    Vec2 on_lens(0.0F);
    if (view.lens_radius > 0.0F) {
      on_lens = view.lens_radius * place_in_aperture(lens);
      seen.position += on_lens.x * view.right + on_lens.y * view.up;
    }
    const Vec3 to_point = point - seen.position;
    seen.distance = std::sqrt(glm::dot(to_point, to_point));
    const float depth = glm::dot(to_point, view.forward);
    if (!(depth > kLeastCosine * seen.distance)) return std::nullopt;
    seen.direction = to_point / seen.distance;
    const Vec2 slope = Vec2(glm::dot(to_point, view.right), glm::dot(to_point, view.up)) / depth +
                       on_lens * view.inverse_focus;
    const float to_plane = view.half_height / resolution_.y;
    seen.film = 0.5F * (Vec2(slope.x, -slope.y) / to_plane + Vec2(resolution_));
    seen.density = density(view, depth / seen.distance);
    return seen;
  }

  float film_density(const Vec3& direction, float time) const override {
    const View view = view_at(time);
    return density(view, glm::dot(direction, view.forward));
  }

  float depth_of(const Vec3& point, float time) const override {
    const View view = view_at(time);
    return glm::dot(point - view.from, view.forward);
  }

 private:
  /// The film lies at distance 1, where a pixel is `edge` wide; an area there is seen under the
  /// cosine and from 1 / cosine away.
  float density(const View& view, float cosine) const {
    if (!(cosine > kLeastCosine)) return 0.0F;
    const float edge = 2.0F * view.half_height / resolution_.y;
    return 1.0F / (edge * edge * cosine * cosine * cosine);
  }

  Vec2 place_in_aperture(const Vec2& u) const {
    return blades_ < 3 ? square_to_disk(u) : square_to_polygon(u, blades_, rotation_);
  }

  View view_at(float time) const {
    if (poses_.size() == 1) return first_;
    const size_t last = poses_.size() - 1;
    const float place = std::clamp(time, 0.0F, 1.0F) * static_cast<float>(last);
    const size_t i = std::min(static_cast<size_t>(place), last - 1);
    return make_view(mix(poses_[i], poses_[i + 1], place - static_cast<float>(i)));
  }

  std::vector<CameraPose> poses_;
  View first_;
  Vec2i resolution_;
  int blades_;
  float rotation_;
};

}  // namespace

std::unique_ptr<Camera> make_perspective_camera(std::vector<CameraPose> poses, Vec2i resolution,
                                                int blades, float blade_rotation) {
  if (poses.empty()) poses.emplace_back();
  return std::make_unique<PerspectiveCamera>(std::move(poses), resolution, blades, blade_rotation);
}

}  // namespace hyades::core
