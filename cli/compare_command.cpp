#include "cli/film_commands.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/command_line.h"
#include "cli/number_range.h"
#include "core/finish/common_part.h"
#include "core/finish/compare.h"
#include "core/finish/perceptual.h"
#include "core/finish/picture.h"
#include "core/image/read_image.h"
#include "core/image/write_image.h"

namespace hyades::cli {
namespace {

using nlohmann::ordered_json;

constexpr int kExceeded = 1;
constexpr int kUnusable = 2;

struct Options {
  std::string a;
  std::string b;
  std::string error_image;
  bool json = false;
  std::optional<double> tolerance;
  std::optional<double> block_tolerance;
  std::optional<double> least_p;
  std::optional<double> perceptual;
  core::CompareOptions compare;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("a", options.a, "picture to judge: EXR, film EXR, HDR, PNG or JPEG")->required();
  app.add_option("b", options.b, "reference of the same size")->required();
  app.add_option("--layer", options.compare.layer, "beauty (default), albedo, normal, depth, ...");
  app.add_option("--error-image", options.error_image,
                 "write the relative error in false colours to this PNG: black 0.001, red 0.01, "
                 "yellow 0.1, white 1");
  app.add_flag("--json", options.json, "print the report as JSON");
  app.add_option("--tolerance", options.tolerance,
                 "exit with 1 where a channel's mean is off by more than this share (0.01 = 1 %)")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--block-tolerance", options.block_tolerance,
                 "exit with 1 where the mean of a block of pixels is off by more than this share")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--least-p", options.least_p,
                 "exit with 1 where the z-test of blocks gives a corrected p below this (both "
                 "pictures need the layer 'variance')")
      ->check(in_range(0.0, 1.0));
  app.add_option("--perceptual", options.perceptual,
                 "say only how different they look (distance in CIELAB, blurred so that noise does "
                 "not count), and exit with 1 where the mean is above this, or that of one of 12 x "
                 "12 fields above four times this; one picture may be a multiple of the other's "
                 "size")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--block", options.compare.block, "side of a block in pixels")
      ->check(in_range(1, 65536))
      ->capture_default_str();
  app.add_option("--epsilon", options.compare.epsilon,
                 "relative MSE is the mean of (a - b)^2 / (b^2 + epsilon)")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.footer(
      "examples:\n"
      "  hyades compare out/shot.0007.exr reference/shot.0007.exr\n"
      "  hyades compare a.png b.png --perceptual 2 --error-image where.png\n"
      "exit status: 0 fine, 1 a tolerance is exceeded (or a pixel is not finite while one is "
      "given), 2 wrong arguments or pictures that cannot be read or compared.");
}

/// Numbers that JSON does not know become null.
ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json test_json(const core::ZTest& test) {
  return {{"tests", test.tests},
          {"share_above_3_sigma", number(test.share_above_3)},
          {"largest_z", number(test.largest_z)},
          {"smallest_p", number(test.smallest_p)},
          {"channel", test.where.channel},
          {"x", test.where.x},
          {"y", test.where.y}};
}

ordered_json to_json(const core::Comparison& comparison) {
  ordered_json json = {{"width", comparison.width},
                       {"height", comparison.height},
                       {"identical", comparison.identical},
                       {"not_finite", comparison.not_finite},
                       {"relative_mse", number(comparison.relative_mse())},
                       {"mean_deviation", number(comparison.largest_mean_deviation())},
                       {"channels", ordered_json::array()}};
  for (const core::ChannelDifference& channel : comparison.channels) {
    json["channels"].push_back({{"name", channel.name},
                                {"mean_a", number(channel.mean_a)},
                                {"mean_b", number(channel.mean_b)},
                                {"mse", number(channel.mse)},
                                {"relative_mse", number(channel.relative_mse)},
                                {"psnr", number(channel.psnr)},
                                {"largest", number(channel.largest)}});
  }
  const core::BlockDifference& blocks = comparison.blocks;
  json["blocks"] = {{"count", blocks.count},
                    {"largest_deviation", number(blocks.largest)},
                    {"share_above_2_percent", number(blocks.share_above_2_percent)},
                    {"channel", blocks.where.channel},
                    {"x", blocks.where.x},
                    {"y", blocks.where.y}};
  if (comparison.pixel_test) json["pixel_test"] = test_json(*comparison.pixel_test);
  if (comparison.block_test) json["block_test"] = test_json(*comparison.block_test);
  return json;
}

