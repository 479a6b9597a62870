#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace hyades::core {

/// A signed Q64.64 fixed-point number (two's complement): addition is exact, associative and
/// commutative, which floating-point addition is not.
struct Fixed128 {
  uint64_t low = 0;  ///< fraction, units of 2^-64
  int64_t high = 0;  ///< integer part, floored

  friend bool operator==(const Fixed128&, const Fixed128&) = default;

  Fixed128& operator+=(const Fixed128& o) {
    const auto a = raw() + o.raw();
    low = static_cast<uint64_t>(a);
    high = static_cast<int64_t>(a >> 64);
    return *this;
  }
  Fixed128& operator-=(const Fixed128& o) {
    const auto a = raw() - o.raw();
    low = static_cast<uint64_t>(a);
    high = static_cast<int64_t>(a >> 64);
    return *this;
  }

  __extension__ typedef unsigned __int128 Raw;
  Raw raw() const { return (Raw{static_cast<uint64_t>(high)} << 64) | low; }
};

/// Largest magnitude that one deposited value may have, so that 2^22 of them cannot overflow.
inline constexpr float kMaxDeposit = 1.0995e12F;  // about 2^40

/// `value` as fixed point. Exact for multiples of 2^-64; finer bits are dropped towards minus
/// infinity (the same on every machine). Precondition: |value| <= kMaxDeposit, not NaN.
/// Works on the bits alone, so that no floating-point mode (FTZ, DAZ, rounding) can change it.
inline Fixed128 to_fixed(float value) {
  const uint32_t bits = std::bit_cast<uint32_t>(value);
  const uint32_t biased = (bits >> 23U) & 0xFFU;
  // value = mantissa * 2^(max(biased, 1) - 150); in units of 2^-64 the exponent grows by 64.
  const uint64_t mantissa = (bits & 0x7FFFFFU) | (biased != 0 ? 0x800000U : 0U);
  const int shift = static_cast<int>(std::max(biased, 1U)) - 86;
  __extension__ typedef __int128 Signed;
  Signed raw = (bits >> 31U) != 0 ? -Signed{static_cast<int64_t>(mantissa)}
                                  : Signed{static_cast<int64_t>(mantissa)};
  // Signed shifts are two's complement since C++20: left multiplies, right floors.
  raw = shift >= 0 ? raw << std::min(shift, 103) : raw >> std::min(-shift, 63);
  return {static_cast<uint64_t>(raw), static_cast<int64_t>(raw >> 64)};
}

/// The nearest double (round to nearest even; the error is below 2^-53 relative).
double to_double(const Fixed128& value);

}  // namespace hyades::core
