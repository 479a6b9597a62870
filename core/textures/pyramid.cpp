#include "core/textures/pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace hyades::core {
namespace {

/// What one texel of a level is made of along one side.
struct Share {
  int texel;  ///< of the level before; -1: black
  double weight;
};

/// Integral of the tent of area 1 over (-1, 1), from there to u.
double tent_integral(double u) {
  if (u <= -1.0) return 0.0;
  if (u >= 1.0) return 1.0;
  return u < 0.0 ? 0.5 * (1.0 + u) * (1.0 + u) : 1.0 - 0.5 * (1.0 - u) * (1.0 - u);
}

/// The shares of texel i of m, of the n before. Tents side by side add up to 1, so that every texel
/// counts alike and the mean stays what it was (where `wrap` leads back into the image evenly).
std::vector<Share> shares_of(int i, int m, int n, WrapMode wrap) {
  if (m == n) return {{i, 1.0}};
  const double step = static_cast<double>(n) / static_cast<double>(m);
  const double center = (i + 0.5) * step;
  std::vector<Share> shares;
  for (auto j = static_cast<int64_t>(std::floor(center - step));
       static_cast<double>(j) < center + step; ++j) {
    const double from = (static_cast<double>(j) - center) / step;
    const double weight = tent_integral(from + 1.0 / step) - tent_integral(from);
    if (weight > 0.0) shares.push_back({wrap_index(j, n, wrap), weight});
  }
  return shares;
}

/// Interleaved channels in linear light, rows from the top. Of 2 and 4 channels the last is alpha.
struct Level {
  int width = 0;
  int height = 0;
  size_t channels = 0;
  std::vector<float> values;

  size_t index(int x, int y) const {
    return (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) *
           channels;
  }
};

bool has_alpha(size_t channels) { return channels % 2 == 0; }

/// Half as high.
Level shorter(const Level& from, WrapMode wrap) {
  Level to{from.width, std::max(from.height / 2, 1), from.channels, {}};
  to.values.resize(static_cast<size_t>(to.width) * static_cast<size_t>(to.height) * to.channels);
  const size_t row = static_cast<size_t>(to.width) * to.channels;
  std::vector<double> sums(row);
  for (int y = 0; y < to.height; ++y) {
    std::fill(sums.begin(), sums.end(), 0.0);
    for (const Share& share : shares_of(y, to.height, from.height, wrap)) {
      if (share.texel < 0) continue;
      const float* values = &from.values[from.index(0, share.texel)];
      for (size_t i = 0; i < row; ++i) sums[i] += share.weight * double{values[i]};
    }
    std::transform(sums.begin(), sums.end(), &to.values[to.index(0, y)],
                   [](double sum) { return static_cast<float>(sum); });
  }
  return to;
}

/// Half as wide.
Level narrower(const Level& from, WrapMode wrap) {
  Level to{std::max(from.width / 2, 1), from.height, from.channels, {}};
  to.values.resize(static_cast<size_t>(to.width) * static_cast<size_t>(to.height) * to.channels);
  std::vector<std::vector<Share>> shares;
  for (int x = 0; x < to.width; ++x) shares.push_back(shares_of(x, to.width, from.width, wrap));
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      for (size_t c = 0; c < to.channels; ++c) {
        double sum = 0.0;
        for (const Share& share : shares[static_cast<size_t>(x)]) {
          if (share.texel < 0) continue;
          sum += share.weight * double{from.values[from.index(share.texel, y) + c]};
        }
        to.values[to.index(x, y) + c] = static_cast<float>(sum);
      }
    }
  }
  return to;
}

/// Colours times alpha.
Level weighed(Level level) {
  const size_t colors = level.channels - 1;
  for (size_t i = 0; i < level.values.size(); i += level.channels) {
    for (size_t c = 0; c < colors; ++c) level.values[i + c] *= level.values[i + colors];
  }
  return level;
}

Level half_the_size(const Level& level, WrapModes wrap) {
  Level plain = narrower(shorter(level, wrap.v), wrap.u);
  if (!has_alpha(level.channels)) return plain;
  const Level by_alpha = narrower(shorter(weighed(level), wrap.v), wrap.u);
  const size_t colors = level.channels - 1;
  for (size_t i = 0; i < plain.values.size(); i += plain.channels) {
    const float alpha = plain.values[i + colors];
    if (!(alpha > 0.0F)) continue;
    for (size_t c = 0; c < colors; ++c) plain.values[i + c] = by_alpha.values[i + c] / alpha;
  }
  return plain;
}

/// Of an opaque image alpha is left out.
Level level_of(const Image& image) {
  const int r = image.find_channel("R");
  const int g = image.find_channel("G");
  const int b = image.find_channel("B");
  const int y = image.find_channel("Y");
  const bool grey = r < 0 || g < 0 || b < 0;
  std::vector<int> channels = {r, g, b};
  if (grey) channels = {y >= 0 ? y : std::max(r, 0)};
  const int a = image.find_channel("A");
  const auto texels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  const auto per_texel = image.channels.size();
  if (a >= 0 && a != channels[0]) {
    for (size_t i = 0; i < texels; ++i) {
      if (image.data[i * per_texel + static_cast<size_t>(a)] == 1.0F) continue;
      channels.push_back(a);
      break;
    }
  }
  Level level{image.width, image.height, channels.size(), {}};
  level.values.reserve(texels * channels.size());
  for (size_t i = 0; i < texels; ++i) {
    for (const int c : channels)
      level.values.push_back(image.data[i * per_texel + static_cast<size_t>(c)]);
  }
  return level;
}

/// Codes of 8 bits are too coarse for means, 16-bit floating-point is not; nor is it larger than
/// the third that all further levels come to.
TexelCoding coding_of_means(const TexelCoding& image) {
  const bool fine = image.format == TexelFormat::words || image.format == TexelFormat::floats;
  return {fine ? TexelFormat::floats : TexelFormat::halves, nullptr, nullptr};
}

}  // namespace

Result<PyramidPtr> ImagePyramid::make(const Image& image, WrapModes wrap, TexelStore& store) {
  auto pyramid = std::make_shared<ImagePyramid>();
  pyramid->wrap_ = wrap;
  if (image.width <= 0 || image.height <= 0 || image.channels.empty()) return PyramidPtr(pyramid);
  Level level = level_of(image);
  const size_t colors = level.channels - (has_alpha(level.channels) ? 1 : 0);
  const auto add = [&](const TexelCoding& coding) -> Status {
    auto texels = Texels::make(level.width, level.height, static_cast<int>(level.channels),
                               level.values, coding, store);
    if (!texels) return texels.error();
    pyramid->levels_.push_back(std::move(*texels));
    return {};
  };
  const TexelCoding coding = smallest_coding(level.values, level.channels, colors);
  if (const Status added = add(coding); !added) return added.error();
  while (level.width > 1 || level.height > 1) {
    level = half_the_size(level, wrap);
    if (const Status added = add(coding_of_means(coding)); !added) return added.error();
  }
  return PyramidPtr(pyramid);
}

size_t ImagePyramid::memory() const {
  size_t bytes = 0;
  for (const Texels& level : levels_) bytes += level.memory();
  return bytes;
}

}  // namespace hyades::core
