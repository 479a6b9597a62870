#include "core/finish/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/finish/student_t.h"

namespace hyades::core {
namespace {

const std::vector<std::string> kRgb{"R", "G", "B"};

Image constant(int width, int height, const std::vector<std::string>& channels, float value) {
  Image image = make_image(width, height, channels);
  for (float& v : image.data) v = value;
  return image;
}

Comparison must_compare(const Image& a, const Image& b, const CompareOptions& options = {}) {
  const Result<Comparison> result = compare_images(a, b, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? *result : Comparison{};
}

TEST(Compare, EqualPicturesAreIdentical) {
  const Image image = constant(33, 17, kRgb, 0.25F);
  const Comparison c = must_compare(image, image);
  EXPECT_TRUE(c.identical);
  EXPECT_EQ(c.pixels, 33U * 17U);
  EXPECT_EQ(c.blocks.count, 3U * 2U * 3U);
  EXPECT_EQ(c.blocks.largest, 0.0);
  EXPECT_EQ(c.largest_mean_deviation(), 0.0);
  ASSERT_EQ(c.channels.size(), 3U);
  EXPECT_EQ(c.channels[0].mse, 0.0);
  EXPECT_TRUE(std::isinf(c.channels[0].psnr));
  EXPECT_FALSE(c.pixel_test.has_value());
  EXPECT_NE(describe_comparison(c).find("identical to the last bit"), std::string::npos);
}

TEST(Compare, KnownNumbers) {
  const Image a = constant(16, 16, {"Y"}, 0.6F);
  const Image b = constant(16, 16, {"Y"}, 0.5F);
  const Comparison c = must_compare(a, b);
  EXPECT_FALSE(c.identical);
  const ChannelDifference& y = c.channels.at(0);
  EXPECT_NEAR(y.mean_a, 0.6, 1e-6);
  EXPECT_NEAR(y.mse, 0.01, 1e-6);
  EXPECT_NEAR(y.relative_mse, 0.01 / (0.25 + 0.01), 1e-5);
  EXPECT_NEAR(y.mean_deviation(), 0.2, 1e-6);
  EXPECT_NEAR(y.largest, 0.1, 1e-6);
  // Display values 0.797738 and 0.735357.
  EXPECT_NEAR(y.psnr, -20.0 * std::log10(0.797738 - 0.735357), 1e-2);
  EXPECT_NEAR(c.blocks.largest, 0.2, 1e-6);
  EXPECT_EQ(c.blocks.share_above_2_percent, 1.0);
}

TEST(Compare, NamesTheWorstBlock) {
  const Image b = constant(64, 48, kRgb, 1.0F);
  Image a = b;
  a.at(37, 20, 1) = 1.0F + 256.0F * 0.05F;  // 5 % of block (32, 16)
  const Comparison c = must_compare(a, b);
  EXPECT_NEAR(c.blocks.largest, 0.05, 1e-6);
  EXPECT_EQ(c.blocks.where.channel, "G");
  EXPECT_EQ(c.blocks.where.x, 32);
  EXPECT_EQ(c.blocks.where.y, 16);
  EXPECT_NEAR(c.blocks.share_above_2_percent, 1.0 / 36.0, 1e-9);
}

TEST(Compare, BlackBlocksAndBlackPictures) {
  Image b = constant(32, 16, {"Y"}, 1.0F);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) b.at(x, y, 0) = 0.0F;
  }
  Image a = b;
  a.at(0, 0, 0) = 0.0128F;  // mean of the block 5e-5, against 1 % of the picture's mean 0.5
  EXPECT_NEAR(must_compare(a, b).blocks.largest, 0.01, 1e-6);
  const Image black = constant(8, 8, kRgb, 0.0F);
  EXPECT_EQ(must_compare(black, black).largest_mean_deviation(), 0.0);
  EXPECT_TRUE(std::isinf(must_compare(constant(8, 8, kRgb, 1.0F), black).largest_mean_deviation()));
}

TEST(Compare, PixelsThatAreNotFiniteAreCountedAndLeftOut) {
  const Image b = constant(16, 16, kRgb, 1.0F);
  Image a = b;
  a.at(3, 3, 2) = std::numeric_limits<float>::quiet_NaN();
  a.at(4, 3, 0) = std::numeric_limits<float>::infinity();
  const Comparison c = must_compare(a, b);
  EXPECT_EQ(c.not_finite, 2U);
  EXPECT_FALSE(c.identical);
  for (const auto& channel : c.channels) EXPECT_EQ(channel.mse, 0.0);
  const Result<Image> error = error_image(a, b);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->at(3, 3, 2), 1.0F);
  EXPECT_EQ(error->at(3, 3, 0), 0.0F);
}

TEST(Compare, LayersAndRefusals) {
  Image a = constant(4, 4, {"R", "G", "B", "albedo.R", "depth.Z"}, 1.0F);
  Image b = a;
  b.at(0, 0, 3) = 0.0F;
  EXPECT_TRUE(must_compare(a, b).identical);
  CompareOptions options;
  options.layer = "albedo";
  EXPECT_FALSE(must_compare(a, b, options).identical);
  options.layer = "depth.Z";
  EXPECT_TRUE(must_compare(a, b, options).identical);
  options.layer = "normal";
  EXPECT_FALSE(compare_images(a, b, options));
  EXPECT_FALSE(compare_images(a, constant(5, 4, kRgb, 1.0F)));
  EXPECT_FALSE(compare_images(a, constant(4, 4, {"Y"}, 1.0F)));
}

