#pragma once

#include "core/base/vec.h"
#include "core/materials/facet_energy.h"

namespace hyades::core {

/// FacetEnergy of rough glass as one of its sides sees it, for any relative index: interpolated
/// between tables at fixed indices, each made at first use. Cheap to make; thread-safe.
class DielectricEnergy {
 public:
  /// `eta` > 0: index of the other side over that of this one.
  explicit DielectricEnergy(float eta);

  float reflectance(float cosine, float alpha) const;
  float mean_loss(float alpha) const;

 private:
  const FacetEnergy* low_;
  const FacetEnergy* high_;
  float part_;
};

/// What single scattering of rough glass loses, given back in two nearly diffuse lobes on either
/// side (Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks"). With E_a(mu)
/// what single scattering leaves of light on side a, l_a the mean of 1 - E_a, and r_a the share
/// that is reflected,
///   f_reflected = r_a (1 - E_a(o)) (1 - E_a(i)) / (pi l_a),
///   f_transmitted = (1 - r_a) (1 - E_a(o)) (1 - E_b(i)) / (pi l_b),
/// reciprocal where (1 - r_a) eta_a^2 l_a = (1 - r_b) eta_b^2 l_b. Of diffuse light smooth facets
/// transmit 1 - F_a, with eta_a^2 (1 - F_a) the same on both sides; here lost light does so from
/// the side that loses less, and less from the other as reciprocity demands:
/// 1 - r_a = (1 - F_a) l_b / max(l_a, l_b). Kulla and Conty divide by l_a + l_b, which would
/// reflect half of it where indices hardly differ; random walks on the facets (Heitz et al. 2016,
/// "Multiple-Scattering Microfacet BSDFs with the Smith Model") agree with this one.
class LostGlassLight {
 public:
  /// `ior`: index of the side z < 0 over that of z > 0. The tints are those of each event.
  LostGlassLight(float ior, float alpha, const Rgb& transmission, const Rgb& reflection);

  /// 1 - E(w): what becomes of single scattering's loss where nothing is tinted.
  float part(const Vec3& w) const;

  /// The share of light that an untinted interface loses from the side of `w` and that comes back
  /// on that side: r_a.
  float reflected_share(const Vec3& w) const { return sides_[w.z < 0.0F].reflected; }

  /// f |cos theta_i| as importance sees it.
  Rgb evaluate(const Vec3& wo, const Vec3& wi) const;

  /// Tints of the lobes. Every further facet keeps the part f of the light, f being the mean of
  /// both tints by how often smooth facets do which, and lets 1 - l of it escape; the sum of that
  /// is g = f (1 - l) / (1 - f l) (Hill 2018, "A Multi-Faceted Exploration", part 2). What is
  /// reflected meets one more facet (f g). What is transmitted went through one (transmission g,
  /// with the mean of both sides' g, so that it is reciprocal).
  const Rgb& reflected_tint(const Vec3& w) const { return sides_[w.z < 0.0F].tint; }
  const Rgb& transmitted_tint() const { return transmitted_tint_; }

 private:
  struct Side {
    DielectricEnergy energy;
    float loss = 0.0F;       ///< l
    float reflected = 0.0F;  ///< r
    float scale = 0.0F;      ///< 1 / (pi l)
    Rgb tint{0.0F};
  };

  float alpha_;
  Side sides_[2];  ///< z > 0, z < 0
  Rgb transmitted_tint_{0.0F};
};

}  // namespace hyades::core
