#include "core/finish/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/base/color.h"
#include "core/film/unit.h"
#include "core/finish/compare_channels.h"
#include "core/finish/student_t.h"

namespace hyades::core {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Two-sided probability of a normal variable beyond three standard deviations.
constexpr double kBeyondThree = 0.002699796063260189;

double display_value(double linear) {
  return std::clamp(double{srgb_encode(static_cast<float>(std::max(linear, 0.0)))}, 0.0, 1.0);
}

/// Sums over a block (or a pixel) of one channel.
struct Cell {
  double a = 0.0;
  double b = 0.0;
  double variance_a = 0.0;
  double variance_b = 0.0;
  double squares = 0.0;  ///< sum of variance^2 / degrees of freedom, of both
  size_t pixels = 0;

  void add(const Cell& o) {
    a += o.a;
    b += o.b;
    variance_a += o.variance_a;
    variance_b += o.variance_b;
    squares += o.squares;
    pixels += o.pixels;
  }
  double variance() const { return variance_a + variance_b; }
  /// Welch (1947), Satterthwaite (1946).
  double dof() const { return squares > 0.0 ? variance() * variance() / squares : kInfinite; }
};

/// Collects t values into a ZTest.
class TestCollector {
 public:
  void add(const Cell& cell, const std::string& channel, int x, int y) {
    const double difference = cell.a - cell.b;
    const double variance = cell.variance();
    double z = 0.0;
    if (variance > 0.0) {
      z = difference / std::sqrt(variance);
    } else {
      // Without noise only rounding may differ: such pixels say nothing, or everything.
      if (std::abs(difference) <= 1e-5 * std::max(std::abs(cell.a), std::abs(cell.b))) return;
      z = std::copysign(kInfinite, difference);
    }
    ++result_.tests;
    result_.largest_z = std::max(result_.largest_z, std::abs(z));
    // Tails of t are heavier than the normal one's: most pixels need no closer look.
    const double least = two_sided_p(z, kInfinite);
    if (least >= kBeyondThree && least >= result_.smallest_p) return;
    const double p = two_sided_p(z, cell.dof());
    if (p < kBeyondThree) ++beyond_;
    if (p < result_.smallest_p) {
      result_.smallest_p = p;
      result_.where = {channel, x, y};
    }
  }

  ZTest finish() const {
    ZTest result = result_;
    const auto tests = static_cast<double>(result.tests);
    if (result.tests > 0) {
      result.share_above_3 = static_cast<double>(beyond_) / tests;
      result.smallest_p = sidak(result.smallest_p, tests);
    }
    return result;
  }

 private:
  ZTest result_;
  size_t beyond_ = 0;
};

/// Degrees of freedom of a pixel's variance; infinity where nothing is known about its batches.
double degrees_of_freedom(const Image& image, int samples, int x, int y) {
  if (samples < 0) return kInfinite;
  const double batches = std::ceil(double{image.at(x, y, samples)} / kBatchSamples);
  return std::max(batches - 1.0, 1.0);
}

class Comparer {
 public:
  Comparer(const Image& a, const Image& b, const CompareOptions& options,
           std::vector<CommonChannel> channels)
      : a_(a),
        b_(b),
        options_(options),
        channels_(std::move(channels)),
        samples_a_(a.find_channel("samples.N")),
        samples_b_(b.find_channel("samples.N")) {}

  Comparison run() {
    Comparison result;
    result.width = a_.width;
    result.height = a_.height;
    count_finite(result);
    result.identical = true;
    TestCollector pixel_test;
    TestCollector block_test;
    bool variances = !channels_.empty();
    for (const CommonChannel& channel : channels_) {
      variances = variances && channel.variance_a >= 0 && channel.variance_b >= 0;
    }
    for (const CommonChannel& channel : channels_) {
      result.identical = result.identical && same_bits(channel);
      result.channels.push_back(measure(channel, result.pixels));
      compare_blocks(channel, result.channels.back().mean_b, result.blocks,
                     variances ? &pixel_test : nullptr, variances ? &block_test : nullptr);
    }
    if (result.blocks.count > 0) {
      result.blocks.share_above_2_percent =
          static_cast<double>(blocks_beyond_) / static_cast<double>(result.blocks.count);
    }
    if (variances) {
      result.pixel_test = pixel_test.finish();
      result.block_test = block_test.finish();
    }
    return result;
  }

