#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/materials/delta_bsdf.h"
#include "core/materials/fresnel.h"
#include "core/materials/ggx.h"
#include "core/materials/hemisphere_mean.h"
#include "core/materials/local.h"
#include "core/materials/lost_light_bsdf.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

struct Metal {
  Rgb eta{1.0F};
  Rgb k{0.0F};
  Rgb tint{1.0F};

  Rgb reflectance(float cosine) const { return tint * fresnel_conductor(cosine, eta, k); }

  /// Over the hemisphere, weighed with the cosine: the integral of F(sqrt(s)) over s.
  Rgb mean_reflectance() const {
    constexpr int kSteps = 64;
    Rgb sum(0.0F);
    for (int i = 0; i < kSteps; ++i) {
      sum += reflectance(std::sqrt((static_cast<float>(i) + 0.5F) / kSteps));
    }
    return sum / static_cast<float>(kSteps);
  }
};

class SmoothConductorBsdf final : public DeltaBsdf {
 public:
  explicit SmoothConductorBsdf(const Metal& metal) : metal_(metal) {}

  std::optional<BsdfSample> sample(const Vec3& wo, float, const Vec2&,
                                   TransportMode) const override {
    return BsdfSample{.weight = metal_.reflectance(std::abs(wo.z)),
                      .pdf = 1.0F,
                      .wi = mirrored(wo),
                      .delta = true};
  }

  Rgb albedo(const Vec3& wo) const override { return metal_.reflectance(std::abs(wo.z)); }

 private:
  const Metal& metal_;
};

class RoughConductorBsdf final : public Bsdf {
 public:
  RoughConductorBsdf(const Metal& metal, float alpha) : metal_(metal), facets_{alpha} {}

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    if (!same_side(wo, wi)) return Rgb(0.0F);
    const Vec3 o = above(wo);
    const Vec3 i = above(wi);
    const float value = facets_.reflect(o, i);
    if (!(value > 0.0F)) return Rgb(0.0F);
    const Vec3 h = o + i;
    const float cosine = std::fmin(1.0F, glm::dot(o, h) / glm::length(h));
    return metal_.reflectance(cosine) * value;
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    return same_side(wo, wi) ? facets_.reflect_pdf(above(wo), above(wi)) : 0.0F;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float, const Vec2& u,
                                   TransportMode) const override {
    const Vec3 o = above(wo);
    if (!(o.z > 0.0F)) return std::nullopt;
    const Vec3 m = facets_.sample_normal(o, u);
    const Vec3 i = reflected(o, m);
    if (!(i.z > 0.0F)) return std::nullopt;
    const float density = facets_.reflect_pdf(o, i);
    if (!(density > 0.0F)) return std::nullopt;
    const float cosine = std::fmin(1.0F, std::fabs(glm::dot(o, m)));
    return BsdfSample{.weight = metal_.reflectance(cosine) * facets_.reflect_weight(o, i),
                      .pdf = density,
                      .wi = {i.x, i.y, i.z * side(wo)}};
  }

  Spread spread(float) const override {
    return {.lobe = hemisphere_mean([&](float cosine) { return metal_.reflectance(cosine); }),
            .alpha = facets_.alpha};
  }
  Rgb albedo(const Vec3& wo) const override { return metal_.reflectance(std::abs(wo.z)); }

 private:
  const Metal& metal_;
  Ggx facets_;
};

/// The index of a metal that reflects `r` straight on; `g` in 0..1 chooses among those that do
/// (Gulbrandsen 2014, equations 4 to 6).
void find_index(float r, float g, float& eta, float& k) {
  r = std::fmin(r, 0.9999F);
  const float root = std::sqrt(r);
  eta = g * (1.0F - r) / (1.0F + r) + (1.0F - g) * (1.0F + root) / (1.0F - root);
  const float k2 = (r * (eta + 1.0F) * (eta + 1.0F) - (eta - 1.0F) * (eta - 1.0F)) / (1.0F - r);
  k = std::sqrt(std::fmax(k2, 0.0F));
}

Metal metal_of(const Rgb& color, const Rgb& edge, const Rgb& tint) {
  Metal metal;
  for (int c = 0; c < 3; ++c) find_index(color[c], edge[c], metal.eta[c], metal.k[c]);
  metal.tint = tint;
  return metal;
}

const Bsdf* conductor_bsdf(const Metal& metal, float roughness, FacetScattering scattering,
                           const Rgb& mean_reflectance, BsdfArena& arena) {
  const float alpha = roughness * roughness;
  if (alpha < Ggx::kLeastAlpha) return arena.make<SmoothConductorBsdf>(metal);
  if (scattering == FacetScattering::multiple) {
    return arena.make<LostLightBsdf<RoughConductorBsdf>>(RoughConductorBsdf(metal, alpha), alpha,
                                                         1.0F, mean_reflectance);
  }
  return arena.make<RoughConductorBsdf>(metal, alpha);
}

class Conductor final : public Material {
 public:
  Conductor(const Metal& metal, ScalarParam roughness, FacetScattering scattering)
      : metal_(metal),
        roughness_(std::move(roughness)),
        scattering_(scattering),
        mean_reflectance_(metal.mean_reflectance()) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    return conductor_bsdf(metal_, fraction_at(roughness_, point), scattering_, mean_reflectance_,
                          arena);
  }

  bool diffuses_evenly() const override { return true; }

 private:
  Metal metal_;
  ScalarParam roughness_;
  FacetScattering scattering_;
  Rgb mean_reflectance_;
};

class ColoredConductor final : public Material {
 public:
  ColoredConductor(ColorParam color, ColorParam edge, ScalarParam roughness, const Rgb& tint,
                   FacetScattering scattering)
      : color_(std::move(color)),
        edge_(std::move(edge)),
        roughness_(std::move(roughness)),
        tint_(unit_clamp(tint)),
        scattering_(scattering) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    const Metal& metal = *arena.make<Metal>(
        metal_of(reflectance_at(color_, point), reflectance_at(edge_, point), tint_));
    const Rgb mean = scattering_ == FacetScattering::multiple
                         ? hemisphere_mean([&](float cosine) { return metal.reflectance(cosine); })
                         : Rgb(0.0F);
    return conductor_bsdf(metal, fraction_at(roughness_, point), scattering_, mean, arena);
  }

  bool diffuses_evenly() const override { return true; }

 private:
  ColorParam color_;
  ColorParam edge_;
  ScalarParam roughness_;
  Rgb tint_;
  FacetScattering scattering_;
};

}  // namespace

MaterialPtr make_conductor(const Rgb& eta, const Rgb& k, const ScalarParam& roughness,
                           const Rgb& tint, FacetScattering scattering) {
  return std::make_shared<Conductor>(Metal{eta, k, unit_clamp(tint)}, roughness, scattering);
}

MaterialPtr make_colored_conductor(const ColorParam& color, const ColorParam& edge,
                                   const ScalarParam& roughness, const Rgb& tint,
                                   FacetScattering scattering) {
  return std::make_shared<ColoredConductor>(color, edge, roughness, tint, scattering);
}

}  // namespace hyades::core
