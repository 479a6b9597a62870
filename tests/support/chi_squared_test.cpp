#include "tests/support/chi_squared.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/quadrature.h"

namespace hyades::test {
namespace {

using core::Vec3;

std::optional<Vec3> cosine_direction(Random& random) {
  const float r2 = random.uniform();
  const double phi = 2.0 * M_PI * random.uniform_double();
  const double r = std::sqrt(r2);
  return Vec3(r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - r2));
}

double cosine_density(const Vec3& w) { return w.z > 0.0F ? w.z / M_PI : 0.0; }

TEST(Quadrature, KnownIntegrals) {
  EXPECT_NEAR(integrate([](double x) { return std::exp(x); }, 0.0, 1.0), M_E - 1.0, 1e-9);
  EXPECT_NEAR(integrate([](double x) { return std::sqrt(x); }, 0.0, 1.0), 2.0 / 3.0, 1e-8);
  // A peak of width 1e-3 between the points of any coarse rule.
  const auto peak = [](double x) { return std::exp(-0.5e6 * (x - 0.3) * (x - 0.3)); };
  EXPECT_NEAR(integrate(peak, 0.0, 1.0, 1e-10, 256), 1e-3 * std::sqrt(2.0 * M_PI), 1e-8);
  EXPECT_NEAR(integrate2([](double x, double y) { return x * y * y; }, 0.0, 1.0, 0.0, 3.0), 4.5,
              1e-9);
  EXPECT_NEAR(integrate2([](double x, double y) { return x * x + y * y < 1.0 ? 1.0 : 0.0; }, -1.0,
                         1.0, -1.0, 1.0, 1e-4, 8, 12),
              M_PI, 1e-3);
  EXPECT_NEAR(integrate_sphere([](const Vec3&) { return 1.0; }), 4.0 * M_PI, 1e-6);
  EXPECT_NEAR(integrate_sphere(cosine_density), 1.0, 1e-6);
}

TEST(ChiSquared, KnownStatistic) {
  const std::vector<double> observed{44, 56};
  const std::vector<double> expected{50, 50};
  const ChiSquared result = chi_squared(observed, expected);
  EXPECT_DOUBLE_EQ(result.statistic, 1.44);
  EXPECT_EQ(result.degrees, 1);
  EXPECT_NEAR(result.p, std::erfc(std::sqrt(0.72)), 1e-10);
}

TEST(ChiSquared, MergesCellsOfLowExpectation) {
  const std::vector<double> observed{1, 2, 0, 3, 100};
  const std::vector<double> expected{1, 2, 1, 2, 100};
  const ChiSquared result = chi_squared(observed, expected);
  EXPECT_EQ(result.degrees, 1);
  EXPECT_DOUBLE_EQ(result.statistic, 0.0);
}

TEST(ChiSquared, SamplesWhereNoneCanBeFail) {
  const std::vector<double> observed{1000, 1000, 1};
  const std::vector<double> expected{1000, 1000, 0};
  EXPECT_EQ(chi_squared(observed, expected).p, 0.0);
}

TEST(DirectionsFollow, AcceptsTheRightDensity) {
  EXPECT_TRUE(directions_follow(cosine_direction, cosine_density));
}

TEST(DirectionsFollow, SeesSmallErrors) {
  // The promised 1 %: more on one side, less on the other.
  const auto tilted = [](const Vec3& w) { return cosine_density(w) * (w.x > 0.0F ? 1.01 : 0.99); };
  EXPECT_FALSE(directions_follow(cosine_direction, tilted));
  const auto uniform = [](const Vec3& w) { return w.z > 0.0F ? 0.5 / M_PI : 0.0; };
  EXPECT_FALSE(directions_follow(cosine_direction, uniform));
}

TEST(DirectionsFollow, SeesDensitiesThatAreNotNormalised) {
  EXPECT_FALSE(
      directions_follow(cosine_direction, [](const Vec3& w) { return 1.01 * cosine_density(w); }));
  // Too little density would mean absorption, which does not happen.
  EXPECT_FALSE(
      directions_follow(cosine_direction, [](const Vec3& w) { return 0.99 * cosine_density(w); }));
}

TEST(DirectionsFollow, CountsAbsorbedSamples) {
  const auto sampler = [](Random& random) {
    return random.uniform() < 0.25F ? std::nullopt : cosine_direction(random);
  };
  EXPECT_TRUE(directions_follow(sampler, [](const Vec3& w) { return 0.75 * cosine_density(w); }));
  EXPECT_FALSE(directions_follow(sampler, [](const Vec3& w) { return 0.77 * cosine_density(w); }));
}

TEST(DirectionsFollow, DetectsThePromisedErrorAsOftenAsPromised) {
  int detected = 0;
  for (int i = 0; i < 60; ++i) {
    SphereTest test;
    test.grid = {4, 4};
    test.seed = 1000 + i;
    test.promise = {.significance = 0.01, .relative_error = 0.05, .power = 0.9};
    const auto wrong = [](const Vec3& w) { return cosine_density(w) * (w.x > 0.0F ? 1.05 : 0.95); };
    detected += directions_follow(cosine_direction, wrong, test) ? 0 : 1;
  }
  EXPECT_GE(detected, 48);  // 54 expected; fewer than 48 happens once in 200 trials
}

}  // namespace
}  // namespace hyades::test
