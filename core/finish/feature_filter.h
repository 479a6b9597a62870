#pragma once

#include <array>
#include <vector>

#include "core/base/vec.h"

namespace hyades::core {

/// A noisy picture and what is known of its pixels, row by row from the top.
struct GuidedPicture {
  static constexpr int kFeatures = 7;
  /// Albedo (3), normal (3), alpha: nearly free of noise, and with edges where the picture has
  /// them.
  using Features = std::array<float, kFeatures>;

  int width = 0;
  int height = 0;
  std::vector<Rgb> color;
  std::vector<Rgb> variance;  ///< of color's pixels (their means), channel by channel
  std::vector<Features> features;
};

/// `picture` without most of its noise. Around each pixel the colour is fitted as a linear function
/// of the features, over the pixels of a window that look alike within their noise (non-local means
/// weights); a pixel's value is the weighted mean of what all fits around it say of it: Bitterli,
/// Rousselle, Moon et al. 2016, "Nonlinearly Weighted First-order Regression for Denoising Monte
/// Carlo Renderings", in one pass. Biased: what is finer than the noise is lost.
/// The result does not depend on the number of `threads` (<= 0: as many as the machine has).
std::vector<Rgb> filter_by_features(const GuidedPicture& picture, int threads = 0);

}  // namespace hyades::core
