#include "core/materials/shading_normal_correction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/warp.h"
#include "core/materials/shaded_surface.h"
#include "tests/core/materials/furnace.h"
#include "tests/support/chi_squared.h"
#include "tests/support/means.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"

// Shading normals that lean far: no light is lost, none leaks, and light paths find the same
// picture.

namespace hyades::core {
namespace {

/// A point whose shading normal leans by `degrees`.
SurfacePoint leaning_by(float degrees) {
  SurfacePoint p;
  const float angle = degrees * kPi / 180.0F;
  p.ns = {std::sin(angle), 0.0F, std::cos(angle)};
  p.dpdu = {0.0F, 1.0F, 0.0F};
  return p;
}

Vec3 from_above(float cosine, float azimuth) {
  const float r = std::sqrt(1.0F - cosine * cosine);
  return {r * std::cos(azimuth), r * std::sin(azimuth), cosine};
}

std::vector<BsdfCase> white_cases() {
  const ColorParam snow = color_of(Rgb(1.0F));
  const auto metal = [](float roughness) {
    return make_conductor(Rgb(0.1F), Rgb(1e4F), number(roughness), Rgb(1.0F),
                          FacetScattering::multiple);
  };
  return {{"mirror", metal(0.0F)},
          {"polished_metal", metal(0.2F)},
          {"dull_metal", metal(0.8F)},
          {"matt", make_lambert(snow)},
          {"glass", make_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F))},
          {"leaf", make_diffuse_transmission(color_of(Rgb(0.3F)), color_of(Rgb(0.7F)))}};
}

// T4 for bumps: single-sided clipping left 0.53 of a white metal's light, and of a mirror nothing
// where it throws its light below the horizon.
TEST(ShadingNormalCorrection, WhiteSurfacesKeepAllLightHoweverFarTheyLean) {
  for (const BsdfCase& c : white_cases()) {
    for (const float degrees : {0.0F, 20.0F, 40.0F, 60.0F, 80.0F}) {
      const SurfacePoint p = leaning_by(degrees);
      BsdfArena arena;
      const ShadedSurface surface(p, *c.material, arena);
      for (const float cosine : {1.0F, 0.7F, 0.3F, 0.05F}) {
        for (const float azimuth : {0.1F, 1.3F, 3.0F}) {
          double sum = 0.0;
          constexpr int kCount = 4000;
          float u = 0.5F;
          float v = 0.5F;
          for (int n = 0; n < kCount; ++n) {
            u += 0.7548777F;
            u -= std::floor(u);
            v += 0.5698403F;
            v -= std::floor(v);
            // Radiance that comes in through glass is scaled by its index: a body of uniform light
            // has it scaled likewise.
            const auto s =
                surface.sample(from_above(cosine, azimuth), (static_cast<float>(n) + 0.5F) / kCount,
                               {u, v}, TransportMode::radiance);
            if (s) sum += double{s->weight.x * s->eta * s->eta};
          }
          EXPECT_NEAR(sum / kCount, 1.0, 0.007)
              << c.name << " " << degrees << " degrees, " << cosine << " " << azimuth;
        }
      }
    }
  }
}

// Exact: importance is what radiance is seen from the other end.
TEST(ShadingNormalCorrection, ImportanceIsTheAdjointOfRadiance) {
  test::Random random(17);
  for (const BsdfCase& c : smooth_cases()) {
    if (!c.reciprocal) continue;
    const SurfacePoint p = leaning_by(65.0F);
    BsdfArena arena;
    const ShadedSurface surface(p, *c.material, arena);
    int folded = 0;
    for (int n = 0; n < 3000; ++n) {
      const Vec3 eye = random.direction();
      const Vec3 light = random.direction();
      const float cos_eye = std::abs(eye.z);
      const float cos_light = std::abs(light.z);
      if (std::fmin(cos_eye, cos_light) < 0.01F) continue;
      const Rgb radiance = surface.evaluate(eye, light, TransportMode::radiance) / cos_light;
      const Rgb importance = surface.evaluate(light, eye, TransportMode::importance) / cos_eye;
      for (int k = 0; k < 3; ++k)
        ASSERT_NEAR(importance[k], radiance[k], 1e-3F * radiance[k] + 1e-4F) << c.name;
      const bool clipped = glm::dot(eye, p.ns) * eye.z < 0.0F;
      folded += clipped && radiance.x > 0.0F ? 1 : 0;
    }
    EXPECT_GT(folded, 50) << c.name;
  }
}

