#include "core/materials/shaded_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

/// A point whose shading normal leans away from its geometric one.
SurfacePoint leaning(const Vec3& ng, float lean) {
  SurfacePoint p;
  const Frame frame = Frame::around(ng);
  p.ng = ng;
  p.ns = glm::normalize(ng + lean * frame.s);
  p.dpdu = frame.t;
  return p;
}

// Exact: seen from the light, a surface with another shading normal must do to importance what it
// does to radiance seen from the eye (Veach 1997, section 5.3), both per geometric projected angle.
TEST(ShadedSurface, ImportanceIsTheAdjointOfRadiance) {
  test::Random random(91);
  for (const BsdfCase& c : smooth_cases()) {
    if (!c.reciprocal) continue;
    int seen = 0;
    for (int n = 0; n < 2000; ++n) {
      BsdfArena arena;
      const SurfacePoint p = leaning(random.direction(), 0.4F);
      const ShadedSurface surface(p, *c.material, arena);
      const Vec3 eye = random.direction();
      const Vec3 light = random.direction();
      const float cos_eye = std::abs(glm::dot(eye, p.ng));
      const float cos_light = std::abs(glm::dot(light, p.ng));
      if (std::fmin(cos_eye, cos_light) < 0.01F) continue;
      const Rgb radiance = surface.evaluate(eye, light, TransportMode::radiance) / cos_light;
      const Rgb importance = surface.evaluate(light, eye, TransportMode::importance) / cos_eye;
      for (int k = 0; k < 3; ++k) {
        ASSERT_NEAR(importance[k], radiance[k], 1e-3F * radiance[k] + 1e-5F) << c.name;
        seen += radiance[k] > 0.0F ? 1 : 0;
      }
    }
    EXPECT_GT(seen, 200) << c.name;
  }
}

// Exact on every sample: weight pdf = value, both modes, in world space.
TEST(ShadedSurface, WeightIsValueOverPdf) {
  test::Random random(92);
  for (const BsdfCase& c : smooth_cases()) {
    for (int n = 0; n < 2000; ++n) {
      BsdfArena arena;
      const SurfacePoint p = leaning(random.direction(), 0.4F);
      const ShadedSurface surface(p, *c.material, arena);
      const Vec3 wo = random.direction();
      const TransportMode mode = kBothModes[n % 2];
      const float lobe = random.uniform();
      const auto s = surface.sample(wo, lobe, random.uniform2(), mode);
      if (!s) continue;
      ASSERT_NEAR(glm::length(s->wi), 1.0F, 1e-6F);
      if (s->delta) continue;
      ASSERT_NEAR(surface.pdf(wo, s->wi, mode) / s->pdf, 1.0F, 2e-3F) << c.name;
      const Rgb value = surface.evaluate(wo, s->wi, mode);
      for (int k = 0; k < 3; ++k) {
        // Turning to world space and back costs sharp lobes some digits.
        ASSERT_NEAR(s->weight[k] * s->pdf, value[k], 2e-3F * value[k] + 1e-6F) << c.name;
      }
    }
  }
}

// Skies that are as bright as their mean, or less, are found by following the BSDF alone: it must
// lead to wherever it scatters.
TEST(ShadedSurface, CanLeadWhereverItScatters) {
  test::Random random(95);
  for (const BsdfCase& c : smooth_cases()) {
    for (int n = 0; n < 5000; ++n) {
      BsdfArena arena;
      const SurfacePoint p = leaning(random.direction(), n % 2 == 0 ? 0.0F : 0.6F);
      const ShadedSurface surface(p, *c.material, arena);
      const Vec3 wo = random.direction();
      const Vec3 wi = random.direction();
      if (is_black(surface.evaluate(wo, wi, TransportMode::radiance))) continue;
      ASSERT_GT(surface.pdf(wo, wi, TransportMode::radiance), 0.0F) << c.name;
    }
  }
}

TEST(ShadedSurface, LightDoesNotLeakThroughTheGeometricSurface) {
  test::Random random(93);
  const MaterialPtr material = make_lambert(color_of(Rgb(1.0F)));
  int between = 0;
  for (int n = 0; n < 20000; ++n) {
    BsdfArena arena;
    const SurfacePoint p = leaning(random.direction(), 0.8F);
    const ShadedSurface surface(p, *material, arena);
    const Vec3 wo = random.direction();
    const Vec3 wi = random.direction();
    const Rgb value = surface.evaluate(wo, wi, TransportMode::radiance);
    const bool same_geometric = glm::dot(wo, p.ng) * glm::dot(wi, p.ng) > 0.0F;
    if (!same_geometric) {
      EXPECT_EQ(value, Rgb(0.0F));
      between += glm::dot(wo, p.ns) * glm::dot(wi, p.ns) > 0.0F ? 1 : 0;
    }
    const auto s = surface.sample(wo, 0.5F, random.uniform2(), TransportMode::radiance);
    if (s) {
      EXPECT_GT(glm::dot(wo, p.ng) * glm::dot(s->wi, p.ng), 0.0F);
    }
  }
  EXPECT_GT(between, 1000);  // the shading normal alone would have let these through
}

TEST(ShadedSurface, WithoutALeanItIsTheBsdfInItsFrame) {
  test::Random random(94);
  const MaterialPtr material = make_lambert(color_of({0.8F, 0.3F, 0.1F}));
  BsdfArena arena;
  const SurfacePoint p = leaning(random.direction(), 0.0F);
  const ShadedSurface surface(p, *material, arena);
  EXPECT_TRUE(surface.has_smooth());
  for (int n = 0; n < 100; ++n) {
    const Vec3 wo = random.direction();
    const Vec3 wi = random.direction();
    const bool same = glm::dot(wo, p.ng) * glm::dot(wi, p.ng) > 0.0F;
    const float expected = same ? 0.3F * kInvPi * std::abs(glm::dot(wi, p.ng)) : 0.0F;
    EXPECT_NEAR(surface.evaluate(wo, wi, TransportMode::importance).y, expected, 1e-6F);
  }
  const MaterialPtr black = make_black();
  const ShadedSurface absorbing(p, *black, arena);
  EXPECT_EQ(absorbing.bsdf(), nullptr);
  EXPECT_FALSE(absorbing.has_smooth());
}

}  // namespace
}  // namespace hyades::core
