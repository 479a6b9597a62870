#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

/// The double-precision insides of elementary.h: range reductions after Cody and Waite (1980,
/// "Software Manual for the Elementary Functions") and polynomials found by Remez exchange in
/// 50-digit arithmetic for the interval and error measure named at each. Only + - * / sqrt and bit
/// operations, grouped explicitly (Estrin's scheme), so that every compiler computes the same bits.
namespace hyades::core::elementary {

inline constexpr double kPiD = 3.141592653589793116;
inline constexpr double kHalfPiD = 1.570796326794896558;
inline constexpr double kQuarterPiD = 0.785398163397448279;
inline constexpr double kLn2 = 0.6931471805599453094;
inline constexpr double kLog2E = 1.4426950408889634074;

/// Adding and subtracting it rounds |x| < 2^51 to the nearest integer (ties to even), which then
/// stands in the low bits of the sum.
inline constexpr double kRoundMagic = 6755399441055744.0;  // 1.5 * 2^52

/// x rounded to the nearest integer, as a double and as (the low bits of) an integer.
struct Rounded {
  double value;
  int64_t integer;
};
inline Rounded round_to_integer(double x) {
  const double shifted = x + kRoundMagic;
  const auto low = std::bit_cast<uint64_t>(shifted) - std::bit_cast<uint64_t>(kRoundMagic);
  return {shifted - kRoundMagic, static_cast<int64_t>(low)};
}

/// 2^k for -1022 <= k <= 1023.
inline double power_of_two(int64_t k) {
  return std::bit_cast<double>(static_cast<uint64_t>(k + 1023) << 52);
}

/// mask all ones: a; zero: b. Keeps unpredictable choices free of branches.
inline double select(uint64_t mask, double a, double b) {
  return std::bit_cast<double>((std::bit_cast<uint64_t>(a) & mask) |
                               (std::bit_cast<uint64_t>(b) & ~mask));
}

/// sin(r), |r| <= pi/4; relative error 5.2e-12.
inline double sin_reduced(double r) {
  const double z = r * r;
  const double p = (-0.1666666664077623 + 0.008333329302416342 * z) +
                   (-0.00019839311485141237 + 2.718114115438729e-06 * z) * (z * z);
  return r + r * z * p;
}

/// cos(r), |r| <= pi/4; relative error 1.2e-13.
inline double cos_reduced(double r) {
  const double z = r * r;
  const double p = (0.04166666661945371 - 0.0013888883496857522 * z) +
                   (2.4799459309519893e-05 - 2.72056845841626e-07 * z) * (z * z);
  return (1.0 - 0.5 * z) + z * z * p;
}

/// x modulo 2 pi (as the double nearest to it) for |x| beyond reduce_quadrant; exact in that sense.
double reduce_huge(double x);

/// x = quadrant pi/2 + r with |r| <= pi/4. pi/2 is split into 32 leading bits, whose products with
/// quadrants below 2^21 are exact, and the rest.
struct Quadrant {
  double r;
  uint64_t quadrant;  ///< its two lowest bits count
};
inline Quadrant reduce_quadrant(double x) {
  if (!(x < 2.0e6 && x > -2.0e6)) x = reduce_huge(x);
  const Rounded k = round_to_integer(x * 0.6366197723675814);
  const double r = (x - k.value * 1.5707963267341256) - k.value * 6.077100506506192e-11;
  return {r, static_cast<uint64_t>(k.integer)};
}

/// exp(r) - 1, |r| <= ln(2)/2; relative error 5.3e-12.
inline double expm1_reduced(double r) {
  const double r2 = r * r;
  const double low = (0.500000000010498 + 0.1666666675392393 * r) +
                     (0.04166666595456476 + 0.008333289124924325 * r) * r2;
  const double high =
      (0.0013888985126439728 + 0.00019904858260370016 * r) + 2.4796382396287847e-05 * r2;
  return r + r2 * (low + high * (r2 * r2));
}

/// exp(x) for |x| <= 700 (no over- or underflow handling).
inline double exp_finite(double x) {
  const Rounded k = round_to_integer(x * kLog2E);
  const double r = (x - k.value * 0.6931471805592082) - k.value * 7.371002565167799e-13;
  const double scale = power_of_two(k.integer);
  return scale + scale * expm1_reduced(r);
}

/// 2^x for |x| <= 1000.
inline double exp2_finite(double x) {
  const Rounded k = round_to_integer(x);
  const double scale = power_of_two(k.integer);
  return scale + scale * expm1_reduced((x - k.value) * kLn2);
}

/// ln((1 + s) / (1 - s)), |s| <= (sqrt(2) - 1) / (sqrt(2) + 1); relative error 2.7e-14.
inline double log_ratio(double s) {
  const double z = s * s;
  const double z2 = z * z;
  const double p = (1.9999999999999467 + 0.6666666667966458 * z) +
                   ((0.39999994868011596 + 0.28572168470890874 * z) +
                    (0.22174157369802344 + 0.19609383783889284 * z) * z2) *
                       z2;
  return s * p;
}

/// x = 2^exponent * mantissa with mantissa in [sqrt(1/2), sqrt(2)), for positive normal doubles.
struct Split {
  double exponent;
  double mantissa;
};
inline Split split_exponent(double x) {
  const auto bits = std::bit_cast<uint64_t>(x);
  const uint64_t above = bits - std::bit_cast<uint64_t>(0.70710678118654752440);
  const int64_t k = static_cast<int64_t>(above) >> 52;
  return {static_cast<double>(k), std::bit_cast<double>(bits - (static_cast<uint64_t>(k) << 52))};
}

/// Natural logarithm of a positive, finite, normal double.
inline double log_finite(double x) {
  const Split s = split_exponent(x);
  return s.exponent * kLn2 + log_ratio((s.mantissa - 1.0) / (s.mantissa + 1.0));
}

/// Binary logarithm of a positive, finite, normal double; exact at powers of two.
inline double log2_finite(double x) {
  const Split s = split_exponent(x);
  return s.exponent + log_ratio((s.mantissa - 1.0) / (s.mantissa + 1.0)) * kLog2E;
}

/// asin(r), 0 <= r <= 0.5, where z = r^2; relative error 9.8e-13.
inline double asin_reduced(double r, double z) {
  const double z2 = z * z;
  const double z4 = z2 * z2;
  const double low = (0.166666666273347 + 0.07500004981694666 * z) +
                     (0.044640707927503694 + 0.030426521672957632 * z) * z2;
  const double high = (0.02186572656896762 + 0.02064636415594119 * z) +
                      (0.0019790647410682545 + 0.03291183292859168 * z) * z2;
  return r + r * z * (low + high * z4);
}

/// atan(t), |t| <= tan(pi/8); relative error 7.9e-13.
inline double atan_reduced(double t) {
  const double z = t * t;
  const double z2 = z * z;
  const double low = (-0.33333333295681095 + 0.19999994320607986 * z) +
                     (-0.1428542338337555 + 0.11103999354913364 * z) * z2;
  const double high = (-0.08996797225170865 + 0.06991018102473645 * z) - 0.03792071180406088 * z2;
  return t + t * z * (low + high * (z2 * z2));
}

}  // namespace hyades::core::elementary
