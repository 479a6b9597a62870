#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/elementary.h"
#include "core/cameras/axes.h"
#include "core/cameras/shutter_views.h"

namespace hyades::core {
namespace {

/// Sine of the angle from the poles that counts as the least: there a pixel is infinitely narrow.
constexpr float kLeastSine = 1e-6F;

/// A pose made ready for rays.
struct View {
  explicit View(const CameraPose& pose)
      : axes(axes_upright(pose.at - pose.from, pose.up)), from(pose.from) {}

  CameraAxes axes;
  Vec3 from;
};

/// The first of `start` + whole multiples of `period` that lies above `lower`.
float first_above(float start, float period, float lower) {
  return start + period * (std::floor((lower - start) / period) + 1.0F);
}

class EquirectangularCamera : public Camera {
 public:
  EquirectangularCamera(std::vector<CameraPose> poses, Vec2i resolution)
      : views_(std::move(poses)), resolution_(glm::max(resolution, Vec2i(1))) {}

  /// Beyond its edges the film goes on: around to the left and right, and over the poles.
  Ray generate(const Vec2& film, const Vec2& /*lens*/, float time) const override {
    const View view = views_.at(time);
    const SinCos azimuth = sin_cos(2.0F * kPi * (film.x / resolution_.x - 0.5F));
    const SinCos polar = sin_cos(kPi * film.y / resolution_.y);
    Ray ray;
    ray.time = time;
    ray.origin = view.from;
    ray.direction =
        glm::normalize(polar.cos * view.axes.up + (polar.sin * azimuth.cos) * view.axes.forward +
                       (polar.sin * azimuth.sin) * view.axes.right);
    return ray;
  }

  std::optional<CameraConnection> connect(const Vec3& point, const Vec2& /*lens*/,
                                          float time) const override {
    const View view = views_.at(time);
    const Vec3 to_point = point - view.from;
    CameraConnection seen;
    seen.position = view.from;
    seen.distance = std::sqrt(glm::dot(to_point, to_point));
    if (!(seen.distance > 0.0F)) return std::nullopt;
    seen.direction = to_point / seen.distance;
    const float ahead = glm::dot(seen.direction, view.axes.forward);
    const float right = glm::dot(seen.direction, view.axes.right);
    const float sine = std::sqrt(ahead * ahead + right * right);
    const float polar = atan2(sine, glm::dot(seen.direction, view.axes.up));
    seen.film = resolution_ * Vec2(atan2(right, ahead) / (2.0F * kPi) + 0.5F, polar / kPi);
    const double distance = static_cast<double>(seen.distance);
    seen.across = static_cast<double>(density(sine)) / (distance * distance);
    return seen;
  }

  float film_density(const Vec3& direction, float time) const override {
    return density(sine_of(views_.at(time), direction));
  }

  /// Next to the poles, of the rows there.
  PixelCone pixel_at(const Vec3& point, float time) const override {
    const View view = views_.at(time);
    const Vec3 to_point = point - view.from;
    const float distance = std::sqrt(glm::dot(to_point, to_point));
    if (!(distance > 0.0F)) return {view.axes.forward, 0.0F};
    const Vec3 direction = to_point / distance;
    const float least = sin(0.5F * kPi / std::max(resolution_.y, 2.0F));
    return {direction, distance / std::sqrt(density(std::max(sine_of(view, direction), least)))};
  }

  float depth_of(const Vec3& point, float time) const override {
    const Vec3 way = point - views_.at(time).from;
    return std::sqrt(glm::dot(way, way));
  }

  void add_places(const Vec2& film, const Vec2& lower, const Vec2& upper,
                  std::vector<Vec2>& places) const override {
    add_rows(film, lower, upper, places);
    // Seen over the pole, turned around by half a turn.
    add_rows({film.x + 0.5F * resolution_.x, -film.y}, lower, upper, places);
  }

 private:
  void add_rows(const Vec2& film, const Vec2& lower, const Vec2& upper,
                std::vector<Vec2>& places) const {
    const float turn = resolution_.x;
    const float both_ways = 2.0F * resolution_.y;
    for (float y = first_above(film.y, both_ways, lower.y); y < upper.y; y += both_ways) {
      for (float x = first_above(film.x, turn, lower.x); x < upper.x; x += turn)
        places.emplace_back(x, y);
    }
  }

  static float sine_of(const View& view, const Vec3& direction) {
    const float ahead = glm::dot(direction, view.axes.forward);
    const float right = glm::dot(direction, view.axes.right);
    return std::sqrt(ahead * ahead + right * right);
  }

  /// Rows are pi / height high, columns 2 pi / width wide, times the sine of the angle from the
  /// pole.
  float density(float sine) const {
    return resolution_.x * resolution_.y / (2.0F * kPi * kPi * std::max(sine, kLeastSine));
  }

  ShutterViews<View> views_;
  Vec2 resolution_;
};

}  // namespace

std::unique_ptr<Camera> make_equirectangular_camera(std::vector<CameraPose> poses,
                                                    Vec2i resolution) {
  return std::make_unique<EquirectangularCamera>(std::move(poses), resolution);
}

}  // namespace hyades::core