 private:
  void count_finite(Comparison& result) {
    finite_.assign(static_cast<size_t>(a_.width) * static_cast<size_t>(a_.height), false);
    for (int y = 0; y < a_.height; ++y) {
      for (int x = 0; x < a_.width; ++x) {
        const bool finite = is_finite(a_, b_, channels_, x, y);
        finite_[place(x, y)] = finite;
        ++(finite ? result.pixels : result.not_finite);
      }
    }
  }

  size_t place(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(a_.width) + static_cast<size_t>(x);
  }

  bool same_bits(const CommonChannel& channel) const {
    for (int y = 0; y < a_.height; ++y) {
      for (int x = 0; x < a_.width; ++x) {
        if (std::bit_cast<uint32_t>(a_.at(x, y, channel.a)) !=
            std::bit_cast<uint32_t>(b_.at(x, y, channel.b))) {
          return false;
        }
      }
    }
    return true;
  }

  ChannelDifference measure(const CommonChannel& channel, uint64_t pixels) const {
    ChannelDifference d;
    d.name = channel.name;
    double display = 0.0;
    for (int y = 0; y < a_.height; ++y) {
      for (int x = 0; x < a_.width; ++x) {
        if (!finite_[place(x, y)]) continue;
        const double a = a_.at(x, y, channel.a);
        const double b = b_.at(x, y, channel.b);
        const double square = (a - b) * (a - b);
        const double shown = display_value(a) - display_value(b);
        d.mean_a += a;
        d.mean_b += b;
        d.mse += square;
        d.relative_mse += square / (b * b + options_.epsilon);
        d.largest = std::max(d.largest, std::abs(a - b));
        display += shown * shown;
      }
    }
    const double n = std::max<double>(static_cast<double>(pixels), 1.0);
    for (double* sum : {&d.mean_a, &d.mean_b, &d.mse, &d.relative_mse}) *sum /= n;
    d.psnr = display > 0.0 ? -10.0 * std::log10(display / n) : kInfinite;
    return d;
  }

  Cell cell_of(const CommonChannel& channel, int x, int y, bool variances) const {
    Cell cell;
    cell.pixels = 1;
    cell.a = a_.at(x, y, channel.a);
    cell.b = b_.at(x, y, channel.b);
    if (!variances) return cell;
    cell.variance_a = a_.at(x, y, channel.variance_a);
    cell.variance_b = b_.at(x, y, channel.variance_b);
    cell.squares = cell.variance_a * cell.variance_a / degrees_of_freedom(a_, samples_a_, x, y) +
                   cell.variance_b * cell.variance_b / degrees_of_freedom(b_, samples_b_, x, y);
    return cell;
  }

  void compare_blocks(const CommonChannel& channel, double mean_b, BlockDifference& blocks,
                      TestCollector* pixel_test, TestCollector* block_test) {
    const int side = std::max(options_.block, 1);
    for (int y0 = 0; y0 < a_.height; y0 += side) {
      for (int x0 = 0; x0 < a_.width; x0 += side) {
        Cell block;
        for (int y = y0; y < std::min(y0 + side, a_.height); ++y) {
          for (int x = x0; x < std::min(x0 + side, a_.width); ++x) {
            if (!finite_[place(x, y)]) continue;
            const Cell pixel = cell_of(channel, x, y, pixel_test != nullptr);
            if (pixel_test != nullptr) pixel_test->add(pixel, channel.name, x, y);
            block.add(pixel);
          }
        }
        if (block.pixels == 0) continue;
        if (block_test != nullptr) block_test->add(block, channel.name, x0, y0);
        note_block(block, channel.name, mean_b, x0, y0, blocks);
      }
    }
  }

