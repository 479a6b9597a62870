// Strands of hair against closed forms, and against rays through a glass rod.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/quadrature.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

MaterialPtr hair_of(const Rgb& absorption, float roughness, float radial_roughness) {
  HairParams params;
  params.absorption = absorption;
  params.roughness.value = roughness;
  params.radial_roughness.value = radial_roughness;
  params.tilt = 0.0F;
  return make_hair(params);
}

// Straight on, at the middle: Fresnel's reflectance f, and a geometric row of passes that each keep
// exp(-2 absorption).
TEST(Hair, KeepsWhatAbsorptionLeaves) {
  const Rgb absorption(0.0F, 0.2F, 1.5F);
  const BsdfUnderTest bsdf(hair_of(absorption, 0.5F, 0.5F));
  const float f = (0.55F / 2.55F) * (0.55F / 2.55F);
  const Rgb kept = bsdf->albedo({0.0F, 0.0F, 1.0F});
  for (int c = 0; c < 3; ++c) {
    const float through = std::exp(-2.0F * absorption[c]);
    EXPECT_NEAR(kept[c], f + (1.0F - f) * (1.0F - f) * through / (1.0F - f * through), 1e-5F);
  }
}

// Everywhere else: what evaluate() sends in all directions is what albedo() says, all of it without
// absorption.
TEST(Hair, ScattersWhatItKeeps) {
  test::Random random(3);
  for (const float roughness : {0.25F, 0.6F}) {
    const BsdfUnderTest bsdf(hair_of({0.0F, 0.3F, 2.0F}, roughness, roughness));
    for (int i = 0; i < 4; ++i) {
      const Vec3 wo = random.direction();
      const Rgb kept = bsdf->albedo(wo);
      EXPECT_NEAR(kept.x, 1.0F, 1e-4F);
      for (int c = 0; c < 3; ++c) {
        const double sum = test::integrate_sphere(
            [&](const Vec3& wi) { return bsdf->evaluate(wo, wi, TransportMode::radiance)[c]; },
            -1.0, 1.0, 1e-4, 16, 16);
        EXPECT_NEAR(sum, static_cast<double>(kept[c]), 2e-3) << wo.x << " " << wo.y << " " << wo.z;
      }
    }
  }
}

/// In the cross-section: a ray that travels along `d` refracted at a surface of normal `n` that
/// faces it, into an index `eta` times as large.
glm::dvec2 refracted(const glm::dvec2& d, const glm::dvec2& n, double eta) {
  const double cosine = -glm::dot(d, n);
  const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (eta * eta));
  return d / eta + n * (cosine / eta - inside);
}

// Narrow lobes go where a ray goes that is mirrored at a rod of glass, and one that goes through.
TEST(Hair, NarrowLobesGoWhereRaysOfARodGo) {
  const BsdfUnderTest bsdf(hair_of(Rgb(0.0F), 0.1F, 0.02F));
  for (const double h : {-0.7, -0.3, 0.2, 0.6}) {
    // The normal is +z; the ray comes from wo, beside the axis by h.
    const double angle = std::asin(h);
    const glm::dvec2 wo(std::sin(angle), std::cos(angle));  // y, z
    const glm::dvec2 n(0.0, 1.0);
    const glm::dvec2 mirrored = 2.0 * glm::dot(wo, n) * n - wo;
    const glm::dvec2 within = refracted(-wo, n, 1.55);
    const glm::dvec2 leaves = n - within * (2.0 * glm::dot(n, within));  // on the rod again
    const glm::dvec2 through = refracted(within, -leaves, 1.0 / 1.55);
    const auto density = [&](const glm::dvec2& wi) {
      return bsdf
          ->evaluate({0.0F, static_cast<float>(wo.x), static_cast<float>(wo.y)},
                     {0.0F, static_cast<float>(wi.x), static_cast<float>(wi.y)},
                     TransportMode::radiance)
          .x;
    };
    for (const glm::dvec2& way : {mirrored, through}) {
      const double turn = 0.1;
      const glm::dvec2 left(way.x * std::cos(turn) - way.y * std::sin(turn),
                            way.x * std::sin(turn) + way.y * std::cos(turn));
      const glm::dvec2 right(way.x * std::cos(turn) + way.y * std::sin(turn),
                             way.y * std::cos(turn) - way.x * std::sin(turn));
      EXPECT_GT(density(way), 2.0F * density(left)) << h;
      EXPECT_GT(density(way), 2.0F * density(right)) << h;
    }
  }
}

// Scales whose ends towards the tip (+x) stand off mirror light that comes from beside the strand
// towards the root.
TEST(Hair, TiltedScalesMirrorTowardsTheRoot) {
  HairParams params;
  params.absorption = Rgb(50.0F);  // nothing but what is mirrored
  params.roughness.value = 0.1F;
  params.tilt = 5.0F;
  const BsdfUnderTest bsdf(make_hair(params));
  const auto density = [&](float degrees) {
    const float angle = degrees * kPi / 180.0F;
    return bsdf
        ->evaluate({0.0F, 0.0F, 1.0F}, {std::sin(angle), 0.0F, std::cos(angle)},
                   TransportMode::radiance)
        .x;
  };
  EXPECT_GT(density(-10.0F), 1.5F * density(-16.0F));
  EXPECT_GT(density(-10.0F), 1.5F * density(-4.0F));
  EXPECT_GT(density(-10.0F), 3.0F * density(10.0F));
}

// Half of a strand's width sees as much as the other: averaged over where a ray meets it, the model
// is the same both ways around the strand, but for what the scales turn.
TEST(Hair, IsReciprocalAcrossItsWidth) {
  HairParams params;
  params.absorption = {0.1F, 0.4F, 1.0F};
  params.tilt = 0.0F;
  const auto mean = [&](double from, double to) {
    // Turned so that the ray from `from` meets the strand at h: the normal is +z.
    const BsdfUnderTest bsdf(make_hair(params));
    double sum = 0.0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
      const double h = (i + 0.5) * 2.0 / kSteps - 1.0;
      const double angle = std::asin(h);
      const double other = angle + to - from;
      sum += static_cast<double>(
          bsdf->evaluate(
                  {0.0F, static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle))},
                  {0.0F, static_cast<float>(std::sin(other)), static_cast<float>(std::cos(other))},
                  TransportMode::radiance)
              .y);
    }
    return sum / kSteps;
  };
  for (const double to : {0.3, 1.2, 2.5, 3.1}) EXPECT_NEAR(mean(0.0, to), mean(to, 0.0), 1e-3);
}

// Chiang et al. 2016: the absorption that makes much hair brown, and that of its pigments, are
// known numbers.
TEST(Hair, ColorsBecomeAbsorption) {
  const Rgb of_color = hair_absorption(Rgb(0.5F), 0.3F);
  EXPECT_NEAR(of_color.x, std::pow(std::log(0.5) / 5.8884, 2.0), 1e-4);
  EXPECT_EQ(hair_absorption(Rgb(1.0F), 0.3F), Rgb(0.0F));
  const Rgb brown = melanin_absorption(1.3F, 0.0F);
  EXPECT_NEAR(brown.z, 1.781F, 1e-5F);
}

}  // namespace
}  // namespace hyades::core
