#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/cameras/aperture.h"
#include "core/cameras/axes.h"
#include "core/cameras/shutter_views.h"

namespace hyades::core {
namespace {

/// A pose made ready for rays.
struct ParallelView {
  explicit ParallelView(const CameraPose& pose)
      : axes(axes_along(pose.at - pose.from, pose.up)),
        from(pose.from),
        height(std::max(pose.height, 1e-30F)),
        lens(pose) {}

  CameraAxes axes;
  Vec3 from;
  float height;  ///< of the picture
  ThinLens lens;
};

/// A lens so far behind the plane of the camera that its rays are parallel: a ray begins where the
/// pinhole's does, moved by the place on the lens, and meets that one in the plane of focus.
class OrthographicCamera : public Camera {
 public:
  OrthographicCamera(std::vector<CameraPose> poses, Vec2i resolution, ApertureShape aperture)
      : views_(std::move(poses)),
        resolution_(glm::max(resolution, Vec2i(1))),
        aperture_(aperture) {}

  bool rays_are_parallel() const override { return true; }

  Ray generate(const Vec2& film, const Vec2& lens, float time) const override {
    const ParallelView view = views_.at(time);
    const Vec2 on_lens = view.lens.place(aperture_, lens);
    const float half_edge = 0.5F * view.height / resolution_.y;
    const Vec2 start =
        Vec2(2.0F * film.x - resolution_.x, resolution_.y - 2.0F * film.y) * half_edge + on_lens;
    Ray ray;
    ray.time = time;
    ray.origin = view.from + start.x * view.axes.right + start.y * view.axes.up;
    ray.direction = direction_through(view, on_lens);
    return ray;
  }

  /// Through one place of the lens light comes from one direction only: what the camera sees of the
  /// place is found by following that back to where the rays begin.
  std::optional<CameraConnection> connect(const Vec3& point, const Vec2& lens,
                                          float time) const override {
    const ParallelView view = views_.at(time);
    const CameraAxes& axes = view.axes;
    const Vec3 to_point = point - view.from;
    const float depth = glm::dot(to_point, axes.forward);
    if (!(depth > 0.0F)) return std::nullopt;
    const Vec2 on_lens = view.lens.place(aperture_, lens);
    const Vec2 start = Vec2(glm::dot(to_point, axes.right), glm::dot(to_point, axes.up)) +
                       (depth * view.lens.inverse_focus) * on_lens;
    CameraConnection seen;
    seen.position = view.from + start.x * axes.right + start.y * axes.up;
    seen.direction = direction_through(view, on_lens);
    const Vec3 way = point - seen.position;
    seen.distance = std::sqrt(glm::dot(way, way));
    const float half_edge = 0.5F * view.height / resolution_.y;
    const Vec2 pinhole = (start - on_lens) / half_edge;
    seen.film = 0.5F * (Vec2(pinhole.x, -pinhole.y) + resolution_);
    seen.across = static_cast<double>(density(view, seen.direction));
    return seen;
  }

  float film_density(const Vec3& direction, float time) const override {
    return density(views_.at(time), direction);
  }

  /// Of the middle of the lens: the same everywhere.
  PixelCone pixel_at(const Vec3& /*point*/, float time) const override {
    const ParallelView view = views_.at(time);
    return {view.axes.forward, view.height / resolution_.y};
  }

  float depth_of(const Vec3& point, float time) const override {
    const ParallelView view = views_.at(time);
    return glm::dot(point - view.from, view.axes.forward);
  }

 private:
  static Vec3 direction_through(const ParallelView& view, const Vec2& on_lens) {
    const Vec2 slope = -view.lens.inverse_focus * on_lens;
    return glm::normalize(view.axes.forward + slope.x * view.axes.right + slope.y * view.axes.up);
  }

  /// A pixel of the camera's plane is seen under the cosine.
  float density(const ParallelView& view, const Vec3& direction) const {
    const float cosine = glm::dot(direction, view.axes.forward);
    const float edge = view.height / resolution_.y;
    return cosine > 0.0F ? 1.0F / (edge * edge * cosine) : 0.0F;
  }

  ShutterViews<ParallelView> views_;
  Vec2 resolution_;
  ApertureShape aperture_;
};

}  // namespace

std::unique_ptr<Camera> make_orthographic_camera(std::vector<CameraPose> poses, Vec2i resolution,
                                                 ApertureShape aperture) {
  return std::make_unique<OrthographicCamera>(std::move(poses), resolution, aperture);
}

}  // namespace hyades::core
