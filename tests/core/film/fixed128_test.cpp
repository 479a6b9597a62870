#include "core/film/fixed128.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace hyades::core {
namespace {

float from_bits(uint32_t bits) { return std::bit_cast<float>(bits); }

/// The definition, in long double: floor(value * 2^64), whose 64-bit mantissa holds any float.
Fixed128::Raw reference(float value) {
  const long double scaled = std::floor(std::ldexp(static_cast<long double>(value), 64));
  const bool negative = scaled < 0;
  long double magnitude = std::fabs(scaled);
  const auto high = static_cast<uint64_t>(std::ldexp(magnitude, -64));
  magnitude -= std::ldexp(static_cast<long double>(high), 64);
  const Fixed128::Raw raw = (Fixed128::Raw{high} << 64) | static_cast<uint64_t>(magnitude);
  return negative ? -raw : raw;
}

TEST(Fixed128, EqualsItsDefinitionForFloatsOfEverySize) {
  std::mt19937 random(1);
  int checked = 0;
  while (checked < 200000) {
    const float value = from_bits(static_cast<uint32_t>(random()));
    if (!(std::fabs(value) <= kMaxDeposit)) continue;
    ++checked;
    ASSERT_TRUE(to_fixed(value).raw() == reference(value)) << value;
  }
  for (const float value : {0.0F, -0.0F, 1.0F, -1.0F, 0x1p-64F, -0x1p-64F, 0x1p-65F, -0x1p-65F,
                            0x1p-149F, -0x1p-149F, kMaxDeposit, -kMaxDeposit}) {
    EXPECT_TRUE(to_fixed(value).raw() == reference(value)) << value;
  }
}

TEST(Fixed128, KnownValues) {
  EXPECT_EQ(to_fixed(1.5F), (Fixed128{uint64_t{1} << 63U, 1}));
  EXPECT_EQ(to_fixed(-0.25F), (Fixed128{uint64_t{3} << 62U, -1}));
  EXPECT_EQ(to_fixed(0x1p-64F), (Fixed128{1, 0}));
  EXPECT_EQ(to_fixed(0x1p-65F), (Fixed128{0, 0}));
  EXPECT_EQ(to_fixed(-0x1p-65F), (Fixed128{~uint64_t{0}, -1}));
  EXPECT_EQ(to_double({0, -1}), -1.0);
  EXPECT_EQ(to_double({0, INT64_MIN}), -0x1p63);
  EXPECT_EQ(to_double({~uint64_t{0}, INT64_MAX}), 0x1p63);
}

TEST(Fixed128, BackToTheSameDouble) {
  std::mt19937 random(2);
  for (int i = 0; i < 100000; ++i) {
    // Exponents at which every bit of the float is a multiple of 2^-64.
    const float value = std::ldexp(1.0F + static_cast<float>(random() % 0x800000) * 0x1p-23F,
                                   static_cast<int>(random() % 80) - 41) *
                        (random() % 2 == 0 ? 1.0F : -1.0F);
    ASSERT_EQ(to_double(to_fixed(value)), static_cast<double>(value));
  }
}

TEST(Fixed128, RoundsToNearestEven) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 200000; ++i) {
    // Random lengths, and bit patterns near ties.
    const auto width = static_cast<int>(random() % 127) + 1;
    Fixed128::Raw raw = (Fixed128::Raw{random()} << 64) | random();
    raw >>= 128 - width;
    if (width > 54 && i % 2 == 0) {
      const int below = width - 53;
      const Fixed128::Raw half = Fixed128::Raw{1} << (below - 1);
      raw = (raw & ~((half << 1) - 1)) + half + (i % 3) - 1;
    }
    const bool negative = i % 5 == 0;
    const Fixed128::Raw stored = negative ? -raw : raw;
    const Fixed128 value{static_cast<uint64_t>(stored), static_cast<int64_t>(stored >> 64)};
    const double got = std::fabs(to_double(value)) * 0x1p64;
    const auto back = static_cast<Fixed128::Raw>(got);
    // Compare with both neighbours, exactly.
    const auto distance = [&](double candidate) {
      const auto c = static_cast<Fixed128::Raw>(candidate);
      return c > raw ? c - raw : raw - c;
    };
    const Fixed128::Raw error = back > raw ? back - raw : raw - back;
    for (const double other : {std::nextafter(got, 0.0), std::nextafter(got, 0x1p127)}) {
      if (other < 1.0) continue;
      ASSERT_TRUE(error <= distance(other)) << i;
      if (error == distance(other) && error != 0) {
        ASSERT_EQ(std::bit_cast<uint64_t>(got) & 1U, 0U) << i;
      }
    }
    ASSERT_EQ(std::signbit(to_double(value)), negative && raw != 0);
  }
}

TEST(Fixed128, FourMillionLargestDepositsDoNotOverflow) {
  Fixed128 total;
  Fixed128 negative;
  const Fixed128 step = to_fixed(kMaxDeposit);
  for (int i = 0; i < (1 << 22); ++i) {
    total += step;
    negative += to_fixed(-kMaxDeposit);
  }
  EXPECT_EQ(to_double(total), static_cast<double>(kMaxDeposit) * 0x1p22);
  EXPECT_EQ(to_double(negative), -static_cast<double>(kMaxDeposit) * 0x1p22);
  total += negative;
  EXPECT_EQ(total, Fixed128{});
}

TEST(Fixed128, SubtractingUndoesAdding) {
  std::mt19937_64 random(4);
  Fixed128 total = to_fixed(3.25F);
  const Fixed128 before = total;
  for (int i = 0; i < 1000; ++i) {
    const Fixed128 value{random(), static_cast<int64_t>(random())};
    total += value;
    total -= value;
    ASSERT_EQ(total, before);
  }
}

}  // namespace
}  // namespace hyades::core
