#include "core/textures/noise_bounds.h"

#include <gtest/gtest.h>

#include "core/textures/noise.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

Vec4 random4(test::Random& random) {
  return {random.uniform(), random.uniform(), random.uniform(), random.uniform()};
}

TEST(NoiseBounds, HoldOverBoxesOfEverySize) {
  test::Random random(8);
  for (int n = 0; n < 3000; ++n) {
    const Vec4 lower = 40.0F * random4(random) - 20.0F;
    const float size = random.uniform() * random.uniform() * 2.0F;
    const Vec4 upper = lower + size * random4(random) * Vec4(1.0F, 1.0F, 1.0F, n % 2);
    const NoiseBounds one = perlin_bounds(lower, upper);
    const NoiseBounds sum = fbm_bounds(lower, upper, 4, 2.1F, 0.6F);
    for (int k = 0; k < 60; ++k) {
      const Vec4 p = lower + random4(random) * (upper - lower);
      const float value = perlin(p).value;
      ASSERT_GE(value, one.least);
      ASSERT_LE(value, one.greatest);
      const float total = fbm(p, 4, 2.1F, 0.6F).value;
      ASSERT_GE(total, sum.least);
      ASSERT_LE(total, sum.greatest);
    }
  }
}

TEST(FractalNoise, IsFbmWithoutItsGradient) {
  test::Random random(9);
  const FractalNoise noise(6, 2.1F, 0.6F);
  for (int n = 0; n < 3000; ++n) {
    const Vec4 p = 40.0F * random4(random) - 20.0F;
    EXPECT_EQ(perlin_value(p), perlin(p).value);
    EXPECT_EQ(noise.value(p), fbm(p, 6, 2.1F, 0.6F).value);
  }
}

TEST(FractalNoise, BetweenBoundsIsWhatItIsElseOnTheSameSide) {
  test::Random random(10);
  const FractalNoise noise(6, 2.1F, 0.6F);
  int outside = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vec4 p = 40.0F * random4(random) - 20.0F;
    const float low = 0.4F * random.uniform() - 0.3F;
    const float high = low + 0.1F * random.uniform();
    const float value = noise.value(p);
    const float between = noise.value_between(p, low, high);
    if (between == value) continue;
    ++outside;
    ASSERT_TRUE(between == -1.0F || between == 1.0F);
    ASSERT_TRUE(between < 0.0F ? value < low : value > high);
  }
  EXPECT_GT(outside, 5000);
}

TEST(NoiseBounds, NarrowDownToTheValueAtAPoint) {
  test::Random random(8);
  for (int n = 0; n < 1000; ++n) {
    const Vec4 p = 40.0F * random4(random) - 20.0F;
    const float value = fbm(p, 4, 2.0F, 0.5F).value;
    const NoiseBounds wide = fbm_bounds(p - 0.01F, p + 0.01F, 4, 2.0F, 0.5F);
    EXPECT_LT(wide.greatest - wide.least, 0.5F);
    const NoiseBounds narrow = fbm_bounds(p - 1e-4F, p + 1e-4F, 4, 2.0F, 0.5F);
    EXPECT_NEAR(narrow.least, value, 4e-3F);
    EXPECT_NEAR(narrow.greatest, value, 4e-3F);
  }
}

}  // namespace
}  // namespace hyades::core
