#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/means.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

test::Moments mean_weight(const Bsdf& bsdf, const Vec3& wo, uint64_t seed) {
  test::Random random(seed);
  test::Moments moments;
  for (int n = 0; n < 40000; ++n) {
    const float lobe = random.uniform();
    const auto s = bsdf.sample(wo, lobe, random.uniform2(), TransportMode::importance);
    moments.add(s ? s->weight.x : 0.0);
  }
  return moments;
}

const Vec3 kMixedWo = glm::normalize(Vec3(0.5F, 0.3F, 0.6F));

// Finds an error of 1 % of the reflectance with probability 0.99.
TEST(Mix, DeltaAndSmoothLobesAddUp) {
  const MaterialPtr grey = make_lambert(color_of(Rgb(0.5F)));
  const MaterialPtr mirror = make_mirror(color_of(Rgb(0.9F)));
  const struct {
    const char* name;
    MaterialPtr material;
    double reflectance;
  } cases[] = {
      {"lambert and mirror", make_mix(grey, mirror, number(0.3F)), 0.7 * 0.5 + 0.3 * 0.9},
      {"mirror and lambert", make_mix(mirror, grey, number(0.3F)), 0.7 * 0.9 + 0.3 * 0.5},
      {"lambert and black", make_mix(grey, make_black(), number(0.25F)), 0.75 * 0.5},
      {"black and mirror", make_mix(make_black(), mirror, number(0.25F)), 0.25 * 0.9},
      {"glass and lambert",
       make_mix(make_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F)), grey, number(0.4F)), 0.6 + 0.4 * 0.5},
      {"lambert and null", make_mix(grey, make_null(), number(0.6F)), 0.4 * 0.5 + 0.6},
      {"three deep", make_mix(make_mix(grey, mirror, number(0.5F)), make_null(), number(0.2F)),
       0.8 * 0.7 + 0.2},
      {"glossy with a mirror", make_glossy(color_of(Rgb(0.6F)), number(0.3F), number(1.0F)), 0.6},
  };
  test::Promise promise;
  promise.tests = static_cast<int>(std::size(cases));
  uint64_t seed = 1;
  for (const auto& c : cases) {
    const BsdfUnderTest bsdf(c.material);
    EXPECT_TRUE(test::mean_is(mean_weight(*bsdf.get(), kMixedWo, ++seed), c.reflectance, promise))
        << c.name;
    EXPECT_NEAR(bsdf->albedo(kMixedWo).x, c.reflectance, 1e-6) << c.name;
  }
}

TEST(Mix, ValuesArePartsOfBoth) {
  const MaterialPtr a = make_lambert(color_of({0.8F, 0.3F, 0.1F}));
  const MaterialPtr b = make_conductor(Rgb(0.2F), Rgb(3.0F), number(0.5F), Rgb(1.0F));
  const BsdfUnderTest first(a);
  const BsdfUnderTest second(b);
  const BsdfUnderTest mix(make_mix(a, b, number(0.3F)));
  test::Random random(9);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 wo = random.direction();
    const Vec3 wi = random.direction();
    const Rgb expected = 0.7F * first->evaluate(wo, wi, TransportMode::radiance) +
                         0.3F * second->evaluate(wo, wi, TransportMode::radiance);
    const Rgb found = mix->evaluate(wo, wi, TransportMode::radiance);
    EXPECT_LT(glm::distance(found, expected), 1e-5F * (1.0F + glm::length(expected)));
    EXPECT_NEAR(mix->pdf(wo, wi, TransportMode::radiance),
                0.7F * first->pdf(wo, wi, TransportMode::radiance) +
                    0.3F * second->pdf(wo, wi, TransportMode::radiance),
                1e-5F);
  }
}

