#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/media/volumes.h"
#include "tests/support/means.h"

namespace hyades::core {
namespace {

const Coefficients kSmoke{{0.05F, 0.1F, 0.0F}, {0.2F, 0.3F, 0.1F}, {1.0F, 0.5F, 2.0F}};

Ray oblique() { return {Vec3(-2.0F, 3.0F, 5.0F), glm::normalize(Vec3(1.0F, 0.45F, 0.3F))}; }

// Short steps come close to the truth, long ones let too much light through.
TEST(Marching, ComesCloserToTheTruthWithItsSteps) {
  const auto field = make_grid_density(random_grid(20, 3));
  const auto volume = volume_of(field, Vec3i(4));
  const Phase phase = Phase::henyey_greenstein(Rgb(0.0F));
  const double passed = density_along(*field, oblique(), 10.0);
  test::Random random(3);
  double errors[2] = {};
  int i = 0;
  for (const float step : {4.0F, 0.05F}) {
    const MediumPtr medium = make_marching(volume, FieldPlace({Mat4(1.0F)}), kSmoke, phase, step);
    test::Moments shares;
    test::Moments scattered;
    test::Moments glow;
    for (int n = 0; n < 20'000; ++n) {
      const Vec4 u = random4(random);
      shares.add(double{medium->transmittance(oblique(), 10.0F, u).y});
      const MediumSample sample = medium->sample(oblique(), 10.0F, Rgb(1.0F / 3.0F), u);
      scattered.add(sample.scattered ? double{sample.weight.y} : 0.0);
      glow.add(double{medium->emitted(oblique(), 10.0F, u).y});
    }
    errors[i++] = shares.mean() - std::exp(-0.4 * passed);
    if (step < 1.0F) {
      const double lost = -std::expm1(-0.4 * passed);
      EXPECT_NEAR(scattered.mean(), 0.75 * lost, 0.05 * lost);
      EXPECT_NEAR(glow.mean(), 0.5 * lost / 0.4, 0.02 * lost / 0.4);
    }
  }
  EXPECT_GT(errors[0], 0.005);
  EXPECT_NEAR(errors[1], 0.0, 0.002);
}

}  // namespace
}  // namespace hyades::core
