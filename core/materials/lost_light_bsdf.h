#pragma once

#include <cmath>
#include <optional>

#include "core/base/warp.h"
#include "core/materials/bsdf.h"
#include "core/materials/facet_energy.h"
#include "core/materials/local.h"

namespace hyades::core {

/// A reflecting BSDF on GGX facets, with the light given back that it loses to second facets.
/// `share`: the part of Single that is facets; `color`: their mean reflectance.
template <class Single>
class LostLightBsdf final : public Bsdf {
 public:
  LostLightBsdf(const Single& single, float alpha, float share, const Rgb& color)
      : single_(single), lost_(alpha), share_(share), tint_(share * lost_.tint(color)) {}

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    if (!same_side(wo, wi)) return Rgb(0.0F);
    return single_.evaluate(wo, wi, mode) + tint_ * lost_.reflect(above(wo), above(wi));
  }

  Rgb evaluate_diffuse(const Vec3& wo, const Vec3& wi) const override {
    return single_.evaluate_diffuse(wo, wi);
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    if (!same_side(wo, wi)) return 0.0F;
    const float p_lost = share_ * lost_.part(above(wo));
    return (1.0F - p_lost) * single_.pdf(wo, wi, mode) +
           p_lost * cosine_hemisphere_pdf(std::abs(wi.z));
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const override {
    const float p_lost = share_ * lost_.part(above(wo));
    BsdfSample s;
    if (lobe < p_lost) {
      const Vec3 i = square_to_cosine_hemisphere(u);
      s.wi = {i.x, i.y, i.z * side(wo)};
    } else {
      const auto single = single_.sample(wo, rest_of(lobe, p_lost, 1.0F - p_lost), u, mode);
      if (!single) return std::nullopt;
      s.wi = single->wi;
    }
    s.pdf = pdf(wo, s.wi, mode);
    if (!(s.pdf > 0.0F)) return std::nullopt;
    s.weight = evaluate(wo, s.wi, mode) / s.pdf;
    return s;
  }

  Spread spread(float outer) const override { return single_.spread(outer); }
  Rgb albedo(const Vec3& wo) const override { return single_.albedo(wo); }

 private:
  Single single_;
  LostLight lost_;
  float share_;
  Rgb tint_;
};

}  // namespace hyades::core
