#include "core/geometry/closed_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/geometry/shape.h"

namespace hyades::core {
namespace {

TEST(ClosedMesh, BoxesAreClosed) {
  const auto box = make_box(Vec3(1.0F, 2.0F, 3.0F));
  ASSERT_GT(box->positions.size(), 8U) << "its faces share no vertices, only positions";
  const MeshClosure closure = examine_closure(*box);
  EXPECT_EQ(closure.open_edges, 0U);
  EXPECT_FALSE(closure.inside_out());
  EXPECT_NEAR(closure.volume, 6.0, 1e-6);
}

TEST(ClosedMesh, ARectangleHasFourOpenEdges) {
  EXPECT_EQ(examine_closure(*make_rectangle(Vec2(1.0F, 1.0F))).open_edges, 4U);
}

TEST(ClosedMesh, HolesAndTurnedTrianglesOpenTheirEdges) {
  auto holed = make_box(Vec3(1.0F));
  holed->triangles.pop_back();
  EXPECT_EQ(examine_closure(*holed).open_edges, 3U);
  auto turned = make_box(Vec3(1.0F));
  std::swap(turned->triangles[0][1], turned->triangles[0][2]);
  EXPECT_EQ(examine_closure(*turned).open_edges, 3U);
}

TEST(ClosedMesh, DegenerateTrianglesDoNotMatter) {
  auto box = make_box(Vec3(1.0F));
  box->triangles.push_back({0, 0, 1});
  box->triangles.push_back({2, 2, 2});
  EXPECT_EQ(examine_closure(*box).open_edges, 0U);
}

TEST(ClosedMesh, WithNormalsThatPointInwardsIsInsideOut) {
  auto box = make_box(Vec3(1.0F));
  for (Vec3& p : box->positions) p += Vec3(100.0F);  // wherever it is
  for (auto& triangle : box->triangles) std::swap(triangle[1], triangle[2]);
  finish_mesh(*box);
  const MeshClosure closure = examine_closure(*box);
  EXPECT_EQ(closure.open_edges, 0U);
  EXPECT_TRUE(closure.inside_out());
}

TEST(ClosedMesh, OfNoTrianglesIsNothing) {
  const MeshClosure closure = examine_closure(TriangleMesh());
  EXPECT_EQ(closure.open_edges, 0U);
  EXPECT_FALSE(closure.inside_out());
}

}  // namespace
}  // namespace hyades::core
