#include "coordinator/local/noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace hyades::coordinator {
namespace {

constexpr int kPixels = 4000;
constexpr int kFewest = 16;
/// Luminance of linear Rec.709 (ITU-R BT.709-6, item 3.2).
constexpr double kWeights[3] = {0.2126, 0.7152, 0.0722};

}  // namespace

double estimate_noise(const core::Film& film) {
  const core::PixelRect& window = film.window();
  if (window.empty()) return -1;
  const double all = static_cast<double>(window.area());
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(all / kPixels))));
  const core::FilmLayout& layout = film.layout();
  const double paths = layout.layers.splats ? film.all_samples() : 0;
  int pixels = 0;
  double variance = 0;
  double luminance = 0;
  for (int y = window.y0 + step / 2; y < window.y1; y += step) {
    for (int x = window.x0 + step / 2; x < window.x1; x += step) {
      const double n = to_double(film.sum(x, y, layout.samples));
      const double batches = std::ceil(n / core::kBatchSamples);
      if (batches < 2) continue;
      ++pixels;
      const core::SplatLayer::Sums splats =
          layout.layers.splats ? film.splats().at(x, y) : core::SplatLayer::Sums{};
      for (int c = 0; c < 3; ++c) {
        const double sum = to_double(film.sum(x, y, c));
        const double squares = to_double(film.sum(x, y, layout.moment2 + c));
        // Variance of the mean over batches, as in Film::normalised. Colours vary together, so
        // that their weighted deviations add rather than their variances; this is the safe side.
        const double spread = std::max(0.0, squares - sum * sum / n) / (batches - 1) / n;
        variance += kWeights[c] * spread;
        luminance += kWeights[c] * sum / n;
        if (!layout.layers.splats) continue;
        const auto i = static_cast<size_t>(c);
        luminance += kWeights[c] * to_double(splats.value[i]) / paths;
        variance +=
            kWeights[c] * to_double(splats.square[i]) * core::kSplatSquareUnit / (paths * paths);
      }
    }
  }
  if (pixels < kFewest || luminance <= 0) return -1;
  return std::sqrt(variance / pixels) / (luminance / pixels);
}

}  // namespace hyades::coordinator
