#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <map>
#include <vector>

#include "core/base/vec.h"

namespace hyades::core::pbrt {

/// The layer on top of a coated material of pbrt.
struct CoatLayer {
  float eta = 1.5F;         ///< index over that of what is around, >= 1
  float alpha = 0.0F;       ///< of its GGX facets; below Ggx::kLeastAlpha it is smooth
  float thickness = 0.01F;  ///< free paths of what is between the surfaces, >= 0
  float g = 0.0F;           ///< mean cosine of what scatters there
  bool scatters = false;    ///< else what is between absorbs only
  int events = 10;          ///< where pbrt breaks its random walk off: "maxdepth"

  friend auto operator<=>(const CoatLayer&, const CoatLayer&) = default;
};

/// What a matt base gives back through a layer: of light that arrives evenly from all sides, the
/// share that comes out again, what the layer's surface reflects at once left out. A power series
/// of the base's reflectance and of what is between, for light that meets the base k and is
/// scattered m times.
class LayerAnswer {
 public:
  /// Walks at random as pbrt's LayeredBxDF does (Guo, Hasan and Zhao 2018, "Position-Free Monte
  /// Carlo Simulation for Arbitrary Layered BSDFs"): facets scatter once and lose the rest, and a
  /// walk that lasts too long is lost. Always the same numbers for the same arguments.
  LayerAnswer(const CoatLayer& layer, int walks);

  /// The share for a base of reflectance `base` and an albedo of what is between, both 0..1.
  float share(float base, float albedo) const;
  /// The share that never met the base, and that which met it once, per reflectance.
  float scattered_only(float albedo) const { return factor(0, albedo); }
  float once(float albedo) const { return factor(1, albedo); }

 private:
  float factor(size_t hits, float albedo) const;

  std::vector<std::vector<float>> shares_;  ///< [k][m]
};

/// Answers of the layers of a scene, each computed once. The first ones are within 0.002; where a
/// scene has very many different ones, further ones within 0.01.
class LayerAnswers {
 public:
  const LayerAnswer& of(const CoatLayer& layer);

 private:
  std::map<CoatLayer, LayerAnswer> known_;
};

}  // namespace hyades::core::pbrt