  void note_block(const Cell& block, const std::string& channel, double mean_b, int x, int y,
                  BlockDifference& blocks) {
    const auto n = static_cast<double>(block.pixels);
    const double difference = std::abs(block.a - block.b) / n;
    const double base = std::max(std::abs(block.b) / n, 0.01 * std::abs(mean_b));
    const double deviation = difference == 0.0 ? 0.0 : (base > 0.0 ? difference / base : kInfinite);
    ++blocks.count;
    if (deviation > 0.02) ++blocks_beyond_;
    if (deviation > blocks.largest) {
      blocks.largest = deviation;
      blocks.where = {channel, x, y};
    }
  }

  const Image& a_;
  const Image& b_;
  const CompareOptions& options_;
  const std::vector<CommonChannel> channels_;
  const int samples_a_;
  const int samples_b_;
  std::vector<bool> finite_;  ///< per pixel
  size_t blocks_beyond_ = 0;
};

}  // namespace

double ChannelDifference::mean_deviation() const {
  if (mean_a == mean_b) return 0.0;
  return mean_b == 0.0 ? kInfinite : std::abs(mean_a / mean_b - 1.0);
}

double Comparison::largest_mean_deviation() const {
  double largest = 0.0;
  for (const auto& channel : channels) largest = std::max(largest, channel.mean_deviation());
  return largest;
}

double Comparison::relative_mse() const {
  double sum = 0.0;
  for (const auto& channel : channels) sum += channel.relative_mse;
  return channels.empty() ? 0.0 : sum / static_cast<double>(channels.size());
}

Result<std::vector<CommonChannel>> common_channels(const Image& a, const Image& b,
                                                   const CompareOptions& options) {
  if (a.width != b.width || a.height != b.height) {
    return Error{fmt::format("the pictures differ in size: {} x {} and {} x {} pixels", a.width,
                             a.height, b.width, b.height)};
  }
  const bool beauty = options.layer.empty() || options.layer == "beauty";
  std::vector<CommonChannel> channels;
  for (size_t i = 0; i < a.channels.size(); ++i) {
    const std::string& name = a.channels[i];
    const bool wanted = beauty ? name == "R" || name == "G" || name == "B" || name == "Y"
                               : name == options.layer || name.starts_with(options.layer + ".");
    const int other = b.find_channel(name);
    if (!wanted || other < 0) continue;
    CommonChannel channel{name, static_cast<int>(i), other, -1, -1};
    if (beauty) {
      channel.variance_a = a.find_channel("variance." + name);
      channel.variance_b = b.find_channel("variance." + name);
    }
    channels.push_back(channel);
  }
  if (channels.empty()) {
    return Error{fmt::format("no channel of {} is in both pictures; a has {}, b has {}",
                             beauty ? "beauty (R, G, B or Y)" : "layer '" + options.layer + "'",
                             fmt::join(a.channels, " "), fmt::join(b.channels, " "))};
  }
  return channels;
}

bool is_finite(const Image& a, const Image& b, const std::vector<CommonChannel>& channels, int x,
               int y) {
  return std::all_of(channels.begin(), channels.end(), [&](const CommonChannel& channel) {
    return std::isfinite(a.at(x, y, channel.a)) && std::isfinite(b.at(x, y, channel.b));
  });
}

Result<Comparison> compare_images(const Image& a, const Image& b, const CompareOptions& options) {
  Result<std::vector<CommonChannel>> channels = common_channels(a, b, options);
  if (!channels) return channels.error();
  return Comparer(a, b, options, std::move(channels).value()).run();
}

}  // namespace hyades::core
