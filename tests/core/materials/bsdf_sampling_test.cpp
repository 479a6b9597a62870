#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/chi_squared.h"
#include "tests/support/random.h"
#include "tests/support/test_quarter.h"

// T1 and T2: samples follow pdf() and carry f cos / pdf.

namespace hyades::core {
namespace {

class BsdfCases : public ::testing::TestWithParam<BsdfCase> {};

// Detects a density that is 1 % too high on half of the samples' domain and as much too low on the
// other with probability 0.99, at a joint significance of 0.01 over all cases and directions.
TEST_P(BsdfCases, DirectionsFollowThePdf) {
  if (!test::in_quarter(smooth_cases(), GetParam().name)) GTEST_SKIP() << test::kOtherQuarter;
  const auto directions = five_directions();
  const BsdfUnderTest bsdf(GetParam().material);
  test::SphereTest settings;
  settings.grid = {6, 8};
  settings.tolerance = 3e-5;
  settings.promise.tests = static_cast<int>(smooth_cases().size() * directions.size());
  for (const NamedDirection& d : directions) {
    ++settings.seed;
    EXPECT_TRUE(test::directions_follow(
        [&](test::Random& random) -> std::optional<Vec3> {
          const float lobe = random.uniform();
          const auto s = bsdf->sample(d.wo, lobe, random.uniform2(), TransportMode::radiance);
          // Delta lobes are not part of the density: their share of samples lacks in it.
          return s && !s->delta ? std::optional(s->wi) : std::nullopt;
        },
        [&](const Vec3& wi) { return bsdf->pdf(d.wo, wi, TransportMode::radiance); }, settings))
        << d.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Smooth, BsdfCases, ::testing::ValuesIn(smooth_cases()),
                         [](const auto& tested) { return tested.param.name; });

// Exact up to rounding, on every sample: an error of 1e-4 in any of them fails.
TEST(BsdfSampling, WeightIsValueOverPdf) {
  test::Random random(11);
  for (const BsdfCase& c : smooth_cases()) {
    const BsdfUnderTest bsdf(c.material);
    int smooth_samples = 0;
    for (const NamedDirection& d : five_directions()) {
      for (const TransportMode mode : kBothModes) {
        for (int n = 0; n < 2000; ++n) {
          const float lobe = random.uniform();
          const auto s = bsdf->sample(d.wo, lobe, random.uniform2(), mode);
          if (!s) continue;
          ASSERT_NEAR(glm::length(s->wi), 1.0F, 1e-5F) << c.name;
          ASSERT_EQ(s->transmitted, s->wi.z * d.wo.z < 0.0F) << c.name;
          ASSERT_GT(s->pdf, 0.0F) << c.name;
          if (s->delta) continue;
          ++smooth_samples;
          ASSERT_NEAR(bsdf->pdf(d.wo, s->wi, mode) / s->pdf, 1.0F, 1e-4F)
              << c.name << ", " << d.name;
          const Rgb value = bsdf->evaluate(d.wo, s->wi, mode);
          for (int k = 0; k < 3; ++k) {
            ASSERT_NEAR(s->weight[k] * s->pdf, value[k], 1e-4F * value[k])
                << c.name << ", " << d.name << ", wi " << s->wi.x << " " << s->wi.y << " "
                << s->wi.z;
          }
        }
      }
    }
    EXPECT_GT(smooth_samples, 2000) << c.name;
    EXPECT_TRUE(bsdf->has_smooth()) << c.name;
  }
}

TEST(BsdfSampling, ExtremeRandomNumbersAndDirectionsGiveFiniteSamples) {
  const float extremes[] = {0.0F, 0x1p-24F, 0.5F, 1.0F - 0x1p-24F};
  const float heights[] = {1.0F, 0.5F, 1e-3F, 1e-6F, 1e-20F, 0.0F, -1e-20F, -1e-6F, -0.5F, -1.0F};
  auto cases = smooth_cases();
  cases.push_back({"glass", make_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F))});
  cases.push_back({"bubble", make_dielectric(0.6F, Rgb(1.0F), Rgb(1.0F))});
  cases.push_back({"sheet", make_thin_dielectric(1.5F, Rgb(1.0F), Rgb(1.0F))});
  cases.push_back(
      {"nearly smooth metal", make_conductor(Rgb(0.2F), Rgb(3.0F), number(0.0101F), Rgb(1.0F))});
  for (const BsdfCase& c : cases) {
    const BsdfUnderTest bsdf(c.material);
    for (const float z : heights) {
      const Vec3 wo(std::sqrt(1.0F - z * z), 0.0F, z);
      for (const float lobe : extremes) {
        for (const float u : extremes) {
          for (const float v : extremes) {
            for (const TransportMode mode : kBothModes) {
              const auto s = bsdf->sample(wo, lobe, {u, v}, mode);
              if (!s) continue;
              ASSERT_TRUE(std::isfinite(s->pdf) && s->pdf > 0.0F) << c.name << " " << z;
              for (int k = 0; k < 3; ++k) {
                ASSERT_TRUE(std::isfinite(s->weight[k]) && s->weight[k] >= 0.0F)
                    << c.name << " " << z;
                ASSERT_TRUE(std::isfinite(s->wi[k])) << c.name << " " << z;
              }
              const Rgb value = bsdf->evaluate(wo, s->wi, mode);
              ASSERT_TRUE(std::isfinite(value.x + value.y + value.z)) << c.name << " " << z;
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace hyades::core
