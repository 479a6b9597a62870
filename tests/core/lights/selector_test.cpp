#include <gtest/gtest.h>

#include <vector>

#include "core/lights/light_selector.h"
#include "tests/support/chi_squared.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

std::vector<LightPtr> lights_of(const std::vector<float>& powers) {
  std::vector<LightPtr> lights;
  for (const float p : powers) lights.push_back(make_point_light({0, 0, 0}, Rgb(p)));
  return lights;
}

/// T14: probabilities sum to 1 and are those with which lights come.
void expect_consistent(const LightSelector& selector, size_t count) {
  double sum = 0.0;
  std::vector<double> expected;
  constexpr int kSamples = 2'200'000;
  for (uint32_t i = 0; i < count; ++i) {
    const float p = selector.probability({1, 2, 3}, {0, 1, 0}, i);
    sum += static_cast<double>(p);
    expected.push_back(static_cast<double>(p) * kSamples);
  }
  EXPECT_NEAR(sum, 1.0, 1e-5);
  std::vector<double> observed(count, 0.0);
  test::Random random(17);
  for (int i = 0; i < kSamples; ++i) {
    const auto chosen = selector.select({1, 2, 3}, {0, 1, 0}, random.uniform());
    ASSERT_TRUE(chosen);
    ASSERT_LT(chosen->index, count);
    ASSERT_GT(chosen->probability, 0.0F);
    ASSERT_EQ(chosen->probability, selector.probability({1, 2, 3}, {0, 1, 0}, chosen->index));
    observed[chosen->index] += 1.0;
  }
  const auto result = test::chi_squared(observed, expected);
  EXPECT_GT(result.p, 0.01);
  // An error of 1 % between two halves of the lights would show in 99 of 100 cases.
  EXPECT_GE(kSamples,
            test::required_chi_squared_samples(std::max(result.degrees, 1), 0.01, 0.01, 0.99));
}

TEST(PowerSelector, ChoosesInProportionToPower) {
  const auto selector = make_power_selector(lights_of({1.0F, 2.0F, 0.0F, 5.0F}));
  EXPECT_NEAR(selector->probability({}, {}, 0), 0.125F, 1e-6F);
  EXPECT_NEAR(selector->probability({}, {}, 1), 0.25F, 1e-6F);
  EXPECT_EQ(selector->probability({}, {}, 2), 0.0F);
  EXPECT_NEAR(selector->probability({}, {}, 3), 0.625F, 1e-6F);
  expect_consistent(*selector, 4);
}

TEST(PowerSelector, SharesHalfAndHalfBetweenLampsAndSky) {
  // However large the world makes the power of the sky, the lamps keep their half.
  std::vector<LightPtr> lights = lights_of({1.0F, 3.0F});
  lights.push_back(make_environment_light(nullptr, 0.0F, Rgb(1.0F), 1e5F));
  const auto selector = make_power_selector(lights);
  EXPECT_NEAR(selector->probability({}, {}, 0), 0.125F, 1e-6F);
  EXPECT_NEAR(selector->probability({}, {}, 1), 0.375F, 1e-6F);
  EXPECT_NEAR(selector->probability({}, {}, 2), 0.5F, 1e-6F);
  expect_consistent(*selector, 3);
}

TEST(PowerSelector, IsConsistentForManyLightsOfAllSizes) {
  std::vector<float> powers;
  test::Random random(23);
  for (int i = 0; i < 1000; ++i) {
    const float u = random.uniform();
    powers.push_back(i % 7 == 0 ? 0.0F : u * u * u * 100.0F);
  }
  expect_consistent(*make_power_selector(lights_of(powers)), powers.size());
}

TEST(PowerSelector, NeverForgetsAFaintLight) {
  const auto selector = make_power_selector(lights_of({1e8F, 1.0F}));
  EXPECT_GT(selector->probability({}, {}, 1), 0.0F);
  EXPECT_EQ(selector->select({}, {}, 0x1.fffffep-1F)->index, 1U);
}

TEST(PowerSelector, HasNothingToChooseFromWithoutPower) {
  const auto dark = make_power_selector(lights_of({0.0F, 0.0F}));
  EXPECT_FALSE(dark->select({}, {}, 0.5F));
  EXPECT_EQ(dark->probability({}, {}, 1), 0.0F);
  const auto none = make_power_selector({});
  EXPECT_FALSE(none->select({}, {}, 0.0F));
  EXPECT_EQ(none->probability({}, {}, 0), 0.0F);
}

}  // namespace
}  // namespace hyades::core
