// Motion within the shutter: as few matrices as keep what is linear between them near the truth.

#include "core/scene/transforms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hyades::core {
namespace {

/// A turn by `degrees` around z, which stands at `pivot`.
ShutterMatrix turning(float degrees, const Vec3& pivot = Vec3(0.0F)) {
  return [=](float place) {
    const float angle = place * degrees * kPi / 180.0F;
    Mat4 m(1.0F);
    m[0] = Vec4(std::cos(angle), std::sin(angle), 0.0F, 0.0F);
    m[1] = Vec4(-std::sin(angle), std::cos(angle), 0.0F, 0.0F);
    Mat4 there(1.0F);
    there[3] = Vec4(pivot, 1.0F);
    return there * m;
  };
}

/// How far a point at distance 1 from the pivot is from its arc, at worst.
float worst(const ShutterMatrix& truth, const std::vector<Mat4>& matrices) {
  float worst = 0.0F;
  const size_t last = matrices.size() - 1;
  for (int i = 0; i <= 5000; ++i) {
    const float place = static_cast<float>(i) / 5000.0F * static_cast<float>(last);
    const size_t at = std::min(static_cast<size_t>(place), last - 1);
    const float w = place - static_cast<float>(at);
    const Mat4 between = matrices[at] * (1.0F - w) + matrices[at + 1] * w;
    const Vec4 point(1.0F, 0.0F, 0.0F, 1.0F);
    worst = std::max(worst,
                     glm::length(between * point - truth(static_cast<float>(i) / 5000.0F) * point));
  }
  return worst;
}

TEST(ShutterMatrices, RotationsStayNearTheirArcs) {
  for (const float degrees : {1.0F, 10.0F, 90.0F, 200.0F, -170.0F}) {
    const auto matrices = sampled_matrices(turning(degrees));
    EXPECT_LT(worst(turning(degrees), matrices), 1.5e-4F) << degrees;
    // Not more than a step of 0.8 degrees takes.
    EXPECT_LE(static_cast<float>(matrices.size() - 1), std::max(2.0F, std::abs(degrees) / 0.79F));
  }
}

TEST(ShutterMatrices, WholeTurnsAreNoRest) {
  EXPECT_EQ(sampled_matrices(turning(360.0F)).size(), 129U);
  EXPECT_LT(worst(turning(360.0F), sampled_matrices(turning(360.0F))), 3.1e-4F);
  EXPECT_LT(worst(turning(1080.0F), sampled_matrices(turning(1080.0F))), 9.0F * 3.1e-4F);
}

/// Also where the object stands so far away that its place is larger than its turn.
TEST(ShutterMatrices, TurnsFarFromTheOriginCountAsWell) {
  const auto near = sampled_matrices(turning(90.0F));
  const auto far = sampled_matrices(turning(90.0F, {5000.0F, 0.0F, -3000.0F}));
  EXPECT_EQ(near.size(), far.size());
}

TEST(ShutterMatrices, StraightWaysTakeTwoMatricesAndRestOne) {
  const auto straight = sampled_matrices([](float place) {
    Mat4 m(1.0F);
    m[3] = Vec4(3.0F * place, 1.0F - place, 100.0F, 1.0F);
    return m;
  });
  EXPECT_EQ(straight.size(), 2U);
  EXPECT_EQ(sampled_matrices(turning(0.0F)).size(), 1U);
}

}  // namespace
}  // namespace hyades::core
