#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/base/elementary.h"
#include "core/base/frame.h"
#include "core/base/warp.h"
#include "core/lights/infinite_light.h"
#include "core/lights/make_light.h"

namespace hyades::core {

namespace {

/// Below this angular radius [rad] a direction's rounding to float would show in the disc's solid
/// angle; the light is a delta light then.
constexpr float kSmallestRadius = 5e-5F;

/// A disc infinitely far away, of uniform radiance or darker at its rim, or (radius 0) a single
/// direction.
class SunLight : public InfiniteLight {
 public:
  SunLight(const Vec3& direction, const Rgb& irradiance, float angle, const Rgb& limb,
           float world_radius)
      : axis_(Frame::around(-direction)), irradiance_(irradiance), limb_(limb) {
    power_ = luminance(irradiance) * kPi * world_radius * world_radius;
    const float radius = std::min(0.5F * angle, 0.5F * kPi);
    if (!(radius >= kSmallestRadius)) return;
    sin_radius_ = sin(radius);
    const float sin_half = sin(0.5F * radius);
    one_minus_cos_ = 2.0F * sin_half * sin_half;
    pdf_ = cone_pdf(one_minus_cos_);
    // A facing surface receives the integral of L cos over the disc: pi L sin^2(radius).
    // mu^a has the mean 2 / (a + 2) over a disc (mu^2 = 1 - r^2).
    radiance_ = irradiance * (0.5F * limb + 1.0F) / (kPi * sin_radius_ * sin_radius_);
  }

  std::optional<LightSample> sample_direct(const Vec3& /*from*/, float /*time*/, float /*pick*/,
                                           const Vec2& u) const override {
    if (is_black(irradiance_)) return std::nullopt;
    LightSample sample;
    sample.distance = kInfinity;
    if (is_delta()) {
      sample.radiance = irradiance_;
      sample.direction = axis_.n;
      sample.pdf = 1.0F;
      sample.delta = true;
      return sample;
    }
    sample.pdf = pdf_;
    sample.pdf_place = pdf_;
    sample.direction = glm::normalize(axis_.to_world(square_to_cone(u, one_minus_cos_)));
    sample.radiance = radiance_at(sample.direction);
    return sample;
  }

  float pdf_direct(const Vec3& /*from*/, const Vec3& direction,
                   const SurfacePoint& /*on*/) const override {
    return covers(direction) ? pdf_ : 0.0F;
  }

  Rgb radiance(const SurfacePoint& /*on*/, const Vec3& outward) const override {
    return covers(-outward) ? radiance_at(-outward) : Rgb(0.0F);
  }

  float power() const override { return power_; }
  bool is_delta() const override { return pdf_ == 0.0F; }

 private:
  /// Compared by the sine where that is the surer measure: the cosine of a small disc's edge is too
  /// near 1 for float, the sine of a wide one's.
  bool covers(const Vec3& direction) const {
    const float cosine = glm::dot(direction, axis_.n);
    if (is_delta() || !(cosine > 0.0F)) return false;
    if (one_minus_cos_ > 0.3F) return cosine >= 1.0F - one_minus_cos_;
    const Vec3 across = glm::cross(direction, axis_.n);
    return glm::dot(across, across) <= sin_radius_ * sin_radius_;
  }

  /// Within the disc.
  Rgb radiance_at(const Vec3& direction) const {
    if (is_black(limb_)) return radiance_;
    const Vec3 across = glm::cross(direction, axis_.n);
    const float mu2 = 1.0F - glm::dot(across, across) / (sin_radius_ * sin_radius_);
    const float mu = std::sqrt(std::max(mu2, 0.0F));
    return radiance_ * Rgb(pow(mu, limb_.x), pow(mu, limb_.y), pow(mu, limb_.z));
  }

  Frame axis_;  ///< n points to the middle of the disc
  Rgb irradiance_;
  Rgb limb_;            ///< exponents; 0: uniform
  Rgb radiance_{0.0F};  ///< of the middle
  float sin_radius_ = 0.0F;
  float one_minus_cos_ = 0.0F;
  float pdf_ = 0.0F;  ///< per solid angle; 0: delta light
  float power_ = 0.0F;
};

}  // namespace

LightPtr make_sun_light(const Vec3& direction, const Rgb& irradiance, float angle,
                        float world_radius) {
  return make_sun_light(direction, irradiance, angle, Rgb(0.0F), world_radius);
}

LightPtr make_sun_light(const Vec3& direction, const Rgb& irradiance, float angle, const Rgb& limb,
                        float world_radius) {
  return std::make_shared<SunLight>(direction, irradiance, angle, limb, world_radius);
}

}  // namespace hyades::core
