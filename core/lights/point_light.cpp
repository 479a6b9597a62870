#include <algorithm>
#include <cmath>

#include "core/base/frame.h"
#include "core/base/warp.h"
#include "core/lights/make_light.h"

namespace hyades::core {

namespace {

/// Light from one point into a cone around `axis`; a point light is the cone that holds everything.
class SpotLight : public Light {
 public:
  SpotLight(const Vec3& position, const Vec3& axis, const Rgb& power, float cos_inner,
            float cos_outer)
      : position_(position),
        axis_(Frame::around(axis)),
        intensity_(power / (4.0F * kPi)),
        cos_inner_(std::clamp(cos_inner, -1.0F, 1.0F)),
        cos_outer_(std::clamp(std::min(cos_outer, cos_inner), -1.0F, 1.0F)) {}

  std::optional<LightSample> sample_direct(const Vec3& from, float /*time*/, float /*pick*/,
                                           const Vec2& /*u*/) const override {
    const Vec3 to_light = position_ - from;
    const float distance2 = glm::dot(to_light, to_light);
    if (!(distance2 > 0.0F)) return std::nullopt;
    LightSample sample;
    sample.distance = std::sqrt(distance2);
    sample.direction = to_light / sample.distance;
    sample.radiance =
        intensity_ * (falloff(std::max(glm::dot(-sample.direction, axis_.n), -1.0F)) / distance2);
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

  /// The smooth step covers half the solid angle between the two cones: its mean in cosine is 1/2.
  float power() const override {
    const float solid_angle = 2.0F * kPi * (1.0F - 0.5F * (cos_inner_ + cos_outer_));
    return luminance(intensity_) * solid_angle;
  }

  bool is_delta() const override { return true; }

  std::optional<LightBounds> bounds() const override {
    LightBounds bounds;
    bounds.box = {position_, position_};
    bounds.normals = {axis_.n, cos_outer_};
    bounds.cos_beyond = 1.0F;
    bounds.set_power(power());
    return bounds.power > 0.0F ? std::optional(bounds) : std::nullopt;
  }

  std::optional<Vec3> middle() const override { return position_; }

  /// Uniformly within the outer cone.
  std::optional<EmissionSample> sample_emission(float time, float /*pick*/, const Vec2& /*place*/,
                                                const Vec2& direction) const override {
    if (!(cone() > 0.0F)) return std::nullopt;
    EmissionSample sample;
    sample.direction = glm::normalize(axis_.to_world(square_to_cone(direction, cone())));
    sample.pdf_place = 1.0F;
    sample.pdf_direction = cone_pdf(cone());
    sample.weight = intensity_ * (falloff(glm::dot(sample.direction, axis_.n)) / cone_pdf(cone()));
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
    const bool inside = cone() >= 2.0F || glm::dot(outward, axis_.n) >= cos_outer_;
    return inside && cone() > 0.0F ? cone_pdf(cone()) : 0.0F;
  }

 private:
  float cone() const { return 1.0F - cos_outer_; }

  /// 1 inside the inner cone, 0 outside the outer one, 3 t^2 - 2 t^3 in the cosine in between.
  float falloff(float cosine) const {
    if (cosine >= cos_inner_) return 1.0F;
    if (cosine <= cos_outer_) return 0.0F;
    const float t = (cosine - cos_outer_) / (cos_inner_ - cos_outer_);
    return t * t * (3.0F - 2.0F * t);
  }

  Vec3 position_;
  Frame axis_;     ///< n is its axis
  Rgb intensity_;  ///< [W/sr]
  float cos_inner_;
  float cos_outer_;
};

}  // namespace

LightPtr make_point_light(const Vec3& position, const Rgb& power) {
  return std::make_shared<SpotLight>(position, Vec3(0.0F, 1.0F, 0.0F), power, -1.0F, -1.0F);
}

LightPtr make_spot_light(const Vec3& position, const Vec3& direction, const Rgb& power,
                         float cos_inner, float cos_outer) {
  return std::make_shared<SpotLight>(position, direction, power, cos_inner, cos_outer);
}

}  // namespace hyades::core
