#include "core/finish/student_t.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hyades::core {
namespace {

/// The continued fraction of the incomplete beta function (DLMF 8.17.22), evaluated from the front
/// by Lentz's method as modified by Thompson and Barnett (1986). Converges fast for
/// x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  const auto away_from_zero = [](double v) { return std::abs(v) < kTiny ? kTiny : v; };
  double c = 1.0;
  double d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
  double fraction = d;
  for (int m = 1; m < 10'000; ++m) {
    const double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
    d = 1.0 / away_from_zero(1.0 + even * d);
    c = away_from_zero(1.0 + even / c);
    fraction *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
    d = 1.0 / away_from_zero(1.0 + odd * d);
    c = away_from_zero(1.0 + odd / c);
    fraction *= d * c;
    if (std::abs(d * c - 1.0) < 1e-15) break;
  }
  return fraction;
}

double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);  // std::lgamma writes a global
}

/// I_x(a, b), the regularised incomplete beta function, with y = 1 - x given for precision.
double regularised_beta(double a, double b, double x, double y) {
  if (x <= 0.0) return 0.0;
  if (y <= 0.0) return 1.0;
  const double front =
      std::exp(a * std::log(x) + b * std::log(y) + log_gamma(a + b) - log_gamma(a) - log_gamma(b));
  if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
  return 1.0 - front * beta_fraction(b, a, y) / b;
}

}  // namespace

double two_sided_p(double t, double dof) {
  if (std::isnan(t) || !(dof > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  if (std::isinf(t)) return 0.0;
  if (dof > 1e6) return std::erfc(std::abs(t) / std::sqrt(2.0));
  const double t2 = t * t;
  return regularised_beta(0.5 * dof, 0.5, dof / (dof + t2), t2 / (dof + t2));
}

double sidak(double smallest_p, double tests) {
  if (!(smallest_p < 1.0)) return 1.0;
  return std::clamp(-std::expm1(tests * std::log1p(-smallest_p)), 0.0, 1.0);
}

}  // namespace hyades::core
