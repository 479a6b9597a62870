#pragma once

#include <array>
#include <cstddef>

#include "core/finish/feature_filter.h"

namespace hyades::core {

/// A colour as a linear function of features: base + sum of slope_i feature_i.
class LinearFit {
 public:
  static constexpr int kUnknowns = GuidedPicture::kFeatures + 1;
  static constexpr int kProducts = kUnknowns * (kUnknowns + 1) / 2;

  /// What least squares need of one pixel, or of a weighted sum of them: products of (1, features)
  /// with each other, and with the three channels; the channels' squares.
  using Terms = std::array<float, kProducts + 3 * kUnknowns + 3>;

  static Terms terms(const GuidedPicture::Features& features, const Rgb& color);

  static void add(Terms& sums, float weight, const Terms& terms) {
    for (size_t i = 0; i < sums.size(); ++i) sums[i] += weight * terms[i];
  }

  /// The fit with the least squared error, slopes held back a little (ridge regression), so that
  /// features that hardly vary cannot make noise of their own. A plain mean where all weights are 0
  /// but one.
  static LinearFit solve(const Terms& sums);

  /// Held to three standard deviations from the mean of what was fitted: where features are noisy
  /// themselves, some lie far from all others.
  Rgb at(const GuidedPicture::Features& features) const {
    Rgb value = coefficients_[0];
    for (size_t i = 0; i < features.size(); ++i) value += features[i] * coefficients_[i + 1];
    return glm::clamp(value, low_, high_);
  }

 private:
  std::array<Rgb, kUnknowns> coefficients_{};
  Rgb low_{0.0F};
  Rgb high_{0.0F};
};

}  // namespace hyades::core
