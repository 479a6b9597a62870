#include <gtest/gtest.h>

#include <cmath>

#include "core/materials/ggx.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/means.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"

// T3 and T4: reciprocity, and no more light out than in.

namespace hyades::core {
namespace {

TEST(BsdfReciprocity, SmoothValuesAreSymmetric) {
  test::Random random(21);
  for (const BsdfCase& c : smooth_cases()) {
    if (!c.reciprocal) continue;
    const BsdfUnderTest bsdf(c.material);
    int seen = 0;
    for (int n = 0; n < 10000; ++n) {
      const Vec3 a = random.direction();
      const Vec3 b = random.direction();
      if (std::abs(a.z) < 1e-3F || std::abs(b.z) < 1e-3F) continue;
      // Radiance: f / eta^2 of the side where it leaves is symmetric (Veach 1997, section 5.2).
      const auto eta2 = [&](const Vec3& w) { return w.z > 0.0F ? 1.0F : c.ior * c.ior; };
      const Rgb forth = bsdf->evaluate(a, b, TransportMode::radiance) / (std::abs(b.z) * eta2(a));
      const Rgb back = bsdf->evaluate(b, a, TransportMode::radiance) / (std::abs(a.z) * eta2(b));
      // Importance: the same BSDF with its arguments exchanged.
      const Rgb adjoint =
          bsdf->evaluate(b, a, TransportMode::importance) / (std::abs(a.z) * eta2(a));
      for (int k = 0; k < 3; ++k) {
        // The absolute part is for facets seen edge-on, whose cosines are all rounding.
        const float tolerance = 1e-3F * std::fmax(forth[k], back[k]) + 1e-5F;
        ASSERT_NEAR(forth[k], back[k], tolerance)
            << c.name << " from " << a.x << " " << a.y << " " << a.z << " to " << b.x << " " << b.y
            << " " << b.z;
        ASSERT_NEAR(forth[k], adjoint[k], tolerance) << c.name;
        seen += forth[k] > 0.0F ? 1 : 0;
      }
    }
    EXPECT_GT(seen, 1000) << c.name;
  }
}

/// What of uniform light of radiance 1 goes to wo, by sampling.
test::Moments furnace(const Bsdf& bsdf, const Vec3& wo, int count, uint64_t seed,
                      TransportMode mode = TransportMode::importance) {
  test::Random random(seed);
  test::Moments moments;
  for (int n = 0; n < count; ++n) {
    const float lobe = random.uniform();
    const auto s = bsdf.sample(wo, lobe, random.uniform2(), mode);
    moments.add(s ? s->weight.x : 0.0F);
  }
  return moments;
}

// Every sample's expectation is checked against quadrature of evaluate(): a wrong weight or pdf of
// 1 % is found with probability 0.99.
TEST(BsdfFurnace, SampledReflectanceIsThatOfQuadratureAndAtMostOne) {
  const auto directions = five_directions();
  const float roughnesses[] = {0.1F, 0.3F, 0.5F, 0.7F, 1.0F};
  test::Promise promise;
  promise.tests = static_cast<int>(std::size(roughnesses) * directions.size());
  uint64_t seed = 31;
  for (const float roughness : roughnesses) {
    // A metal that reflects everything shows the facets alone.
    const BsdfUnderTest bsdf(
        make_glossy(color_of(Rgb(1.0F)), number(1.0F), number(1.0F - roughness)));
    for (const NamedDirection& d : directions) {
      const double low = d.wo.z > 0.0F ? 0.0 : -1.0;
      const double exact = test::integrate_sphere(
          [&](const Vec3& wi) { return bsdf->evaluate(d.wo, wi, TransportMode::radiance).x; }, low,
          low + 1.0, 2e-5, 8, 10);
      EXPECT_LE(exact, 1.0 + 1e-4) << roughness << ", " << d.name;
      EXPECT_TRUE(test::mean_is(furnace(*bsdf.get(), d.wo, 600000, ++seed), exact, promise))
          << roughness << ", " << d.name;
    }
  }
}

// Single scattering loses what would hit a second facet. For alpha = 1 and normal incidence D is
// 1 / pi and G2 rational in cos theta_i, so that the integral is elementary: 1 - ln 2.
TEST(BsdfFurnace, RoughestFacetsReflectOneMinusLogTwo) {
  const Ggx facets{1.0F};
  const double sum = test::integrate_sphere(
      [&](const Vec3& wi) {
        return facets.reflect({0.0F, 0.0F, 1.0F}, wi);
      },
      0.0, 1.0);
  EXPECT_NEAR(sum, 1.0 - std::log(2.0), 1e-5);
}

TEST(BsdfFurnace, SmoothFacetsLoseNothing) {
  for (const float alpha : {1e-4F, 1e-3F, 1e-2F}) {
    const Ggx facets{alpha};
    const Vec3 wo = glm::normalize(Vec3(0.3F, 0.1F, 0.8F));
    test::Random random(41);
    test::Moments moments;
    for (int n = 0; n < 20000; ++n) {
      const Vec3 wi = reflected(wo, facets.sample_normal(wo, random.uniform2()));
      moments.add(wi.z > 0.0F ? facets.reflect_weight(wo, wi) : 0.0F);
    }
    EXPECT_NEAR(moments.mean(), 1.0, 1e-3 + 2.0 * alpha * alpha) << alpha;
  }
}

// The density of normals is normalised as projected area (Walter et al. 2007, equation 4), and
// visible normals carry the area seen: integral of D G1 max(0, wo.m) / wo.z = 1.
TEST(Ggx, NormalsAreNormalised) {
  for (const float alpha : {0.1F, 0.3F, 1.0F}) {
    const Ggx facets{alpha};
    EXPECT_NEAR(test::integrate_sphere([&](const Vec3& m) { return facets.density(m) * m.z; }, 0.0,
                                       1.0, 1e-5, 12, 10),
                1.0, 1e-4)
        << alpha;
    for (const float z : {1.0F, 0.6F, 0.05F}) {
      const Vec3 wo(std::sqrt(1.0F - z * z), 0.0F, z);
      const double seen = test::integrate_sphere(
          [&](const Vec3& m) {
            const float g1 = 2.0F * wo.z / (wo.z + facets.spread(wo));
            return g1 * std::fmax(0.0F, glm::dot(wo, m)) * facets.density(m) / wo.z;
          },
          0.0, 1.0, 1e-5, 12, 10);
      EXPECT_NEAR(seen, 1.0, 1e-4) << alpha << " " << z;
    }
  }
}

TEST(BsdfFurnace, LambertReflectsItsColour) {
  const BsdfUnderTest bsdf(make_lambert(color_of({0.8F, 0.3F, 0.1F})));
  for (const NamedDirection& d : five_directions()) {
    const double sum = test::integrate_sphere(
        [&](const Vec3& wi) { return bsdf->evaluate(d.wo, wi, TransportMode::radiance).y; });
    EXPECT_NEAR(sum, 0.3, 1e-5) << d.name;
    EXPECT_EQ(bsdf->albedo(d.wo), Rgb(0.8F, 0.3F, 0.1F));
  }
}

// 100,000 samples of a quantity of deviation below 0.79 put its mean's error below 0.0025.
TEST(BsdfFurnace, NoMaterialCreatesEnergy) {
  uint64_t seed = 51;
  for (const BsdfCase& c : smooth_cases()) {
    // Importance has no such bound where it is scattered about a turned normal (Veach 1997, 5.3.4),
    // or by strands, which take it as from their whole width.
    if (!c.reciprocal) continue;
    const BsdfUnderTest bsdf(c.material);
    for (const NamedDirection& d : five_directions()) {
      const TransportMode mode = c.scaled ? TransportMode::importance : TransportMode::radiance;
      const test::Moments moments = furnace(*bsdf.get(), d.wo, 100000, ++seed, mode);
      const double sigma = std::sqrt(moments.variance_of_mean());
      EXPECT_LT(sigma, 0.0025) << c.name;
      // Light that is given back comes from tables that are within 0.002.
      EXPECT_LE(moments.mean() - 3.0 * sigma, 1.002) << c.name << ", " << d.name;
      EXPECT_LE(moments.mean(), 1.005) << c.name << ", " << d.name;
    }
  }
}

}  // namespace
}  // namespace hyades::core
