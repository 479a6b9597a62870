#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "tests/support/moments.h"

/// Tests of means, which say what they would have noticed. A statistical test that passes because
/// it has too few samples proves nothing, so each fails as underpowered unless it would detect the
/// stated relative error with the stated probability.
namespace hyades::test {

/// What a test promises.
struct Promise {
  double significance = 0.01;    ///< probability of failing although all is right, over all tests
  int tests = 1;                 ///< how many tests share it (Sidak)
  double relative_error = 0.01;  ///< an error of the mean that must be noticed
  double power = 0.99;           ///< with at least this probability
};

/// The significance of each of `tests` independent tests that together have `significance`
/// (Sidak 1967): 1 - (1 - significance)^(1 / tests).
double sidak(double significance, int tests);

/// Two-sided p-value of the hypothesis that `sample` comes from a distribution of mean `expected`
/// (Student's t). 1 or 0 where the sample does not vary and equals or misses it (to 1e-6 relative).
double t_test(const Moments& sample, double expected);

/// Two-sided p-value of the hypothesis that two samples have the same mean (Welch's t).
double t_test(const Moments& a, const Moments& b);

/// Two-sided p-value of the hypothesis that a difference with known variance is 0.
double z_test(double difference, double variance);

/// How many samples a two-sided test of a mean needs to detect an absolute error `effect` of
/// samples with standard deviation `sigma`: ((z_{1 - alpha/2} + z_{power}) sigma / effect)^2.
int64_t required_samples(double sigma, double effect, double significance, double power);

/// The absolute error of the mean that a test of variance `variance_of_mean` detects with `power`.
double detectable_effect(double variance_of_mean, double significance, double power);

/// Whether the mean of `sample` is `expected`, in the sense of `promise`: fails where it is not,
/// and where the sample could not have told.
::testing::AssertionResult mean_is(const Moments& sample, double expected,
                                   const Promise& promise = {});

/// Whether two samples have the same mean; the relative error is that of b's mean.
::testing::AssertionResult means_agree(const Moments& a, const Moments& b,
                                       const Promise& promise = {});

}  // namespace hyades::test
