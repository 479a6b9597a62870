#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/vec.h"
#include "core/materials/energy_grid.h"
#include "core/materials/hemisphere_mean.h"
#include "core/materials/spread.h"

namespace hyades::core {

/// What is lost where a layer that lets T(cosine) through weighs what lies beneath by the lesser of
/// T(o) and T(i): for what reflects everything, D(o) = mean over i of max(0, T(o) - T(i)). The
/// cosines where white facets (with what they throw onto each other) and even surfaces send light
/// are tabulated as quantiles, Gauss and Legendre's six.
class LayerLoss {
 public:
  static constexpr int kQuantiles = 6;

  /// `beneath`: T of a cosine. Cheap: 17 of its values.
  template <class Beneath>
  LayerLoss(const Beneath& beneath, float alpha) : alpha_(alpha) {
    for (int n = 0; n < kNodes; ++n) {
      const float x = static_cast<float>(n) / (kNodes - 1);
      beneath_[n] = beneath(x * x);
    }
    for (int q = 0; q < kQuantiles; ++q) even_[q] = at(std::sqrt(kPlaces[q]));
  }

  /// T, as it is used here.
  float at(float cosine) const { return GridPlace::at(std::sqrt(cosine), kNodes).in(beneath_); }

  /// D of facets.
  float of_lobe(float cosine) const;

  /// D of what scatters evenly.
  float of_wide(float cosine) const {
    const float here = at(cosine);
    float sum = 0.0F;
    for (int q = 0; q < kQuantiles; ++q) sum += kWeights[q] * std::max(0.0F, here - even_[q]);
    return sum;
  }

 private:
  static constexpr int kNodes = 17;  ///< even in the root of the cosine
  static constexpr std::array<float, kQuantiles> kPlaces = {
      0.033765243F, 0.169395307F, 0.380690407F, 0.619309593F, 0.830604693F, 0.966234757F};
  static constexpr std::array<float, kQuantiles> kWeights = {
      0.085662246F, 0.180380787F, 0.233956967F, 0.233956967F, 0.180380787F, 0.085662246F};

  friend class FacetQuantiles;

  float alpha_;
  std::array<float, kNodes> beneath_;
  std::array<float, kQuantiles> even_;
};

/// The lobe that gives back what a layer loses so: G(o) G(i) / (pi mean G) per channel, reciprocal,
/// with G = D times what lies beneath; for white surfaces it is exactly what lacks. Light that the
/// layer throws down meets the surface again, and of what that reflects the same share is thrown
/// down once more (Hill 2018, "A Multi-Faceted Exploration", part 2, for facets).
class LayerLight {
 public:
  /// `loss` of the layer, `beneath` of what lies there, `all`: its mean reflectance, where that is
  /// more than `beneath` tells.
  LayerLight(const LayerLoss& loss, const Spread& beneath, const Rgb& all);

  /// What of the light from `cosine` comes back on this side and on the other: the lobe's weight
  /// when one is chosen.
  Rgb part(float cosine) const { return lost(cosine) * again_; }
  float through_share() const { return through_; }

  /// f of both directions' cosines; on the other side where `through`.
  Rgb value(float o, float i, bool through) const {
    const Rgb both = lost(o) * lost(i) * scale_;
    return through ? both * through_tint_ : both * back_tint_;
  }

  bool is_none() const { return none_; }

 private:
  /// G.
  Rgb lost(float cosine) const {
    Rgb sum(0.0F);
    if (wide_ != Rgb(0.0F)) sum += wide_ * loss_.of_wide(cosine);
    if (lobe_ != Rgb(0.0F)) sum += lobe_ * loss_.of_lobe(cosine);
    return sum;
  }

  LayerLoss loss_;
  Rgb wide_;
  Rgb lobe_;
  Rgb again_{0.0F};
  Rgb scale_{0.0F};
  Rgb back_tint_{0.0F};
  Rgb through_tint_{0.0F};
  float through_ = 0.0F;
  bool none_ = true;
};

}  // namespace hyades::core
