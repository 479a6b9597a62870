#include "tests/core/materials/furnace.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

// T4: white surfaces of every kind and at every corner of their parameters, in uniform light, give
// back 1 +- 0.005 at every angle, 88 degrees included; where a bound is wider, docs/job.md says so.

namespace hyades::core {
namespace {

using P = PrincipledParams;

ColorParam snow() { return color_of(Rgb(1.0F)); }

MaterialPtr metal(float roughness) {
  return make_conductor(Rgb(0.1F), Rgb(1e4F), number(roughness), Rgb(1.0F),
                        FacetScattering::multiple);
}

MaterialPtr glass(float roughness, float ior = 1.5F) {
  return make_rough_dielectric(ior, Rgb(1.0F), Rgb(1.0F), number(roughness),
                               FacetScattering::multiple);
}

MaterialPtr pane(float roughness) {
  return make_thin_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F), number(roughness));
}

MaterialPtr leaf() { return make_diffuse_transmission(color_of(Rgb(0.4F)), color_of(Rgb(0.6F))); }

MaterialPtr coated(MaterialPtr base, float roughness) {
  CoatParams params;
  params.roughness.value = roughness;
  return make_coat(std::move(base), params);
}

template <class Change>
MaterialPtr white(const Change& change) {
  return principled_with([&](P& p) {
    p.base_color.value = Rgb(1.0F);
    change(p);
  });
}

TEST(BsdfFurnace, WhiteFacetsKeepEverything) {
  for (const float roughness : {0.0F, 0.1F, 0.4F, 0.7F, 1.0F}) {
    EXPECT_TRUE(test::keeps_all_light(metal(roughness))) << "metal " << roughness;
    EXPECT_TRUE(test::keeps_all_light(make_colored_conductor(snow(), snow(), number(roughness),
                                                             Rgb(1.0F), FacetScattering::multiple)))
        << "coloured metal " << roughness;
    EXPECT_TRUE(test::keeps_all_light(
        make_glossy(snow(), number(0.8F), number(1.0F - roughness), FacetScattering::multiple)))
        << "glossy " << roughness;
    for (const bool inside : {false, true}) {
      EXPECT_TRUE(test::keeps_all_light(glass(roughness), inside)) << "glass " << roughness;
      EXPECT_TRUE(test::keeps_all_light(glass(roughness, 0.98F), inside))
          << "matched glass " << roughness;
      EXPECT_TRUE(test::keeps_all_light(pane(roughness), inside)) << "pane " << roughness;
    }
    EXPECT_TRUE(test::keeps_all_light(make_rough_matt(snow(), number(roughness))))
        << "plaster " << roughness;
  }
  EXPECT_TRUE(test::keeps_all_light(leaf()));
  EXPECT_TRUE(test::keeps_all_light(make_mirror(snow())));
}

TEST(BsdfFurnace, WhitePrincipledSurfacesKeepEverything) {
  for (const float roughness : {0.0F, 0.2F, 0.5F, 1.0F}) {
    for (const float metallic : {0.0F, 0.5F, 1.0F}) {
      EXPECT_TRUE(test::keeps_all_light(white([&](P& p) {
        p.roughness.value = roughness;
        p.metallic.value = metallic;
        p.specular.value = 1.0F;
      }))) << roughness
           << " metallic " << metallic;
    }
    for (const float transmission : {0.5F, 1.0F}) {
      for (const bool inside : {false, true}) {
        EXPECT_TRUE(test::keeps_all_light(white([&](P& p) {
                                            p.roughness.value = roughness;
                                            p.transmission.value = transmission;
                                          }),
                                          inside))
            << roughness << " transmission " << transmission;
        EXPECT_TRUE(test::keeps_all_light(white([&](P& p) {
                                            p.roughness.value = roughness;
                                            p.transmission.value = transmission;
                                            p.diffuse_transmission.value = 0.5F;
                                            p.thin_walled = true;
                                          }),
                                          inside))
            << roughness << " thin, transmission " << transmission;
      }
    }
  }
}

// Before what layers lose of wide lobes was given back: 0.95 below coats, 0.87 below fuzz.
TEST(BsdfFurnace, LayersOverWhiteSurfacesLoseNothing) {
  for (const float roughness : {0.0F, 0.3F, 1.0F}) {
    for (const float beneath : {0.0F, 0.3F, 0.6F, 1.0F}) {
      EXPECT_TRUE(test::keeps_all_light(coated(metal(beneath), roughness)))
          << roughness << " over metal " << beneath;
      EXPECT_TRUE(test::keeps_all_light(coated(pane(beneath), roughness)))
          << roughness << " over a pane " << beneath;
      EXPECT_TRUE(test::keeps_all_light(make_sheen(metal(beneath), snow(), number(roughness))))
          << "fuzz " << roughness << " over metal " << beneath;
    }
    EXPECT_TRUE(test::keeps_all_light(coated(make_lambert(snow()), roughness))) << roughness;
    EXPECT_TRUE(test::keeps_all_light(coated(leaf(), roughness))) << roughness;
    EXPECT_TRUE(test::keeps_all_light(make_sheen(make_lambert(snow()), snow(), number(roughness))))
        << roughness;
    const auto mixed = make_mix(make_lambert(snow()), metal(0.4F), number(0.5F));
    EXPECT_TRUE(test::keeps_all_light(coated(mixed, roughness))) << roughness;
    const auto sides = make_two_sided(make_lambert(snow()), metal(0.5F));
    for (const bool inside : {false, true})
      EXPECT_TRUE(test::keeps_all_light(coated(sides, roughness), inside, 1, 0.006)) << roughness;
  }
}

