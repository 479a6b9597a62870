#pragma once

#include "core/base/vec.h"

namespace hyades::core {

/// Into which directions a medium scatters light: a phase function, or two of them blended. Values
/// are per steradian and channel, functions of the cosine between the directions of travel before
/// and after (1: straight on), and integrate to 1 over the sphere. Sampling is exact for grey
/// functions; where channels differ, one of them is chosen with the probabilities `shares` (which
/// add up to 1) and pdf() is the mixture's. Immutable.
class Phase {
 public:
  /// Henyey and Greenstein 1941: p = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)), g in (-1, 1) is
  /// the mean cosine. 0 is isotropic.
  static Phase henyey_greenstein(const Rgb& g);

  /// (1 - blend) of one Henyey-Greenstein lobe and `blend` (0..1) of another.
  static Phase two_lobes(const Rgb& g, const Rgb& other_g, float blend);

  /// Particles far smaller than the wavelength: p = 3 (1 + cos^2) / (16 pi).
  static Phase rayleigh();

  Rgb evaluate(float cosine) const;

  /// Density of sample() per steradian.
  float pdf(float cosine, const Rgb& shares) const;

  /// A direction after unit `travel`; `pick` chooses channel and lobe, all in [0, 1).
  Vec3 sample(const Vec3& travel, const Rgb& shares, float pick, const Vec2& u) const;

 private:
  Rgb g_{0.0F};
  Rgb other_g_{0.0F};
  float blend_ = 0.0F;  ///< share of the other lobe
  bool rayleigh_ = false;
};

}  // namespace hyades::core
