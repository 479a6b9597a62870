#include <cstdint>
#include <memory>
#include <utility>

#include "core/lights/make_light.h"

namespace hyades::core {
namespace {

/// Each place of the ball shines as its source does, so that from afar it is that source.
class SourceProfile final : public AngularProfile {
 public:
  explicit SourceProfile(PointSourcePtr source) : source_(std::move(source)) {}

  Rgb share(const Vec3& /*normal*/, const Vec3& outward) const override {
    return source_->value(outward);
  }
  Vec3 choose(const Vec3& /*normal*/, const Vec2& u) const override { return source_->choose(u); }
  float pdf(const Vec3& /*normal*/, const Vec3& outward) const override {
    return source_->pdf(outward);
  }
  float mean() const override {
    const float all_round = 4.0F * kPi * luminance(source_->intensity());
    return all_round > 0.0F ? source_->power() / all_round : 0.0F;
  }
  void narrow(LightBounds& bounds) const override {
    bounds.normals = source_->cone();
    bounds.cos_beyond = 1.0F;
  }

 private:
  PointSourcePtr source_;
};

}  // namespace

LightPtr make_ball_light(const World& world, uint32_t object, PointSourcePtr source) {
  const float radius = world.placement(object).shape.radius;
  SurfaceEmission emission;
  // From all sides one sees a disk of pi r^2.
  emission.radiance = source->intensity() / (kPi * radius * radius);
  emission.profile = std::make_shared<const SourceProfile>(std::move(source));
  return make_area_light(world, object, emission);
}

}  // namespace hyades::core
