#include <gtest/gtest.h>

#include <cmath>

#include "core/materials/fresnel.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/random.h"
#include "tests/support/special_functions.h"

namespace hyades::core {
namespace {

const Vec2 kAnyU(0.3F, 0.6F);

/// Both lobes of a delta BSDF: found by the ends of the range of `lobe`.
struct Lobes {
  std::optional<BsdfSample> reflected;
  std::optional<BsdfSample> refracted;
};

Lobes lobes_of(const Bsdf& bsdf, const Vec3& wo, TransportMode mode) {
  Lobes lobes;
  for (const float lobe : {0.0F, 1.0F - 0x1p-24F}) {
    const auto s = bsdf.sample(wo, lobe, kAnyU, mode);
    if (s) (s->transmitted ? lobes.refracted : lobes.reflected) = s;
  }
  return lobes;
}

/// Energy that a lobe carries: its weight times its discrete probability.
float energy(const std::optional<BsdfSample>& s) { return s ? s->weight.x * s->pdf : 0.0F; }

Vec3 at_height(float z) {
  const float r = std::sqrt(1.0F - z * z);
  return {0.8F * r, -0.6F * r, z};
}

const float kHeights[] = {1.0F, 0.8F, 0.4F, 0.05F, -0.05F, -0.3F, -0.8F, -1.0F};

// Exact: importance is neither lost nor gained at an interface.
TEST(Dielectric, LobesSumToOneForImportance) {
  for (const float ior : {1.0F, 1.33F, 1.5F, 2.4F, 0.7F}) {
    const BsdfUnderTest glass(make_dielectric(ior, Rgb(1.0F), Rgb(1.0F)));
    const BsdfUnderTest sheet(make_thin_dielectric(ior, Rgb(1.0F), Rgb(1.0F)));
    for (const float z : kHeights) {
      for (const BsdfUnderTest* bsdf : {&glass, &sheet}) {
        const Lobes lobes = lobes_of(*bsdf->get(), at_height(z), TransportMode::importance);
        EXPECT_NEAR(energy(lobes.reflected) + energy(lobes.refracted), 1.0F, 1e-6F)
            << ior << " " << z;
        EXPECT_EQ((*bsdf)->albedo(at_height(z)).x, 1.0F) << ior << " " << z;
        EXPECT_FALSE((*bsdf)->has_smooth());
      }
    }
  }
}

// A beam of radiance L fills a solid angle 1 / eta^2 as wide inside glass, so it appears eta^2
// times brighter there: refraction from the side of index eta_i into that of eta_o scales radiance
// with (eta_o / eta_i)^2, importance with 1.
TEST(Dielectric, RefractionScalesRadianceByTheSquaredIndexRatio) {
  const BsdfUnderTest glass(make_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F)));
  for (const float z : {1.0F, 0.5F, -0.9F}) {
    const Vec3 wo = at_height(z);
    const auto radiance = lobes_of(*glass.get(), wo, TransportMode::radiance).refracted;
    const auto importance = lobes_of(*glass.get(), wo, TransportMode::importance).refracted;
    ASSERT_TRUE(radiance && importance);
    // The eye above sees light that comes out of the glass: dimmer by 1.5^2.
    const float expected = z > 0.0F ? 1.0F / 2.25F : 2.25F;
    EXPECT_NEAR(radiance->weight.x, expected, 1e-6F);
    EXPECT_EQ(importance->weight.x, 1.0F);
    EXPECT_NEAR(radiance->eta, z > 0.0F ? 1.5F : 1.0F / 1.5F, 1e-6F);
    EXPECT_TRUE(radiance->delta);
  }
}

TEST(Dielectric, DirectionsObeySnell) {
  const BsdfUnderTest glass(make_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F)));
  for (const float z : kHeights) {
    const Vec3 wo = at_height(z);
    const Lobes lobes = lobes_of(*glass.get(), wo, TransportMode::radiance);
    const float sine_i = std::sqrt(1.0F - z * z);
    const bool total = z < 0.0F && sine_i * 1.5F > 1.0F;
    EXPECT_EQ(!lobes.refracted, total) << z;
    if (total) {
      EXPECT_EQ(energy(lobes.reflected), 1.0F);
      EXPECT_EQ(lobes.reflected->wi, Vec3(-wo.x, -wo.y, wo.z));
      continue;
    }
    const Vec3 wi = lobes.refracted->wi;
    const float eta = z > 0.0F ? 1.5F : 1.0F / 1.5F;
    EXPECT_NEAR(std::hypot(wi.x, wi.y), sine_i / eta, 1e-6F) << z;
    EXPECT_NEAR(glm::length(wi), 1.0F, 1e-6F) << z;
    EXPECT_LE(glm::dot(Vec2(wi.x, wi.y), Vec2(wo.x, wo.y)), 0.0F) << z;
    EXPECT_LT(wi.z * z, 0.0F) << z;
    // Backwards along the refracted ray: the same way and the same energy.
    const Lobes back = lobes_of(*glass.get(), wi, TransportMode::importance);
    EXPECT_LT(glm::distance(back.refracted->wi, wo), 1e-5F) << z;
    EXPECT_NEAR(energy(back.refracted), energy(lobes.refracted) * eta * eta, 2e-5F) << z;
  }
}

