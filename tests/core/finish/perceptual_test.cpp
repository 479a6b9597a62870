#include "core/finish/perceptual.h"

#include <gtest/gtest.h>

#include "core/base/hash.h"

namespace hyades::core {
namespace {

/// Grey of `value` with noise of +-`noise` in every pixel.
Image grey(float value, float noise, uint64_t seed = 1) {
  Image image = make_image(240, 120, {"R", "G", "B"});
  for (size_t i = 0; i < image.data.size(); ++i) {
    const float u = static_cast<float>(mix64(hash_combine(seed, i)) >> 40) * 0x1p-24F;
    image.data[i] = value + noise * (2.0F * u - 1.0F);
  }
  return image;
}

TEST(Perceptual, KnownDistances) {
  // L* of a linear 0.18 is 49.496, that of 0.25 is 57.08.
  const auto difference = perceptual_difference(grey(0.18F, 0.0F), grey(0.25F, 0.0F));
  ASSERT_TRUE(difference);
  EXPECT_NEAR(difference->mean, 7.581, 0.01);
  EXPECT_NEAR(difference->largest, 7.581, 0.01);
  Image red = grey(0.0F, 0.0F);
  Image black = red;
  for (size_t i = 0; i < red.data.size(); i += 3) red.data[i] = 1.0F;
  // Rec.709's red is L* 53.24, a* 80.09, b* 67.20.
  EXPECT_NEAR(perceptual_difference(red, black)->mean, 117.35, 0.1);
}

TEST(Perceptual, NoiseIsNoDifferenceButASmallThingIs) {
  const Image a = grey(0.3F, 0.1F, 1);
  EXPECT_LT(perceptual_difference(a, grey(0.3F, 0.1F, 2))->mean, 2.5);
  Image b = grey(0.3F, 0.1F, 2);
  for (int y = 60; y < 80; ++y) {
    for (int x = 100; x < 120; ++x) {
      for (int c = 0; c < 3; ++c) b.at(x, y, c) *= 0.4F;
    }
  }
  const auto difference = perceptual_difference(a, b);
  EXPECT_LT(difference->mean, 3.0);
  EXPECT_GT(difference->largest, 12.0);
  EXPECT_EQ(difference->x, 100);
  EXPECT_TRUE(difference->y == 60 || difference->y == 70) << difference->y;
}

TEST(Perceptual, LargerPicturesAreAveragedDown) {
  Image small = make_image(120, 60, {"R", "G", "B"});
  Image large = grey(0.0F, 0.0F);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 240; ++x) {
      for (int c = 0; c < 3; ++c) {
        large.at(x, y, c) = (x + y) % 2 == 0 ? 0.1F : 0.3F;
        small.at(x / 2, y / 2, c) = 0.2F;
      }
    }
  }
  EXPECT_LT(perceptual_difference(large, small)->mean, 1e-3);
  EXPECT_LT(perceptual_difference(small, large)->largest, 1e-3);
}

TEST(Perceptual, RefusesOtherSizes) {
  const auto difference =
      perceptual_difference(grey(0.3F, 0.0F), make_image(100, 10, {"R", "G", "B"}));
  ASSERT_FALSE(difference);
  EXPECT_EQ(difference.error().message,
            "the pictures have 240 x 120 and 100 x 10 pixels, expected the same size");
}

}  // namespace
}  // namespace hyades::core