/// A picture of mean `mean` as a film would give it: every pixel averages 16 batches of normal
/// noise of standard deviation 0.4 and estimates its variance from them.
Image noisy(int side, float mean, uint64_t seed) {
  constexpr int kBatches = 16;
  Image image = make_image(side, side,
                           {"R", "G", "B", "variance.R", "variance.G", "variance.B", "samples.N"});
  uint64_t state = mix64(seed);
  const auto uniform = [&state] {
    state = mix64(state + 0x9E3779B97F4A7C15ULL);
    return (static_cast<double>(state >> 11) + 0.5) * 0x1p-53;
  };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      for (int c = 0; c < 3; ++c) {
        double sum = 0.0;
        double squares = 0.0;
        for (int i = 0; i < kBatches; ++i) {
          const double normal = std::sqrt(-2.0 * std::log(uniform())) *
                                std::cos(2.0 * std::numbers::pi * uniform());  // Box, Muller 1958
          const double value = double{mean} + 0.4 * normal;
          sum += value;
          squares += value * value;
        }
        const double average = sum / kBatches;
        const double variance = (squares / kBatches - average * average) / (kBatches - 1);
        image.at(x, y, c) = static_cast<float>(average);
        image.at(x, y, c + 3) = static_cast<float>(variance);
      }
      image.at(x, y, 6) = 16.0F * kBatches;
    }
  }
  return image;
}

TEST(Compare, ZTestAcceptsEqualMeans) {
  // 128 * 128 * 3 = 49,152 tests: the share beyond 3 sigma has a standard deviation of 0.00023.
  const Comparison c = must_compare(noisy(128, 1.0F, 1), noisy(128, 1.0F, 2));
  ASSERT_TRUE(c.pixel_test && c.block_test);
  EXPECT_EQ(c.pixel_test->tests, 49152U);
  EXPECT_EQ(c.block_test->tests, 192U);
  EXPECT_NEAR(c.pixel_test->share_above_3, 0.0027, 0.001);
  EXPECT_GT(c.pixel_test->smallest_p, 0.01);
  EXPECT_GT(c.block_test->smallest_p, 0.01);
}

TEST(Compare, ZTestOfBlocksSeesAFewPercent) {
  // A block's mean difference has a standard deviation of 0.1 sqrt(2) / 16 = 0.0088; the corrected
  // level 0.01 lies at 4.1 of them: a shift of 0.06 (6.8 of them) fails with 99.6 % in each block.
  const Comparison c = must_compare(noisy(128, 1.06F, 3), noisy(128, 1.0F, 4));
  ASSERT_TRUE(c.block_test.has_value());
  EXPECT_LT(c.block_test->smallest_p, 1e-6);
  EXPECT_GT(c.block_test->share_above_3, 0.9);
  EXPECT_NE(describe_comparison(c).find("z-test of blocks"), std::string::npos);
}

TEST(Compare, ZIsTheDifferenceOverItsDeviation) {
  const std::vector<std::string> names{"Y", "variance.Y", "samples.N"};
  Image a = make_image(1, 1, names);
  Image b = a;
  a.data = {1.5F, 0.03F, 16.0F * 11.0F};
  b.data = {1.0F, 0.01F, 16.0F * 6.0F};
  const Comparison c = must_compare(a, b);
  ASSERT_TRUE(c.pixel_test.has_value());
  EXPECT_NEAR(c.pixel_test->largest_z, 0.5 / std::sqrt(0.04), 1e-6);
  // Welch: 0.04^2 / (0.03^2 / 10 + 0.01^2 / 5).
  const double dof = 0.0016 / (0.0009 / 10.0 + 0.0001 / 5.0);
  EXPECT_NEAR(c.pixel_test->smallest_p, two_sided_p(2.5, dof), 1e-6);
}

TEST(Compare, ZTestWithoutNoise) {
  const std::vector<std::string> names{"Y", "variance.Y"};
  Image a = make_image(8, 8, names);
  for (size_t i = 0; i < a.data.size(); i += 2) a.data[i] = 1.0F;
  Image b = a;
  const Comparison same = must_compare(a, b);
  ASSERT_TRUE(same.pixel_test.has_value());
  EXPECT_EQ(same.pixel_test->tests, 0U);
  EXPECT_EQ(same.pixel_test->smallest_p, 1.0);
  a.at(2, 5, 0) = 1.01F;
  const Comparison other = must_compare(a, b);
  EXPECT_EQ(other.pixel_test->smallest_p, 0.0);
  EXPECT_EQ(other.pixel_test->where.x, 2);
  EXPECT_EQ(other.pixel_test->where.y, 5);
}

TEST(Compare, ErrorImageColoursByDecade) {
  const Image b = constant(4, 1, {"Y"}, 0.0F);
  Image a = b;
  // Relative error = |a| / sqrt(0.01).
  a.data = {0.0F, 0.001F, 0.01F, 0.1F};
  const Result<Image> image = error_image(a, b);
  ASSERT_TRUE(image);
  const float expected[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}};
  for (int x = 0; x < 4; ++x) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image->at(x, 0, c), expected[x][c], 1e-4F) << x << c;
  }
}

}  // namespace
}  // namespace hyades::core
