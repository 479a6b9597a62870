#include <gtest/gtest.h>

#include <vector>

#include "core/lights/light_selector.h"
#include "tests/core/lights/selector_checks.h"

namespace hyades::core {
namespace {

std::vector<LightPtr> lights_of(const std::vector<float>& powers) {
  std::vector<LightPtr> lights;
  for (const float p : powers) lights.push_back(make_point_light({0, 0, 0}, Rgb(p)));
  return lights;
}

void expect_consistent(const LightSelector& selector, size_t count) {
  test::expect_consistent_at(selector, count, {1, 2, 3}, {0, 1, 0});
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
