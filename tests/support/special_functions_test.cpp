#include "tests/support/special_functions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hyades::test {
namespace {

TEST(SpecialFunctions, UpperGammaHasItsClosedForms) {
  for (const double x : {0.01, 0.5, 1.0, 3.0, 10.0, 50.0}) {
    EXPECT_NEAR(upper_gamma(1.0, x) / std::exp(-x), 1.0, 1e-10) << x;
    EXPECT_NEAR(upper_gamma(0.5, x) / std::erfc(std::sqrt(x)), 1.0, 1e-10) << x;
    // Q(3, x) = e^-x (1 + x + x^2 / 2)
    EXPECT_NEAR(upper_gamma(3.0, x) / (std::exp(-x) * (1.0 + x + 0.5 * x * x)), 1.0, 1e-10) << x;
  }
  EXPECT_EQ(upper_gamma(2.0, 0.0), 1.0);
  EXPECT_NEAR(upper_gamma(500.0, 500.0), 0.494, 1e-3);  // the median is near a - 1/3
}

TEST(SpecialFunctions, IncompleteBetaHasItsClosedForms) {
  for (const double x : {0.0, 0.1, 0.4, 0.75, 0.99, 1.0}) {
    EXPECT_NEAR(incomplete_beta(1.0, 1.0, x), x, 1e-12);
    EXPECT_NEAR(incomplete_beta(2.0, 1.0, x), x * x, 1e-12);
    EXPECT_NEAR(incomplete_beta(1.0, 3.0, x), 1.0 - std::pow(1.0 - x, 3.0), 1e-12);
    EXPECT_NEAR(incomplete_beta(0.5, 0.5, x), 2.0 / M_PI * std::asin(std::sqrt(x)), 1e-12);
  }
}

TEST(SpecialFunctions, QuantilesOfTheTables) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963985, 1e-8);
  EXPECT_NEAR(normal_quantile(0.01), -2.326347874, 1e-8);
  EXPECT_NEAR(normal_cdf(1.0), 0.841344746, 1e-9);
  // Abramowitz and Stegun, tables 26.8 and 26.10.
  EXPECT_NEAR(chi_squared_quantile(0.05, 10), 18.307, 1e-3);
  EXPECT_NEAR(chi_squared_quantile(0.01, 100), 135.807, 1e-3);
  EXPECT_NEAR(chi_squared_tail(3.841459, 1), 0.05, 1e-6);
  EXPECT_NEAR(student_two_sided(2.228, 10), 0.05, 1e-4);
  EXPECT_NEAR(student_two_sided(-12.706, 1), 0.05, 1e-4);
  EXPECT_NEAR(student_two_sided(1.959964, 1e7), 0.05, 1e-6);
}

}  // namespace
}  // namespace hyades::test
