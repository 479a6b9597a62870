#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/elementary_kernels.h"

/// Elementary functions with the same bits on every processor and C library: polynomials in double
/// from + - * / sqrt alone, rounded once to float (glibc chooses FMA variants at run time, so its
/// sin, cos, exp, pow differ between machines; see docs/architecture.md). All accept any float;
/// errors are at most 0.51 ulp of float unless noted; NaN in gives NaN out; the sign of zero is
/// ignored. Under FpMode denormal arguments and results are zeros, as in all arithmetic.
namespace hyades::core {

struct SinCos {
  float sin;
  float cos;
};

/// x in radians, any |x| <= 2e6 to full precision; beyond, the absolute error grows as
/// |x| 2^-53; infinity gives NaN.
inline SinCos sin_cos(float x) {
  const elementary::Quadrant q = elementary::reduce_quadrant(x);
  const double s = elementary::sin_reduced(q.r);
  const double c = elementary::cos_reduced(q.r);
  const uint64_t odd = 0 - (q.quadrant & 1);
  const uint64_t sin_sign = (q.quadrant & 2) << 62;
  const uint64_t cos_sign = ((q.quadrant + 1) & 2) << 62;
  const auto sine = std::bit_cast<uint64_t>(elementary::select(odd, c, s)) ^ sin_sign;
  const auto cosine = std::bit_cast<uint64_t>(elementary::select(odd, s, c)) ^ cos_sign;
  return {static_cast<float>(std::bit_cast<double>(sine)),
          static_cast<float>(std::bit_cast<double>(cosine))};
}

inline float sin(float x) { return sin_cos(x).sin; }  ///< as sin_cos
inline float cos(float x) { return sin_cos(x).cos; }  ///< as sin_cos

/// The tangent of `x` [radians], as exact as sin_cos.
inline float tan(float x) {
  const elementary::Quadrant q = elementary::reduce_quadrant(x);
  const double s = elementary::sin_reduced(q.r);
  const double c = elementary::cos_reduced(q.r);
  return static_cast<float>((q.quadrant & 1) != 0 ? -c / s : s / c);
}

/// x clamped to [-1, 1]; radians.
inline float asin(float x) {
  const double a = x < 0.0F ? -double{x} : double{x};
  const bool big = a > 0.5;
  const double z = big ? (a < 1.0 ? 0.5 - 0.5 * a : 0.0) : a * a;
  const double p = elementary::asin_reduced(big ? std::sqrt(z) : a, z);
  const double positive = big ? elementary::kHalfPiD - 2.0 * p : p;
  return static_cast<float>(x < 0.0F ? -positive : positive);
}

/// x clamped to [-1, 1]; radians, [0, pi].
inline float acos(float x) {
  const double a = x < 0.0F ? -double{x} : double{x};
  const bool big = a > 0.5;
  const double z = big ? (a < 1.0 ? 0.5 - 0.5 * a : 0.0) : a * a;
  const double p = elementary::asin_reduced(big ? std::sqrt(z) : a, z);
  if (big) return static_cast<float>(x < 0.0F ? elementary::kPiD - 2.0 * p : 2.0 * p);
  return static_cast<float>(elementary::kHalfPiD - (x < 0.0F ? -p : p));
}

/// Angle of the point (x, y), [-pi, pi] radians; atan2(0, 0) = 0, atan2(0, negative) = pi;
/// infinities count as in the limit of equal magnitudes.
inline float atan2(float y, float x) {
  if (x != x || y != y) return x + y;
  const double ax = x < 0.0F ? -double{x} : double{x};
  const double ay = y < 0.0F ? -double{y} : double{y};
  double high = ax > ay ? ax : ay;
  double low = ax > ay ? ay : ax;
  if (high == 0.0) return 0.0F;
  if (high == std::numeric_limits<double>::infinity()) {
    low = low == high ? 1.0 : 0.0;
    high = 1.0;
  }
  const bool steep = low > 0.41421356237309503 * high;  // tan(pi/8): rotate by pi/4
  const double t = (steep ? low - high : low) / (steep ? low + high : high);
  double angle = elementary::atan_reduced(t) + (steep ? elementary::kQuarterPiD : 0.0);
  if (ay > ax) angle = elementary::kHalfPiD - angle;
  if (x < 0.0F) angle = elementary::kPiD - angle;
  return static_cast<float>(y < 0.0F ? -angle : angle);
}

/// Overflows to +inf, underflows to 0.
inline float exp(float x) {
  const double clamped = x < -104.0F ? -104.0 : x > 89.0F ? 89.0 : double{x};
  return static_cast<float>(elementary::exp_finite(clamped));
}

/// exp(x) - 1 without cancellation near 0.
inline float expm1(float x) {
  const double clamped = x < -104.0F ? -104.0 : x > 89.0F ? 89.0 : double{x};
  const elementary::Rounded k = elementary::round_to_integer(clamped * elementary::kLog2E);
  const double r = (clamped - k.value * 0.6931471805592082) - k.value * 7.371002565167799e-13;
  const double scale = elementary::power_of_two(k.integer);
  return static_cast<float>(scale * elementary::expm1_reduced(r) + (scale - 1.0));
}

/// Natural; log(0) = -inf, negative: NaN.
inline float log(float x) {
  using Limits = std::numeric_limits<float>;
  if (!(x > 0.0F && x < Limits::infinity())) {
    if (x == 0.0F) return -Limits::infinity();
    return x > 0.0F ? x : Limits::quiet_NaN();
  }
  return static_cast<float>(elementary::log_finite(x));
}

/// log(1 + x) without cancellation near 0; log1p(-1) = -inf, below: NaN.
inline float log1p(float x) {
  using Limits = std::numeric_limits<float>;
  if (!(x > -1.0F && x < Limits::infinity())) {
    if (x == -1.0F) return -Limits::infinity();
    return x > 0.0F ? x : Limits::quiet_NaN();
  }
  const double y = 1.0 + double{x};
  // Within one octave of 1 the addition above may lose low bits of x: take them from x itself.
  if (x > -0.29F && x < 0.41F) {
    return static_cast<float>(elementary::log_ratio(double{x} / (2.0 + double{x})));
  }
  return static_cast<float>(elementary::log_finite(y));
}

/// Exact at integers; overflows to +inf, underflows to 0.
inline float exp2(float x) {
  const double clamped = x < -151.0F ? -151.0 : x > 129.0F ? 129.0 : double{x};
  return static_cast<float>(elementary::exp2_finite(clamped));
}

/// Exact at powers of two; log2(0) = -inf, negative: NaN.
inline float log2(float x) {
  using Limits = std::numeric_limits<float>;
  if (!(x > 0.0F && x < Limits::infinity())) {
    if (x == 0.0F) return -Limits::infinity();
    return x > 0.0F ? x : Limits::quiet_NaN();
  }
  return static_cast<float>(elementary::log2_finite(x));
}

/// x^y for x >= 0; pow(0, 0) = 1, pow(0, y < 0) = +inf; negative x: NaN.
inline float pow(float x, float y) {
  using Limits = std::numeric_limits<float>;
  if (x != x || y != y) return x + y;
  if (y == 0.0F || x == 1.0F) return x < 0.0F ? Limits::quiet_NaN() : 1.0F;
  if (!(x > 0.0F)) {
    if (x < 0.0F) return Limits::quiet_NaN();
    return y > 0.0F ? 0.0F : Limits::infinity();
  }
  if (x == Limits::infinity()) return y > 0.0F ? x : 0.0F;
  const double e = double{y} * elementary::log2_finite(x);
  const double clamped = e < -151.0 ? -151.0 : e > 129.0 ? 129.0 : e;
  return static_cast<float>(elementary::exp2_finite(clamped));
}

/// Real cube root, also of negative numbers.
inline float cbrt(float x) {
  if (!(x != 0.0F && x - x == 0.0F)) return x;  // zeros, infinities, NaN
  const double a = x < 0.0F ? -double{x} : double{x};
  // A third of the exponent gives two figures (the constant centres the error); two steps of
  // Halley's method t (t^3 + 2 a) / (2 t^3 + a) triple them each.
  double t = std::bit_cast<double>(std::bit_cast<uint64_t>(a) / 3 + 0x2A9F789300000000ULL);
  for (int i = 0; i < 2; ++i) {
    const double cube = t * t * t;
    t = t * ((cube + 2.0 * a) / (2.0 * cube + a));
  }
  return static_cast<float>(x < 0.0F ? -t : t);
}

}  // namespace hyades::core
