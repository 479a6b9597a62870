#include "core/media/albedo_inversion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hyades::core {
namespace {

/// What an isotropic half-space of albedo `a` sends back of diffuse light: 1 - 2 sqrt(1 - a) times
/// the first moment of Chandrasekhar's H, which is found by iterating its equation.
double exact_reflectance(double a) {
  constexpr int kSteps = 400;
  std::vector<double> h(kSteps, 1.0);
  const auto mu = [](int i) { return (i + 0.5) / kSteps; };
  const double s = std::sqrt(1.0 - a);
  for (double change = 1.0; change > 1e-9;) {
    std::vector<double> next(kSteps);
    change = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      double sum = 0.0;
      for (int j = 0; j < kSteps; ++j) sum += mu(j) * h[static_cast<size_t>(j)] / (mu(i) + mu(j));
      const auto at = static_cast<size_t>(i);
      next[at] = 0.5 * (h[at] + 1.0 / (s + 0.5 * a * sum / kSteps));
      change = std::max(change, std::abs(next[at] - h[at]));
    }
    h = next;
  }
  double moment = 0.0;
  for (int i = 0; i < kSteps; ++i) moment += mu(i) * h[static_cast<size_t>(i)] / kSteps;
  return 1.0 - 2.0 * s * moment;
}

TEST(AlbedoInversion, IsNearChandrasekharsHalfSpace) {
  for (const float albedo : {0.1F, 0.4F, 0.6F, 0.8F, 0.95F, 0.99F}) {
    EXPECT_NEAR(diffuse_reflectance(albedo, 0.0F), exact_reflectance(albedo), 0.0025) << albedo;
  }
  EXPECT_EQ(diffuse_reflectance(1.0F, 0.5F), 1.0F);
  EXPECT_EQ(diffuse_reflectance(0.0F, 0.5F), 0.0F);
}

TEST(AlbedoInversion, InvertsWhatItSays) {
  for (const float g : {-0.7F, 0.0F, 0.5F, 0.95F}) {
    for (int i = 0; i <= 20; ++i) {
      const float reflectance = static_cast<float>(i) / 20.0F;
      const float albedo = albedo_of_reflectance(reflectance, g);
      EXPECT_GE(albedo, 0.0F);
      EXPECT_LE(albedo, 1.0F);
      EXPECT_NEAR(diffuse_reflectance(albedo, g), reflectance, 2e-3F) << g;
    }
  }
  for (const float inner : {0.0F, 0.4F, 0.6F}) {
    EXPECT_EQ(reflectance_through(1.0F, inner), 1.0F);
    for (const float seen : {0.0F, 0.2F, 0.9F}) {
      EXPECT_NEAR(reflectance_through(reflectance_behind(seen, inner), inner), seen, 1e-6F);
    }
  }
}

// Against Walsh's closed form for light from outside, as tabulated (Judd 1942, "Fresnel Reflection
// of Diffusely Incident Light"): 0.0918 outside and 0.5964 inside for 1.5, 0.0667 and 0.4732 (of 1
// - (1 - outer) / eta^2) for 4/3.
TEST(AlbedoInversion, KnowsWhatASurfaceReflectsOfDiffuseLight) {
  EXPECT_NEAR(diffuse_fresnel(1.5F).outer, 0.0918F, 5e-4F);
  EXPECT_NEAR(diffuse_fresnel(1.5F).inner, 0.5964F, 5e-4F);
  EXPECT_NEAR(diffuse_fresnel(1.0F).outer, 0.0F, 1e-6F);
  EXPECT_NEAR(diffuse_fresnel(1.0F).inner, 0.0F, 1e-6F);
  // A bubble: the same surface seen from the other side.
  EXPECT_NEAR(diffuse_fresnel(1.0F / 1.5F).outer, diffuse_fresnel(1.5F).inner, 2e-3F);
  EXPECT_NEAR(diffuse_fresnel(1.0F / 1.5F).inner, diffuse_fresnel(1.5F).outer, 5e-3F);
}

TEST(AlbedoInversion, MakesCoefficientsOfColorAndRadius) {
  BodyColor body;
  body.color = {0.9F, 0.5F, 1.0F};
  body.radius = {0.01F, 0.002F, 0.5F};
  body.g = 0.6F;
  body.index = 1.4F;
  const ScatteringNumbers made = scattering_of(body);
  const float inner = diffuse_fresnel(1.4F).inner;
  for (int c = 0; c < 3; ++c) {
    EXPECT_GE(made.absorption[c], 0.0F);
    const float transport = made.absorption[c] + (1.0F - body.g) * made.scattering[c];
    EXPECT_NEAR(transport * body.radius[c], 1.0F, 1e-5F);
    const float albedo = made.scattering[c] / (made.absorption[c] + made.scattering[c]);
    EXPECT_NEAR(reflectance_through(diffuse_reflectance(albedo, body.g), inner), body.color[c],
                2e-3F);
  }
}

}  // namespace
}  // namespace hyades::core
