#include <gtest/gtest.h>

#include <cmath>

#include "core/materials/shaded_surface.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/random.h"

namespace hyades::core {
namespace {

Vec3 normal_of(const MaterialPtr& material, const SurfacePoint& point) {
  BsdfArena arena;
  return ShadedSurface(point, *material, arena).frame().n;
}

/// The normal where a map holds `n` (tangent space).
Vec3 mapped(const Vec3& n, const SurfacePoint& point, float strength = 1.0F) {
  const MaterialPtr grey = make_lambert(color_of(Rgb(0.5F)));
  return normal_of(
      make_normal_map(grey, make_constant_texture(0.5F * n + Vec3(0.5F)), number(strength)), point);
}

SurfacePoint upright() {
  SurfacePoint p;
  p.ng = p.ns = {0.0F, 1.0F, 0.0F};
  p.dpdu = {2.0F, 0.0F, 0.0F};
  p.dpdv = {0.0F, 0.0F, -3.0F};
  return p;
}

TEST(NormalMap, BlueIsTheNormalItself) {
  EXPECT_LT(glm::distance(mapped({0.0F, 0.0F, 1.0F}, upright()), Vec3(0.0F, 1.0F, 0.0F)), 1e-6F);
}

TEST(NormalMap, RedIsAlongUAndGreenAlongV) {
  const Vec3 n = glm::normalize(Vec3(0.3F, -0.4F, 0.8F));
  EXPECT_LT(glm::distance(mapped(n, upright()), Vec3(n.x, n.z, -n.y)), 1e-6F);
}

TEST(NormalMap, GreenFollowsVWhereUvAreMirrored) {
  SurfacePoint p = upright();
  p.dpdv = -p.dpdv;
  const Vec3 n = glm::normalize(Vec3(0.3F, -0.4F, 0.8F));
  EXPECT_LT(glm::distance(mapped(n, p), Vec3(n.x, n.z, n.y)), 1e-6F);
}

TEST(NormalMap, StrengthFlattensOrSteepens) {
  const Vec3 n = glm::normalize(Vec3(0.6F, 0.0F, 0.8F));
  const Vec3 steep = glm::normalize(Vec3(1.2F, 0.8F, 0.0F));
  EXPECT_LT(glm::distance(mapped(n, upright(), 2.0F), steep), 1e-6F);
  EXPECT_LT(glm::distance(mapped(n, upright(), 0.0F), Vec3(0.0F, 1.0F, 0.0F)), 1e-6F);
}

TEST(NormalMap, NeverTurnsBelowTheHorizon) {
  const Vec3 n = mapped(glm::normalize(Vec3(0.9F, 0.1F, -0.4F)), upright());
  EXPECT_GT(n.y, 0.0F);
}

// A map of the normals of a height is the bump of that height.
TEST(NormalMap, AgreesWithBumps) {
  const MaterialPtr grey = make_lambert(color_of(Rgb(0.5F)));
  test::Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3 slope(random.uniform() - 0.5F, 0.0F, random.uniform() - 0.5F);
    SurfacePoint p = upright();
    if (i % 2 == 1) p.dpdv = -p.dpdv;
    const Vec3 bumped = normal_of(make_bump(grey, object_slope(slope), 1.0F), p);
    // Slopes along the unit tangents.
    const float du = glm::dot(slope, glm::normalize(p.dpdu));
    const float dv = glm::dot(slope, glm::normalize(p.dpdv));
    const Vec3 n = glm::normalize(Vec3(-du, -dv, 1.0F));
    ASSERT_LT(glm::distance(mapped(n, p), bumped), 1e-5F);
  }
}

// Smooth tangents come before those of the triangle.
TEST(NormalMap, TakesTheTangentOfTheMesh) {
  SurfacePoint p = upright();
  p.tangent = {0.0F, 0.0F, -5.0F};
  p.dpdv = {-1.0F, 0.0F, 0.0F};
  p.dpdu = {0.5F, 0.0F, -1.0F};
  const Vec3 n = glm::normalize(Vec3(0.3F, 0.0F, 0.8F));
  EXPECT_LT(glm::distance(mapped(n, p), Vec3(0.0F, n.z, -n.x)), 1e-6F);
}

}  // namespace
}  // namespace hyades::core
