#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/warp.h"
#include "core/materials/delta_bsdf.h"
#include "core/materials/dielectric_bsdf.h"
#include "core/materials/facet_energy.h"
#include "core/materials/fresnel.h"
#include "core/materials/ggx.h"
#include "core/materials/hemisphere_mean.h"
#include "core/materials/local.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

float sheet_reflectance(float cosine, float ior) {
  const float r = fresnel_dielectric(cosine, ior).reflectance;
  return 2.0F * r / (1.0F + r);
}

/// Both faces of a sheet at once. With R and T = 1 - R of one face the geometric series of inner
/// bounces gives R' = R + T^2 R / (1 - R^2) = 2 R / (1 + R) and T' = 1 - R' (Stokes 1862). Light
/// leaves into the medium it came from, so that both transport modes agree.
class ThinDielectricBsdf final : public DeltaBsdf {
 public:
  ThinDielectricBsdf(float ior, const Rgb& transmission, const Rgb& reflection)
      : ior_(ior), transmission_(transmission), reflection_(reflection) {}

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2&,
                                   TransportMode) const override {
    const float reflectance = sheet_reflectance(std::abs(wo.z), ior_);
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
    const float reflectance = sheet_reflectance(std::abs(wo.z), ior_);
    return reflection_ * reflectance + transmission_ * (1.0F - reflectance);
  }

 private:
  float ior_;
  Rgb transmission_;
  Rgb reflection_;
};

/// A thin sheet of GGX facets. What each facet transmits leaves as what it reflects does, on the
/// other side; what facets throw onto each other comes out nearly diffuse on both (LostLight), on
/// each as much as smooth sheets reflect and transmit of diffuse light. Each further facet keeps
/// what it does of both tints.
class RoughThinBsdf final : public Bsdf {
 public:
  RoughThinBsdf(float ior, float alpha, const Rgb& transmission, const Rgb& reflection)
      : ior_(ior),
        facets_{alpha},
        lost_(alpha),
        transmission_(transmission),
        reflection_(reflection),
        back_(hemisphere_mean([&](float cosine) { return sheet_reflectance(cosine, ior); })) {
    const float loss = FacetEnergy::table().mean_loss(alpha);
    const Rgb f = back_ * reflection + (1.0F - back_) * transmission;
    further_ = f * (1.0F - loss) / (Rgb(1.0F) - f * loss);
  }

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    if (wo.z == 0.0F || wi.z == 0.0F) return Rgb(0.0F);
    const Vec3 o = above(wo);
    const Vec3 i = above(wi);
    const float single = facets_.reflect(o, i);
    const float r = single > 0.0F ? sheet_reflectance(cosine_between(o, i), ior_) : 0.0F;
    const float lost = lost_.reflect(o, i);
    return same_side(wo, wi)
               ? reflection_ * (Rgb(r * single) + further_ * (back_ * lost))
               : transmission_ * (Rgb((1.0F - r) * single) + further_ * ((1.0F - back_) * lost));
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    if (wo.z == 0.0F || wi.z == 0.0F) return 0.0F;
    const Vec3 o = above(wo);
    const Vec3 i = above(wi);
    const float p_lost = lost_.part(o);
    const float cosine = cosine_between(o, i);
    const bool back = same_side(wo, wi);
    const float p = p_back(sheet_reflectance(cosine, ior_));
    const float p_wide = p_back(back_);
    return (1.0F - p_lost) * (back ? p : 1.0F - p) * facets_.reflect_pdf(o, i) +
           p_lost * (back ? p_wide : 1.0F - p_wide) * cosine_hemisphere_pdf(i.z);
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const override {
    const Vec3 o = above(wo);
    if (!(o.z > 0.0F)) return std::nullopt;
    const float p_lost = lost_.part(o);
    Vec3 i;
    float p = 0.0F;
    float rest = 0.0F;
    if (lobe < p_lost) {
      i = square_to_cosine_hemisphere(u);
      p = p_back(back_);
      rest = rest_of(lobe, 0.0F, p_lost);
    } else {
      i = reflected(o, facets_.sample_normal(o, u));
      if (!(i.z > 0.0F)) return std::nullopt;
      p = p_back(sheet_reflectance(cosine_between(o, i), ior_));
      rest = rest_of(lobe, p_lost, 1.0F - p_lost);
    }
    BsdfSample s;
    s.transmitted = !(rest < p);
    s.wi = {i.x, i.y, s.transmitted ? -i.z * side(wo) : i.z * side(wo)};
    s.pdf = pdf(wo, s.wi, mode);
    if (!(s.pdf > 0.0F)) return std::nullopt;
    s.weight = evaluate(wo, s.wi, mode) / s.pdf;
    return s;
  }

  Spread spread(float) const override {
    return {.lobe = back_ * reflection_,
            .lobe_through = (1.0F - back_) * transmission_,
            .alpha = facets_.alpha};
  }

  Rgb albedo(const Vec3& wo) const override {
    const float reflectance = sheet_reflectance(std::abs(wo.z), ior_);
    return reflection_ * reflectance + transmission_ * (1.0F - reflectance);
  }

 private:
  static float cosine_between(const Vec3& o, const Vec3& i) {
    const Vec3 h = o + i;
    return std::fmin(1.0F, glm::dot(o, h) / glm::length(h));
  }

  /// The probability of reflection where the share `r` is reflected.
  float p_back(float r) const {
    const float back = r * max_component(reflection_);
    const float through = (1.0F - r) * max_component(transmission_);
    return back + through > 0.0F ? back / (back + through) : 1.0F;
  }

  float ior_;
  Ggx facets_;
  LostLight lost_;
  Rgb transmission_;
  Rgb reflection_;
  float back_;  ///< the share of diffuse light that a smooth sheet reflects
  Rgb further_{0.0F};
};

class ThinDielectric final : public Material {
 public:
  ThinDielectric(float ior, const Rgb& transmission, const Rgb& reflection, ScalarParam roughness)
      : ior_(ior),
        transmission_(unit_clamp(transmission)),
        reflection_(unit_clamp(reflection)),
        roughness_(std::move(roughness)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    const float roughness = fraction_at(roughness_, point);
    return thin_dielectric_bsdf(ior_ / point.outside_index, roughness * roughness, transmission_,
                                reflection_, arena);
  }
  float index() const override { return ior_; }

 private:
  float ior_;
  Rgb transmission_;
  Rgb reflection_;
  ScalarParam roughness_;
};

}  // namespace

const Bsdf* thin_dielectric_bsdf(float ior, float alpha, const Rgb& transmission,
                                 const Rgb& reflection, BsdfArena& arena) {
  if (alpha < Ggx::kLeastAlpha || ior == 1.0F)
    return arena.make<ThinDielectricBsdf>(ior, transmission, reflection);
  return arena.make<RoughThinBsdf>(ior, alpha, transmission, reflection);
}

MaterialPtr make_thin_dielectric(float ior, const Rgb& transmission, const Rgb& reflection,
                                 const ScalarParam& roughness) {
  return std::make_shared<ThinDielectric>(ior, transmission, reflection, roughness);
}

}  // namespace hyades::core