TEST(Mix, EndsOfTheRangeAreTheParts) {
  const MaterialPtr mirror = make_mirror(color_of(Rgb(0.9F)));
  const MaterialPtr grey = make_lambert(color_of(Rgb(0.5F)));
  EXPECT_FALSE(BsdfUnderTest(make_mix(mirror, grey, number(0.0F)))->has_smooth());
  EXPECT_TRUE(BsdfUnderTest(make_mix(mirror, grey, number(1.0F)))->has_smooth());
  EXPECT_EQ(BsdfUnderTest(make_mix(make_black(), make_black(), number(0.5F))).get(), nullptr);
}

TEST(Mix, AmountComesFromItsTexture) {
  const ScalarParam amount{0.0F, function_texture([](const TexturePoint& at) {
                             ScalarGradient g;
                             g.value = at.uv.x;
                             return g;
                           })};
  const MaterialPtr material =
      make_mix(make_lambert(color_of(Rgb(0.0F))), make_lambert(color_of(Rgb(1.0F))), amount);
  for (const float u : {0.25F, 0.5F, 0.75F}) {
    SurfacePoint point;
    point.uv = {u, 0.0F};
    Frame frame;
    BsdfArena arena;
    EXPECT_NEAR(material->bsdf_at(point, frame, arena)->albedo(kMixedWo).x, u, 1e-6F);
  }
}

// A part's own normal counts for that part only.
TEST(Mix, PartsKeepTheirBumps) {
  const MaterialPtr grey = make_lambert(color_of(Rgb(0.5F)));
  const MaterialPtr bumped = make_bump(grey, object_slope({1.0F, 0.0F, 0.0F}), 1.0F);
  const BsdfUnderTest mix(make_mix(grey, bumped, number(0.5F)));
  const Vec3 wi(0.0F, 0.0F, 1.0F);
  const float tilted = std::sqrt(0.5F);  // a slope of 1 turns the normal by 45 degrees
  EXPECT_NEAR(mix->evaluate(wi, wi, TransportMode::radiance).x,
              0.5F * kInvPi * (0.5F + 0.5F * tilted), 1e-6F);
}

// Where a part's own normal looks away from wo, that part is seen in the upright mirror behind it
// (shading_normal_correction.h), even if it transmits.
TEST(Mix, PartsSeenFromBehindTheirNormalShowTheirFronts) {
  const MaterialPtr glass = make_rough_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F), number(0.5F));
  const BsdfUnderTest mix(make_mix(make_lambert(color_of(Rgb(0.5F))),
                                   make_bump(glass, object_slope({1.0F, 0.0F, 0.0F}), 1.0F),
                                   number(0.5F)));
  const Vec3 wo = glm::normalize(Vec3(0.9F, 0.1F, 0.2F));
  const Vec3 in_mirror(-wo.x, wo.y, wo.z);
  test::Random random(10);
  int more_than_matt = 0;
  for (int n = 0; n < 1000; ++n) {
    const Vec3 wi = random.direction();
    const float pdf = mix->pdf(wo, wi, TransportMode::radiance);
    EXPECT_NEAR(pdf, mix->pdf(in_mirror, wi, TransportMode::radiance), 1e-4F * pdf + 1e-6F);
    const float value = mix->evaluate(wo, wi, TransportMode::radiance).x;
    EXPECT_NEAR(value, mix->evaluate(in_mirror, wi, TransportMode::radiance).x,
                1e-4F * value + 1e-6F);
    more_than_matt += value > 0.25F * kInvPi * std::fmax(wi.z, 0.0F) + 0.01F ? 1 : 0;
  }
  EXPECT_GT(more_than_matt, 50);
}

TEST(BsdfArena, RunsOutWithoutHarm) {
  BsdfArena arena;
  MaterialPtr material = make_lambert(color_of(Rgb(0.5F)));
  for (int i = 0; i < 200; ++i) {
    material = make_mix(material, make_lambert(color_of(Rgb(0.5F))), number(0.5F));
  }
  SurfacePoint point;
  Frame frame;
  material->bsdf_at(point, frame, arena);
  arena.reset();
  EXPECT_NE(make_lambert(color_of(Rgb(0.5F)))->bsdf_at(point, frame, arena), nullptr);
}

}  // namespace
}  // namespace hyades::core
