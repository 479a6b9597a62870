#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/warp.h"
#include "core/materials/dielectric_bsdf.h"
#include "core/materials/dielectric_energy.h"
#include "core/materials/fresnel.h"
#include "core/materials/ggx.h"
#include "core/materials/hemisphere_mean.h"
#include "core/materials/local.h"
#include "core/materials/params.h"

namespace hyades::core {
namespace {

/// Rough interface; `ior` is the index of the side z < 0 over that of the other (Walter et al.
/// 2007, "Microfacet Models for Refraction through Rough Surfaces", equations 16, 20 and 21):
/// smooth facets, GGX distributed, of which one that is visible from wo is drawn; it then reflects
/// or refracts by its energy. Radiance gains (eta_o / eta_i)^2 in refraction as at a smooth
/// interface, or not (see dielectric.cpp).
class RoughDielectricBsdf final : public Bsdf {
 public:
  RoughDielectricBsdf(float ior, float alpha, const Rgb& transmission, const Rgb& reflection,
                      bool scale_radiance)
      : ior_(ior),
        facets_{alpha},
        transmission_(transmission),
        reflection_(reflection),
        scale_radiance_(scale_radiance) {}

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    const auto event = find_event(wo, wi);
    if (!event) return Rgb(0.0F);
    const float reflectance = event->reflectance;
    if (!event->refraction)
      return reflection_ * (reflectance * facets_.reflect(event->o, event->i));
    const float scaled = (1.0F - reflectance) * facets_.density(event->m) *
                         facets_.both_visible(event->o, above(event->i)) * event->o_m *
                         event->jacobian / (event->o.z * event->eta * event->eta);
    return transmission_ *
           (is_scaled(mode, scale_radiance_) ? scaled : scaled * event->eta * event->eta);
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode) const override {
    const auto event = find_event(wo, wi);
    return event ? density_of(*event) : 0.0F;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const override {
    const Vec3 o = above(wo);
    if (!(o.z > 0.0F)) return std::nullopt;
    const float eta = index_beyond(wo, ior_);
    const Vec3 m = facets_.sample_normal(o, u);
    const float o_m = glm::dot(o, m);
    if (!(o_m > 0.0F)) return std::nullopt;
    const auto [reflectance, cos_t] = fresnel_dielectric(std::fmin(o_m, 1.0F), eta);
    const float p_reflect = reflect_probability(reflectance);
    const bool reflects = lobe < p_reflect;
    if (!reflects && !(p_reflect < 1.0F)) return std::nullopt;

    // Snell's law in vectors: the part of o along the facet shrinks by eta.
    const Vec3 i = reflects ? reflected(o, m) : (o_m / eta - cos_t) * m - o / eta;
    if (reflects ? !(i.z > 0.0F) : !(i.z < 0.0F)) return std::nullopt;
    const Vec3 wi = glm::normalize(Vec3(i.x, i.y, i.z * side(wo)));
    const auto event = find_event(wo, wi);
    if (!event) return std::nullopt;
    const float density = density_of(*event);
    if (!(density > 0.0F)) return std::nullopt;

    BsdfSample s{.pdf = density, .wi = wi};
    if (reflects) {
      s.weight = reflection_ * (reflectance / p_reflect * facets_.reflect_weight(o, i));
      return s;
    }
    s.transmitted = true;
    s.eta = eta;
    s.scale_radiance = scale_radiance_;
    const float seen = facets_.both_visible(o, above(i)) / facets_.visible(o);
    s.weight = transmission_ * ((1.0F - reflectance) / (1.0F - p_reflect) * seen);
    if (is_scaled(mode, scale_radiance_)) s.weight *= 1.0F / (eta * eta);
    return s;
  }

  /// Of what it reflects; what it lets through is beneath the layers on one side only.
  Spread spread(float outer) const override {
    const float eta = outer < 0.0F ? 1.0F / ior_ : ior_;
    const float mean =
        hemisphere_mean([&](float cosine) { return fresnel_dielectric(cosine, eta).reflectance; });
    return {.lobe = mean * reflection_, .alpha = facets_.alpha};
  }

  Rgb albedo(const Vec3& wo) const override {
    const float r = fresnel_dielectric(std::abs(wo.z), index_beyond(wo, ior_)).reflectance;
    return reflection_ * r + transmission_ * (1.0F - r);
  }

 private:
  /// How light gets from wi to wo, seen with wo above.
  struct Event {
    Vec3 o, i, m;  ///< m: the facet's unit normal, on the side of o
    float eta = 1.0F;
    float o_m = 0.0F;
    float reflectance = 0.0F;  ///< Fresnel's
    bool refraction = false;
    float jacobian = 0.0F;  ///< of refraction: solid angle of m over that of wi
  };

  float reflect_probability(float reflectance) const {
    const float reflect = reflectance * max_component(reflection_);
    const float transmit = (1.0F - reflectance) * max_component(transmission_);
    return reflect + transmit > 0.0F ? reflect / (reflect + transmit) : 1.0F;
  }

  std::optional<Event> find_event(const Vec3& wo, const Vec3& wi) const {
    if (wo.z == 0.0F || wi.z == 0.0F) return std::nullopt;
    Event e;
    e.o = above(wo);
    e.i = {wi.x, wi.y, wi.z * side(wo)};
    e.eta = index_beyond(wo, ior_);
    e.refraction = e.i.z < 0.0F;
    const Vec3 h = e.refraction ? e.o + e.eta * e.i : e.o + e.i;
    const float length2 = glm::dot(h, h);
    if (!(length2 > 0.0F)) return std::nullopt;
    e.m = h / std::copysign(std::sqrt(length2), h.z);
    e.o_m = glm::dot(e.o, e.m);
    const float i_m = glm::dot(e.i, e.m);
    // A facet shows each direction the face that the surface shows it.
    if (!(e.o_m > 0.0F) || !(e.refraction ? i_m < 0.0F : i_m > 0.0F)) return std::nullopt;
    e.reflectance = fresnel_dielectric(std::fmin(e.o_m, 1.0F), e.eta).reflectance;
    if (e.refraction) {
      const float sum = e.o_m + e.eta * i_m;
      e.jacobian = e.eta * e.eta * -i_m / (sum * sum);
    }
    return e;
  }

  float density_of(const Event& e) const {
    const float p_reflect = reflect_probability(e.reflectance);
    if (!e.refraction) return p_reflect * facets_.reflect_pdf(e.o, e.i);
    return (1.0F - p_reflect) * facets_.visible(e.o) * facets_.density(e.m) * e.o_m * e.jacobian /
           e.o.z;
  }

  float ior_;
  Ggx facets_;
  Rgb transmission_;
  Rgb reflection_;
  bool scale_radiance_;
};

/// A rough dielectric that gives back the light that it loses to second facets. How much of that
/// goes where depends on (1 - E) cos: nearly on the cosine where much is lost, and nearly on
/// nothing where little is. Half of the samples of its lobes do each.
class FullDielectricBsdf final : public Bsdf {
 public:
  FullDielectricBsdf(float ior, float alpha, const Rgb& transmission, const Rgb& reflection,
                     bool scale_radiance)
      : single_(ior, alpha, transmission, reflection, scale_radiance),
        scale_radiance_(scale_radiance),
        lost_(ior, alpha, transmission, reflection),
        ior_(ior),
        brightest_(std::fmax(max_component(transmission), max_component(reflection))) {}