TEST(BsdfFurnace, WithoutMultipleScatteringPrincipledIsAsItsPartsAre) {
  for (const float roughness : {0.3F, 0.7F, 1.0F}) {
    const auto principled = [&](float metallic) {
      return white([&](P& p) {
        p.roughness.value = roughness;
        p.metallic.value = metallic;
        p.transmission.value = 1.0F - metallic;
        p.facets = FacetScattering::single;
      });
    };
    const MaterialPtr metal_alone =
        make_conductor(Rgb(0.1F), Rgb(1e4F), number(roughness), Rgb(1.0F), FacetScattering::single);
    const MaterialPtr glass_alone = make_rough_dielectric(
        1.5F, Rgb(1.0F), Rgb(1.0F), number(roughness), FacetScattering::single);
    for (const bool is_metal : {true, false}) {
      const BsdfUnderTest a(principled(is_metal ? 1.0F : 0.0F));
      const BsdfUnderTest b(is_metal ? metal_alone : glass_alone);
      for (const float z : {0.9F, 0.5F, 0.2F}) {
        const Vec3 wo(std::sqrt(1.0F - z * z), 0.0F, z);
        const double back = test::furnace(*a.get(), wo, 6000);
        EXPECT_NEAR(back, test::furnace(*b.get(), wo, 6000), 0.003)
            << roughness << (is_metal ? " metal" : " glass") << " at " << z;
        EXPECT_LT(back, roughness == 1.0F ? 0.9 : 1.0) << "nothing is lost";
      }
    }
  }
}

TEST(BsdfFurnace, PrincipledLayersLoseNothing) {
  for (const float beneath : {0.0F, 0.5F, 1.0F}) {
    for (const float metallic : {0.0F, 0.5F, 1.0F}) {
      for (const float roughness : {0.0F, 0.3F, 1.0F}) {
        EXPECT_TRUE(test::keeps_all_light(white([&](P& p) {
          p.roughness.value = beneath;
          p.metallic.value = metallic;
          p.coat.value = 1.0F;
          p.coat_roughness.value = roughness;
        }))) << "coat "
             << roughness << " over " << beneath << ", metallic " << metallic;
        if (roughness == 0.0F) continue;
        EXPECT_TRUE(test::keeps_all_light(white([&](P& p) {
          p.roughness.value = beneath;
          p.metallic.value = metallic;
          p.sheen.value = 1.0F;
          p.sheen_roughness.value = roughness;
        }))) << "fuzz "
             << roughness << " over " << beneath << ", metallic " << metallic;
      }
    }
  }
}

// Layers over what scatters neither evenly nor as facets do: its spread is guessed.
TEST(BsdfFurnace, LayersOverLayersLoseLittle) {
  const auto plaster = make_rough_matt(snow(), number(1.0F));
  const auto velvet = make_sheen(make_lambert(snow()), snow(), number(0.5F));
  for (const float roughness : {0.0F, 0.3F, 1.0F}) {
    for (const MaterialPtr& base :
         {plaster, velvet, coated(make_lambert(snow()), 0.3F), white([](P&) {})})
      EXPECT_TRUE(test::keeps_all_light(coated(base, roughness), false, 1, 0.016)) << roughness;
    EXPECT_TRUE(
        test::keeps_all_light(make_sheen(plaster, snow(), number(roughness)), false, 1, 0.01))
        << roughness;
  }
  for (const float metallic : {0.0F, 1.0F}) {
    EXPECT_TRUE(test::keeps_all_light(white([&](P& p) {
                                        p.metallic.value = metallic;
                                        p.coat.value = 1.0F;
                                        p.coat_roughness.value = 0.3F;
                                        p.sheen.value = 1.0F;
                                      }),
                                      false, 1, 0.016))
        << metallic;
  }
}

// What a coat throws back into a body of glass is lost, up to a tenth: never is any made.
TEST(BsdfFurnace, CoatsOverGlassMakeNoLight) {
  for (const float roughness : {0.0F, 0.3F, 1.0F}) {
    for (const MaterialPtr& material :
         {coated(glass(0.0F), roughness), coated(glass(0.5F), roughness), white([&](P& p) {
            p.transmission.value = 0.5F;
            p.coat.value = 1.0F;
            p.coat_roughness.value = roughness;
          })}) {
      EXPECT_TRUE(test::keeps_all_light(material, false, 1, 0.01)) << roughness;
      const BsdfUnderTest bsdf(material);
      for (const float z : {1.0F, 0.8F, 0.5F, 0.1F}) {
        const double back = test::furnace(*bsdf.get(), {0.0F, std::sqrt(1.0F - z * z), -z}, 10000);
        EXPECT_GT(back, 0.89) << roughness << " " << z;
        EXPECT_LT(back, 1.005) << roughness << " " << z;
      }
    }
  }
}

}  // namespace
}  // namespace hyades::core
