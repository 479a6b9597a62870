#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>

#include "core/base/text.h"
#include "core/finish/compare.h"

namespace hyades::core {
namespace {

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.3f} %", 100.0 * share) : "infinite";
}

void describe_test(const ZTest& test, const char* what, std::string& text) {
  auto out = std::back_inserter(text);
  if (test.tests == 0) {
    fmt::format_to(out, "z-test of {}: nothing to test (no noise in either picture)\n", what);
    return;
  }
  fmt::format_to(out,
                 "z-test of {}: {} beyond 3 sigma (0.270 % expected), smallest p {:.3g} (Sidak, {} "
                 "tests)",
                 what, percent(test.share_above_3), test.smallest_p, format_count(test.tests));
  // Nowhere in pictures that are the same.
  if (!test.where.channel.empty()) {
    fmt::format_to(out, " in {} at {},{}", test.where.channel, test.where.x, test.where.y);
  }
  fmt::format_to(out, "\n");
}

}  // namespace

std::string describe_comparison(const Comparison& comparison) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{} x {} pixels", comparison.width, comparison.height);
  if (comparison.identical) fmt::format_to(out, ", identical to the last bit");
  if (comparison.not_finite > 0) {
    fmt::format_to(out, ", {} of them not finite and left out",
                   format_count(comparison.not_finite));
  }
  fmt::format_to(out, "\n{:<12} {:>12} {:>12} {:>11} {:>11} {:>11} {:>9} {:>11}\n", "channel",
                 "mean a", "mean b", "deviation", "MSE", "rel. MSE", "PSNR dB", "largest");
  for (const ChannelDifference& c : comparison.channels) {
    fmt::format_to(
        out, "{:<12} {:>12.6g} {:>12.6g} {:>11} {:>11.4g} {:>11.4g} {:>9.2f} {:>11.4g}\n", c.name,
        c.mean_a, c.mean_b, percent(c.mean_deviation()), c.mse, c.relative_mse, c.psnr, c.largest);
  }
  const BlockDifference& blocks = comparison.blocks;
  fmt::format_to(out, "blocks: largest deviation {}", percent(blocks.largest));
  if (blocks.largest > 0.0) {
    fmt::format_to(out, " in {} at {},{}", blocks.where.channel, blocks.where.x, blocks.where.y);
  }
  fmt::format_to(out, "; {} of {} differ by more than 2 %\n", percent(blocks.share_above_2_percent),
                 format_count(blocks.count));
  if (comparison.pixel_test) describe_test(*comparison.pixel_test, "pixels", text);
  if (comparison.block_test) describe_test(*comparison.block_test, "blocks", text);
  if (!comparison.pixel_test) {
    text += "no z-test: it needs the layer 'variance' in both pictures\n";
  }
  return text;
}

}  // namespace hyades::core
