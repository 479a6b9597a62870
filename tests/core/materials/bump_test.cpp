#include <gtest/gtest.h>

#include <cmath>

#include "core/materials/shaded_surface.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

Vec3 bumped_normal(const SurfacePoint& point, const TexturePtr& height, float scale = 1.0F,
                   float strength = 1.0F) {
  const MaterialPtr material =
      make_bump(make_lambert(color_of(Rgb(0.5F))), height, scale, number(strength));
  BsdfArena arena;
  return ShadedSurface(point, *material, arena).frame().n;
}

/// A point of the sphere of `radius` around the origin, with tangents of longitude and latitude.
SurfacePoint on_sphere(const Vec3& n, float radius) {
  SurfacePoint p;
  p.position = radius * n;
  p.ng = p.ns = n;
  const float r = std::sqrt(n.x * n.x + n.z * n.z);
  p.dpdu = 2.0F * kPi * radius * Vec3(n.z, 0.0F, -n.x);
  p.dpdv = kPi * radius * Vec3(-n.y * n.x / r, r, -n.y * n.z / r);
  return p;
}

/// A wavy height over space with its gradient.
ScalarGradient wave(const Vec3& p) {
  ScalarGradient g;
  g.value = 0.3F * p.x * p.y + 0.2F * p.z * p.z - 0.4F * p.x;
  g.d_object = {0.3F * p.y - 0.4F, 0.3F * p.x, 0.4F * p.z};
  return g;
}

TEST(Bump, NormalLeansAwayFromRisingHeight) {
  const Vec3 n = bumped_normal(SurfacePoint(), object_slope({0.5F, 0.0F, 0.0F}));
  const Vec3 expected = glm::normalize(Vec3(-0.5F, 0.0F, 1.0F));
  EXPECT_LT(glm::distance(n, expected), 1e-6F);
}

TEST(Bump, StrengthMixesTheNormals) {
  const TexturePtr steep = object_slope({2.0F, 0.0F, 0.0F});
  const Vec3 whole = glm::normalize(Vec3(-2.0F, 0.0F, 1.0F));
  for (const float strength : {0.0F, 0.25F, 0.5F, 1.0F, 1.5F}) {
    const Vec3 expected = glm::normalize(strength * whole + (1.0F - strength) * Vec3(0, 0, 1));
    const Vec3 n = bumped_normal(SurfacePoint(), steep, 1.0F, strength);
    EXPECT_LT(glm::distance(n, expected), 1e-6F) << strength;
  }
}

// Exact: with tangents dp + dh n the normal is n - grad h, grad h taken along the surface.
TEST(Bump, IsTheSurfaceGradientOnASphere) {
  test::Random random(81);
  const TexturePtr height =
      function_texture([](const TexturePoint& at) { return wave(at.object); });
  for (int i = 0; i < 1000; ++i) {
    const Vec3 n = random.direction();
    if (std::abs(n.y) > 0.99F) continue;
    const SurfacePoint p = on_sphere(n, 2.0F);
    const Vec3 gradient = wave(p.position).d_object;
    const Vec3 expected = glm::normalize(n - 0.5F * (gradient - glm::dot(gradient, n) * n));
    ASSERT_LT(glm::distance(bumped_normal(p, height, 0.5F), expected), 2e-5F);
  }
}

// The true normal of the displaced sphere, by differences in double, up to the terms in h / radius
// that bump mapping drops.
TEST(Bump, ApproachesTheDisplacedSurface) {
  test::Random random(82);
  constexpr float kScale = 1e-3F;
  const TexturePtr height =
      function_texture([](const TexturePoint& at) { return wave(at.object); });
  const auto displaced = [](const Vec3d& n) {
    const Vec3d p = 2.0 * n;
    return p + n * (kScale * (0.3 * p.x * p.y + 0.2 * p.z * p.z - 0.4 * p.x));
  };
  double greatest = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 n = random.direction();
    if (std::abs(n.y) > 0.99F) continue;
    const Frame frame = Frame::around(n);
    const Vec3d nd(n);
    constexpr double kStep = 1e-5;
    const auto tangent = [&](const Vec3& t) {
      return displaced(glm::normalize(nd + kStep * Vec3d(t))) -
             displaced(glm::normalize(nd - kStep * Vec3d(t)));
    };
    const Vec3d exact = glm::normalize(glm::cross(tangent(frame.s), tangent(frame.t)));
    const Vec3 found = bumped_normal(on_sphere(n, 2.0F), height, kScale);
    ASSERT_LT(glm::distance(Vec3d(found), exact), 1e-5);
    greatest = std::fmax(greatest, glm::distance(exact, nd));
  }
  EXPECT_GT(greatest, 5e-4);  // the bump itself is far larger than the error allowed
}