// As physics has it radiance changes by 1 / eta^2, without that importance does: their ratio, which
// paths from both ends share, stays.
TEST(Dielectric, RadianceMayKeepItsValue) {
  const BsdfUnderTest scaled(make_rough_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F), number(0.0F)));
  const BsdfUnderTest unscaled(make_rough_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F), number(0.0F),
                                                     FacetScattering::single, false));
  for (const float z : kHeights) {
    for (const TransportMode mode : kBothModes) {
      const bool is_radiance = mode == TransportMode::radiance;
      const TransportMode other = is_radiance ? TransportMode::importance : TransportMode::radiance;
      const Lobes with = lobes_of(*scaled.get(), at_height(z), mode);
      const Lobes without = lobes_of(*unscaled.get(), at_height(z), mode);
      const Lobes as = lobes_of(*scaled.get(), at_height(z), other);
      EXPECT_EQ(energy(without.reflected), energy(with.reflected));
      EXPECT_EQ(energy(without.refracted), energy(as.refracted)) << z;
    }
  }
}

TEST(Dielectric, EqualIndicesPassLightUnchanged) {
  const BsdfUnderTest air(make_dielectric(1.0F, Rgb(1.0F), Rgb(1.0F)));
  for (const float z : kHeights) {
    for (const TransportMode mode : kBothModes) {
      for (const float lobe : {0.0F, 0.5F, 1.0F - 0x1p-24F}) {
        const auto s = air->sample(at_height(z), lobe, kAnyU, mode);
        ASSERT_TRUE(s);
        EXPECT_EQ(s->wi, -at_height(z));
        EXPECT_EQ(s->weight, Rgb(1.0F));
        EXPECT_EQ(s->pdf, 1.0F);
        EXPECT_EQ(s->eta, 1.0F);
        EXPECT_TRUE(s->delta && s->transmitted);
      }
    }
  }
}

// Exact, by adding the bounces inside the sheet one by one.
TEST(ThinDielectric, ReflectanceIsTheSeriesOfInnerBounces) {
  const BsdfUnderTest sheet(make_thin_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F)));
  for (const float z : {1.0F, 0.5F, 0.1F, -0.7F}) {
    const double r = fresnel_dielectric(std::abs(z), 1.5F).reflectance;
    double reflected = r;
    double inside = 1.0 - r;
    double transmitted = 0.0;
    for (int bounce = 0; bounce < 200; ++bounce) {
      (bounce % 2 == 0 ? transmitted : reflected) += inside * (1.0 - r);
      inside *= r;
    }
    for (const TransportMode mode : kBothModes) {
      const Lobes lobes = lobes_of(*sheet.get(), at_height(z), mode);
      EXPECT_NEAR(energy(lobes.reflected), reflected, 1e-6) << z;
      EXPECT_NEAR(energy(lobes.refracted), transmitted, 1e-6) << z;
      EXPECT_EQ(lobes.refracted->wi, -at_height(z));
      EXPECT_EQ(lobes.refracted->eta, 1.0F);
    }
  }
}

TEST(Dielectric, TintsScaleTheirLobeOnly) {
  const Rgb transmission(0.9F, 0.5F, 0.1F);
  const Rgb reflection(0.2F, 1.0F, 0.6F);
  const MaterialPtr materials[] = {make_dielectric(1.5F, transmission, reflection),
                                   make_thin_dielectric(1.5F, transmission, reflection)};
  const MaterialPtr clear[] = {make_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F)),
                               make_thin_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F))};
  for (int m = 0; m < 2; ++m) {
    const BsdfUnderTest tinted(materials[m]);
    const BsdfUnderTest plain(clear[m]);
    for (const float z : {0.9F, 0.2F, -0.9F}) {
      const Lobes a = lobes_of(*tinted.get(), at_height(z), TransportMode::radiance);
      const Lobes b = lobes_of(*plain.get(), at_height(z), TransportMode::radiance);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(a.reflected->weight[c] * a.reflected->pdf, reflection[c] * energy(b.reflected),
                    1e-6F);
        EXPECT_NEAR(a.refracted->weight[c] * a.refracted->pdf,
                    transmission[c] * energy(b.refracted), 1e-6F);
      }
    }
  }
}