int compare_error(const std::string& message) {
  std::fprintf(stderr, "hyades compare: %s\n", message.c_str());
  return kUnusable;
}

/// Says how different the pictures look; the exit status.
int compare_looks(const core::Image& a, const core::Image& b, double limit) {
  const auto difference = core::perceptual_difference(a, b);
  if (!difference) return compare_error(difference.error().message);
  std::printf("they look %.2f apart (CIELAB), at most %.2f around %d,%d\n", difference->mean,
              difference->largest, difference->x, difference->y);
  if (difference->mean <= limit && difference->largest <= 4.0 * limit) return 0;
  std::fputs("the pictures look different\n", stderr);
  return kExceeded;
}

/// Why the pictures do not pass, one reason per line; empty where they do.
std::string verdict(const core::Comparison& comparison, const Options& options) {
  std::string text;
  const bool judged = options.tolerance || options.block_tolerance || options.least_p;
  if (judged && comparison.not_finite > 0) text += "some pixels are not finite\n";
  if (options.tolerance && !(comparison.largest_mean_deviation() <= *options.tolerance)) {
    text += "the mean of a channel is off by more than the tolerance\n";
  }
  if (options.block_tolerance && !(comparison.blocks.largest <= *options.block_tolerance)) {
    text += "the mean of a block is off by more than the tolerance\n";
  }
  if (options.least_p && comparison.block_test &&
      !(comparison.block_test->smallest_p >= *options.least_p)) {
    text += "the pictures differ by more than their variances allow\n";
  }
  return text;
}

int compare(const Options& options) {
  auto a = core::read_image_file(options.a);
  if (!a) return compare_error(a.error().message);
  auto b = core::read_image_file(options.b);
  if (!b) return compare_error(b.error().message);
  if (options.perceptual) return compare_looks(*a, *b, *options.perceptual);
  if (const auto cut = core::cut_to_common_part(*a, *b); !cut)
    return compare_error(cut.error().message);
  const auto comparison = core::compare_images(*a, *b, options.compare);
  if (!comparison) return compare_error(comparison.error().message);
  if (options.least_p && !comparison->block_test) {
    return compare_error("--least-p needs the layer 'variance' in both pictures");
  }
  if (!options.error_image.empty()) {
    const auto image = core::error_image(*a, *b, options.compare);
    if (!image) return compare_error(image.error().message);
    const auto format = core::picture_format(options.error_image);
    if (!format || *format != core::PictureFormat::png) {
      return compare_error("--error-image: expected a name that ends with .png");
    }
    if (const auto status = core::write_png(options.error_image, *image); !status) {
      return compare_error(status.error().message);
    }
  }
  const std::string report =
      options.json ? to_json(*comparison).dump(2) + "\n" : core::describe_comparison(*comparison);
  std::fputs(report.c_str(), stdout);
  const std::string reasons = verdict(*comparison, options);
  std::fputs(reasons.c_str(), stderr);
  return reasons.empty() ? 0 : kExceeded;
}

}  // namespace

int compare_command(int argc, char** argv) {
  CLI::App app("compares two pictures, statistically where both carry variances", "hyades compare");
  Options options;
  declare(app, options);
  if (const auto status = parse_command_line(app, argc, argv, kUnusable)) return *status;
  return compare(options);
}

}  // namespace hyades::cli