TEST(Bump, UvGradientsCountPerUnitOfSurface) {
  SurfacePoint p;
  p.dpdu = {4.0F, 0.0F, 0.0F};
  p.dpdv = {0.0F, 0.5F, 0.0F};
  const TexturePtr height = function_texture([](const TexturePoint&) {
    ScalarGradient g;
    g.d_uv = {1.0F, 0.25F};
    return g;
  });
  const Vec3 expected = glm::normalize(Vec3(-0.25F, -0.5F, 1.0F));
  EXPECT_LT(glm::distance(bumped_normal(p, height), expected), 1e-6F);
}

TEST(Bump, ObjectAndWorldGradientsMeetInWorldSpace) {
  SurfacePoint p;
  p.world_to_object = Mat4(2.0F);  // the object was halved: its texture is twice as steep
  p.world_to_object[3][3] = 1.0F;
  EXPECT_LT(glm::distance(bumped_normal(p, object_slope({0.5F, 0.0F, 0.0F})),
                          glm::normalize(Vec3(-1.0F, 0.0F, 1.0F))),
            1e-6F);
  const TexturePtr world = function_texture([](const TexturePoint&) {
    ScalarGradient g;
    g.d_world = {0.0F, 0.5F, 0.0F};
    return g;
  });
  EXPECT_LT(glm::distance(bumped_normal(p, world), glm::normalize(Vec3(0.0F, -0.5F, 1.0F))), 1e-6F);
}

TEST(Bump, HandednessOfTheTangentsDoesNotMatter) {
  SurfacePoint p;
  std::swap(p.dpdu, p.dpdv);
  EXPECT_LT(glm::distance(bumped_normal(p, object_slope({0.5F, 0.2F, 0.0F})),
                          glm::normalize(Vec3(-0.5F, -0.2F, 1.0F))),
            1e-6F);
  // An outer side that faces down.
  p.ng = p.ns = {0.0F, 0.0F, -1.0F};
  EXPECT_LT(glm::distance(bumped_normal(p, object_slope({0.5F, 0.2F, 0.0F})),
                          glm::normalize(Vec3(-0.5F, -0.2F, -1.0F))),
            1e-6F);
}

TEST(Bump, NormalStaysAboveTheGeometricHorizon) {
  SurfacePoint p;
  p.ns = glm::normalize(Vec3(1.0F, 0.0F, 0.2F));
  p.dpdu = glm::cross(Vec3(0.0F, 1.0F, 0.0F), p.ns);
  for (const float slope : {-50.0F, -1.0F, 0.0F, 1.0F, 50.0F, 1e6F}) {
    const Vec3 n = bumped_normal(p, object_slope({slope, 0.3F * slope, slope}));
    EXPECT_GT(glm::dot(n, p.ng), 0.009F) << slope;
    EXPECT_NEAR(glm::length(n), 1.0F, 1e-5F) << slope;
  }
}

TEST(Bump, WithoutHeightOrTangentsNothingTurns) {
  SurfacePoint p;
  EXPECT_EQ(bumped_normal(p, object_slope(Vec3(0.0F))), p.ns);
  EXPECT_EQ(bumped_normal(p, object_slope({1.0F, 0.0F, 0.0F}), 0.0F), p.ns);
  p.dpdu = Vec3(0.0F);
  EXPECT_EQ(bumped_normal(p, object_slope({1.0F, 0.0F, 0.0F})), p.ns);
}

}  // namespace
}  // namespace hyades::core
