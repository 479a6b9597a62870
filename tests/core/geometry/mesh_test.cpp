#include "core/geometry/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/geometry/mesh_source.h"
#include "core/geometry/shape.h"
#include "tests/core/geometry/test_worlds.h"

namespace hyades::core {
namespace {

using Corners = std::array<uint32_t, 3>;

double signed_area(const std::vector<Vec3>& p, const Corners& t) {
  const Vec3d a(p[t[0]]);
  return 0.5 * glm::cross(Vec3d(p[t[1]]) - a, Vec3d(p[t[2]]) - a).z;
}

/// Twice the signed area inside an outline in the plane z = 0 (shoelace formula).
double outline_area(const std::vector<Vec3>& p) {
  double sum = 0.0;
  for (size_t i = 0; i < p.size(); ++i) {
    const Vec3d a(p[i]);
    const Vec3d b(p[(i + 1) % p.size()]);
    sum += a.x * b.y - a.y * b.x;
  }
  return 0.5 * sum;
}

/// A triangulation is right when it has n - 2 triangles, none turns the wrong way, and their areas
/// add up to the polygon's.
void expect_right_cut(const std::vector<Vec3>& outline) {
  std::vector<uint32_t> corners(outline.size());
  std::iota(corners.begin(), corners.end(), 0U);
  std::vector<Corners> triangles;
  triangulate(outline, corners, triangles);
  ASSERT_EQ(triangles.size(), outline.size() - 2);
  const double whole = outline_area(outline);
  double sum = 0.0;
  for (const Corners& t : triangles) {
    const double area = signed_area(outline, t);
    EXPECT_GE(area * (whole > 0.0 ? 1.0 : -1.0), -1e-7 * std::abs(whole));
    sum += area;
  }
  EXPECT_NEAR(sum, whole, 1e-5 * std::abs(whole));
}

TEST(Triangulate, ConvexAndConcaveQuads) {
  expect_right_cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  // The reflex corner at each place in turn.
  const std::vector<Vec3> dart{{0, 0, 0}, {2, -1, 0}, {0.5F, 0, 0}, {2, 1, 0}};
  for (size_t shift = 0; shift < 4; ++shift) {
    std::vector<Vec3> turned = dart;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(shift), turned.end());
    expect_right_cut(turned);
    std::reverse(turned.begin(), turned.end());
    expect_right_cut(turned);
  }
}

TEST(Triangulate, StarsAndCombs) {
  test::Random random(1);
  for (size_t n = 5; n <= 60; ++n) {
    std::vector<Vec3> star;
    for (size_t i = 0; i < n; ++i) {
      const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(n);
      const double r = static_cast<double>(random.uniform(0.2F, 1.0F));
      star.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.0);
    }
    expect_right_cut(star);
  }
  std::vector<Vec3> comb;
  for (int i = 0; i < 20; ++i) {
    comb.emplace_back(static_cast<float>(i), i % 2 == 0 ? 0.0F : 5.0F, 0.0F);
  }
  comb.emplace_back(19.0F, -1.0F, 0.0F);
  comb.emplace_back(0.0F, -1.0F, 0.0F);
  std::reverse(comb.begin(), comb.end());
  expect_right_cut(comb);
  // Corners on a straight line, and one visited twice.
  expect_right_cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}});
}

TEST(Triangulate, SelfCrossingAndFlatOutlinesEnd) {
  test::Random random(2);
  for (int i = 0; i < 300; ++i) {
    std::vector<Vec3> points;
    const size_t n = 5 + test::pick(random, 30);
    for (size_t k = 0; k < n; ++k) {
      points.push_back(i % 3 == 0 ? Vec3(1.0F) : test::in_box(random, Vec3(-1.0F), Vec3(1.0F)));
    }
    std::vector<uint32_t> corners(n);
    std::iota(corners.begin(), corners.end(), 0U);
    std::vector<Corners> triangles;
    triangulate(points, corners, triangles);
    EXPECT_EQ(triangles.size(), n - 2);
  }
}

TEST(Mesh, BoundsAndPadding) {
  TriangleMesh mesh;
  finish_mesh(mesh);
  EXPECT_TRUE(mesh.bounds.empty());
  const auto ball = test::make_ball(6);
  EXPECT_EQ(ball->bounds.lower, Vec3(-1.0F));
  EXPECT_EQ(ball->bounds.upper, Vec3(1.0F));
  EXPECT_GT(ball->positions.capacity(), ball->positions.size());
  EXPECT_EQ(ball->memory(), ball->positions.size() * 12 + ball->triangles.size() * 12);
}

TEST(Mesh, SmoothNormalsAreWeightedByAngle) {
  // A box with shared corners: each corner's normal is its diagonal, however its faces are cut.
  TriangleMesh box;
  for (int i = 0; i < 8; ++i) {
    box.positions.emplace_back(i & 1 ? 1.0F : -1.0F, i & 2 ? 1.0F : -1.0F, i & 4 ? 1.0F : -1.0F);
  }
  box.triangles = {
      {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}, {2, 6, 7},
      {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 0, 1}};  // without area: no say
  compute_smooth_normals(box);
  ASSERT_EQ(box.normals.size(), 8U);
  for (size_t i = 0; i < 8; ++i) {
    EXPECT_LT(glm::length(box.normals[i] - glm::normalize(box.positions[i])), 1e-6F);
  }
}

TEST(Shape, BoxAndRectangleFaceOutwards) {
  const auto box = make_box({2, 4, 6});
  EXPECT_EQ(box->bounds.lower, Vec3(-1, -2, -3));
  EXPECT_EQ(box->bounds.upper, Vec3(1, 2, 3));
  ASSERT_EQ(box->triangles.size(), 12U);
  for (const Corners& t : box->triangles) {
    const Vec3 a = box->positions[t[0]];
    const Vec3 b = box->positions[t[1]];
    const Vec3 c = box->positions[t[2]];
    EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a + b + c), 0.0F);
  }
  const auto rectangle = make_rectangle({2, 6});
  EXPECT_EQ(rectangle->bounds.lower, Vec3(-1, 0, -3));
  EXPECT_EQ(rectangle->bounds.upper, Vec3(1, 0, 3));
}

TEST(Shape, BoundsOfQuadrics) {
  Shape s;
  s.radius = 2.0F;
  s.height = 5.0F;
  s.kind = Shape::Kind::sphere;
  EXPECT_EQ(bounds_of(s).lower, Vec3(-2.0F));
  s.kind = Shape::Kind::disk;
  EXPECT_EQ(bounds_of(s).upper, Vec3(2, 0, 2));
  s.kind = Shape::Kind::cylinder;
  EXPECT_EQ(bounds_of(s).upper, Vec3(2, 5, 2));
  EXPECT_EQ(bounds_of(s).lower, Vec3(-2, 0, -2));
}

}  // namespace
}  // namespace hyades::core
