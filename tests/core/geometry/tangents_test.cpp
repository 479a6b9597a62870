#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/mesh.h"

namespace hyades::core {
namespace {

/// A square of 2 x 2 cells; u is x, or its size where mirrored at the middle.
TriangleMesh sheet(bool mirrored) {
  TriangleMesh mesh;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const auto x = static_cast<float>(i) - 1.0F;
      const auto y = static_cast<float>(j);
      mesh.positions.push_back({x, y, 0.0F});
      mesh.normals.push_back({0.0F, 0.0F, 1.0F});
      mesh.uvs.push_back({mirrored ? std::abs(x) : x, y});
    }
  }
  for (uint32_t j = 0; j < 2; ++j) {
    for (uint32_t i = 0; i < 2; ++i) {
      const uint32_t a = 3 * j + i;
      mesh.triangles.push_back({a, a + 1, a + 4});
      mesh.triangles.push_back({a, a + 4, a + 3});
    }
  }
  finish_mesh(mesh);
  return mesh;
}

TEST(Tangents, FollowU) {
  TriangleMesh mesh = sheet(false);
  compute_tangents(mesh);
  ASSERT_EQ(mesh.tangents.size(), mesh.triangles.size());
  for (const auto& corners : mesh.tangents) {
    for (const Vec3& t : corners) EXPECT_LT(glm::distance(t, Vec3(1.0F, 0.0F, 0.0F)), 1e-6F);
  }
}

// Where uv are mirrored, as on faces made of one half, vertices in the middle have two tangents.
TEST(Tangents, MirroredUvAreNotAveraged) {
  TriangleMesh mesh = sheet(true);
  compute_tangents(mesh);
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    float middle = 0.0F;
    for (const uint32_t v : mesh.triangles[i]) middle += mesh.positions[v].x;
    const Vec3 along(middle < 0.0F ? -1.0F : 1.0F, 0.0F, 0.0F);
    for (const Vec3& t : mesh.tangents[i]) EXPECT_LT(glm::distance(t, along), 1e-6F);
  }
}

// Vertices that a file lists twice share a tangent all the same, weighed by angles.
TEST(Tangents, EqualVerticesShareThem) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 0, 0.5F}};
  mesh.normals.assign(6, Vec3(0.0F, 0.0F, 1.0F));
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {0, 0}, {0, 1}, {-1, 0.5F}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  finish_mesh(mesh);
  compute_tangents(mesh);
  EXPECT_EQ(mesh.tangents[0][0], mesh.tangents[1][0]);
  EXPECT_EQ(mesh.tangents[0][2], mesh.tangents[1][1]);
  EXPECT_NE(mesh.tangents[0][0], mesh.tangents[0][1]);
  for (const auto& corners : mesh.tangents) {
    for (const Vec3& t : corners) {
      EXPECT_NEAR(glm::length(t), 1.0F, 1e-6F);
      EXPECT_NEAR(t.z, 0.0F, 1e-6F);
    }
  }
}

TEST(Tangents, NoneWithoutNormalsOrUv) {
  TriangleMesh mesh = sheet(false);
  mesh.normals.clear();
  compute_tangents(mesh);
  EXPECT_TRUE(mesh.tangents.empty());
}

}  // namespace
}  // namespace hyades::core
