#pragma once

/// The distribution functions behind the statistical tests, in double.
namespace hyades::test {

/// Regularised upper incomplete gamma function Q(a, x): a > 0, x >= 0. Q(k/2, x/2) is the
/// probability that a chi-squared variable of k degrees exceeds x. Relative error < 1e-10.
double upper_gamma(double a, double x);

/// Regularised incomplete beta function I_x(a, b): a, b > 0, x in [0, 1].
double incomplete_beta(double a, double b, double x);

/// Probability that a standard normal variable is below z.
double normal_cdf(double z);

/// The z with normal_cdf(z) = p, p in (0, 1).
double normal_quantile(double p);

/// Probability that |T| >= |t| for Student's t of `degrees` > 0 degrees of freedom.
double student_two_sided(double t, double degrees);

/// Probability that a chi-squared variable of `degrees` >= 1 is at least `x`.
double chi_squared_tail(double x, double degrees);

/// The x with chi_squared_tail(x, degrees) = p.
double chi_squared_quantile(double p, double degrees);

}  // namespace hyades::test
