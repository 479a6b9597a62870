#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <vector>

#include "core/lights/light_selector.h"
#include "tests/support/chi_squared.h"
#include "tests/support/means.h"
#include "tests/support/random.h"

namespace hyades::test {

/// T14: probabilities sum to 1 and are those with which `count` lights come. `tests`: how many of
/// these the calling test makes.
inline void expect_consistent(
    size_t count, const std::function<std::optional<core::SelectedLight>(float)>& select,
    const std::function<float(uint32_t)>& probability, int tests = 1) {
  double sum = 0.0;
  std::vector<double> expected;
  constexpr int kSamples = 2'200'000;
  for (uint32_t i = 0; i < count; ++i) {
    const float p = probability(i);
    sum += static_cast<double>(p);
    expected.push_back(static_cast<double>(p) * kSamples);
  }
  EXPECT_NEAR(sum, 1.0, 1e-5);
  std::vector<double> observed(count, 0.0);
  Random random(17);
  for (int i = 0; i < kSamples; ++i) {
    const auto chosen = select(random.uniform());
    ASSERT_TRUE(chosen);
    ASSERT_LT(chosen->index, count);
    ASSERT_GT(chosen->probability, 0.0F);
    if (i % 16 == 0) {
      ASSERT_EQ(chosen->probability, probability(chosen->index));
    }
    observed[chosen->index] += 1.0;
  }
  const auto result = chi_squared(observed, expected);
  const double alpha = sidak(0.01, tests);
  EXPECT_GT(result.p, alpha);
  // An error of 1 % between two halves of the lights would show in 99 of 100 cases.
  EXPECT_GE(kSamples, required_chi_squared_samples(std::max(result.degrees, 1), 0.01, alpha, 0.99));
}

/// Expects that a selector draws as often as it says at a place with a normal (zero: none).
inline void expect_consistent_at(const core::LightSelector& selector, size_t count,
                                 const core::Vec3& from, const core::Vec3& normal, int tests = 1) {
  expect_consistent(
      count, [&](float u) { return selector.select(from, normal, u); },
      [&](uint32_t i) { return selector.probability(from, normal, i); }, tests);
}

}  // namespace hyades::test
