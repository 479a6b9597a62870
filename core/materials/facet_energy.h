#pragma once

#include <array>

#include "core/materials/energy_grid.h"
#include "core/materials/ggx.h"

namespace hyades::core {

/// What GGX facets of one relative index give off again by single scattering, reflected and
/// transmitted together: E(cos theta_o, alpha). The rest really bounces between facets and comes
/// out nearly diffuse (Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks").
/// Tabulated by quadrature (about 10 ms, where light may be totally reflected 20); E is within
/// 0.001 (one standard deviation; 0.008 near the critical angle of sharp lobes).
class FacetEnergy {
 public:
  /// The table of facets that reflect everything; made at first use.
  static const FacetEnergy& table();

  /// `eta` >= 0: index of the other side over that of the side where light arrives; infinite where
  /// everything is reflected.
  explicit FacetEnergy(float eta);

  /// Where in any table the values for a direction at `cosine` in [0, 1] and alpha in [0, 1] are.
  struct Place {
    Place(float cosine, float alpha);
    GridPlace row, column;
  };

  float reflectance(const Place& place) const;
  float reflectance(float cosine, float alpha) const { return reflectance(Place(cosine, alpha)); }

  /// The mean over the hemisphere of 1 - E, weighed with the cosine: 2 integral of (1 - E) mu dmu.
  float mean_loss(float alpha) const;

 private:
  static constexpr int kCosines = 48;
  static constexpr int kAlphas = 24;  ///< rows, even in roughness
  static constexpr int kMeans = 128;  ///< even in roughness, since what is lost grows with alpha^2

  std::array<std::array<float, kCosines>, kAlphas> reflectance_;
  std::array<float, kMeans> mean_loss_;
};

/// The lobe that gives back what single scattering of `facets` loses: reciprocal, and for facets
/// that reflect everything the two together reflect everything. Directions as for Ggx.
class LostLight {
 public:
  explicit LostLight(float alpha)
      : alpha_(alpha), mean_loss_(FacetEnergy::table().mean_loss(alpha)) {}

  /// 1 - E(wo): the lobe's reflectance for facets that reflect everything; picks the lobe.
  float part(const Vec3& wo) const { return 1.0F - FacetEnergy::table().reflectance(wo.z, alpha_); }

  /// f cos(theta_i) of facets that reflect everything (equation 10).
  float reflect(const Vec3& wo, const Vec3& wi) const {
    return mean_loss_ > 0.0F ? part(wo) * part(wi) * kInvPi * wi.z / mean_loss_ : 0.0F;
  }

  /// What facets of mean reflectance `f` make of that: each further bounce is reflected by f, and
  /// of what remains the mean of E escapes: f^2 E / (1 - f (1 - E)) (Hill 2018, "A Multi-Faceted
  /// Exploration", part 2).
  Rgb tint(const Rgb& f) const {
    return f * f * (1.0F - mean_loss_) / (Rgb(1.0F) - f * mean_loss_);
  }

 private:
  float alpha_;
  float mean_loss_;
};

}  // namespace hyades::core
