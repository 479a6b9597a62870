#include "core/media/phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/chi_squared.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"

// T1 and T11: phase functions integrate to 1, have the mean cosine that they say, and samples
// follow them.

namespace hyades::core {
namespace {

struct PhaseCase {
  const char* name;
  Phase phase;
  Rgb mean_cosine;
};

std::vector<PhaseCase> cases() {
  return {
      {"isotropic", Phase::henyey_greenstein(Rgb(0.0F)), Rgb(0.0F)},
      {"forward", Phase::henyey_greenstein(Rgb(0.7F)), Rgb(0.7F)},
      {"backward", Phase::henyey_greenstein(Rgb(-0.5F)), Rgb(-0.5F)},
      {"barely forward", Phase::henyey_greenstein(Rgb(1e-4F)), Rgb(1e-4F)},
      {"barely backward", Phase::henyey_greenstein(Rgb(-1e-4F)), Rgb(-1e-4F)},
      {"sharp", Phase::henyey_greenstein(Rgb(0.99F)), Rgb(0.99F)},
      {"sharply back", Phase::henyey_greenstein(Rgb(-0.99F)), Rgb(-0.99F)},
      {"coloured", Phase::henyey_greenstein(Rgb(-0.3F, 0.0F, 0.8F)), Rgb(-0.3F, 0.0F, 0.8F)},
      {"two lobes", Phase::two_lobes(Rgb(0.8F), Rgb(-0.4F), 0.25F), Rgb(0.5F)},
      {"rayleigh", Phase::rayleigh(), Rgb(0.0F)},
  };
}

TEST(Phase, IntegratesToOneWithItsMeanCosine) {
  for (const PhaseCase& c : cases()) {
    for (int channel = 0; channel < 3; ++channel) {
      const auto value = [&](double cosine) {
        return 2.0 * M_PI * double{c.phase.evaluate(static_cast<float>(cosine))[channel]};
      };
      EXPECT_NEAR(test::integrate(value, -1.0, 1.0, 1e-4, 512, 8), 1.0, 1e-3) << c.name;
      EXPECT_NEAR(test::integrate([&](double x) { return x * value(x); }, -1.0, 1.0, 1e-4, 512, 8),
                  double{c.mean_cosine[channel]}, 1e-3)
          << c.name;
    }
  }
}

// Detects a density that is 1 % too high on half of the samples' domain and as much too low on the
// other with probability 0.99, at a joint significance of 0.01.
TEST(Phase, SamplesFollowThePdf) {
  const Rgb equal(1.0F / 3.0F);
  test::SphereTest settings;
  settings.tolerance = 1e-3;
  settings.promise.tests = 16;
  for (const PhaseCase& c : cases()) {
    if (std::abs(c.mean_cosine.x) > 0.9F) continue;  // all in one cell of the grid: see below
    for (const Vec3 travel : {Vec3(0.0F, 0.0F, 1.0F), glm::normalize(Vec3(1.0F, -2.0F, 0.5F))}) {
      ++settings.seed;
      EXPECT_TRUE(test::directions_follow(
          [&](test::Random& random) -> std::optional<Vec3> {
            const float pick = random.uniform();
            return c.phase.sample(travel, equal, pick, random.uniform2());
          },
          [&](const Vec3& w) { return double{c.phase.pdf(glm::dot(travel, w), equal)}; }, settings))
          << c.name;
    }
  }
}

// The sharp ones by their distribution function, which has a closed form: F(cos) =
// (1 - g^2) / (2 g) (1 / sqrt(1 + g^2 - 2 g cos) - 1 / (1 + g)).
TEST(Phase, SharpLobesHaveTheRightQuantiles) {
  for (const double g : {0.99, -0.99, 0.999, 0.9, -0.9}) {
    const Phase phase = Phase::henyey_greenstein(Rgb(static_cast<float>(g)));
    const double exact = double{static_cast<float>(g)};
    for (const double u : {0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.999}) {
      const Vec3 travel(0.0F, 0.0F, 1.0F);
      const Vec3 w =
          phase.sample(travel, Rgb(1.0F, 0.0F, 0.0F), 0.5F, {static_cast<float>(u), 0.25F});
      // From the sine, which keeps its precision where the cosine has none left.
      const double sine2 = double{w.x} * double{w.x} + double{w.y} * double{w.y};
      const double below =
          w.z > 0.0F ? sine2 / (1.0 + std::sqrt(1.0 - sine2)) : 1.0 + std::sqrt(1.0 - sine2);
      const double root = std::sqrt((1.0 - exact) * (1.0 - exact) + 2.0 * exact * below);
      const double found =
          (1.0 - exact * exact) / (2.0 * exact) * (1.0 / root - 1.0 / (1.0 + exact));
      EXPECT_NEAR(found, u, 2e-4) << "g " << g;
      EXPECT_NEAR(glm::length(w), 1.0F, 1e-6F);
    }
  }
}

TEST(Phase, IsFiniteAtTheEndsOfItsRandomNumbers) {
  const float last = 0x1.fffffep-1F;
  for (const PhaseCase& c : cases()) {
    for (const Vec2 u : {Vec2(0.0F), Vec2(last), Vec2(0.0F, last), Vec2(last, 0.0F), Vec2(0.5F)}) {
      for (const float pick : {0.0F, last}) {
        const Vec3 w = c.phase.sample({1.0F, 0.0F, 0.0F}, Rgb(1.0F / 3.0F), pick, u);
        EXPECT_NEAR(glm::length(w), 1.0F, 1e-5F) << c.name;
        const float pdf = c.phase.pdf(glm::dot(w, Vec3(1.0F, 0.0F, 0.0F)), Rgb(1.0F / 3.0F));
        EXPECT_TRUE(pdf > 0.0F && std::isfinite(pdf)) << c.name;
      }
    }
  }
}

}  // namespace
}  // namespace hyades::core
