#include "tests/support/means.h"

#include <cmath>

#include "tests/support/special_functions.h"

namespace hyades::test {
namespace {

constexpr double kExact = 1e-6;  // float rounding

bool equal(double a, double b) {
  return std::abs(a - b) <= kExact * std::fmax(std::abs(a), std::abs(b));
}

::testing::AssertionResult judge(double found, double expected, double variance_of_mean, double p,
                                 const Promise& promise) {
  const double alpha = sidak(promise.significance, promise.tests);
  const double detectable = detectable_effect(variance_of_mean, alpha, promise.power);
  const double wanted = promise.relative_error * std::abs(expected);
  if (!(detectable <= wanted)) {
    return ::testing::AssertionFailure()
           << "underpowered: detects errors of " << detectable << " with probability "
           << promise.power << ", promised " << wanted << " (" << 100.0 * promise.relative_error
           << " % of " << expected << "); take " << std::pow(detectable / wanted, 2.0)
           << " times the samples";
  }
  if (!(p >= alpha)) {
    return ::testing::AssertionFailure()
           << "mean " << found << " +- " << std::sqrt(variance_of_mean) << ", expected " << expected
           << ": p = " << p << " < " << alpha;
  }
  return ::testing::AssertionSuccess() << "mean " << found << ", p = " << p;
}

}  // namespace

double sidak(double significance, int tests) {
  return -std::expm1(std::log1p(-significance) / tests);
}

double t_test(const Moments& sample, double expected) {
  if (sample.count() < 2 || !(sample.variance_of_mean() > 0.0)) {
    return sample.count() > 0 && equal(sample.mean(), expected) ? 1.0 : 0.0;
  }
  const double t = (sample.mean() - expected) / std::sqrt(sample.variance_of_mean());
  return student_two_sided(t, static_cast<double>(sample.count() - 1));
}

double t_test(const Moments& a, const Moments& b) {
  const double va = a.variance_of_mean();
  const double vb = b.variance_of_mean();
  if (a.count() < 2 || b.count() < 2 || !(va + vb > 0.0)) {
    return a.count() > 0 && b.count() > 0 && equal(a.mean(), b.mean()) ? 1.0 : 0.0;
  }
  const double degrees =
      (va + vb) * (va + vb) /
      (va * va / static_cast<double>(a.count() - 1) + vb * vb / static_cast<double>(b.count() - 1));
  return student_two_sided((a.mean() - b.mean()) / std::sqrt(va + vb), degrees);
}

double z_test(double difference, double variance) {
  if (!(variance > 0.0)) return difference == 0.0 ? 1.0 : 0.0;
  return std::erfc(std::abs(difference) / std::sqrt(2.0 * variance));
}

int64_t required_samples(double sigma, double effect, double significance, double power) {
  const double z = normal_quantile(1.0 - 0.5 * significance) + normal_quantile(power);
  return static_cast<int64_t>(std::ceil(std::pow(z * sigma / effect, 2.0)));
}

double detectable_effect(double variance_of_mean, double significance, double power) {
  const double z = normal_quantile(1.0 - 0.5 * significance) + normal_quantile(power);
  return z * std::sqrt(variance_of_mean);
}

::testing::AssertionResult mean_is(const Moments& sample, double expected, const Promise& promise) {
  if (sample.count() < 2) return ::testing::AssertionFailure() << "underpowered: no samples";
  return judge(sample.mean(), expected, sample.variance_of_mean(), t_test(sample, expected),
               promise);
}

::testing::AssertionResult means_agree(const Moments& a, const Moments& b, const Promise& promise) {
  if (a.count() < 2 || b.count() < 2) {
    return ::testing::AssertionFailure() << "underpowered: no samples";
  }
  return judge(a.mean(), b.mean(), a.variance_of_mean() + b.variance_of_mean(), t_test(a, b),
               promise);
}

}  // namespace hyades::test
