#include <gtest/gtest.h>

#include <cmath>

#include "core/base/warp.h"
#include "core/materials/shaded_surface.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/random.h"

// What of a surface's light is diffuse: the split that layers rest on.

namespace hyades::core {
namespace {

const Vec3 kWo = glm::normalize(Vec3(0.5F, 0.3F, 0.6F));
const Vec3 kWi = glm::normalize(Vec3(-0.2F, 0.4F, 0.5F));
const Rgb kRed{0.8F, 0.3F, 0.1F};

void expect_rgb(const Rgb& value, const Rgb& expected, const char* what) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], 1e-6F) << what;
}

TEST(DiffuseShare, IsAPartOfTheValueOnTheSideOfTheViewer) {
  test::Random random(3);
  for (const BsdfCase& c : smooth_cases()) {
    const BsdfUnderTest bsdf(c.material);
    for (int n = 0; n < 2000; ++n) {
      const Vec3 wo = square_to_uniform_sphere(random.uniform2());
      const Vec3 wi = square_to_uniform_sphere(random.uniform2());
      const Rgb diffuse = bsdf->evaluate_diffuse(wo, wi);
      const Rgb all = bsdf->evaluate(wo, wi, TransportMode::radiance);
      for (int k = 0; k < 3; ++k) {
        ASSERT_GE(diffuse[k], 0.0F) << c.name;
        ASSERT_LE(diffuse[k], all[k] * 1.0001F) << c.name;
      }
      if (wo.z * wi.z < 0.0F) {
        ASSERT_TRUE(is_black(diffuse)) << c.name;
      }
      // The same whichever way light goes: both are divided by the cosine of the way on.
      const Rgb back = bsdf->evaluate_diffuse(wi, wo);
      if (!c.reciprocal) continue;
      for (int k = 0; k < 3; ++k)
        ASSERT_NEAR(diffuse[k] * std::abs(wo.z), back[k] * std::abs(wi.z), 1e-5F) << c.name;
    }
  }
}

TEST(DiffuseShare, OfPlainSurfacesIsAllOrNothing) {
  const MaterialPtr metal = make_conductor(Rgb(0.2F), Rgb(3.0F), number(0.5F), Rgb(1.0F));
  const Rgb lambert = kRed * (kInvPi * kWi.z);
  const BsdfUnderTest red(make_lambert(color_of(kRed)));
  expect_rgb(red->evaluate_diffuse(kWo, kWi), lambert, "lambert");
  expect_rgb(red->evaluate_diffuse(-kWo, -kWi), lambert, "lambert from below");
  const BsdfUnderTest rough(metal);
  expect_rgb(rough->evaluate_diffuse(kWo, kWi), Rgb(0.0F), "metal");
  const BsdfUnderTest mixed(make_mix(make_lambert(color_of(kRed)), metal, number(0.25F)));
  expect_rgb(mixed->evaluate_diffuse(kWo, kWi), 0.75F * lambert, "mix");
}

TEST(DiffuseShare, OfGlossySurfacesIsWhatTheirLobeLeaves) {
  for (const FacetScattering scattering : {FacetScattering::single, FacetScattering::multiple}) {
    for (const float glossiness : {0.3F, 1.0F}) {
      const BsdfUnderTest glossy(
          make_glossy(color_of(kRed), number(0.4F), number(glossiness), scattering));
      expect_rgb(glossy->evaluate_diffuse(kWo, kWi), 0.6F * kInvPi * kWi.z * kRed, "glossy");
    }
  }
}

TEST(DiffuseShare, OfASurfaceIsByChannelAndWithoutCosines) {
  // Red is dull and blue shines: two parts of one mix.
  const MaterialPtr material =
      make_mix(make_lambert(color_of({1.0F, 0.0F, 0.0F})),
               make_glossy(color_of({0.0F, 0.0F, 1.0F}), number(1.0F), number(0.2F)), number(0.5F));
  SurfacePoint point;
  point.ng = {0.0F, 0.0F, 1.0F};
  point.ns = glm::normalize(Vec3(0.2F, 0.0F, 1.0F));
  BsdfArena arena;
  const ShadedSurface surface(point, *material, arena);
  expect_rgb(surface.diffuse_share(kWo, kWi), {1.0F, 0.0F, 0.0F}, "by channel");
  // Where nothing is reflected nothing is diffuse.
  expect_rgb(surface.diffuse_share(kWo, -kWi), Rgb(0.0F), "other side");
}

}  // namespace
}  // namespace hyades::core
