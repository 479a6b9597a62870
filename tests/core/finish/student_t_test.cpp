#include "core/finish/student_t.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace hyades::core {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(StudentT, ClosedFormsForOneAndTwoDegrees) {
  for (const double t : {0.0, 0.01, 0.5, 1.0, 2.0, 7.0, 100.0, 1e6}) {
    const double one = 2.0 / std::numbers::pi * std::atan2(1.0, t);
    EXPECT_NEAR(two_sided_p(t, 1.0), one, 1e-10 * one) << t;
    const double root = std::sqrt(2.0 + t * t);
    const double two = 2.0 / (root * (root + t));  // 1 - t / root without cancellation
    EXPECT_NEAR(two_sided_p(t, 2.0), two, 1e-10 * two) << t;
    EXPECT_EQ(two_sided_p(-t, 5.0), two_sided_p(t, 5.0));
  }
}

TEST(StudentT, TablesOfQuantiles) {
  EXPECT_NEAR(two_sided_p(2.228139, 10.0), 0.05, 1e-7);
  EXPECT_NEAR(two_sided_p(2.749996, 30.0), 0.01, 1e-7);
  EXPECT_NEAR(two_sided_p(4.072765, 15.0), 0.001, 1e-8);
  EXPECT_NEAR(two_sided_p(1.959964, kInfinite), 0.05, 1e-7);
  EXPECT_NEAR(two_sided_p(3.0, kInfinite), 0.0026997961, 1e-10);
  EXPECT_NEAR(two_sided_p(3.0, 9e5) / two_sided_p(3.0, kInfinite), 1.0, 1e-4);
}

TEST(StudentT, OddArguments) {
  EXPECT_EQ(two_sided_p(0.0, 7.0), 1.0);
  EXPECT_EQ(two_sided_p(kInfinite, 7.0), 0.0);
  EXPECT_TRUE(std::isnan(two_sided_p(1.0, 0.0)));
  EXPECT_TRUE(std::isnan(two_sided_p(std::nan(""), 3.0)));
}

TEST(StudentT, Sidak) {
  EXPECT_NEAR(sidak(0.01, 1.0), 0.01, 1e-15);
  EXPECT_NEAR(sidak(0.5, 2.0), 0.75, 1e-15);
  EXPECT_NEAR(sidak(1e-20, 1e6), 1e-14, 1e-20);
  EXPECT_EQ(sidak(1.0, 5.0), 1.0);
  EXPECT_EQ(sidak(0.0, 5.0), 0.0);
}

}  // namespace
}  // namespace hyades::core
