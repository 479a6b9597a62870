#include "core/job/expression_functions.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/base/elementary.h"
#include "core/base/hash.h"

namespace hyades::core::expression {

namespace {

constexpr double kTwoPi = 6.283185307179586476925;

/// Radians brought to -pi..pi before they become a float, so that long animations do not jitter.
float one_turn(double radians) {
  double rest = std::fmod(radians, kTwoPi);
  if (rest > 0.5 * kTwoPi) rest -= kTwoPi;
  if (rest < -0.5 * kTwoPi) rest += kTwoPi;
  return static_cast<float>(rest);
}

/// Slope of the noise at lattice point `i`, in [-2, 2]: then |noise| <= 1, reached half-way between
/// opposite extreme slopes.
double slope(double i) {
  // Beyond 2^62 doubles are whole numbers far apart: noise is 0 there whatever the slope.
  const double bounded = std::clamp(i, -4.0e18, 4.0e18);
  const uint64_t bits =
      mix64(static_cast<uint64_t>(static_cast<int64_t>(bounded)) ^ 0x6A09E667F3BCC909ULL);
  return static_cast<double>(bits >> 11) * 0x1.0p-53 * 4.0 - 2.0;
}

}  // namespace

double sin(double radians) { return core::sin(one_turn(radians)); }
double cos(double radians) { return core::cos(one_turn(radians)); }
double tan(double radians) { return core::tan(one_turn(radians)); }
double asin(double x) { return core::asin(static_cast<float>(x)); }
double acos(double x) { return core::acos(static_cast<float>(x)); }
double atan(double x) { return core::atan2(static_cast<float>(x), 1.0F); }
double atan2(double y, double x) {
  return core::atan2(static_cast<float>(y), static_cast<float>(x));
}
double exp(double x) { return core::exp(static_cast<float>(x)); }
double log(double x) { return core::log(static_cast<float>(x)); }

double pow(double x, double y) {
  if (y == std::floor(y) && std::abs(y) <= 64.0) {
    auto left = static_cast<unsigned>(std::abs(y));
    double result = 1.0;
    for (double factor = x; left != 0; left >>= 1U, factor *= factor) {
      if ((left & 1U) != 0) result *= factor;
    }
    return y < 0.0 ? 1.0 / result : result;
  }
  if (y == 0.5) return std::sqrt(x);
  return core::pow(static_cast<float>(x), static_cast<float>(y));
}

double mod(double a, double b) { return a - b * std::floor(a / b); }
double round(double x) { return std::floor(x + 0.5); }
double clamp(double x, double low, double high) { return std::min(std::max(x, low), high); }
double lerp(double a, double b, double u) { return (1.0 - u) * a + u * b; }

double smoothstep(double a, double b, double x) {
  if (a == b) return x < a ? 0.0 : 1.0;
  const double u = clamp((x - a) / (b - a), 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

double noise(double x) {
  if (!std::isfinite(x)) return std::numeric_limits<double>::quiet_NaN();
  const double i = std::floor(x);
  const double u = x - i;
  const double fade = u * u * u * (u * (u * 6.0 - 15.0) + 10.0);
  return lerp(slope(i) * u, slope(i + 1.0) * (u - 1.0), fade);
}

}  // namespace hyades::core::expression