  Rgb evaluate(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    if (wo.z == 0.0F || wi.z == 0.0F) return Rgb(0.0F);
    Rgb lost = lost_.evaluate(wo, wi);
    if (is_scaled(mode, scale_radiance_) && !same_side(wo, wi)) {
      const float eta = index_beyond(wo, ior_);
      lost *= 1.0F / (eta * eta);
    }
    return single_.evaluate(wo, wi, mode) + lost;
  }

  float pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
    return pdf(lobes_of(wo), wo, wi, mode);
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float lobe, const Vec2& u,
                                   TransportMode mode) const override {
    const Lobes p = lobes_of(wo);
    BsdfSample s;
    if (lobe < p.reflected + p.transmitted) {
      s.transmitted = lobe >= p.reflected;
      const float begin = s.transmitted ? p.reflected : 0.0F;
      const float width = s.transmitted ? p.transmitted : p.reflected;
      const Vec3 i = lobe < begin + 0.5F * width ? square_to_cosine_hemisphere(u)
                                                 : square_to_uniform_hemisphere(u);
      s.wi = {i.x, i.y, s.transmitted ? -i.z * side(wo) : i.z * side(wo)};
    } else {
      const float single = 1.0F - p.reflected - p.transmitted;
      const auto drawn =
          single_.sample(wo, rest_of(lobe, p.reflected + p.transmitted, single), u, mode);
      if (!drawn) return std::nullopt;
      s.wi = drawn->wi;
      s.transmitted = drawn->transmitted;
    }
    if (s.transmitted) s.eta = index_beyond(wo, ior_);
    s.scale_radiance = scale_radiance_;
    s.pdf = pdf(p, wo, s.wi, mode);
    if (!(s.pdf > 0.0F)) return std::nullopt;
    s.weight = evaluate(wo, s.wi, mode) / s.pdf;
    return s;
  }

