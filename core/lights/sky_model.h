#pragma once

#include <vector>

#include "core/base/vec.h"

namespace hyades::core {

/// The Earth's air, clear or hazy, lit by a sun of irradiance 1 (in each channel) above it, as seen
/// from the ground: scattering by molecules (Rayleigh) and haze (Mie), absorption by haze and
/// ozone.
///
/// Sources: the coefficients of molecules and ozone and the estimate of multiply scattered light
/// are those of Hillaire 2020, "A Scalable and Production Ready Sky and Atmosphere Rendering
/// Technique" (table 1, sections 5.2 and 5.5); the table of transmittance is laid out as in
/// Bruneton & Neyret 2008, "Precomputed Atmospheric Scattering" (section 4). Haze has the height
/// of 1.2 km, albedo 0.9 and mean cosine 0.8 given there; how much there is follows from the
/// turbidity, the ratio of the optical thickness of air and haze to that of air alone at 550 nm,
/// its colour from Angstrom's exponent 1.3 (both as in Preetham, Shirley & Smits 1999, "A Practical
/// Analytic Model for Daylight", appendix A).
///
/// Immutable and thread-safe. Making one takes about a tenth of a second.
class SkyModel {
 public:
  /// `turbidity` >= 1: 1 is pure air, 2 a clear day, 3 usual, 6 hazy. `ground_albedo` 0..1.
  SkyModel(float turbidity, const Rgb& ground_albedo);

  /// What is left of light that comes in from a direction `sine` above the horizon (the sine of the
  /// elevation), on the ground. Black below the horizon.
  Rgb transmittance(float sine) const;

  /// Radiance arriving on the ground from unit `direction` (y up) while the sun stands in unit
  /// direction `sun`: of the sky, without the sun itself. Below the horizon: of the ground, as the
  /// sun alone lights it.
  Rgb radiance(const Vec3& direction, const Vec3& sun) const;

 private:
  /// Per metre at some height.
  struct Matter {
    Rgb rayleigh, mie, extinction;
    Rgb scattering() const { return rayleigh + mie; }
  };
  Matter matter(float height) const;

  /// The share of light that is left on a way from `radius` (from the Earth's middle) in a
  /// direction of cosine `mu` to the zenith, to the top of the air.
  Rgb to_space(float radius, float mu) const;
  Rgb integrate_to_space(float radius, float mu) const;
  /// The sun's light at a place: nothing where the Earth is in the way.
  Rgb sunlight(float radius, float mu) const;
  Rgb multiple(float radius, float mu_sun) const;

  void tabulate_transmittance();
  void tabulate_multiple();

  /// What a ray gathers: all light, and what isotropic light of radiance 1 everywhere would give.
  struct Gathered {
    Rgb light{0.0F};
    Rgb transfer{0.0F};
  };
  enum class Phases { real, isotropic };
  Gathered gather(float radius, const Vec3& direction, const Vec3& sun, int steps,
                  Phases phases) const;

  Rgb mie_scattering_;
  Rgb mie_extinction_;
  Rgb ground_albedo_;
  std::vector<Rgb> transmittance_;  ///< rows by radius
  std::vector<Rgb> multiple_;       ///< rows by radius, columns by the sun's height
};

}  // namespace hyades::core
