#include <cmath>
#include <memory>

#include "core/base/elementary.h"
#include "core/materials/dielectric_bsdf.h"
#include "core/materials/make_principled.h"
#include "core/materials/params.h"
#include "core/materials/principled_bsdf.h"

namespace hyades::core {
namespace {

bool may_be_positive(const ScalarParam& param) { return param.texture || param.value > 0.0F; }

float square(float x) { return x * x; }

/// The index whose reflectance straight on is that of `eta`, times `scale`.
float scaled_index(float eta, float scale) {
  if (scale == 1.0F) return eta;
  const float root = (eta - 1.0F) / (eta + 1.0F);
  const float f = std::fmin(std::fabs(root) * std::sqrt(scale), 0.99F);
  const float dense = (1.0F + f) / (1.0F - f);
  return eta >= 1.0F ? dense : 1.0F / dense;
}

Rgb square_root(const Rgb& c) { return {std::sqrt(c.x), std::sqrt(c.y), std::sqrt(c.z)}; }

class Principled final : public Material {
 public:
  explicit Principled(const PrincipledParams& params)
      : params_(params),
        leads_inside_(!params.thin_walled &&
                      (params.subsurface || may_be_positive(params.transmission))),
        coated_(may_be_positive(params.coat)),
        fuzzy_(may_be_positive(params.sheen)) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame& frame, BsdfArena& arena) const override {
    PrincipledParts parts;
    const Rgb base = reflectance_at(params_.base_color, point);
    parts.metallic = fraction_at(params_.metallic, point);
    parts.glassy = params_.subsurface ? 1.0F : fraction_at(params_.transmission, point);
    const float roughness = fraction_at(params_.roughness, point);
    parts.alpha = square(roughness);
    set_facets(parts, point, frame);
    const float eta = params_.ior / point.outside_index;
    parts.eta = scaled_index(eta, 2.0F * fraction_at(params_.specular, point));
    parts.facet_tint = reflectance_at(params_.specular_tint, point);
    parts.metal = base;
    parts.metal_edge = parts.facet_tint;
    parts.matt = base;
    parts.solid = leads_inside_;
    parts.metal_keeps_light = params_.facets == FacetScattering::multiple;
    if (params_.thin_walled) {
      const float through = fraction_at(params_.diffuse_transmission, point);
      parts.matt = base * (1.0F - through);
      parts.matt_through = base * through;
    }
    if (parts.glassy > 0.0F && parts.metallic < 1.0F) {
      parts.glass = glass_of(parts, base, eta, arena);
    }
    if (coated_) {
      const float coat = fraction_at(params_.coat, point);
      const float coat_eta = params_.coat_ior / point.outside_index;
      if (coat > 0.0F && coat_eta != 1.0F)
        parts.coat.emplace(coat, coat_eta, square(fraction_at(params_.coat_roughness, point)));
    }
    if (fuzzy_) {
      const Rgb color =
          reflectance_at(params_.sheen_tint, point) * fraction_at(params_.sheen, point);
      if (!is_black(color)) parts.fuzz.emplace(color, fraction_at(params_.sheen_roughness, point));
    }
    return arena.make<PrincipledBsdf>(parts);
  }

  bool leads_inside() const override { return leads_inside_; }
  float index() const override {
    return leads_inside_ || (params_.thin_walled && may_be_positive(params_.transmission))
               ? params_.ior
               : 0.0F;
  }

 private:
  /// Widths by Burley 2012: their ratio is 1 - 0.9 anisotropic. Or by two roughnesses: neither
  /// width is more than ten times the other then, either.
  void set_facets(PrincipledParts& parts, const SurfacePoint& point, Frame& frame) const {
    parts.facets = {parts.alpha, parts.alpha};
    if (params_.roughness_along) {
      const float along = square(fraction_at(*params_.roughness_along, point));
      const float wider = std::fmax(along, parts.alpha);
      if (along == parts.alpha || wider < AnisotropicGgx::kLeastAlpha) return;
      const float least = std::fmax(0.1F * wider, AnisotropicGgx::kLeastAlpha);
      parts.facets = {std::fmax(along, least), std::fmax(parts.alpha, least)};
      parts.alpha = std::sqrt(parts.facets.along_x * parts.facets.along_y);
    } else {
      const float anisotropic = fraction_at(params_.anisotropic, point);
      if (!(anisotropic > 0.0F) || parts.alpha < AnisotropicGgx::kLeastAlpha) return;
      const float aspect = std::sqrt(1.0F - 0.9F * anisotropic);
      parts.facets = {std::fmin(parts.alpha / aspect, 1.0F),
                      std::fmax(parts.alpha * aspect, AnisotropicGgx::kLeastAlpha)};
    }
    const float turns = fraction_at(params_.anisotropic_rotation, point);
    if (turns == 0.0F) return;
    const auto [sine, cosine] = sin_cos(2.0F * kPi * turns);
    const Vec3 s = cosine * frame.s + sine * frame.t;
    frame = {s, glm::cross(frame.n, s), frame.n};
  }

  /// Bodies tint light where it comes in and where it goes out; thin walls once.
  const Bsdf* glass_of(const PrincipledParts& parts, const Rgb& base, float eta,
                       BsdfArena& arena) const {
    if (params_.thin_walled)
      return thin_dielectric_bsdf(eta, parts.alpha, base, parts.facet_tint, arena);
    const Rgb tint = params_.subsurface ? Rgb(1.0F) : square_root(base);
    return dielectric_bsdf(eta, parts.alpha, tint, parts.facet_tint, params_.facets,
                           params_.scale_radiance, arena);
  }

  PrincipledParams params_;
  bool leads_inside_;
  bool coated_;
  bool fuzzy_;
};

}  // namespace

MaterialPtr make_principled(const PrincipledParams& params) {
  return std::make_shared<Principled>(params);
}

}  // namespace hyades::core
