#include "core/materials/anisotropic_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/materials/facet_energy.h"
#include "tests/core/materials/furnace.h"
#include "tests/support/quadrature.h"

namespace hyades::core {
namespace {

Vec3 seen_at(float cosine, float azimuth) {
  const float r = std::sqrt(1.0F - cosine * cosine);
  return {r * std::cos(azimuth), r * std::sin(azimuth), cosine};
}

// Which of both widths is the greater one must not matter but for a quarter turn.
TEST(AnisotropicEnergy, TablesAreTheIntegralOfTheLobe) {
  for (const AnisotropicGgx facets :
       {AnisotropicGgx{0.5F, 0.2F}, AnisotropicGgx{1.0F, 0.3F}, AnisotropicGgx{0.13F, 0.9F}}) {
    const AnisotropicEnergy energy(facets);
    for (const float cosine : {0.1F, 0.35F, 0.8F, 1.0F}) {
      for (const float azimuth : {0.0F, 0.7F, 1.5707F}) {
        const Vec3 wo = seen_at(cosine, azimuth);
        const double exact = test::integrate_sphere(
            [&](const Vec3& wi) { return facets.reflect(wo, wi); }, 0.0, 1.0, 1e-4, 8, 10);
        EXPECT_NEAR(energy.reflectance(wo), exact, 0.004)
            << facets.along_x << " " << facets.along_y << ", " << cosine << " " << azimuth;
      }
    }
  }
}

TEST(AnisotropicEnergy, MeanLossIsThatOfTheTable) {
  const AnisotropicGgx facets{0.7F, 0.1F};
  const AnisotropicEnergy energy(facets);
  const double lost = test::integrate_sphere(
      [&](const Vec3& w) { return (1.0 - energy.reflectance(w)) * w.z / 3.14159265; }, 0.0, 1.0,
      1e-5, 4, 8);
  EXPECT_NEAR(energy.mean_loss(), lost, 0.001);
}

TEST(AnisotropicEnergy, EvenFacetsAreThoseOfTheEvenTable) {
  const AnisotropicEnergy energy(AnisotropicGgx{0.4F, 0.4F});
  const Vec3 wo = seen_at(0.3F, 0.4F);
  EXPECT_EQ(energy.reflectance(wo), FacetEnergy::table().reflectance(0.3F, 0.4F));
  EXPECT_EQ(energy.mean_loss(), FacetEnergy::table().mean_loss(0.4F));
  EXPECT_EQ(energy.over_even(wo, 0.04F), 1.0F);
}

// T4, from three sides: a table for even facets of the width seen was off by up to 0.44.
TEST(BsdfFurnace, BrushedWhiteMetalKeepsEverything) {
  for (const float roughness : {0.1F, 0.3F, 0.6F, 1.0F}) {
    for (const float anisotropic : {0.4F, 0.8F, 1.0F}) {
      EXPECT_TRUE(test::keeps_all_light(principled_with([&](PrincipledParams& p) {
                                          p.base_color.value = Rgb(1.0F);
                                          p.metallic.value = 1.0F;
                                          p.roughness.value = roughness;
                                          p.anisotropic.value = anisotropic;
                                        }),
                                        false, 3))
          << roughness << " " << anisotropic;
    }
  }
}

TEST(BsdfFurnace, TwoRoughnessesKeepEverything) {
  for (const float along : {0.0F, 0.2F, 0.7F, 1.0F}) {
    for (const float across : {0.0F, 0.3F, 0.8F}) {
      EXPECT_TRUE(test::keeps_all_light(principled_with([&](PrincipledParams& p) {
                                          p.base_color.value = Rgb(1.0F);
                                          p.metallic.value = 1.0F;
                                          p.roughness.value = across;
                                          p.roughness_along = ScalarParam{along, nullptr};
                                        }),
                                        false, 3, 0.01))
          << along << " " << across;
    }
  }
}

// Fresnel's reflectance of stretched facets is scaled from that of even ones: 1 % at grazing
// angles.
TEST(BsdfFurnace, WhitePaintBelowBrushedFacetsKeepsEverything) {
  for (const float roughness : {0.1F, 0.5F, 1.0F}) {
    for (const float anisotropic : {0.5F, 1.0F}) {
      EXPECT_TRUE(test::keeps_all_light(principled_with([&](PrincipledParams& p) {
                                          p.base_color.value = Rgb(1.0F);
                                          p.roughness.value = roughness;
                                          p.anisotropic.value = anisotropic;
                                        }),
                                        false, 3, 0.01))
          << roughness << " " << anisotropic;
    }
  }
}

// What lies on bodies lies on their outer side: inside, the matt part must not be scaled as if a
// coat took its share.
TEST(BsdfFurnace, InsideOfCoatedBodiesNothingIsMade) {
  const BsdfUnderTest bsdf(principled_with([](PrincipledParams& p) {
    p.base_color.value = Rgb(1.0F);
    p.transmission.value = 0.5F;
    p.roughness.value = 0.0F;
    p.coat.value = 1.0F;
  }));
  for (const float z : {1.0F, 0.8F, 0.5F, 0.2F})
    EXPECT_LE(test::furnace(*bsdf.get(), {0.0F, std::sqrt(1.0F - z * z), -z}, 8000), 1.005) << z;
}

}  // namespace
}  // namespace hyades::core
