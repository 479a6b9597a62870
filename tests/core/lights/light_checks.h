#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "core/base/frame.h"
#include "core/lights/light.h"
#include "tests/support/chi_squared.h"
#include "tests/support/moments.h"
#include "tests/support/random.h"

/// What tests of several lights share.
namespace hyades::test {

/// Directions within a cone around `axis`, spread over the whole sphere by an equal-area map (their
/// height 1 - cos is stretched), so that a grid of the sphere can look into a narrow cone.
struct ConeView {
  core::Frame frame;
  double one_minus_cos = 2.0;

  core::Vec3 spread(const core::Vec3& direction) const {
    const core::Vec3d s(frame.s);
    const core::Vec3d t(frame.t);
    const core::Vec3d n(frame.n);
    const core::Vec3d d(direction);
    const double x = glm::dot(d, s);
    const double y = glm::dot(d, t);
    const double sine2 = std::min((x * x + y * y) / glm::dot(d, d), 1.0);
    const double height = glm::dot(d, n) > 0.0 ? sine2 / (1.0 + std::sqrt(1.0 - sine2))
                                               : 1.0 + std::sqrt(1.0 - sine2);
    const double z = 1.0 - 2.0 * std::min(height / one_minus_cos, 1.0);
    const double r = std::sqrt((1.0 - z) * (1.0 + z));
    const double length = std::sqrt(x * x + y * y);
    const double scale = length > 0.0 ? r / length : 0.0;
    return {static_cast<float>(x * scale), static_cast<float>(y * scale), static_cast<float>(z)};
  }

  core::Vec3 gather(const core::Vec3& spread_out) const {
    const core::Vec3d e(glm::normalize(core::Vec3d(spread_out)));
    const double height = 0.5 * (1.0 - e.z) * one_minus_cos;
    const double sine = std::sqrt(height * (2.0 - height));
    const double length = std::sqrt(e.x * e.x + e.y * e.y);
    const double scale = length > 0.0 ? sine / length : 0.0;
    return core::Vec3(core::Vec3d(frame.s) * (e.x * scale) + core::Vec3d(frame.t) * (e.y * scale) +
                      core::Vec3d(frame.n) * (1.0 - height));
  }

  /// Density per solid angle of spread directions, from that of directions in the cone.
  double density(double pdf) const { return pdf * 0.5 * one_minus_cos; }
};

/// The chi-squared test of all directions, its integrals good to `tolerance`, one of `tests`.
inline SphereTest sphere_test(double tolerance, uint64_t seed, int tests = 1) {
  SphereTest test;
  test.tolerance = tolerance;
  test.seed = seed;
  test.promise.tests = tests;
  return test;
}

/// Estimates of the irradiance on a surface at `from` with normal `n`, by choosing places of
/// `light` (occlusion left out), luminance.
inline Moments irradiance(const core::Light& light, const core::Vec3& from, const core::Vec3& n,
                          int samples, float time = 0.0F, uint64_t seed = 7) {
  Moments moments;
  Random random(seed);
  for (int i = 0; i < samples; ++i) {
    const auto s = light.sample_direct(from, time, random.uniform(), random.uniform2());
    const float cosine = s ? std::max(glm::dot(s->direction, n), 0.0F) : 0.0F;
    moments.add(s ? static_cast<double>(core::luminance(s->radiance) * cosine / s->pdf) : 0.0);
  }
  return moments;
}

/// Checks what any sample of a light promises: unit direction, positive density, finite numbers.
inline void expect_sound(const core::LightSample& s) {
  EXPECT_NEAR(glm::dot(s.direction, s.direction), 1.0F, 1e-5F);
  EXPECT_GT(s.pdf, 0.0F);
  EXPECT_TRUE(std::isfinite(s.pdf));
  EXPECT_FALSE(core::is_black(s.radiance));
  EXPECT_TRUE(std::isfinite(core::luminance(s.radiance)));
  EXPECT_GT(s.distance, 0.0F);
}

}  // namespace hyades::test
