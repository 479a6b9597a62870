#include <memory>
#include <optional>
#include <utility>

#include "core/base/warp.h"
#include "core/lights/environment_map.h"
#include "core/lights/infinite_light.h"
#include "core/lights/make_light.h"

namespace hyades::core {

namespace {

/// Flux through a disc around the world, over all directions.
float flux(const Rgb& integral, float world_radius) {
  return luminance(integral) * kPi * world_radius * world_radius;
}

/// The same radiance from everywhere. By its excess it is never chosen.
class ConstantSky : public InfiniteLight {
 public:
  ConstantSky(const Rgb& radiance, float world_radius, SkyDensity density)
      : radiance_(radiance),
        power_(density == SkyDensity::excess ? 0.0F : flux(4.0F * kPi * radiance, world_radius)) {}

  std::optional<LightSample> sample_direct(const Vec3& /*from*/, float /*time*/, float /*pick*/,
                                           const Vec2& u) const override {
    if (!(power_ > 0.0F)) return std::nullopt;
    LightSample sample;
    sample.radiance = radiance_;
    sample.pdf = uniform_sphere_pdf();
    sample.pdf_place = sample.pdf;
    sample.direction = square_to_uniform_sphere(u);
    sample.distance = kInfinity;
    return sample;
  }

  float pdf_direct(const Vec3& /*from*/, const Vec3& /*direction*/,
                   const SurfacePoint& /*on*/) const override {
    return power_ > 0.0F ? uniform_sphere_pdf() : 0.0F;
  }

  Rgb radiance(const SurfacePoint& /*on*/, const Vec3& /*outward*/) const override {
    return radiance_;
  }

  float power() const override { return power_; }

 private:
  Rgb radiance_;
  float power_;
};

/// Radiance from a lat-long map, turned about +y.
class ImageSky : public InfiniteLight {
 public:
  ImageSky(std::shared_ptr<const EnvironmentMap> map, float rotate_y, const Rgb& scale,
           float world_radius)
      : map_(std::move(map)),
        // Turning the map counter-clockwise lowers the azimuth atan2(z, x) of what is on it.
        turn_(rotate_y / (2.0F * kPi)),
        scale_(scale),
        power_(flux(scale * map_->integral(), world_radius) * sampled_share(*map_)) {}

  std::optional<LightSample> sample_direct(const Vec3& /*from*/, float /*time*/, float /*pick*/,
                                           const Vec2& u) const override {
    if (is_dark()) return std::nullopt;
    LightSample sample;
    sample.direction = map_->sample(u, turn_);
    // Looked up again from the rounded direction: the same numbers that a ray will find there.
    const EnvironmentMap::View view = map_->view(sample.direction, turn_);
    sample.pdf = view.pdf;
    sample.pdf_place = sample.pdf;
    sample.radiance = scale_ * view.radiance;
    sample.distance = kInfinity;
    if (!(sample.pdf > 0.0F) || is_black(sample.radiance)) return std::nullopt;
    return sample;
  }

  float pdf_direct(const Vec3& /*from*/, const Vec3& direction,
                   const SurfacePoint& /*on*/) const override {
    return is_dark() ? 0.0F : map_->view(direction, turn_).pdf;
  }

  Rgb radiance(const SurfacePoint& /*on*/, const Vec3& outward) const override {
    return scale_ * map_->look_up(-outward, turn_);
  }

  float power() const override { return power_; }

 private:
  /// What of its light the sky is to be chosen for.
  static float sampled_share(const EnvironmentMap& map) {
    const float all = luminance(map.integral());
    return all > 0.0F ? map.sampled() / all : 0.0F;
  }

  bool is_dark() const { return !(power_ > 0.0F); }

  std::shared_ptr<const EnvironmentMap> map_;
  float turn_;
  Rgb scale_;
  float power_;
};

}  // namespace

LightPtr make_environment_map_light(std::shared_ptr<const EnvironmentMap> map, float rotate_y,
                                    const Rgb& scale, float world_radius) {
  return std::make_shared<ImageSky>(std::move(map), rotate_y, scale, world_radius);
}

LightPtr make_environment_light(std::shared_ptr<const Image> image, float rotate_y,
                                const Rgb& scale, float world_radius, SkyDensity density) {
  if (image == nullptr || image->data.empty()) {
    return std::make_shared<ConstantSky>(scale, world_radius, density);
  }
  return make_environment_map_light(std::make_shared<EnvironmentMap>(std::move(image), density),
                                    rotate_y, scale, world_radius);
}

}  // namespace hyades::core
