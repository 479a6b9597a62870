#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/elementary.h"
#include "core/cameras/aperture.h"
#include "core/cameras/axes.h"
#include "core/cameras/shutter_views.h"

namespace hyades::core {
namespace {

/// Directions further from the view axis are behind the film's edge for any field of view.
constexpr float kLeastCosine = 1e-4F;

/// A pose made ready for rays.
struct PerspectiveView {
  explicit PerspectiveView(const CameraPose& pose)
      : axes(axes_along(pose.at - pose.from, pose.up)),
        from(pose.from),
        shift(2.0F * pose.shift),
        half_height(tan(0.5F * std::clamp(pose.fov, 1e-4F, 0.999F * kPi))),
        lens(pose) {}

  CameraAxes axes;
  Vec3 from;
  Vec2 shift;         ///< in halves of the picture
  float half_height;  ///< of the picture at distance 1
  ThinLens lens;
};

class PerspectiveCamera : public Camera {
 public:
  PerspectiveCamera(std::vector<CameraPose> poses, Vec2i resolution, ApertureShape aperture)
      : views_(std::move(poses)),
        resolution_(glm::max(resolution, Vec2i(1))),
        aperture_(aperture) {}

  Ray generate(const Vec2& film, const Vec2& lens, float time) const override {
    const PerspectiveView view = views_.at(time);
    const CameraAxes& axes = view.axes;
    // Both axes are measured in half heights, so pixels are square.
    const float to_plane = view.half_height / resolution_.y;
    const Vec2 shift = view.shift * resolution_;
    Ray ray;
    ray.time = time;
    ray.origin = view.from;
    // The ray meets the pinhole's ray in the plane of focus; divided by the focus distance, so
    // that a focus at infinity needs no special case.
    Vec2 slope((2.0F * film.x - resolution_.x + shift.x) * to_plane,
               (resolution_.y - 2.0F * film.y + shift.y) * to_plane);
    if (view.lens.radius > 0.0F) {
      const Vec2 on_lens = view.lens.place(aperture_, lens);
      ray.origin += on_lens.x * axes.right + on_lens.y * axes.up;
      slope -= on_lens * view.lens.inverse_focus;
    }
    ray.direction = glm::normalize(axes.forward + slope.x * axes.right + slope.y * axes.up);
    return ray;
  }

  std::optional<CameraConnection> connect(const Vec3& point, const Vec2& lens,
                                          float time) const override {
    const PerspectiveView view = views_.at(time);
    const CameraAxes& axes = view.axes;
    CameraConnection seen;
    seen.position = view.from;
    Vec2 on_lens(0.0F);
    if (view.lens.radius > 0.0F) {
      on_lens = view.lens.place(aperture_, lens);
      seen.position += on_lens.x * axes.right + on_lens.y * axes.up;
    }
    const Vec3 to_point = point - seen.position;
    seen.distance = std::sqrt(glm::dot(to_point, to_point));
    const float depth = glm::dot(to_point, axes.forward);
    if (!(depth > kLeastCosine * seen.distance)) return std::nullopt;
    seen.direction = to_point / seen.distance;
    const Vec2 slope = Vec2(glm::dot(to_point, axes.right), glm::dot(to_point, axes.up)) / depth +
                       on_lens * view.lens.inverse_focus;
    const float to_plane = view.half_height / resolution_.y;
    const Vec2 shift = view.shift * resolution_;
    seen.film = 0.5F * (Vec2(slope.x, -slope.y) / to_plane + resolution_ - Vec2(shift.x, -shift.y));
    const double distance = static_cast<double>(seen.distance);
    seen.across = static_cast<double>(density(view, depth / seen.distance)) / (distance * distance);
    return seen;
  }

  float film_density(const Vec3& direction, float time) const override {
    const PerspectiveView view = views_.at(time);
    return density(view, glm::dot(direction, view.axes.forward));
  }

  /// From the middle of the lens.
  PixelCone pixel_at(const Vec3& point, float time) const override {
    const PerspectiveView view = views_.at(time);
    const Vec3 to_point = point - view.from;
    const float distance = std::sqrt(glm::dot(to_point, to_point));
    if (!(distance > 0.0F)) return {view.axes.forward, 0.0F};
    const Vec3 direction = to_point / distance;
    // Towards the corners pixels are narrower: of film_density(), the side of a square.
    const float edge = 2.0F * view.half_height / resolution_.y;
    const Vec2 corner = 0.5F * edge * resolution_ * (Vec2(1.0F) + glm::abs(view.shift));
    const float least = 1.0F / std::sqrt(1.0F + glm::dot(corner, corner));
    const float cosine = std::max(glm::dot(direction, view.axes.forward), least);
    return {direction, distance * edge * cosine * std::sqrt(cosine)};
  }

  float depth_of(const Vec3& point, float time) const override {
    const PerspectiveView view = views_.at(time);
    return glm::dot(point - view.from, view.axes.forward);
  }

 private:
  /// The film lies at distance 1, where a pixel is `edge` wide; an area there is seen under the
  /// cosine and from 1 / cosine away.
  float density(const PerspectiveView& view, float cosine) const {
    if (!(cosine > kLeastCosine)) return 0.0F;
    const float edge = 2.0F * view.half_height / resolution_.y;
    return 1.0F / (edge * edge * cosine * cosine * cosine);
  }

  ShutterViews<PerspectiveView> views_;
  Vec2 resolution_;
  ApertureShape aperture_;
};

}  // namespace

std::unique_ptr<Camera> make_perspective_camera(std::vector<CameraPose> poses, Vec2i resolution,
                                                ApertureShape aperture) {
  return std::make_unique<PerspectiveCamera>(std::move(poses), resolution, aperture);
}

}  // namespace hyades::core
