#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/elementary.h"
#include "core/lights/make_light.h"

namespace hyades::core {
namespace {

/// Light from one point, of which a picture says how much goes where. Directions are of the light's
/// own axes.
class PicturedLight : public Light {
 public:
  PicturedLight(const Vec3& position, const Mat3& axes, const Rgb& power)
      : position_(position), axes_(axes), intensity_(power / (4.0F * kPi)) {}

  std::optional<LightSample> sample_direct(const Vec3& from, float /*time*/, float /*pick*/,
                                           const Vec2& /*u*/) const override {
    const Vec3 to_light = position_ - from;
    const float distance2 = glm::dot(to_light, to_light);
    if (!(distance2 > 0.0F)) return std::nullopt;
    LightSample sample;
    sample.distance = std::sqrt(distance2);
    sample.direction = to_light / sample.distance;
    sample.radiance = intensity_ * (look(to_own(-sample.direction)).value / distance2);
    if (is_black(sample.radiance)) return std::nullopt;
    sample.pdf = 1.0F;
    sample.position = position_;
    sample.delta = true;
    return sample;
  }

  float pdf_direct(const Vec3& /*from*/, const Vec3& /*direction*/,
                   const SurfacePoint& /*on*/) const override {
    return 0.0F;
  }

  Rgb radiance(const SurfacePoint& /*on*/, const Vec3& /*outward*/) const override {
    return Rgb(0.0F);
  }

  bool is_delta() const override { return true; }
  std::optional<Vec3> middle() const override { return position_; }

  std::optional<LightBounds> bounds() const override {
    LightBounds bounds;
    bounds.box = {position_, position_};
    const DirectionCone own = cone();
    bounds.normals = {axes_ * own.axis, own.cosine};
    bounds.cos_beyond = 1.0F;
    bounds.set_power(power());
    return bounds.power > 0.0F ? std::optional(bounds) : std::nullopt;
  }

  std::optional<EmissionSample> sample_emission(float time, float /*pick*/, const Vec2& /*place*/,
                                                const Vec2& direction) const override {
    if (!(power() > 0.0F)) return std::nullopt;
    EmissionSample sample;
    sample.direction = glm::normalize(axes_ * choose(direction));
    // Looked up again from the rounded direction: the same numbers that pdf_outward finds.
    const View view = look(to_own(sample.direction));
    if (!(view.pdf > 0.0F)) return std::nullopt;
    sample.pdf_place = 1.0F;
    sample.pdf_direction = view.pdf;
    sample.weight = intensity_ * (view.value / view.pdf);
    if (is_black(sample.weight)) return std::nullopt;
    sample.on.position = position_;
    sample.on.ng = Vec3(0.0F);
    sample.on.time = time;
    return sample;
  }

  float pdf_place(const SurfacePoint& /*on*/, const Vec3& /*direction*/) const override {
    return 1.0F;
  }

  float pdf_outward(const Vec3& /*normal*/, const Vec3& outward) const override {
    return power() > 0.0F ? look(to_own(outward)).pdf : 0.0F;
  }

 protected:
  struct View {
    Rgb value{0.0F};
    float pdf = 0.0F;  ///< per solid angle with which choose() chooses the direction
  };
  virtual View look(const Vec3& direction) const = 0;
  virtual Vec3 choose(const Vec2& u) const = 0;
  /// All that is lit.
  virtual DirectionCone cone() const = 0;

  const Rgb& intensity() const { return intensity_; }

 private:
  Vec3 to_own(const Vec3& v) const { return v * axes_; }

  Vec3 position_;
  Mat3 axes_;
  Rgb intensity_;  ///< where the picture is 1 [W/sr]
};

class GoniometricLight final : public PicturedLight {
 public:
  GoniometricLight(const Vec3& position, const Mat3& axes, const Rgb& power,
                   std::shared_ptr<const EnvironmentMap> map)
      : PicturedLight(position, axes, power), map_(std::move(map)) {}

