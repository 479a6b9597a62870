#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/film/film.h"

namespace hyades::core {
namespace {

/// Nearest float; what would be denormal becomes 0 by rule instead of by the thread's FTZ mode.
float to_float(double value) {
  constexpr double kSmallest = std::numeric_limits<float>::min();
  return std::abs(value) < kSmallest ? 0.0F : static_cast<float>(value);
}

/// Variance of a pixel's mean, estimated over its batches. With s_b the sum over the n_b samples
/// of batch b, S and N their totals and q = sum of s_b^2 / n_b: E[q] = B sigma^2 + N mu^2 and
/// E[S^2 / N] = sigma^2 + N mu^2, so (q - S^2 / N) / (B - 1) estimates the variance sigma^2 of one
/// sample without bias where batches are independent, and sigma^2 / N that of the mean.
double variance_of_mean(double q, double sum, double samples, uint32_t batches) {
  if (batches < 2) return 0.0;
  const double excess = q - sum * sum / samples;
  return std::max(excess, 0.0) / (static_cast<double>(batches - 1) * samples);
}

}  // namespace

Image Film::normalised() const {
  std::vector<std::string> names;
  for (int c = 0; c < layout_.deposited; ++c) {
    names.push_back(layout_.channels[static_cast<size_t>(c)].name);
  }
  const auto variance = static_cast<size_t>(layout_.deposited);
  const size_t count = variance + 3;
  for (const char* name : {"variance.R", "variance.G", "variance.B", "samples.N"}) {
    names.emplace_back(name);
  }

  Image image;
  image.width = std::max(window_.width(), 0);
  image.height = std::max(window_.height(), 0);
  image.channels = std::move(names);
  const size_t stride = image.channels.size();
  const std::vector<uint32_t> batches = batch_counts();
  image.data.assign(batches.size() * stride, 0.0F);

  const std::vector<Fixed128>& samples = planes_[static_cast<size_t>(layout_.samples)];
  for (size_t i = 0; i < batches.size(); ++i) {
    if (samples[i] == Fixed128{}) continue;
    const double n = to_double(samples[i]);
    float* const pixel = image.data.data() + i * stride;
    for (size_t c = 0; c < variance; ++c) {
      pixel[c] = layout_.channels[c].rule == MergeRule::min
                     ? std::bit_cast<float>(static_cast<uint32_t>(planes_[c][i].low))
                     : to_float(to_double(planes_[c][i]) / n);
    }
    for (size_t c = 0; c < 3; ++c) {
      const double q = to_double(planes_[static_cast<size_t>(layout_.moment2) + c][i]);
      pixel[variance + c] = to_float(variance_of_mean(q, to_double(planes_[c][i]), n, batches[i]));
    }
    pixel[count] = to_float(n);
  }
  if (layout_.layers.splats) {
    add_splats(image);
    add_part_splats(image);
  }
  return image;
}

double Film::all_samples() const {
  double all = 0.0;  // exact: whole numbers
  for (const Fixed128& n : planes_[static_cast<size_t>(layout_.samples)]) all += to_double(n);
  return all;
}

void Film::add_splats(Image& image) const {
  const double paths = all_samples();
  const auto first_variance = static_cast<size_t>(layout_.deposited);
  splats_.for_each([&](uint32_t index, const SplatLayer::Sums& sums) {
    const auto width = static_cast<uint32_t>(splats_.region().width());
    const int x = splats_.region().x0 + static_cast<int>(index % width);
    const int y = splats_.region().y0 + static_cast<int>(index / width);
    if (!window_.contains(x, y)) return;
    const size_t i = offset(x, y);
    if (planes_[static_cast<size_t>(layout_.samples)][i] == Fixed128{}) return;
    float* const pixel = image.data.data() + i * image.channels.size();
    for (size_t c = 0; c < 3; ++c) {
      const double mean =
          to_double(planes_[c][i]) / to_double(planes_[static_cast<size_t>(layout_.samples)][i]);
      pixel[c] = to_float(mean + to_double(sums.value[c]) / paths);
      // Most paths bring nothing to a pixel, so that the square of the mean does not matter.
      pixel[first_variance + c] =
          to_float(double{pixel[first_variance + c]} +
                   to_double(sums.square[c]) * kSplatSquareUnit / (paths * paths));
    }
  });
}

void Film::add_part_splats(Image& image) const {
  const double paths = all_samples();
  const std::vector<Fixed128>& samples = planes_[static_cast<size_t>(layout_.samples)];
  for (size_t part = 0; part < part_splats_.size(); ++part) {
    const size_t first = static_cast<size_t>(layout_.parts) + 3 * part;
    const PixelRect& region = part_splats_[part].region();
    part_splats_[part].for_each([&](uint32_t index, const PartSums& sums) {
      const auto width = static_cast<uint32_t>(region.width());
      const int x = region.x0 + static_cast<int>(index % width);
      const int y = region.y0 + static_cast<int>(index / width);
      if (!window_.contains(x, y)) return;
      const size_t i = offset(x, y);
      if (samples[i] == Fixed128{}) return;
      float* const pixel = image.data.data() + i * image.channels.size() + first;
      for (size_t c = 0; c < 3; ++c) {
        const double mean = to_double(planes_[first + c][i]) / to_double(samples[i]);
        pixel[c] = to_float(mean + to_double(sums.value[c]) / paths);
      }
    });
  }
}

}  // namespace hyades::core
