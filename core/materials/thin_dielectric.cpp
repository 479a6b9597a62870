#include <cmath>

#include "core/materials/delta_bsdf.h"
#include "core/materials/fresnel.h"
#include "core/materials/local.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

/// Both faces of a sheet at once. With R and T = 1 - R of one face the geometric series of inner
/// bounces gives R' = R + T^2 R / (1 - R^2) = 2 R / (1 + R) and T' = 1 - R' (Stokes 1862). Light
/// leaves into the medium it came from, so that both transport modes agree.
class ThinDielectricBsdf final : public DeltaBsdf {
 public:
  ThinDielectricBsdf(float ior, const Rgb& transmission, const Rgb& reflection)
      : ior_(ior), transmission_(transmission), reflection_(reflection) {}

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2&,
                                   TransportMode) const override {
    const float reflectance = sheet_reflectance(wo);
    const float reflect = reflectance * max_component(reflection_);
    const float transmit = (1.0F - reflectance) * max_component(transmission_);
    if (!(reflect + transmit > 0.0F)) return std::nullopt;
    const float p_reflect = reflect / (reflect + transmit);
    if (lobe < p_reflect) {
      return BsdfSample{.weight = reflection_ * (reflectance / p_reflect),
                        .pdf = p_reflect,
                        .wi = mirrored(wo),
                        .delta = true};
    }
    const float p_transmit = 1.0F - p_reflect;
    if (!(p_transmit > 0.0F)) return std::nullopt;
    return BsdfSample{.weight = transmission_ * ((1.0F - reflectance) / p_transmit),
                      .pdf = p_transmit,
                      .wi = -wo,
                      .delta = true,
                      .transmitted = true};
  }

  Rgb albedo(const Vec3& wo) const override {
    const float reflectance = sheet_reflectance(wo);
    return reflection_ * reflectance + transmission_ * (1.0F - reflectance);
  }

 private:
  float sheet_reflectance(const Vec3& wo) const {
    const float r = fresnel_dielectric(std::abs(wo.z), ior_).reflectance;
    return 2.0F * r / (1.0F + r);
  }

  float ior_;
  Rgb transmission_;
  Rgb reflection_;
};

class ThinDielectric final : public Material {
 public:
  ThinDielectric(float ior, const Rgb& transmission, const Rgb& reflection)
      : ior_(ior), transmission_(unit_clamp(transmission)), reflection_(unit_clamp(reflection)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    return arena.make<ThinDielectricBsdf>(ior_ / point.outside_index, transmission_, reflection_);
  }
  float index() const override { return ior_; }

 private:
  float ior_;
  Rgb transmission_;
  Rgb reflection_;
};

}  // namespace

MaterialPtr make_thin_dielectric(float ior, const Rgb& transmission, const Rgb& reflection) {
  return std::make_shared<ThinDielectric>(ior, transmission, reflection);
}

}  // namespace hyades::core
