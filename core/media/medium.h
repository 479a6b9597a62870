#pragma once

#include <optional>

#include "core/base/ray.h"
#include "core/base/vec.h"
#include "core/media/phase.h"

namespace hyades::core {

/// What becomes of light on its way through a medium.
struct MediumSample {
  /// Scattered: transmittance times the scattering coefficient over the density with which this
  /// place was chosen. Passed: transmittance over the probability of passing.
  Rgb weight{1.0F};
  float t = 0.0F;          ///< where it scatters, below the end of the way
  bool scattered = false;  ///< else it reaches the end
};

/// How a place on the way compares as one to scatter at.
struct FlightDensity {
  Rgb scattered{0.0F};  ///< transmittance times the scattering coefficient [1/m]
  float pdf = 0.0F;     ///< density with which Medium::sample scatters there [1/m]
};

/// What fills space between surfaces. Coefficients are per metre, and channels of linear Rec.709.
/// Immutable and thread-safe; belongs to one frame.
class Medium {
 public:
  virtual ~Medium() = default;

  /// Free flight from the ray's origin to `t_max` (may be infinite), an unbiased estimate whatever
  /// `shares` (probabilities of the channels, which add up to 1) are; they should be in proportion
  /// to what the path carries. `u` in [0, 1)^4.
  virtual MediumSample sample(const Ray& ray, float t_max, const Rgb& shares,
                              const Vec4& u) const = 0;

  /// The density of free flight at `t` below the end of the way, where it is known: in media that
  /// are the same everywhere.
  virtual std::optional<FlightDensity> flight_density(float /*t*/, const Rgb& /*shares*/) const {
    return std::nullopt;
  }

  /// An unbiased estimate of the share of light that reaches `t_max` unscattered.
  virtual Rgb transmittance(const Ray& ray, float t_max, const Vec4& u) const = 0;

  /// An unbiased estimate of the radiance that the way to `t_max` gives off towards the ray's
  /// origin, what the medium itself swallows taken off.
  virtual Rgb emitted(const Ray& ray, float t_max, const Vec4& u) const = 0;

  virtual const Phase& phase() const = 0;

  /// Share of extinction that is scattering, at a place; for the albedo layer.
  virtual Rgb albedo(const Vec3& position) const = 0;
};

}  // namespace hyades::core
