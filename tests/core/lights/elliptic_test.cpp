#include "core/lights/elliptic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/quadrature.h"

namespace hyades::core {
namespace {

TEST(CarlsonRg, MeasuresSpheresAndCircles) {
  EXPECT_NEAR(carlson_rg(1.0, 1.0, 1.0), 1.0, 1e-14);
  EXPECT_NEAR(carlson_rg(9.0, 9.0, 9.0), 3.0, 1e-14);
  EXPECT_NEAR(8.0 * carlson_rg(0.0, 4.0, 4.0), 4.0 * M_PI, 1e-13);
  EXPECT_EQ(carlson_rg(0.0, 0.0, 0.0), 0.0);
}

TEST(CarlsonRg, MatchesPublishedValue) {
  // Carlson (1995), "Numerical computation of real or complex elliptic integrals", section 3.
  EXPECT_NEAR(carlson_rg(0.0, 16.0, 16.0), M_PI, 1e-13);
  EXPECT_NEAR(carlson_rg(2.0, 3.0, 4.0), 1.7255030280692, 1e-12);
  EXPECT_NEAR(carlson_rg(0.0, 0.0796, 4.0), 1.0284758090288, 1e-12);
}

TEST(CarlsonRg, IsTheMeanOverDirections) {
  // R_G(x, y, z) is the mean of sqrt(x n_x^2 + y n_y^2 + z n_z^2) over unit vectors.
  const double xs[][3] = {{1.0, 2.0, 3.0}, {100.0, 1.0, 0.01}, {1e-6, 5.0, 5.0}};
  for (const auto& x : xs) {
    const double mean = test::integrate_sphere([&](const Vec3& n) {
                          const Vec3d m(n);
                          return std::sqrt(x[0] * m.x * m.x + x[1] * m.y * m.y + x[2] * m.z * m.z);
                        }) /
                        (4.0 * M_PI);
    EXPECT_NEAR(carlson_rg(x[0], x[1], x[2]) / mean, 1.0, 1e-6);
    EXPECT_DOUBLE_EQ(carlson_rg(x[0], x[1], x[2]), carlson_rg(x[2], x[0], x[1]));
  }
}

}  // namespace
}  // namespace hyades::core