  Rgb albedo(const Vec3& wo) const override { return single_.albedo(wo); }

  Spread spread(float outer) const override { return single_.spread(outer); }

 private:
  /// Probabilities of the lobes of lost light; the rest is for single scattering.
  struct Lobes {
    float reflected = 0.0F;
    float transmitted = 0.0F;
  };

  Lobes lobes_of(const Vec3& wo) const {
    const float part = lost_.part(wo);
    const float share = lost_.reflected_share(wo);
    const float reflected = part * share * max_component(lost_.reflected_tint(wo));
    const float transmitted = part * (1.0F - share) * max_component(lost_.transmitted_tint());
    const float all = reflected + transmitted + (1.0F - part) * brightest_;
    return all > 0.0F ? Lobes{reflected / all, transmitted / all} : Lobes{};
  }

  float pdf(const Lobes& p, const Vec3& wo, const Vec3& wi, TransportMode mode) const {
    if (wo.z == 0.0F || wi.z == 0.0F) return 0.0F;
    const float lost = same_side(wo, wi) ? p.reflected : p.transmitted;
    return (1.0F - p.reflected - p.transmitted) * single_.pdf(wo, wi, mode) +
           lost * 0.5F * (cosine_hemisphere_pdf(std::fabs(wi.z)) + uniform_hemisphere_pdf());
  }

  RoughDielectricBsdf single_;
  bool scale_radiance_;
  LostGlassLight lost_;
  float ior_;
  float brightest_;  ///< the most that single scattering keeps of any colour
};

class RoughDielectric final : public Material {
 public:
  RoughDielectric(float ior, const Rgb& transmission, const Rgb& reflection, ScalarParam roughness,
                  FacetScattering scattering, bool scale_radiance)
      : ior_(ior),
        transmission_(unit_clamp(transmission)),
        reflection_(unit_clamp(reflection)),
        roughness_(std::move(roughness)),
        scattering_(scattering),
        scale_radiance_(scale_radiance) {}

  const Bsdf* bsdf_at(const SurfacePoint& point, Frame&, BsdfArena& arena) const override {
    const float roughness = fraction_at(roughness_, point);
    return dielectric_bsdf(ior_ / point.outside_index, roughness * roughness, transmission_,
                           reflection_, scattering_, scale_radiance_, arena);
  }
  bool leads_inside() const override { return true; }
  float index() const override { return ior_; }

 private:
  float ior_;
  Rgb transmission_;
  Rgb reflection_;
  ScalarParam roughness_;
  FacetScattering scattering_;
  bool scale_radiance_;
};

}  // namespace

const Bsdf* dielectric_bsdf(float ior, float alpha, const Rgb& transmission, const Rgb& reflection,
                            FacetScattering scattering, bool scale_radiance, BsdfArena& arena) {
  if (alpha < Ggx::kLeastAlpha || ior == 1.0F)
    return smooth_dielectric_bsdf(ior, transmission, reflection, scale_radiance, arena);
  if (scattering == FacetScattering::multiple)
    return arena.make<FullDielectricBsdf>(ior, alpha, transmission, reflection, scale_radiance);
  return arena.make<RoughDielectricBsdf>(ior, alpha, transmission, reflection, scale_radiance);
}

MaterialPtr make_rough_dielectric(float ior, const Rgb& transmission, const Rgb& reflection,
                                  const ScalarParam& roughness, FacetScattering scattering,
                                  bool scale_radiance) {
  return std::make_shared<RoughDielectric>(ior, transmission, reflection, roughness, scattering,
                                           scale_radiance);
}

}  // namespace hyades::core
