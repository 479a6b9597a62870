#pragma once

#include <array>

#include "core/base/vec.h"

namespace hyades::core {

/// Light thrown back by fuzz: fibres that stand up from the surface, bright where one looks along
/// it (Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF": equations 2 to 4 and
/// the fit of table 1). Reciprocal; reflects less than what comes, E(cos theta_o). Directions are
/// local and above the surface.
class Fuzz {
 public:
  /// `roughness` in [0, 1]: how much the fibres lean in all directions; below 0.3 it is 0.3.
  explicit Fuzz(float roughness);

  /// f cos(theta_i).
  float reflect(const Vec3& wo, const Vec3& wi) const;

  /// E: what of uniform light goes to a direction at `cosine` in [0, 1]; tabulated within 0.003
  /// (0.007 within half a degree of the surface).
  float reflectance(float cosine) const;

  /// The mean of reflectance() over the hemisphere, weighed with the cosine.
  float mean_reflectance() const;

 private:
  /// Smith's Lambda, for the fibres.
  float hidden(float cosine) const;

  float exponent_;  ///< 1 / alpha, alpha = roughness^2
  float scale_;     ///< of the density of normals
  float a_, b_, c_, d_, e_;
  float middle_;  ///< the exponent of Lambda at cosine 1/2
  float row_;     ///< where in the table
};

}  // namespace hyades::core
