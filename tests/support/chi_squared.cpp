#include "tests/support/chi_squared.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tests/support/quadrature.h"
#include "tests/support/special_functions.h"

namespace hyades::test {

ChiSquared chi_squared(std::span<const double> observed, std::span<const double> expected,
                       double least) {
  ChiSquared result;
  const double total = std::accumulate(observed.begin(), observed.end(), 0.0);
  std::vector<size_t> order;
  for (size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] > 0.0) {
      order.push_back(i);
    } else {
      result.impossible += observed[i];
    }
  }
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return expected[a] < expected[b]; });
  double pooled_observed = result.impossible;
  double pooled_expected = 0.0;
  int cells = 0;
  for (size_t n = 0; n < order.size(); ++n) {
    pooled_observed += observed[order[n]];
    pooled_expected += expected[order[n]];
    if (pooled_expected < least && n + 1 < order.size()) continue;
    const double difference = pooled_observed - pooled_expected;
    result.statistic += difference * difference / pooled_expected;
    pooled_observed = pooled_expected = 0.0;
    ++cells;
  }
  result.degrees = std::max(cells - 1, 0);
  // A single cell has no freedom left, but its count may still be wrong.
  result.p = chi_squared_tail(result.statistic, std::max(result.degrees, 1));
  if (result.impossible > 1e-5 * total) result.p = 0.0;
  return result;
}

int64_t required_chi_squared_samples(int degrees, double relative_error, double significance,
                                     double power) {
  const double critical = chi_squared_quantile(significance, degrees);
  const double z = normal_quantile(power);
  double low = 0.0;
  double high = 1.0;
  // The noncentral variable has mean k + lambda and variance 2 (k + 2 lambda).
  const auto detects = [&](double lambda) {
    return degrees + lambda - z * std::sqrt(2.0 * (degrees + 2.0 * lambda)) >= critical;
  };
  while (!detects(high)) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (detects(middle) ? high : low) = middle;
  }
  return static_cast<int64_t>(std::ceil(high / (relative_error * relative_error)));
}

int SphereGrid::cell_of(const core::Vec3& direction) const {
  const double z = std::clamp(0.5 * (static_cast<double>(direction.z) + 1.0), 0.0, 1.0);
  double phi = std::atan2(direction.y, direction.x) / (2.0 * M_PI);
  if (phi < 0.0) phi += 1.0;
  const int row = std::min(static_cast<int>(z * rows), rows - 1);
  const int column = std::min(static_cast<int>(phi * columns), columns - 1);
  return row * columns + column;
}

::testing::AssertionResult directions_follow(const DirectionSampler& sample,
                                             const DirectionDensity& pdf, const SphereTest& test) {
  const SphereGrid& grid = test.grid;
  const int cells = grid.cells();
  const double alpha = sidak(test.promise.significance, test.promise.tests);

  std::vector<double> expected(cells + 1, 0.0);  // the last cell: no sample
  double integral = 0.0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double part =
          integrate2([&](double z, double phi) { return pdf(spherical(z, phi)); },
                     -1.0 + 2.0 * row / grid.rows, -1.0 + 2.0 * (row + 1) / grid.rows,
                     2.0 * M_PI * column / grid.columns, 2.0 * M_PI * (column + 1) / grid.columns,
                     test.tolerance / std::sqrt(cells), 4, 9);
      expected[row * grid.columns + column] = part;
      integral += part;
    }
  }
  if (!(integral <= 1.0 + 10.0 * test.tolerance)) {
    return ::testing::AssertionFailure() << "the density integrates to " << integral << " > 1";
  }
  expected[cells] = std::max(0.0, 1.0 - integral);
  // Quadrature leaves dust where there is nothing.
  if (expected[cells] < test.tolerance) expected[cells] = 0.0;

  int used = 0;
  for (const double e : expected) used += e > 1e-6 ? 1 : 0;
  const int64_t count = required_chi_squared_samples(
      std::max(1, used - 1), test.promise.relative_error, alpha, test.promise.power);
  std::vector<double> observed(cells + 1, 0.0);
  Random random(test.seed);
  for (int64_t n = 0; n < count; ++n) {
    const auto direction = sample(random);
    observed[direction ? grid.cell_of(*direction) : cells] += 1.0;
  }
  for (double& e : expected) e *= static_cast<double>(count);
  const ChiSquared result = chi_squared(observed, expected);
  if (!(result.p >= alpha)) {
    return ::testing::AssertionFailure()
           << "chi-squared " << result.statistic << " with " << result.degrees
           << " degrees of freedom: p = " << result.p << " < " << alpha << " (" << count
           << " samples, " << result.impossible << " where the density is 0, " << observed[cells]
           << " absorbed, expected " << expected[cells] << ")";
  }
  return ::testing::AssertionSuccess() << "p = " << result.p;
}

}  // namespace hyades::test
