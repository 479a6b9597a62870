#include "core/media/equiangular.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/means.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"

namespace hyades::test {
namespace {

using core::Equiangular;
using core::Ray;
using core::Vec3;

struct Case {
  const char* name;
  Vec3 point;
  float t_max;
};

const Case kCases[] = {{"beside the way", {1.0F, 0.0F, 3.0F}, 8.0F},
                       {"behind its begin", {0.5F, 0.2F, -2.0F}, 4.0F},
                       {"beyond its end", {0.3F, 0.1F, 9.0F}, 5.0F},
                       {"on it", {0.0F, 0.0F, 2.0F}, 6.0F},
                       {"far away", {300.0F, 40.0F, 10.0F}, 5.0F},
                       {"way without end", {0.5F, 0.0F, 4.0F}, core::kInfinity}};

// The share of places below t is the integral of the density up to there.
TEST(Equiangular, PlacesComeWithTheirDensity) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    const Equiangular places(Ray{{}, {0.0F, 0.0F, 1.0F}}, c.t_max, c.point);
    Random random(3);
    for (const float limit : {0.7F, 1.9F, 4.5F}) {
      if (limit >= c.t_max) continue;
      Moments below;
      for (int i = 0; i < 40000; ++i)
        below.add(places.sample(random.uniform()) < limit ? 1.0 : 0.0);
      const double expected = integrate(
          [&](double t) { return static_cast<double>(places.pdf(static_cast<float>(t))); }, 0.0,
          static_cast<double>(limit), 1e-5);
      EXPECT_GE(t_test(below, expected), sidak(0.01, 3 * static_cast<int>(std::size(kCases))))
          << limit << ": " << below.mean() << ", expected " << expected;
    }
    EXPECT_EQ(places.pdf(-0.1F), 0.0F);
    if (c.t_max < core::kInfinity) {
      EXPECT_EQ(places.pdf(c.t_max * 1.01F), 0.0F);
    }
  }
}

TEST(Equiangular, NearestPlaceIsOnTheWay) {
  const Ray ray{{}, {0.0F, 0.0F, 1.0F}};
  EXPECT_FLOAT_EQ(Equiangular(ray, 8.0F, {1.0F, 0.0F, 3.0F}).nearest(), 3.0F);
  EXPECT_FLOAT_EQ(Equiangular(ray, 8.0F, {1.0F, 0.0F, -3.0F}).nearest(), 0.0F);
  EXPECT_FLOAT_EQ(Equiangular(ray, 2.0F, {1.0F, 0.0F, 3.0F}).nearest(), 2.0F);
}

}  // namespace
}  // namespace hyades::test
