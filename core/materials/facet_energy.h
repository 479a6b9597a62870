#pragma once

#include <array>

#include "core/materials/ggx.h"

namespace hyades::core {

/// What white GGX facets reflect by single scattering, E(cos theta_o, alpha), and the rest, which
/// really bounces between facets and comes out nearly diffuse (Kulla and Conty 2017, "Revisiting
/// Physically Based Shading at Imageworks"). Tabulated once, at first use, by quadrature (tens of
/// milliseconds); E is within 0.002.
class FacetEnergy {
 public:
  static const FacetEnergy& table();

  /// E for a direction at `cosine` in [0, 1]; alpha in [0, 1].
  float reflectance(float cosine, float alpha) const;

  /// The mean over the hemisphere of 1 - E, weighed with the cosine: 2 integral of (1 - E) mu dmu.
  float mean_loss(float alpha) const;

 private:
  static constexpr int kCosines = 32;
  static constexpr int kAlphas = 32;  ///< rows, even in alpha
  static constexpr int kMeans = 128;  ///< even in roughness, since what is lost grows with alpha^2

  FacetEnergy();

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
