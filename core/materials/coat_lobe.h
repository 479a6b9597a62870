#pragma once

#include <cmath>

#include "core/base/warp.h"
#include "core/materials/fresnel.h"
#include "core/materials/ggx.h"
#include "core/materials/interface_energy.h"
#include "core/materials/local.h"
#include "core/materials/sheen.h"
#include "core/materials/spread.h"

/// What lies on top of other surfaces: each reflects a part of the light and lets the rest through.
/// Directions are local and on the upper side.
namespace hyades::core {

/// What every lobe on top tells.
///   share(w): the part of light from `w` that it reflects, 0..1
///   mean_share(): its mean over the hemisphere, weighed with the cosine
///   spread(): how widely it reflects
///   reflect(o, i), pdf(o, i), draw(o, u): f cos(theta_i), its sampling
///   is_mirror(), mirror(o): a delta lobe, and what it reflects; the others are then 0

/// Clear varnish: GGX facets of a dielectric, alpha = roughness^2, that cover the part `amount`.
class CoatLobe {
 public:
  /// `eta`: index of the coat over that of what is around.
  CoatLobe(float amount, float eta, float alpha)
      : energy_(eta), facets_{alpha}, amount_(amount), eta_(eta) {}

  float share(const Vec3& w) const { return amount_ * energy_.reflected(w.z, facets_.alpha); }
  float mean_share() const { return amount_ * (1.0F - energy_.mean_rest(facets_.alpha)); }
  bool is_mirror() const { return facets_.alpha < Ggx::kLeastAlpha; }
  Rgb mirror(const Vec3& o) const {
    return Rgb(amount_ * fresnel_dielectric(o.z, eta_).reflectance);
  }

  Spread spread() const {
    return is_mirror() ? Spread() : Spread{.lobe = Rgb(mean_share()), .alpha = facets_.alpha};
  }

  Rgb reflect(const Vec3& o, const Vec3& i) const {
    if (is_mirror()) return Rgb(0.0F);
    const float value = facets_.reflect(o, i);
    if (!(value > 0.0F)) return Rgb(0.0F);
    const Vec3 h = o + i;
    const float cosine = std::fmin(1.0F, glm::dot(o, h) / glm::length(h));
    return Rgb(amount_ * fresnel_dielectric(cosine, eta_).reflectance * value);
  }
  float pdf(const Vec3& o, const Vec3& i) const {
    return is_mirror() ? 0.0F : facets_.reflect_pdf(o, i);
  }
  Vec3 draw(const Vec3& o, const Vec2& u) const {
    return reflected(o, facets_.sample_normal(o, u));
  }

 private:
  InterfaceEnergy energy_;
  Ggx facets_;
  float amount_;
  float eta_;
};

/// Fuzz of a colour.
class FuzzLobe {
 public:
  FuzzLobe(const Rgb& color, float roughness)
      : fuzz_(roughness), color_(color), most_(max_component(color)) {}

  Spread spread() const { return {.wide = color_ * fuzz_.mean_reflectance()}; }
  float share(const Vec3& w) const { return most_ * fuzz_.reflectance(w.z); }
  float mean_share() const { return most_ * fuzz_.mean_reflectance(); }
  static constexpr bool is_mirror() { return false; }
  static Rgb mirror(const Vec3&) { return Rgb(0.0F); }
  Rgb reflect(const Vec3& o, const Vec3& i) const { return color_ * fuzz_.reflect(o, i); }
  static float pdf(const Vec3&, const Vec3&) { return uniform_hemisphere_pdf(); }
  static Vec3 draw(const Vec3&, const Vec2& u) { return square_to_uniform_hemisphere(u); }

 private:
  Fuzz fuzz_;
  Rgb color_;
  float most_;
};

}  // namespace hyades::core