// Weights are exact on every sample, and directions follow the density.
TEST(ShadingNormalCorrection, SamplesFollowTheirDensityInBothModes) {
  const SurfacePoint p = leaning_by(65.0F);
  for (const BsdfCase& c : smooth_cases()) {
    if (c.name != "conductor_rough_03" && c.name != "rough_glass_06") continue;
    BsdfArena arena;
    const ShadedSurface surface(p, *c.material, arena);
    for (const TransportMode mode : kBothModes) {
      // At 65 degrees the first leaves for below the horizon, the second sees the back.
      for (const Vec3& wo : {from_above(0.9F, 0.3F), from_above(0.2F, 2.9F)}) {
        test::SphereTest settings;
        settings.grid = {6, 8};
        settings.tolerance = 1e-4;
        settings.promise.tests = 8;
        settings.seed = 7;
        EXPECT_TRUE(test::directions_follow(
            [&](test::Random& random) -> std::optional<Vec3> {
              const float lobe = random.uniform();
              const auto s = surface.sample(wo, lobe, random.uniform2(), mode);
              return s && !s->delta ? std::optional(s->wi) : std::nullopt;
            },
            [&](const Vec3& wi) { return surface.pdf(wo, wi, mode); }, settings))
            << c.name << ", " << wo.z;
        test::Random random(3);
        for (int n = 0; n < 500; ++n) {
          const float lobe = random.uniform();
          const auto s = surface.sample(wo, lobe, random.uniform2(), mode);
          if (!s || s->delta) continue;
          ASSERT_NEAR(surface.pdf(wo, s->wi, mode) / s->pdf, 1.0F, 5e-3F) << c.name;
          const Rgb value = surface.evaluate(wo, s->wi, mode);
          for (int k = 0; k < 3; ++k)
            ASSERT_NEAR(s->weight[k] * s->pdf, value[k], 5e-3F * value[k] + 1e-5F) << c.name;
        }
      }
    }
  }
}

// What a mirror does to importance adds up to what it does to radiance, though each is a delta: the
// light that a wide beam leaves in the upper half as seen by all eyes.
TEST(ShadingNormalCorrection, MirrorsSendLightPathsWhereEyePathsFindThem) {
  const SurfacePoint p = leaning_by(50.0F);
  BsdfArena arena;
  const auto cases = white_cases();
  const ShadedSurface surface(p, *cases[0].material, arena);
  // Sum over eyes and lights of g(eye) h(light) by either way must agree.
  const auto g = [](const Vec3& w) { return 1.0 + double{w.x} + double{w.y * w.y}; };
  const auto h = [](const Vec3& w) { return 1.0 - 0.5 * double{w.x} + double{w.z}; };
  test::Random random(29);
  test::Moments from_eyes;
  test::Moments from_lights;
  for (int n = 0; n < 400000; ++n) {
    // Cosine-weighted about the surface, which projected solid angles ask for.
    const Vec3 w = square_to_cosine_hemisphere(random.uniform2());
    const float lobe = random.uniform();
    const Vec2 u = random.uniform2();
    const auto seen = surface.sample(w, lobe, u, TransportMode::radiance);
    from_eyes.add(seen ? double{seen->weight.x} * g(w) * h(seen->wi) : 0.0);
    const auto lit = surface.sample(w, lobe, u, TransportMode::importance);
    from_lights.add(lit ? double{lit->weight.x} * g(lit->wi) * h(w) : 0.0);
  }
  const double error = std::sqrt(from_eyes.variance_of_mean() + from_lights.variance_of_mean());
  EXPECT_LT(error, 0.02);
  EXPECT_NEAR(from_eyes.mean(), from_lights.mean(), 4.0 * error);
}

}  // namespace
}  // namespace hyades::core
