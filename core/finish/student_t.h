#pragma once

namespace hyades::core {

/// Probability that |T| >= |t| for Student's t with `dof` degrees of freedom (> 0; infinity means
/// the normal distribution). Relative error below 1e-9 as far as doubles reach.
double two_sided_p(double t, double dof);

/// The smallest of `tests` p-values, corrected for having looked at so many (Sidak 1967):
/// 1 - (1 - p)^tests, without cancellation. Conservative where the tests are correlated.
double sidak(double smallest_p, double tests);

}  // namespace hyades::core
