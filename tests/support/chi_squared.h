#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "core/base/vec.h"
#include "tests/support/means.h"
#include "tests/support/random.h"

/// Pearson's chi-squared test: do samples fall where a density says?
namespace hyades::test {

struct ChiSquared {
  double statistic = 0.0;
  int degrees = 0;        ///< cells after merging, minus one
  double p = 1.0;         ///< probability of a statistic at least as large if all is right
  double impossible = 0;  ///< samples in cells where none was expected
};

/// Compares counts with expected counts (which add up to about the same). Cells with fewer than
/// `least` expected are merged, least expected first. More than 1e-5 of all samples in cells with
/// expectation 0 give p = 0.
ChiSquared chi_squared(std::span<const double> observed, std::span<const double> expected,
                       double least = 5.0);

/// How many samples a chi-squared test of `degrees` needs to notice with probability `power` that
/// the density is `relative_error` too high on one half of the samples' domain and as much too low
/// on the other (normal approximation of the noncentral distribution, noncentrality
/// n relative_error^2).
int64_t required_chi_squared_samples(int degrees, double relative_error, double significance,
                                     double power);

/// One sample of a direction; nothing where the sampler gave up (absorbed).
using DirectionSampler = std::function<std::optional<core::Vec3>(Random&)>;
using DirectionDensity = std::function<double(const core::Vec3&)>;

/// The sphere cut into rows of equal height in z and columns in azimuth.
struct SphereGrid {
  int rows = 16;  ///< even, so that the horizon lies between two rows
  int columns = 16;

  int cells() const { return rows * columns; }
  int cell_of(const core::Vec3& direction) const;
};

struct SphereTest {
  SphereGrid grid;
  double tolerance = 1e-5;  ///< of the integral of the density
  uint64_t seed = 1;
  Promise promise;  ///< decides the number of samples
};

/// T1: `sample` produces directions of density `pdf` per solid angle. The integral of pdf must not
/// exceed 1; what lacks to 1 is the probability that there is no sample.
::testing::AssertionResult directions_follow(const DirectionSampler& sample,
                                             const DirectionDensity& pdf,
                                             const SphereTest& test = {});

}  // namespace hyades::test
