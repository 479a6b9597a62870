#include "core/base/half.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "tests/support/random.h"

namespace hyades::core {
namespace {

TEST(Half, AllOfThemGoThereAndBack) {
  for (uint32_t bits = 0; bits < 65536; ++bits) {
    const auto half = static_cast<uint16_t>(bits);
    const float value = from_half(half);
    const int exponent = static_cast<int>((bits >> 10U) & 31U);
    const auto mantissa = static_cast<float>(bits & 0x3FFU);
    const float sign = (bits & 0x8000U) != 0 ? -1.0F : 1.0F;
    if (exponent == 31) {
      EXPECT_EQ(std::isnan(value), mantissa != 0.0F);
      EXPECT_EQ(std::isinf(value), mantissa == 0.0F);
    } else {
      const float expected = exponent == 0 ? mantissa * 0x1p-24F
                                           : std::ldexp(1.0F + mantissa / 1024.0F, exponent - 15);
      EXPECT_EQ(value, sign * expected) << bits;
    }
    if (!std::isnan(value)) {
      EXPECT_EQ(to_half(value), half) << bits;
    }
  }
  EXPECT_TRUE(std::isnan(from_half(to_half(std::numeric_limits<float>::quiet_NaN()))));
}

TEST(Half, RoundsToTheNearestAndTiesToEven) {
  test::Random random(3);
  for (int i = 0; i < 100000; ++i) {
    const auto low = static_cast<uint16_t>(random.bits() % 0x7BFFU);
    const double a = from_half(low);
    const double b = from_half(static_cast<uint16_t>(low + 1));
    const auto x = static_cast<float>(a + (b - a) * random.uniform_double());
    const uint16_t rounded = to_half(x);
    if (double{x} - a != b - double{x}) {
      EXPECT_EQ(rounded, double{x} - a < b - double{x} ? low : low + 1) << x;
    }
    EXPECT_EQ(to_half(-x), rounded | 0x8000U);
    EXPECT_EQ(to_half(static_cast<float>(0.5 * (a + b))), low % 2 == 0 ? low : low + 1);
  }
  EXPECT_EQ(to_half(65519.0F), 0x7BFF);
  EXPECT_EQ(to_half(65520.0F), 0x7C00);
  EXPECT_EQ(to_half(3e38F), 0x7C00);
}

}  // namespace
}  // namespace hyades::core
