#include <cmath>
#include <memory>
#include <optional>

#include "core/materials/delta_bsdf.h"
#include "core/materials/dielectric_bsdf.h"
#include "core/materials/fresnel.h"
#include "core/materials/local.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

/// Smooth interface; `ior` is the index of the side z < 0 over that of the other. One lobe is
/// picked by its energy.
///
/// Refraction squeezes a beam's solid angle: radiance over the squared index is what stays constant
/// along a ray (Veach 1997, section 5.2). Radiance that arrives along wi in index eta_i leaves
/// along wo in eta_o as (1 - F) (eta_o / eta_i)^2 L; importance is carried without that factor.
/// Most renderers leave it out; `scale_radiance` off does, too.
class DielectricBsdf final : public DeltaBsdf {
 public:
  DielectricBsdf(float ior, const Rgb& transmission, const Rgb& reflection, bool scale_radiance)
      : ior_(ior),
        transmission_(transmission),
        reflection_(reflection),
        scale_radiance_(scale_radiance) {}

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2&,
                                   TransportMode mode) const override {
    const float eta = index_beyond(wo, ior_);
    const auto [reflectance, cos_t] = fresnel_dielectric(std::abs(wo.z), eta);
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
    Rgb weight = transmission_ * ((1.0F - reflectance) / p_transmit);
    if (is_scaled(mode, scale_radiance_)) weight *= 1.0F / (eta * eta);
    return BsdfSample{.weight = weight,
                      .pdf = p_transmit,
                      .wi = {-wo.x / eta, -wo.y / eta, wo.z < 0.0F ? cos_t : -cos_t},
                      .delta = true,
                      .transmitted = true,
                      .eta = eta,
                      .scale_radiance = scale_radiance_};
  }

  Rgb albedo(const Vec3& wo) const override {
    const float eta = index_beyond(wo, ior_);
    const float reflectance = fresnel_dielectric(std::abs(wo.z), eta).reflectance;
    return reflection_ * reflectance + transmission_ * (1.0F - reflectance);
  }

 private:
  float ior_;
  Rgb transmission_;
  Rgb reflection_;
  bool scale_radiance_;
};

/// Light goes straight on: an interface between equal indices.
class MatchedBsdf final : public DeltaBsdf {
 public:
  explicit MatchedBsdf(const Rgb& transmission) : transmission_(transmission) {}

  std::optional<BsdfSample> sample(const Vec3& wo, float, const Vec2&,
                                   TransportMode) const override {
    return BsdfSample{
        .weight = transmission_, .pdf = 1.0F, .wi = -wo, .delta = true, .transmitted = true};
  }

  Rgb albedo(const Vec3&) const override { return transmission_; }

 private:
  Rgb transmission_;
};

class Dielectric final : public Material {
 public:
  Dielectric(float ior, const Rgb& transmission, const Rgb& reflection)
      : ior_(ior), transmission_(unit_clamp(transmission)), reflection_(unit_clamp(reflection)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    return smooth_dielectric_bsdf(ior_ / point.outside_index, transmission_, reflection_, true,
                                  arena);
  }
  bool leads_inside() const override { return true; }
  float index() const override { return ior_; }

 private:
  float ior_;
  Rgb transmission_;
  Rgb reflection_;
};

}  // namespace

const Bsdf* smooth_dielectric_bsdf(float ior, const Rgb& transmission, const Rgb& reflection,
                                   bool scale_radiance, BsdfArena& arena) {
  if (ior == 1.0F) return arena.make<MatchedBsdf>(transmission);
  return arena.make<DielectricBsdf>(ior, transmission, reflection, scale_radiance);
}

MaterialPtr make_dielectric(float ior, const Rgb& transmission, const Rgb& reflection) {
  return std::make_shared<Dielectric>(ior, transmission, reflection);
}

}  // namespace hyades::core
