#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace hyades::core {

struct CompareOptions {
  std::string layer;      ///< "" = beauty (R G B, or Y); "albedo" = albedo.R, albedo.G, ...
  double epsilon = 0.01;  ///< keeps relative errors of dark pixels finite: see relative_mse
  int block = 16;         ///< pixels, side of a block
};

/// How one channel of picture a differs from that of picture b, the reference. Pixels that are not
/// finite in one of them are left out.
struct ChannelDifference {
  std::string name;
  double mean_a = 0.0;
  double mean_b = 0.0;
  double mse = 0.0;  ///< mean of (a - b)^2
  double relative_mse =
      0.0;               ///< mean of (a - b)^2 / (b^2 + epsilon) (Rousselle et al. 2011, eq. 9)
  double psnr = 0.0;     ///< dB, of display values (sRGB-encoded, clipped to 0..1); inf where equal
  double largest = 0.0;  ///< largest |a - b|

  /// |mean_a / mean_b - 1|; infinity where only mean_b is 0.
  double mean_deviation() const;
};

/// Where something was found.
struct PicturePlace {
  std::string channel;
  int x = 0;  ///< pixel, or left edge of the block
  int y = 0;
};

/// Means over blocks of pixels: noise averages out, real differences stay.
struct BlockDifference {
  size_t count = 0;      ///< blocks times channels
  double largest = 0.0;  ///< of |a - b| / max(|b|, 1 % of the channel's mean b)
  PicturePlace where;    ///< of the largest
  double share_above_2_percent = 0.0;
};

/// Do the pictures differ by more than their own variances allow? Each pixel's (or block's)
/// difference over its standard deviation follows Student's t, with as many degrees of freedom as
/// the two variances have batches behind them (Welch 1947; the normal distribution where no layer
/// "samples" says so). Assumes batch sums that are about normal: rare bright samples (fireflies)
/// make single pixels fail; blocks forgive more. Batches of Sobol points fill each other's gaps, so
/// their variance is an upper bound and the test lenient.
struct ZTest {
  size_t tests = 0;            ///< pixels (or blocks) times channels with a variance
  double share_above_3 = 0.0;  ///< beyond three sigma; expected: 0.0027
  double largest_z = 0.0;      ///< difference over standard deviation
  PicturePlace where;          ///< of the smallest p
  double smallest_p = 1.0;     ///< Sidak-corrected: below 0.01, the pictures hardly agree
};

struct Comparison {
  int width = 0;
  int height = 0;
  bool identical = false;   ///< the same bits in all compared channels
  uint64_t not_finite = 0;  ///< pixels left out: infinite or NaN in one of the pictures
  uint64_t pixels = 0;      ///< pixels compared
  std::vector<ChannelDifference> channels;
  BlockDifference blocks;
  std::optional<ZTest> pixel_test;  ///< where both pictures have variances
  std::optional<ZTest> block_test;

  double largest_mean_deviation() const;  ///< over the channels
  double relative_mse() const;            ///< mean over the channels
};

/// Compares the common channels of a layer. Refused where sizes differ or no channel is common.
Result<Comparison> compare_images(const Image& a, const Image& b,
                                  const CompareOptions& options = {});

/// The comparison as lines of text for a person.
std::string describe_comparison(const Comparison& comparison);

/// Where the pictures differ: root of the relative squared error (as relative_mse, mean over
/// channels) in false colours, black up to 0.001, then red, yellow, white at 1 and above, one
/// colour per decade; blue where a pixel is not finite. Channels R G B, display values.
Result<Image> error_image(const Image& a, const Image& b, const CompareOptions& options = {});

}  // namespace hyades::core