  float power() const override { return luminance(intensity() * map_->integral()); }

 private:
  View look(const Vec3& direction) const override {
    const EnvironmentMap::View view = map_->view(direction, 0.0F);
    return {view.radiance, view.pdf};
  }
  Vec3 choose(const Vec2& u) const override { return map_->sample(u, 0.0F); }
  DirectionCone cone() const override { return {{0.0F, 1.0F, 0.0F}, -1.0F}; }

  std::shared_ptr<const EnvironmentMap> map_;
};

/// The slide stands at z = 1 before the light.
class ProjectorLight final : public PicturedLight {
 public:
  ProjectorLight(const Vec3& position, const Mat3& axes, const Rgb& power, float tan_half_fov,
                 std::shared_ptr<const Slide> slide)
      : PicturedLight(position, axes, power),
        slide_(std::move(slide)),
        half_(tan_half_fov * slide_->half_size()),
        power_(luminance(intensity() * integral())) {}

  float power() const override { return power_; }

 private:
  /// The solid angle of the picture, each part times its colour [sr].
  Rgb integral() const {
    const std::vector<Rgb>& cells = slide_->overview();
    const double width = 2.0 * static_cast<double>(half_.x) / Slide::kOverview;
    const double height = 2.0 * static_cast<double>(half_.y) / Slide::kOverview;
    Vec3d sum(0.0);
    for (int row = 0; row < Slide::kOverview; ++row) {
      const double y = static_cast<double>(half_.y) - height * (row + 0.5);
      for (int column = 0; column < Slide::kOverview; ++column) {
        const double x = width * (column + 0.5) - static_cast<double>(half_.x);
        const double distance2 = 1.0 + x * x + y * y;
        sum += Vec3d(cells[static_cast<size_t>(row * Slide::kOverview + column)]) /
               (distance2 * std::sqrt(distance2));
      }
    }
    return Rgb(sum * width * height);
  }

  View look(const Vec3& direction) const override {
    if (!(direction.z > 0.0F)) return {};
    const Vec2 at = Vec2(direction) / direction.z;
    if (!(std::abs(at.x) <= half_.x && std::abs(at.y) <= half_.y)) return {};
    const Slide::View view =
        slide_->view({0.5F + 0.5F * at.x / half_.x, 0.5F - 0.5F * at.y / half_.y});
    // Of the unit square to the slide to the sphere: a length 1 away, seen at an angle whose cosine
    // is 1 / distance, and farther away by that.
    const float distance2 = 1.0F + glm::dot(at, at);
    const float solid_angle = 4.0F * half_.x * half_.y / (distance2 * std::sqrt(distance2));
    return {view.value, view.pdf / solid_angle};
  }

  Vec3 choose(const Vec2& u) const override {
    const Vec2 place = slide_->sample(u);
    return glm::normalize(
        Vec3((2.0F * place.x - 1.0F) * half_.x, (1.0F - 2.0F * place.y) * half_.y, 1.0F));
  }

  DirectionCone cone() const override {
    return {{0.0F, 0.0F, 1.0F}, 1.0F / std::sqrt(1.0F + glm::dot(half_, half_))};
  }

  std::shared_ptr<const Slide> slide_;
  Vec2 half_;
  float power_;
};

}  // namespace

LightPtr make_goniometric_light(const Vec3& position, const Mat3& axes, const Rgb& power,
                                std::shared_ptr<const EnvironmentMap> map) {
  return std::make_shared<GoniometricLight>(position, axes, power, std::move(map));
}

LightPtr make_projector_light(const Vec3& position, const Mat3& axes, const Rgb& power, float fov,
                              std::shared_ptr<const Slide> slide) {
  const SinCos half = sin_cos(0.5F * fov);
  return std::make_shared<ProjectorLight>(position, axes, power, half.sin / half.cos,
                                          std::move(slide));
}

}  // namespace hyades::core
