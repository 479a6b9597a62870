#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/elementary.h"
#include "core/lights/make_light.h"
#include "core/lights/point_source.h"

namespace hyades::core {
namespace {

/// A source with axes of its own.
class TurnedSource : public PointSource {
 public:
  TurnedSource(const Vec3& position, const Mat3& axes, const Rgb& power)
      : PointSource(position, power / (4.0F * kPi)), axes_(axes) {}

 protected:
  Vec3 to_own(const Vec3& v) const { return v * axes_; }
  Vec3 to_world(const Vec3& v) const { return axes_ * v; }

 private:
  Mat3 axes_;
};

class GoniometricLight final : public TurnedSource {
 public:
  GoniometricLight(const Vec3& position, const Mat3& axes, const Rgb& power,
                   std::shared_ptr<const EnvironmentMap> map)
      : TurnedSource(position, axes, power), map_(std::move(map)) {}

  float power() const override { return luminance(intensity() * map_->integral()); }

 private:
  Rgb value(const Vec3& direction) const override { return map_->look_up(to_own(direction), 0.0F); }
  Vec3 choose(const Vec2& u) const override { return to_world(map_->sample(u, 0.0F)); }
  float pdf(const Vec3& direction) const override {
    return map_->view(to_own(direction), 0.0F).pdf;
  }
  DirectionCone cone() const override { return {to_world({0.0F, 1.0F, 0.0F}), -1.0F}; }

  std::shared_ptr<const EnvironmentMap> map_;
};

/// The gobo stands at z = 1 before the light.
class ProjectorLight final : public TurnedSource {
 public:
  ProjectorLight(const Vec3& position, const Mat3& axes, const Rgb& power, float tan_half_fov,
                 std::shared_ptr<const Gobo> gobo)
      : TurnedSource(position, axes, power),
        gobo_(std::move(gobo)),
        half_(tan_half_fov * gobo_->half_size()),
        power_(luminance(intensity() * integral())) {}

  float power() const override { return power_; }

 private:
  /// The solid angle of the picture, each part times its colour [sr].
  Rgb integral() const {
    const std::vector<Rgb>& cells = gobo_->overview();
    const double width = 2.0 * static_cast<double>(half_.x) / Gobo::kOverview;
    const double height = 2.0 * static_cast<double>(half_.y) / Gobo::kOverview;
    Vec3d sum(0.0);
    for (int row = 0; row < Gobo::kOverview; ++row) {
      const double y = static_cast<double>(half_.y) - height * (row + 0.5);
      for (int column = 0; column < Gobo::kOverview; ++column) {
        const double x = width * (column + 0.5) - static_cast<double>(half_.x);
        const double distance2 = 1.0 + x * x + y * y;
        sum += Vec3d(cells[static_cast<size_t>(row * Gobo::kOverview + column)]) /
               (distance2 * std::sqrt(distance2));
      }
    }
    return Rgb(sum * width * height);
  }

  /// Where a direction goes through the gobo, in lengths from its middle; nothing beside it.
  std::optional<Vec2> through(const Vec3& direction) const {
    const Vec3 own = to_own(direction);
    if (!(own.z > 0.0F)) return std::nullopt;
    const Vec2 at = Vec2(own) / own.z;
    if (!(std::abs(at.x) <= half_.x && std::abs(at.y) <= half_.y)) return std::nullopt;
    return at;
  }

  Gobo::View view(const Vec2& at) const {
    return gobo_->view({0.5F + 0.5F * at.x / half_.x, 0.5F - 0.5F * at.y / half_.y});
  }

  Rgb value(const Vec3& direction) const override {
    const auto at = through(direction);
    return at ? view(*at).value : Rgb(0.0F);
  }

  float pdf(const Vec3& direction) const override {
    const auto at = through(direction);
    if (!at) return 0.0F;
    // Of the unit square to the gobo to the sphere: a length 1 away, seen at an angle whose cosine
    // is 1 / distance, and farther away by that.
    const float distance2 = 1.0F + glm::dot(*at, *at);
    const float solid_angle = 4.0F * half_.x * half_.y / (distance2 * std::sqrt(distance2));
    return view(*at).pdf / solid_angle;
  }

  Vec3 choose(const Vec2& u) const override {
    const Vec2 place = gobo_->sample(u);
    return to_world(glm::normalize(
        Vec3((2.0F * place.x - 1.0F) * half_.x, (1.0F - 2.0F * place.y) * half_.y, 1.0F)));
  }

  DirectionCone cone() const override {
    return {to_world({0.0F, 0.0F, 1.0F}), 1.0F / std::sqrt(1.0F + glm::dot(half_, half_))};
  }

  std::shared_ptr<const Gobo> gobo_;
  Vec2 half_;
  float power_;
};

}  // namespace

PointSourcePtr make_goniometric_light(const Vec3& position, const Mat3& axes, const Rgb& power,
                                      std::shared_ptr<const EnvironmentMap> map) {
  return std::make_shared<GoniometricLight>(position, axes, power, std::move(map));
}

PointSourcePtr make_projector_light(const Vec3& position, const Mat3& axes, const Rgb& power,
                                    float fov, std::shared_ptr<const Gobo> gobo) {
  const SinCos half = sin_cos(0.5F * fov);
  return std::make_shared<ProjectorLight>(position, axes, power, half.sin / half.cos,
                                          std::move(gobo));
}

}  // namespace hyades::core
