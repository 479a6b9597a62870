#include "core/base/elementary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/base/fp_mode.h"
#include "core/base/hash.h"

namespace hyades::core {
namespace {

using Real = long double;
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kBound = 0.51;
constexpr int kSamples = 200'000;

/// Distance of `got` from the exact value in units of the float spacing at the exact value.
double ulp_error(float got, Real exact) {
  if (std::isnan(got) || std::isnan(exact)) return std::isnan(got) == std::isnan(exact) ? 0 : 1e9;
  const Real max = std::numeric_limits<float>::max();
  if (std::fabs(exact) >= max) return std::isinf(got) || std::fabs(got) == max ? 0 : 1e9;
  if (std::isinf(got)) return 1e9;
  int exponent = 0;
  std::frexp(exact, &exponent);
  const Real spacing = std::ldexp(Real{1}, std::max(exponent, -125) - 24);
  return static_cast<double>(std::fabs(got - exact) / spacing);
}

double unit(uint64_t i, uint64_t stream) {
  return static_cast<double>(hash_combine(i, stream) >> 11) * 0x1p-53;
}

/// Any finite float, all exponents alike.
float any_float(uint64_t i, uint64_t stream) {
  const auto bits = static_cast<uint32_t>(hash_combine(i, stream) >> 32);
  const float x = std::bit_cast<float>(bits);
  return std::isfinite(x) ? x : 1.0F;
}

struct Range {
  double low;
  double high;
};

void expect_accurate(const std::string& name, const std::function<float(float)>& f,
                     const std::function<Real(Real)>& exact, const std::vector<Range>& ranges) {
  double worst = 0.0;
  float at = 0.0F;
  const auto check = [&](float x) {
    const double e = ulp_error(f(x), exact(x));
    if (e > worst) {
      worst = e;
      at = x;
    }
  };
  for (size_t r = 0; r < ranges.size(); ++r) {
    const auto [low, high] = ranges[r];
    for (uint64_t i = 0; i < kSamples; ++i) {
      check(static_cast<float>(low + (high - low) * unit(i, 17 + r)));
    }
    check(static_cast<float>(low));
    check(static_cast<float>(high));
    // Arguments of all magnitudes down to the smallest normal number.
    for (uint64_t i = 0; i < kSamples / 4; ++i) {
      const float x = any_float(i, 99 + r);
      if (x >= low && x <= high && std::isnormal(x)) check(x);
    }
  }
  testing::Test::RecordProperty("max_ulp_" + name, std::to_string(worst));
  EXPECT_LE(worst, kBound) << name << " at " << at;
}

TEST(Elementary, TrigonometryIsAccurate) {
  const std::vector<Range> ranges = {{-1, 1}, {-10, 10}, {-1000, 1000}, {-1.9e6, 1.9e6}};
  expect_accurate("sin", core::sin, sinl, ranges);
  expect_accurate("cos", core::cos, cosl, ranges);
  expect_accurate("tan", core::tan, tanl, ranges);
}

TEST(Elementary, InverseTrigonometryIsAccurate) {
  const std::vector<Range> ranges = {{-1, 1}, {0.999, 1}, {-1, -0.999}, {-1e-3, 1e-3}};
  expect_accurate("asin", core::asin, asinl, ranges);
  expect_accurate("acos", core::acos, acosl, ranges);
}

TEST(Elementary, ArcTangentOfTwoIsAccurate) {
  double worst = 0.0;
  for (uint64_t i = 0; i < 3 * kSamples; ++i) {
    const bool wild = i % 3 == 0;
    const float y = wild ? any_float(i, 3) : static_cast<float>(2.0 * unit(i, 3) - 1.0);
    const float x = wild ? any_float(i, 4) : static_cast<float>(2.0 * unit(i, 4) - 1.0);
    const double e = ulp_error(core::atan2(y, x), atan2l(y, x));
    if (std::fabs(y) < 1e-37F && e <= 1.0) continue;  // denormal ratios round twice
    worst = std::max(worst, e);
  }
  RecordProperty("max_ulp_atan2", std::to_string(worst));
  EXPECT_LE(worst, kBound);
}

TEST(Elementary, ExponentialsAreAccurate) {
  const std::vector<Range> ranges = {{-87, 88.7}, {-1, 1}, {-1e-3, 1e-3}};
  expect_accurate("exp", core::exp, expl, ranges);
  expect_accurate("expm1", core::expm1, expm1l, ranges);
  expect_accurate("exp2", core::exp2, exp2l, {{-125.9, 127.9}, {-1, 1}, {-1e-3, 1e-3}});
}

TEST(Elementary, LogarithmsAreAccurate) {
  const std::vector<Range> ranges = {{1e-37, 3e38}, {1e-3, 10}, {0.9, 1.1}, {0.9999, 1.0001}};
  expect_accurate("log", core::log, logl, ranges);
  expect_accurate("log2", core::log2, log2l, ranges);
  expect_accurate("log1p", core::log1p, log1pl,
                  {{-0.9999999, 3e38}, {-0.99, 10}, {-0.5, 0.5}, {-1e-4, 1e-4}});
}

TEST(Elementary, CubeRootIsAccurate) {
  expect_accurate("cbrt", core::cbrt, cbrtl, {{-3e38, 3e38}, {-8, 8}, {-1e-3, 1e-3}});
}

TEST(Elementary, PowerIsAccurate) {
  double worst = 0.0;
  const auto check = [&](float x, float y) {
    const Real exact = powl(x, y);
    if (exact != 0 && exact < std::numeric_limits<float>::min()) return;
    worst = std::max(worst, ulp_error(core::pow(x, y), exact));
  };
  for (uint64_t i = 0; i < kSamples; ++i) {
    check(std::fabs(any_float(i, 5)), static_cast<float>(4.0 * unit(i, 6) - 2.0));
    check(static_cast<float>(unit(i, 7)), static_cast<float>(100.0 * unit(i, 8)));
    check(static_cast<float>(0.9 + 0.2 * unit(i, 9)),
          static_cast<float>(2000 * unit(i, 10) - 1000));
  }
  RecordProperty("max_ulp_pow", std::to_string(worst));
  EXPECT_LE(worst, kBound);
}

TEST(Elementary, SpecialValuesAreAsDocumented) {
  for (const auto f : {core::sin, core::cos, core::tan, core::asin, core::acos, core::exp,
                       core::expm1, core::log, core::log1p, core::exp2, core::log2, core::cbrt}) {
    EXPECT_TRUE(std::isnan(f(kNan)));
  }
  EXPECT_TRUE(std::isnan(core::sin(kInf)) && std::isnan(core::cos(-kInf)));
  EXPECT_EQ(core::sin(0.0F), 0.0F);
  EXPECT_EQ(core::cos(0.0F), 1.0F);
  EXPECT_EQ(core::asin(1.5F), core::asin(1.0F));
  EXPECT_EQ(core::asin(-kInf), core::asin(-1.0F));
  EXPECT_EQ(core::acos(2.0F), 0.0F);
  EXPECT_EQ(core::acos(-2.0F), 3.14159265358979F);
  EXPECT_EQ(core::exp(0.0F), 1.0F);
  EXPECT_EQ(core::exp(kInf), kInf);
  EXPECT_EQ(core::exp(89.0F), kInf);
  EXPECT_EQ(core::exp(-kInf), 0.0F);
  EXPECT_EQ(core::expm1(-kInf), -1.0F);
  EXPECT_EQ(core::expm1(1e30F), kInf);
  EXPECT_EQ(core::exp2(128.0F), kInf);
  EXPECT_EQ(core::exp2(-kInf), 0.0F);
  EXPECT_EQ(core::log(0.0F), -kInf);
  EXPECT_EQ(core::log(-0.0F), -kInf);
  EXPECT_EQ(core::log(1.0F), 0.0F);
  EXPECT_EQ(core::log(kInf), kInf);
  EXPECT_TRUE(std::isnan(core::log(-1.0F)) && std::isnan(core::log2(-kInf)));
  EXPECT_EQ(core::log1p(-1.0F), -kInf);
  EXPECT_TRUE(std::isnan(core::log1p(-1.5F)));
  EXPECT_EQ(core::log1p(kInf), kInf);
  EXPECT_EQ(core::log2(0.0F), -kInf);
  for (int k = -126; k <= 127; ++k) {
    EXPECT_EQ(core::log2(std::ldexp(1.0F, k)), static_cast<float>(k));
    EXPECT_EQ(core::exp2(static_cast<float>(k)), std::ldexp(1.0F, k));
  }
  EXPECT_EQ(core::cbrt(0.0F), 0.0F);
  EXPECT_EQ(core::cbrt(-27.0F), -3.0F);
  EXPECT_EQ(core::cbrt(-kInf), -kInf);
}

TEST(Elementary, SpecialAnglesOfAtan2) {
  const float pi = 3.14159265358979F;
  EXPECT_EQ(core::atan2(0.0F, 0.0F), 0.0F);
  EXPECT_EQ(core::atan2(0.0F, -1.0F), pi);
  EXPECT_EQ(core::atan2(-0.0F, -1.0F), pi);
  EXPECT_EQ(core::atan2(1.0F, 0.0F), pi / 2);
  EXPECT_EQ(core::atan2(-1.0F, 0.0F), -pi / 2);
  EXPECT_EQ(core::atan2(2.0F, 2.0F), pi / 4);
  EXPECT_EQ(core::atan2(kInf, kInf), pi / 4);
  EXPECT_EQ(core::atan2(kInf, -kInf), static_cast<float>(0.75 * 3.14159265358979));
  EXPECT_EQ(core::atan2(1.0F, kInf), 0.0F);
  EXPECT_EQ(core::atan2(1.0F, -kInf), pi);
  EXPECT_EQ(core::atan2(-kInf, 3.0F), -pi / 2);
  EXPECT_TRUE(std::isnan(core::atan2(kNan, 1.0F)) && std::isnan(core::atan2(1.0F, kNan)));
}

TEST(Elementary, SpecialPowers) {
  EXPECT_EQ(core::pow(0.0F, 0.0F), 1.0F);
  EXPECT_EQ(core::pow(0.0F, 2.0F), 0.0F);
  EXPECT_EQ(core::pow(0.0F, -2.0F), kInf);
  EXPECT_EQ(core::pow(1.0F, kInf), 1.0F);
  EXPECT_EQ(core::pow(kInf, 0.0F), 1.0F);
  EXPECT_EQ(core::pow(kInf, -1.0F), 0.0F);
  EXPECT_EQ(core::pow(0.5F, kInf), 0.0F);
  EXPECT_EQ(core::pow(2.0F, kInf), kInf);
  EXPECT_EQ(core::pow(3.0F, 4.0F), 81.0F);
  EXPECT_EQ(core::pow(1e30F, 2.0F), kInf);
  EXPECT_TRUE(std::isnan(core::pow(-2.0F, 2.0F)) && std::isnan(core::pow(-2.0F, 0.0F)));
  EXPECT_TRUE(std::isnan(core::pow(kNan, 0.0F)) && std::isnan(core::pow(1.0F, kNan)));
}

TEST(Elementary, HugeAnglesStayInRange) {
  for (uint64_t i = 0; i < 20'000; ++i) {
    const float x = any_float(i, 12);
    const SinCos sc = sin_cos(x);
    EXPECT_NEAR(sc.sin * sc.sin + sc.cos * sc.cos, 1.0F, 1e-6F) << x;
    if (std::fabs(x) < 1e9F) {
      EXPECT_NEAR(sc.sin, std::sin(double{x}), 1e-7 + std::fabs(x) * 0x1p-53);
      EXPECT_NEAR(sc.cos, std::cos(double{x}), 1e-7 + std::fabs(x) * 0x1p-53);
    }
  }
}

/// Hash of the bits of a million values of `f(i)`; every NaN counts alike.
template <class Function>
uint64_t bits_of(const Function& f) {
  const FpMode mode;
  uint64_t hash = 0;
  for (uint64_t i = 0; i < 1'000'000; ++i) {
    const float y = f(i);
    hash = hash_combine(hash, y == y ? std::bit_cast<uint32_t>(y) : 0x7FC00000U);
  }
  return hash;
}

/// Half of the arguments of any magnitude, half in [-12, 12).
float argument(uint64_t i, uint64_t stream) {
  return i % 2 == 0 ? any_float(i, stream) : static_cast<float>(24.0 * unit(i, stream) - 12.0);
}

// The constants are the bits that every supported compiler and processor must reproduce (invariant
// 1). A change of the functions changes them on purpose, and changes every picture.
TEST(Elementary, BitsAreTheSameOnEveryMachine) {
  const auto bits = [](float (*f)(float)) {
    return bits_of([f](uint64_t i) { return f(argument(i, 1)); });
  };
  const auto unit_bits = [](float (*f)(float)) {
    return bits_of([f](uint64_t i) { return f(argument(i, 1) / 12.0F); });
  };
  const auto positive_bits = [](float (*f)(float)) {
    return bits_of([f](uint64_t i) { return f(std::fabs(argument(i, 1))); });
  };
  EXPECT_EQ(bits(core::sin), 0x18F45002AA35586EULL);
  EXPECT_EQ(bits(core::cos), 0x6CF1BEC0CA4B7616ULL);
  EXPECT_EQ(bits(core::tan), 0xEB523B9F007BEBCDULL);
  EXPECT_EQ(unit_bits(core::asin), 0xA5D6799E30AD47F2ULL);
  EXPECT_EQ(unit_bits(core::acos), 0xB0500780FFD43519ULL);
  EXPECT_EQ(bits_of([](uint64_t i) { return core::atan2(argument(i, 1), argument(i, 2)); }),
            0xE2EFB91422D70333ULL);
  EXPECT_EQ(bits(core::exp), 0x76163EA5DC61FC91ULL);
  EXPECT_EQ(bits(core::expm1), 0x9A033A73551759D6ULL);
  EXPECT_EQ(positive_bits(core::log), 0xC2DB118ABB43CD17ULL);
  EXPECT_EQ(bits(core::log1p), 0x33761BDC778CA2D7ULL);
  EXPECT_EQ(bits(core::exp2), 0x15D9058A9EBE4E5EULL);
  EXPECT_EQ(positive_bits(core::log2), 0x74B2968CC50FD21FULL);
  EXPECT_EQ(bits_of([](uint64_t i) {
              return core::pow(std::fabs(argument(i, 1)), argument(i | 1, 2) / 4.0F);
            }),
            0xC920FDB87E5E205FULL);
  EXPECT_EQ(bits(core::cbrt), 0x659CEDFAA2D1E74EULL);
}

}  // namespace
}  // namespace hyades::core
