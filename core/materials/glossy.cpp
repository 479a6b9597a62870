#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/warp.h"
#include "core/materials/ggx.h"
#include "core/materials/local.h"
#include "core/materials/lost_light_bsdf.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

/// f = color ((1 - r) / pi + r D G2 / (4 cos theta_o cos theta_i)), with r the reflectiveness and
/// D, G2 those of GGX with alpha = (1 - glossiness)^2 and no Fresnel: reciprocal, and as D G2 / (4
/// ..) reflects at most everything, never more than `color` in all. At glossiness 1 the second term
/// is a perfect mirror.
class GlossyBsdf final : public Bsdf {
 public:
  GlossyBsdf(const Rgb& color, float reflectiveness, float alpha)
      : color_(color), r_(reflectiveness), facets_{alpha}, mirror_(alpha < Ggx::kLeastAlpha) {}

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    return same_side(wo, wi) ? color_ * value(above(wo), above(wi)) : Rgb(0.0F);
  }

  Rgb evaluate_diffuse(const Vec3& wo, const Vec3& wi) const override {
    return same_side(wo, wi) ? color_ * diffuse(std::abs(wi.z)) : Rgb(0.0F);
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    return same_side(wo, wi) ? density(above(wo), above(wi)) : 0.0F;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode) const override {
    const Vec3 o = above(wo);
    if (!(o.z > 0.0F)) return std::nullopt;
    Vec3 i;
    if (lobe < r_) {
      if (mirror_) {
        return BsdfSample{.weight = color_, .pdf = r_, .wi = mirrored(wo), .delta = true};
      }
      i = reflected(o, facets_.sample_normal(o, u));
    } else {
      i = square_to_cosine_hemisphere(u);
    }
    if (!(i.z > 0.0F)) return std::nullopt;
    const float d = density(o, i);
    if (!(d > 0.0F)) return std::nullopt;
    return BsdfSample{
        .weight = color_ * (value(o, i) / d), .pdf = d, .wi = {i.x, i.y, i.z * side(wo)}};
  }

  Spread spread(float) const override {
    return {.wide = (1.0F - r_) * color_,
            .lobe = mirror_ ? Rgb(0.0F) : r_ * color_,
            .alpha = facets_.alpha};
  }
  Rgb albedo(const Vec3&) const override { return color_; }
  bool has_smooth() const override { return !mirror_ || r_ < 1.0F; }

 private:
  /// The first term, times the cosine `z` of wi, for color 1.
  float diffuse(float z) const { return (1.0F - r_) * kInvPi * z; }

  /// f cos(theta_i) for color 1, both directions above.
  float value(const Vec3& o, const Vec3& i) const {
    const float dull = diffuse(i.z);
    return mirror_ || r_ == 0.0F ? dull : dull + r_ * facets_.reflect(o, i);
  }

  float density(const Vec3& o, const Vec3& i) const {
    const float dull = diffuse(i.z);
    return mirror_ || r_ == 0.0F ? dull : dull + r_ * facets_.reflect_pdf(o, i);
  }

  Rgb color_;
  float r_;
  Ggx facets_;
  bool mirror_;
};

class Glossy final : public Material {
 public:
  Glossy(ColorParam color, ScalarParam reflectiveness, ScalarParam glossiness,
         FacetScattering scattering)
      : color_(std::move(color)),
        reflectiveness_(std::move(reflectiveness)),
        glossiness_(std::move(glossiness)),
        scattering_(scattering) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    const Rgb color = reflectance_at(color_, point);
    if (is_black(color)) return nullptr;
    const float dull = 1.0F - fraction_at(glossiness_, point);
    const float alpha = dull * dull;
    const float reflectiveness = fraction_at(reflectiveness_, point);
    if (scattering_ == FacetScattering::multiple && alpha >= Ggx::kLeastAlpha) {
      return arena.make<LostLightBsdf<GlossyBsdf>>(GlossyBsdf(color, reflectiveness, alpha), alpha,
                                                   reflectiveness, color);
    }
    return arena.make<GlossyBsdf>(color, reflectiveness, alpha);
  }

  bool diffuses_evenly() const override { return true; }

 private:
  ColorParam color_;
  ScalarParam reflectiveness_;
  ScalarParam glossiness_;
  FacetScattering scattering_;
};

}  // namespace

MaterialPtr make_glossy(const ColorParam& color, const ScalarParam& reflectiveness,
                        const ScalarParam& glossiness, FacetScattering scattering) {
  return std::make_shared<Glossy>(color, reflectiveness, glossiness, scattering);
}

}  // namespace hyades::core
