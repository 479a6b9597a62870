#include "core/materials/facet_energy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/quadrature.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

/// E by quadrature of the value; where the lobe is too sharp for that, by many of its samples.
double exact(float cosine, float alpha) {
  const Ggx facets{alpha};
  const Vec3 wo(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
  if (alpha >= 0.05F) {
    return test::integrate_sphere([&](const Vec3& wi) { return facets.reflect(wo, wi); }, 0.0, 1.0,
                                  1e-4, 8, 10);
  }
  constexpr int kCount = 100000;
  test::Random random(5);
  double sum = 0.0;
  for (int n = 0; n < kCount; ++n) {
    // Strata of height: the standard error is below 0.001.
    const float u = (static_cast<float>(n) + random.uniform()) / kCount;
    const Vec3 wi =
        reflected(wo, facets.sample_normal(wo, {random.uniform(), std::min(u, 0.9999999F)}));
    sum += wi.z > 0.0F ? facets.reflect_weight(wo, wi) : 0.0F;
  }
  return sum / kCount;
}

TEST(FacetEnergy, TableIsTheIntegralOfTheLobe) {
  const FacetEnergy& table = FacetEnergy::table();
  for (const float alpha : {0.002F, 0.013F, 0.05F, 0.117F, 0.33F, 0.7F, 1.0F}) {
    for (const float cosine : {0.02F, 0.11F, 0.3F, 0.77F, 1.0F}) {
      EXPECT_NEAR(table.reflectance(cosine, alpha), exact(cosine, alpha), 0.002)
          << alpha << " " << cosine;
    }
  }
  EXPECT_NEAR(table.reflectance(1.0F, 1.0F), 1.0 - std::log(2.0), 5e-4);
  EXPECT_NEAR(table.reflectance(0.5F, 0.0F), 1.0F, 1e-5F);
  EXPECT_EQ(table.mean_loss(0.0F), 0.0F);
}

// T4: white facets with what single scattering loses given back reflect everything.
TEST(FacetEnergy, BothLobesTogetherReflectEverything) {
  for (const float alpha : {0.003F, 0.01F, 0.04F, 0.1F, 0.25F, 0.5F, 0.8F, 1.0F}) {
    const LostLight lost(alpha);
    const Rgb all = lost.tint(Rgb(1.0F));
    EXPECT_NEAR(all.x, 1.0F, 1e-5F);
    for (const float cosine : {0.03F, 0.1F, 0.3F, 0.6F, 1.0F}) {
      const Vec3 wo(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
      const double back = test::integrate_sphere(
          [&](const Vec3& wi) { return wi.z > 0.0F ? lost.reflect(wo, wi) : 0.0F; }, 0.0, 1.0, 1e-5,
          4, 10);
      const double single =
          alpha < 0.03F ? FacetEnergy::table().reflectance(cosine, alpha) : exact(cosine, alpha);
      EXPECT_NEAR(single + back, 1.0, 0.005) << alpha << " " << cosine;
      EXPECT_LE(single + back, 1.005) << alpha << " " << cosine;
    }
  }
}

TEST(FacetEnergy, DarkFacetsGiveBackLess) {
  const LostLight lost(1.0F);
  const Rgb tint = lost.tint({0.9F, 0.5F, 0.0F});
  EXPECT_LT(tint.x, 0.9F);
  EXPECT_LT(tint.y, 0.5F * tint.x / 0.9F);
  EXPECT_EQ(tint.z, 0.0F);
}

}  // namespace
}  // namespace hyades::core
