#include "core/materials/layer_loss.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/base/fp_mode.h"
#include "core/materials/facet_energy.h"

namespace hyades::core {

/// Cosines below which white facets send given parts of the light from one direction.
class FacetQuantiles {
 public:
  static constexpr int kCosines = 20;  ///< even in the root of the cosine
  static constexpr int kWidths = 16;   ///< even in the root of alpha
  using Quantiles = std::array<float, LayerLoss::kQuantiles>;

  static const FacetQuantiles& table() {
    static const FacetQuantiles made;
    return made;
  }

  /// Calls `use` with the number and the cosine of each.
  template <class Use>
  void each(float cosine, float alpha, const Use& use) const {
    const auto width = GridPlace::at(std::sqrt(alpha), kWidths);
    const auto column = GridPlace::at(std::sqrt(cosine), kCosines);
    const auto& low = of_[width.node];
    const auto& high = of_[width.node + 1];
    for (size_t q = 0; q < LayerLoss::kQuantiles; ++q) {
      const float narrow = lerp(low[column.node][q], low[column.node + 1][q], column.part);
      const float wide = lerp(high[column.node][q], high[column.node + 1][q], column.part);
      use(q, lerp(narrow, wide, width.part));
    }
  }

 private:
  struct Sent {
    float cosine;
    float weight;
  };

  FacetQuantiles() {
    // The table is part of the picture: the same bits whoever asks first.
    const FpMode mode;
    for (int row = 0; row < kWidths; ++row) {
      const float root = static_cast<float>(row) / (kWidths - 1);
      for (int column = 0; column < kCosines; ++column) {
        const float x = static_cast<float>(column) / (kCosines - 1);
        of_[row][column] = quantiles(x * x, root * root);
      }
    }
  }

  static Quantiles quantiles(float cosine, float alpha) {
    Quantiles found;
    if (alpha < Ggx::kLeastAlpha) {
      found.fill(cosine);
      return found;
    }
    std::vector<Sent> sent = sent_from(std::max(cosine, 1e-6F), alpha);
    std::sort(sent.begin(), sent.end(), [](const Sent& a, const Sent& b) {
      return a.cosine != b.cosine ? a.cosine < b.cosine : a.weight < b.weight;
    });
    double all = 0.0;
    for (const Sent& s : sent) all += double{s.weight};
    double below = 0.0;
    size_t next = 0;
    for (size_t q = 0; q < found.size(); ++q) {
      const double wanted = double{LayerLoss::kPlaces[q]} * all;
      while (next + 1 < sent.size() && below + double{sent[next].weight} < wanted)
        below += double{sent[next++].weight};
      found[q] = sent[next].cosine;
    }
    return found;
  }

  /// By single scattering, over a lattice of the golden ratio; and by further ones (LostLight).
  static std::vector<Sent> sent_from(float cosine, float alpha) {
    constexpr int kPoints = 512;
    constexpr int kSteps = 64;
    constexpr float kGoldenRatio = 0.618033988749895F;
    const Ggx facets{alpha};
    const Vec3 wo(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
    std::vector<Sent> sent;
    float v = 0.5F;
    for (int i = 0; i < kPoints; ++i) {
      const float u = (static_cast<float>(i) + 0.5F) / kPoints;
      v += kGoldenRatio;
      if (v >= 1.0F) v -= 1.0F;
      const Vec3 back = reflected(wo, facets.sample_normal(wo, {v, 0.5F + 0.5F * u}));
      if (back.z > 0.0F)
        sent.push_back({std::min(back.z, 1.0F), facets.reflect_weight(wo, back) / kPoints});
    }
    const LostLight lost(alpha);
    for (int i = 0; i < kSteps; ++i) {
      const float z = std::sqrt((static_cast<float>(i) + 0.5F) / kSteps);
      const Vec3 wi(0.0F, std::sqrt(1.0F - z * z), z);
      sent.push_back({z, lost.reflect(wo, wi) * kPi / (z * kSteps)});
    }
    return sent;
  }

  std::array<std::array<Quantiles, kCosines>, kWidths> of_;
};

float LayerLoss::of_lobe(float cosine) const {
  const float here = at(cosine);
  float sum = 0.0F;
  FacetQuantiles::table().each(cosine, alpha_, [&](size_t q, float there) {
    sum += kWeights[q] * std::max(0.0F, here - at(there));
  });
  return sum;
}

LayerLight::LayerLight(const LayerLoss& loss, const Spread& beneath, const Rgb& all)
    : loss_(loss),
      wide_(beneath.wide + beneath.wide_through),
      lobe_(beneath.lobe + beneath.lobe_through) {
  if (is_black(wide_ + lobe_)) return;
  const Rgb mean = hemisphere_mean([&](float cosine) { return lost(cosine); });
  const float open = hemisphere_mean([&](float cosine) { return loss_.at(cosine); });
  if (!(max_component(mean) > 1e-6F) || !(open > 0.0F)) return;
  none_ = false;
  for (int c = 0; c < 3; ++c) {
    const float f = std::min(all[c], 1.0F);
    const float scattered = wide_[c] + lobe_[c];
    if (!(mean[c] > 0.0F) || !(f > 0.0F)) continue;
    scale_[c] = kInvPi / mean[c];
    const float down = std::min(mean[c] / (scattered * open), 0.99F);
    again_[c] = f * (1.0F - down) / (1.0F - f * down);
  }
  const Rgb through = beneath.through();
  through_ = max_component(through) / max_component(wide_ + lobe_);
  for (int c = 0; c < 3; ++c) {
    const float share = wide_[c] + lobe_[c] > 0.0F ? through[c] / (wide_[c] + lobe_[c]) : 0.0F;
    through_tint_[c] = again_[c] * share;
    back_tint_[c] = again_[c] * (1.0F - share);
  }
}

}  // namespace hyades::core