TEST(Dielectric, BlackLobesAreNotSampled) {
  const BsdfUnderTest only_through(make_dielectric(1.5F, Rgb(1.0F), Rgb(0.0F)));
  const BsdfUnderTest only_back(make_dielectric(1.5F, Rgb(0.0F), Rgb(1.0F)));
  const BsdfUnderTest neither(make_dielectric(1.5F, Rgb(0.0F), Rgb(0.0F)));
  for (const float lobe : {0.0F, 0.5F, 1.0F - 0x1p-24F}) {
    const auto through = only_through->sample(at_height(0.5F), lobe, kAnyU, kBothModes[1]);
    ASSERT_TRUE(through && through->transmitted);
    EXPECT_EQ(through->pdf, 1.0F);
    const auto back = only_back->sample(at_height(0.5F), lobe, kAnyU, kBothModes[1]);
    ASSERT_TRUE(back && !back->transmitted);
    EXPECT_EQ(back->pdf, 1.0F);
    EXPECT_FALSE(neither->sample(at_height(0.5F), lobe, kAnyU, kBothModes[1]));
  }
}

// Frequencies of discrete lobes are their pdf: 40,000 draws put a standard error of at most 0.0025
// on each, so that an error of 0.013 is found with probability 0.99.
TEST(DeltaLobes, AreDrawnAsOftenAsTheirPdfSays) {
  test::Random random(71);
  const BsdfCase cases[] = {
      {"glass", make_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F))},
      {"tinted", make_dielectric(1.5F, Rgb(0.1F), Rgb(1.0F))},
      {"sheet", make_thin_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F))},
      {"mirror in lambert",
       make_mix(make_lambert(color_of(Rgb(0.5F))), make_mirror(color_of(Rgb(0.9F))), number(0.3F))},
      {"glossy", make_glossy(color_of(Rgb(0.5F)), number(0.35F), number(1.0F))},
  };
  for (const BsdfCase& c : cases) {
    const BsdfUnderTest bsdf(c.material);
    for (const float z : {0.7F, 0.1F, -0.9F}) {
      constexpr int kCount = 40000;
      int drawn[2] = {};
      float pdf[2] = {};
      for (int n = 0; n < kCount; ++n) {
        const auto s = bsdf->sample(at_height(z), random.uniform(), random.uniform2(),
                                    TransportMode::radiance);
        if (!s || !s->delta) continue;
        ++drawn[s->transmitted];
        pdf[s->transmitted] = s->pdf;
      }
      for (int k = 0; k < 2; ++k) {
        const double sigma = std::sqrt(pdf[k] * (1.0 - pdf[k]) / kCount);
        EXPECT_NEAR(static_cast<double>(drawn[k]) / kCount, pdf[k], 4.0 * sigma + 1e-9) << c.name;
      }
    }
  }
}

TEST(Mirror, ReflectsItsColourOnBothSides) {
  const BsdfUnderTest mirror(make_mirror(color_of({0.9F, 0.8F, 0.2F})));
  for (const float z : kHeights) {
    const Vec3 wo = at_height(z);
    const auto s = mirror->sample(wo, 0.5F, kAnyU, TransportMode::radiance);
    ASSERT_TRUE(s && s->delta && !s->transmitted);
    EXPECT_EQ(s->weight, Rgb(0.9F, 0.8F, 0.2F));
    EXPECT_EQ(s->wi, Vec3(-wo.x, -wo.y, wo.z));
  }
}

TEST(Conductor, WithoutRoughnessIsAMirrorWithFresnel) {
  const MetalIndex copper = *find_metal("copper");
  const BsdfUnderTest bsdf(make_conductor(copper.eta, copper.k, number(0.0F), Rgb(0.5F)));
  EXPECT_FALSE(bsdf->has_smooth());
  for (const float z : kHeights) {
    const auto s = bsdf->sample(at_height(z), 0.5F, kAnyU, TransportMode::radiance);
    ASSERT_TRUE(s && s->delta);
    EXPECT_EQ(s->weight, 0.5F * fresnel_conductor(std::abs(z), copper.eta, copper.k));
    EXPECT_GT(s->wi.z * z, 0.0F);
  }
}

TEST(NullAndBlack, DoWhatTheySay) {
  const MaterialPtr null_material = make_null();
  EXPECT_TRUE(null_material->is_null());
  const BsdfUnderTest nothing(null_material);
  EXPECT_TRUE(nothing->is_null());
  EXPECT_EQ(nothing->sample(at_height(0.3F), 0.5F, kAnyU, TransportMode::radiance)->wi,
            -at_height(0.3F));
  EXPECT_EQ(BsdfUnderTest(make_black()).get(), nullptr);
  EXPECT_EQ(BsdfUnderTest(make_lambert(color_of(Rgb(0.0F)))).get(), nullptr);
  EXPECT_FALSE(make_mix(make_null(), make_black(), number(0.5F))->is_null());
  EXPECT_TRUE(make_mix(make_null(), make_null(), number(0.5F))->is_null());
}

}  // namespace
}  // namespace hyades::core
