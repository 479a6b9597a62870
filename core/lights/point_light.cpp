#include <algorithm>
#include <memory>

#include "core/base/frame.h"
#include "core/base/warp.h"
#include "core/lights/make_light.h"
#include "core/lights/point_source.h"

namespace hyades::core {

namespace {

/// Light from one point into a cone around `axis`; a point light is the cone that holds everything.
class SpotLight final : public PointSource {
 public:
  SpotLight(const Vec3& position, const Vec3& axis, const Rgb& power, float cos_inner,
            float cos_outer)
      : PointSource(position, power / (4.0F * kPi)),
        axis_(Frame::around(axis)),
        cos_inner_(std::clamp(cos_inner, -1.0F, 1.0F)),
        cos_outer_(std::clamp(std::min(cos_outer, cos_inner), -1.0F, 1.0F)) {}

  /// The smooth step covers half the solid angle between the two cones: its mean in cosine is 1/2.
  float power() const override {
    const float solid_angle = 2.0F * kPi * (1.0F - 0.5F * (cos_inner_ + cos_outer_));
    return luminance(intensity()) * solid_angle;
  }

 private:
  /// 1 inside the inner cone, 0 outside the outer one, 3 t^2 - 2 t^3 in the cosine in between.
  Rgb value(const Vec3& direction) const override {
    const float cosine = std::max(glm::dot(direction, axis_.n), -1.0F);
    if (cosine >= cos_inner_) return Rgb(1.0F);
    if (cosine <= cos_outer_) return Rgb(0.0F);
    const float t = (cosine - cos_outer_) / (cos_inner_ - cos_outer_);
    return Rgb(t * t * (3.0F - 2.0F * t));
  }

  /// Uniformly within the outer cone.
  Vec3 choose(const Vec2& u) const override { return axis_.to_world(square_to_cone(u, width())); }
  float pdf(const Vec3& direction) const override {
    const bool inside = width() >= 2.0F || glm::dot(direction, axis_.n) >= cos_outer_;
    return inside && width() > 0.0F ? cone_pdf(width()) : 0.0F;
  }
  DirectionCone cone() const override { return {axis_.n, cos_outer_}; }

  float width() const { return 1.0F - cos_outer_; }

  Frame axis_;  ///< n is its axis
  float cos_inner_;
  float cos_outer_;
};

}  // namespace

PointSourcePtr make_point_light(const Vec3& position, const Rgb& power) {
  return std::make_shared<SpotLight>(position, Vec3(0.0F, 1.0F, 0.0F), power, -1.0F, -1.0F);
}

PointSourcePtr make_spot_light(const Vec3& position, const Vec3& direction, const Rgb& power,
                               float cos_inner, float cos_outer) {
  return std::make_shared<SpotLight>(position, direction, power, cos_inner, cos_outer);
}

}  // namespace hyades::core
