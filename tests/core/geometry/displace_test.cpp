#include "core/geometry/displace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "core/base/elementary.h"
#include "core/geometry/closed_mesh.h"
#include "core/geometry/shape.h"
#include "core/geometry/tessellate.h"

namespace hyades::core {
namespace {

constexpr size_t kPlenty = 10'000'000;

double squared(const Vec3& a, const Vec3& b) {
  const Vec3d d = Vec3d(a) - Vec3d(b);
  return glm::dot(d, d);
}

double longest_edge(const TriangleMesh& mesh) {
  double longest = 0.0;
  for (const auto& t : mesh.triangles) {
    for (size_t k = 0; k < 3; ++k)
      longest = std::max(longest, squared(mesh.positions[t[k]], mesh.positions[t[(k + 1) % 3]]));
  }
  return std::sqrt(longest);
}

double area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3d a(mesh.positions[t[0]]);
    const Vec3d n = glm::cross(Vec3d(mesh.positions[t[1]]) - a, Vec3d(mesh.positions[t[2]]) - a);
    sum += 0.5 * std::sqrt(glm::dot(n, n));
  }
  return sum;
}

/// A unit sphere of quads with a seam at u = 0 and one vertex per quad at the poles, with normals.
TriangleMesh uv_sphere(int across, int down) {
  TriangleMesh mesh;
  mesh.name = "sphere";
  for (int j = 0; j <= down; ++j) {
    for (int i = 0; i <= across; ++i) {
      const Vec2 uv(static_cast<float>(i) / static_cast<float>(across),
                    static_cast<float>(j) / static_cast<float>(down));
      const SinCos around =
          sin_cos(2.0F * kPi * static_cast<float>(i % across) / static_cast<float>(across));
      SinCos high = sin_cos(kPi * uv.y);
      if (j == 0 || j == down) high = {0.0F, j == 0 ? 1.0F : -1.0F};
      mesh.positions.emplace_back(high.sin * around.cos, high.cos, high.sin * around.sin);
      mesh.uvs.push_back(uv);
    }
  }
  mesh.normals = mesh.positions;
  const auto at = [&](int i, int j) { return static_cast<uint32_t>(j * (across + 1) + i); };
  for (int j = 0; j < down; ++j) {
    for (int i = 0; i < across; ++i) {
      if (j > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (j + 1 < down) mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  finish_mesh(mesh);
  return mesh;
}

/// How many different normals there are at `place`.
size_t normals_at(const TriangleMesh& mesh, const Vec3& place) {
  std::map<std::tuple<float, float, float>, int> found;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3& n = mesh.normals[i];
    if (squared(mesh.positions[i], place) < 1e-12) ++found[{n.x, n.y, n.z}];
  }
  return found.size();
}

TEST(Tessellate, HalvesUntilNoEdgeIsTooLong) {
  TriangleMesh mesh = *make_box(Vec3(1.0F, 2.0F, 0.3F));
  const double before = area(mesh);
  const double told = estimate_tessellation(mesh, 0.05F);
  std::vector<Vec3> along(mesh.positions.size(), Vec3(0.0F, 1.0F, 0.0F));
  ASSERT_TRUE(tessellate(mesh, along, 0.05F, kPlenty));
  EXPECT_LE(longest_edge(mesh), 0.05);
  EXPECT_GT(longest_edge(mesh), 0.025);
  EXPECT_NEAR(area(mesh), before, 1e-5);
  EXPECT_EQ(along.size(), mesh.positions.size());
  EXPECT_EQ(mesh.uvs.size(), mesh.positions.size());
  EXPECT_EQ(examine_closure(mesh).open_edges, 0U) << "neighbours must agree on what is halved";
  EXPECT_NEAR(told / static_cast<double>(mesh.triangles.size()), 1.0, 0.5);
}

TEST(Tessellate, NeighboursOfAllSizesAgree) {
  // Triangles of one, two and three edges that are too long, side by side.
  TriangleMesh mesh = uv_sphere(40, 6);
  for (const float edge : {0.5F, 0.3F, 0.2F, 0.1F, 0.03F}) {
    TriangleMesh fine = mesh;
    std::vector<Vec3> along = fine.normals;
    const double told = estimate_tessellation(mesh, edge);
    ASSERT_TRUE(tessellate(fine, along, edge, kPlenty));
    EXPECT_LE(longest_edge(fine), edge);
    EXPECT_EQ(examine_closure(fine).open_edges, 0U) << edge;
    EXPECT_NEAR(told / static_cast<double>(fine.triangles.size()), 1.0, 0.5) << edge;
  }
}

TEST(Tessellate, RefusesMoreThanItsBudgetBeforeItMakesThem) {
  TriangleMesh mesh = *make_rectangle(Vec2(1.0F));
  std::vector<Vec3> along(mesh.positions.size(), Vec3(0.0F, 1.0F, 0.0F));
  const Status refused = tessellate(mesh, along, 1e-9F, 1'000'000);
  ASSERT_FALSE(refused);
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_NE(refused.error().message.find("triangles, more than its budget of 1000000"),
            std::string::npos)
      << refused.error().message;
}

TEST(Tessellate, EndsWhereNumbersAreTooCoarse) {
  TriangleMesh mesh = *make_rectangle(Vec2(1.0F));
  for (Vec3& p : mesh.positions) p.x += 4e6F;  // floats there are 0.5 apart
  std::vector<Vec3> along(mesh.positions.size(), Vec3(0.0F, 1.0F, 0.0F));
  (void)tessellate(mesh, along, 0.1F, 100'000);
  EXPECT_LE(mesh.triangles.size(), 100'000U);
}

/// With and without normals of its own.
class DisplacedPlane : public testing::TestWithParam<bool> {};

TEST_P(DisplacedPlane, OnASlopeIsTheTiltedPlane) {
  TriangleMesh plane = *make_rectangle(Vec2(2.0F));
  if (GetParam()) plane.normals.assign(plane.positions.size(), Vec3(0.0F, 1.0F, 0.0F));
  const auto made = displace(plane, {.max_edge = 0.1F, .budget = kPlenty},
                             [](const Vec2&, const Vec3& p) { return 0.5F * p.x - 0.25F * p.z; });
  ASSERT_TRUE(made) << made.error().message;
  const TriangleMesh& mesh = **made;
  EXPECT_GT(mesh.triangles.size(), 800U);
  const Vec3 normal = glm::normalize(Vec3(-0.5F, 1.0F, 0.25F));
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3& p = mesh.positions[i];
    EXPECT_NEAR(p.y, 0.5F * p.x - 0.25F * p.z, 1e-6F);
    EXPECT_NEAR(glm::dot(mesh.normals[i], normal), 1.0F, 1e-5F);
    EXPECT_NEAR(p.x, 2.0F * mesh.uvs[i].x - 1.0F, 1e-6F) << "uvs stay";
  }
  EXPECT_NEAR(mesh.bounds.upper.y, 0.75F, 1e-6F);
}

INSTANTIATE_TEST_SUITE_P(Normals, DisplacedPlane, testing::Bool());

TEST(Displace, ASphereStaysClosedAcrossSeamsOfUv) {
  const TriangleMesh sphere = uv_sphere(24, 12);
  ASSERT_EQ(examine_closure(sphere).open_edges, 0U);
  // Not the same at u = 0 and 1.
  const auto ripple = [](const Vec2& uv, const Vec3&) {
    return 0.1F * sin_cos(11.0F * uv.x + 5.0F * uv.y).sin;
  };
  for (const auto normals :
       {DisplacedNormals::creased, DisplacedNormals::smooth, DisplacedNormals::flat}) {
    const auto made =
        displace(sphere, {.max_edge = 0.05F, .budget = kPlenty, .normals = normals}, ripple);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(examine_closure(**made).open_edges, 0U);
    EXPECT_GT(examine_closure(**made).volume * examine_closure(sphere).volume, 0.0);
    EXPECT_EQ((*made)->normals.empty(), normals == DisplacedNormals::flat);
    EXPECT_GT((*made)->bounds.upper.y, 1.02F);
    if (normals == DisplacedNormals::flat) continue;
    EXPECT_EQ(normals_at(**made, (*made)->positions[0]), 1U) << "no seam is seen at the pole";
  }
}

TEST(Displace, EdgesOfABoxMoveTogetherAndStaySharpUnlessSmoothed) {
  TriangleMesh box = *make_box(Vec3(2.0F));
  if (box.normals.empty()) {
    for (size_t i = 0; i < box.positions.size(); ++i) box.normals.emplace_back(0.0F);
    for (const auto& t : box.triangles) {
      const Vec3 n = glm::normalize(glm::cross(box.positions[t[1]] - box.positions[t[0]],
                                               box.positions[t[2]] - box.positions[t[0]]));
      for (const uint32_t v : t) box.normals[v] = n;
    }
  }
  const auto grow = [](const Vec2&, const Vec3&) { return 0.5F; };
  const Vec3 corner(1.0F + 0.5F / std::sqrt(3.0F));
  const auto sharp = displace(box, {.max_edge = 0.2F, .budget = kPlenty}, grow);
  ASSERT_TRUE(sharp);
  EXPECT_EQ(examine_closure(**sharp).open_edges, 0U);
  EXPECT_EQ(normals_at(**sharp, corner), 3U);
  const auto smooth = displace(
      box, {.max_edge = 0.2F, .budget = kPlenty, .normals = DisplacedNormals::smooth}, grow);
  ASSERT_TRUE(smooth);
  EXPECT_EQ(normals_at(**smooth, corner), 1U);
}

TEST(Displace, GivesTheSameBitsAgain) {
  const TriangleMesh sphere = uv_sphere(24, 12);
  const auto bumps = [](const Vec2& uv, const Vec3& p) {
    return 0.05F * sin_cos(20.0F * uv.x).sin * sin_cos(15.0F * p.y).cos;
  };
  const Displacement how{.max_edge = 0.02F, .budget = kPlenty};
  const auto a = displace(sphere, how, bumps);
  const auto b = displace(sphere, how, bumps);
  ASSERT_TRUE(a && b);
  EXPECT_GT((*a)->positions.size(), size_t{1} << 15U) << "so that several threads work on it";
  EXPECT_EQ((*a)->positions, (*b)->positions);
  EXPECT_EQ((*a)->normals, (*b)->normals);
  EXPECT_EQ((*a)->uvs, (*b)->uvs);
  EXPECT_EQ((*a)->triangles, (*b)->triangles);
}

TEST(Displace, RefusesHeightsThatAreNoNumbers) {
  const auto made =
      displace(*make_rectangle(Vec2(1.0F)), {.max_edge = 1.0F, .budget = kPlenty},
               [](const Vec2&, const Vec3&) { return std::numeric_limits<float>::infinity(); });
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("is inf, expected a number"), std::string::npos)
      << made.error().message;
}

}  // namespace
}  // namespace hyades::core
