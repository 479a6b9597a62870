// What vertices carry besides their place: from files to points of surfaces, and back into files.
#include "core/geometry/mesh_attributes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/color.h"
#include "core/base/fp_mode.h"
#include "core/geometry/mesh_source.h"
#include "core/geometry/tessellate.h"
#include "core/geometry/write_ply.h"
#include "tests/core/geometry/test_worlds.h"

namespace hyades::core {
namespace {

using test::Random;

/// A ball whose vertices carry everything.
std::shared_ptr<TriangleMesh> full_ball() {
  auto mesh = test::make_ball(2);
  Random random(5);
  compute_smooth_normals(*mesh);
  for (size_t i = 0; i < mesh->positions.size(); ++i) {
    mesh->uvs.push_back(random.uniform2());
    mesh->second_uvs.push_back(3.0F * random.uniform2());
    mesh->colors.emplace_back(random.uniform2(), random.uniform2());
    mesh->vertex_tangents.emplace_back(random.direction(), i % 2 == 0 ? 1.0F : -1.0F);
  }
  return mesh;
}

std::shared_ptr<TriangleMesh> read(const Bytes& bytes) {
  auto mesh = read_ply({bytes.chars(), bytes.size()});
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? *mesh : nullptr;
}

std::shared_ptr<TriangleMesh> read(const std::string& text) {
  auto mesh = read_ply({text.data(), text.size()});
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? *mesh : nullptr;
}

std::string ascii(const std::string& properties, const std::array<std::string, 3>& rows) {
  return "ply\nformat ascii 1.0\nelement vertex 3\n"
         "property float x\nproperty float y\nproperty float z\n" +
         properties + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         "0 0 0 " + rows[0] + "\n1 0 0 " + rows[1] + "\n0 1 0 " + rows[2] + "\n3 0 1 2\n";
}

TEST(MeshAttributes, GoThroughFilesToTheLastBit) {
  const auto mesh = full_ball();
  const auto back = read(ply_bytes(*mesh));
  ASSERT_NE(back, nullptr);
  EXPECT_EQ(back->positions, mesh->positions);
  EXPECT_EQ(back->triangles, mesh->triangles);
  EXPECT_EQ(back->uvs, mesh->uvs);
  EXPECT_EQ(back->second_uvs, mesh->second_uvs);
  EXPECT_EQ(back->colors, mesh->colors);
  EXPECT_EQ(back->vertex_tangents, mesh->vertex_tangents);
  ASSERT_EQ(back->normals.size(), mesh->normals.size());
  for (size_t i = 0; i < mesh->normals.size(); ++i) {
    EXPECT_LT(glm::length(back->normals[i] - mesh->normals[i]), 1e-6F);
  }
}

TEST(MeshAttributes, FilesWithoutThemHaveNone) {
  TriangleMesh mesh = *test::make_ball(1);
  const auto back = read(ply_bytes(mesh));
  EXPECT_EQ(back->positions, mesh.positions);
  EXPECT_TRUE(back->normals.empty());
  EXPECT_TRUE(back->uvs.empty());
  EXPECT_TRUE(back->second_uvs.empty());
  EXPECT_TRUE(back->colors.empty());
  EXPECT_TRUE(back->vertex_tangents.empty());
}

TEST(MeshAttributes, CodesOfColoursAreSrgbAndFloatsAreLinear) {
  const auto codes = read(
      ascii("property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n",
            {"255 0 128 51", "0 0 0 255", "1 2 3 0"}));
  EXPECT_EQ(codes->colors[0].x, 1.0F);
  EXPECT_EQ(codes->colors[0].y, 0.0F);
  EXPECT_FLOAT_EQ(codes->colors[0].z, srgb_decode(128.0F / 255.0F));
  EXPECT_FLOAT_EQ(codes->colors[0].w, 0.2F);
  const auto floats = read(ascii("property float red\nproperty float green\nproperty float blue\n",
                                 {"0.5 2 0", "0 0 0", "1 1 1"}));
  EXPECT_EQ(floats->colors[0], Vec4(0.5F, 2.0F, 0.0F, 1.0F));
  const auto two = read(ascii("property uchar red\nproperty uchar green\n", {"1 2", "3 4", "5 6"}));
  EXPECT_TRUE(two->colors.empty());
}

TEST(MeshAttributes, BinaryCodesOfColoursAreTheSame) {
  std::string file =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nproperty ushort alpha\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 3; ++i) {
    const std::array<float, 3> p{i == 1 ? 1.0F : 0.0F, i == 2 ? 1.0F : 0.0F, 0.0F};
    file.append(reinterpret_cast<const char*>(p.data()), 12);
    file += static_cast<char>(200);
    file += static_cast<char>(10 * i);
    file += '\0';
    const uint16_t alpha = 13107;
    file.append(reinterpret_cast<const char*>(&alpha), 2);
  }
  file += '\3';
  const std::array<int32_t, 3> corners{0, 1, 2};
  file.append(reinterpret_cast<const char*>(corners.data()), 12);
  const auto mesh = read(file);
  EXPECT_FLOAT_EQ(mesh->colors[2].x, srgb_decode(200.0F / 255.0F));
  EXPECT_FLOAT_EQ(mesh->colors[2].y, srgb_decode(20.0F / 255.0F));
  EXPECT_EQ(mesh->colors[2].z, 0.0F);
  EXPECT_FLOAT_EQ(mesh->colors[2].w, 0.2F);
}

TEST(MeshAttributes, NumbersThatAreNoneAreRefused) {
  const auto text = ascii("property float red\nproperty float green\nproperty float blue\n",
                          {"nan 1 1", "1 1 1", "1 1 1"});
  const auto mesh = read_ply({text.data(), text.size()});
  ASSERT_FALSE(mesh);
  EXPECT_NE(mesh.error().message.find("the colour of vertex 0 is not finite"), std::string::npos);
}

TEST(MeshAttributes, VerticesWithoutFacesTakeTheirsAlong) {
  std::string text = ascii("property float u1\nproperty float v1\n", {"1 2", "3 4", "5 6"});
  text.replace(text.find("vertex 3"), 8, "vertex 4");
  text.replace(text.find("0 0 0 1 2"), 0, "9 9 9 7 7\n");
  text.replace(text.find("3 0 1 2"), 7, "3 1 2 3");
  const auto mesh = read(text);
  ASSERT_EQ(mesh->second_uvs.size(), 3U);
  EXPECT_EQ(mesh->second_uvs[0], Vec2(1.0F, 2.0F));
}

/// Points that rays find on `mesh`, placed by `to_world`.
std::vector<SurfacePoint> some_points(const std::shared_ptr<TriangleMesh>& mesh,
                                      const Mat4& to_world, std::shared_ptr<const World>& world) {
  world = test::build({test::place(mesh, {to_world})});
  Random random(9);
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 400; ++i) {
    Ray ray;
    ray.origin = 6.0F * random.direction();
    ray.direction = glm::normalize(0.5F * random.direction() - ray.origin);
    SurfacePoint p;
    if (world->nearest(ray, RayKind::diffuse, p)) points.push_back(p);
  }
  EXPECT_GT(points.size(), 100U);
  return points;
}

TEST(MeshAttributes, AreInterpolatedAtHits) {
  const FpMode mode;
  auto mesh = test::make_ball(3);
  for (const Vec3& p : mesh->positions) {
    mesh->colors.emplace_back(p, 2.0F * p.x);
    mesh->second_uvs.emplace_back(3.0F * p.y, p.z - p.x);
  }
  Mat4 m = test::scaling({1.0F, 2.0F, -0.5F});
  m[3] = Vec4(0.1F, 0.2F, 0.3F, 1.0F);
  std::shared_ptr<const World> world;
  for (const SurfacePoint& p : some_points(mesh, m, world)) {
    const Vec3 object = transform_point(p.world_to_object, p.position);
    const Vec4 color = *vertex_color(p);
    EXPECT_LT(glm::length(Vec3(color) - object), 1e-5F);
    EXPECT_NEAR(color.w, 2.0F * object.x, 1e-5F);
    EXPECT_NEAR(second_uv(p).x, 3.0F * object.y, 1e-5F);
    EXPECT_NEAR(second_uv(p).y, object.z - object.x, 1e-5F);
    // Along the triangle they change as they do over all of space.
    const auto& t = mesh->triangles[p.primitive];
    const auto gradient = second_uv_gradient(p);
    const auto by_place = vertex_color_gradient(p);
    for (const uint32_t corner : {t[1], t[2]}) {
      const Vec3 edge = mesh->positions[corner] - mesh->positions[t[0]];
      EXPECT_NEAR(glm::dot(gradient[0], edge), 3.0F * edge.y, 1e-4F);
      EXPECT_NEAR(glm::dot(gradient[1], edge), edge.z - edge.x, 1e-4F);
      const Vec4 change = by_place[0] * edge.x + by_place[1] * edge.y + by_place[2] * edge.z;
      EXPECT_LT(glm::length(change - Vec4(edge, 2.0F * edge.x)), 1e-4F);
    }
  }
}

TEST(MeshAttributes, WhatHasNoneSaysSo) {
  const FpMode mode;
  std::shared_ptr<const World> world;
  const auto points = some_points(test::make_ball(1), Mat4(1.0F), world);
  EXPECT_FALSE(vertex_color(points[0]));
  EXPECT_FALSE(file_tangent_mirrored(points[0]));
  EXPECT_EQ(second_uv(points[0]), Vec2(0.0F));
  EXPECT_FALSE(vertex_color(SurfacePoint()));
}

TEST(MeshAttributes, TangentsOfTheFileArriveInTheWorld) {
  const FpMode mode;
  auto mesh = test::make_ball(3);
  compute_smooth_normals(*mesh);
  for (size_t i = 0; i < mesh->positions.size(); ++i) {
    mesh->vertex_tangents.emplace_back(0.6F, 0.8F, 0.0F, -1.0F);
  }
  for (const float mirror : {1.0F, -1.0F}) {
    std::shared_ptr<const World> world;
    for (const SurfacePoint& p : some_points(mesh, test::scaling({2.0F, 1.0F, mirror}), world)) {
      EXPECT_LT(glm::length(p.tangent - Vec3(1.2F, 0.8F, 0.0F)), 1e-5F);
      EXPECT_EQ(file_tangent_mirrored(p), mirror > 0.0F);
    }
  }
}

TEST(MeshAttributes, SmallerTrianglesHaveWhatLiesBetween) {
  auto mesh = test::make_ball(0);
  for (const Vec3& p : mesh->positions) {
    mesh->colors.emplace_back(p, 1.0F);
    mesh->second_uvs.emplace_back(p.x, p.y);
  }
  std::vector<Vec3> along = smooth_normals(*mesh, {});
  ASSERT_TRUE(tessellate(*mesh, along, 0.2F, 100'000));
  ASSERT_EQ(mesh->colors.size(), mesh->positions.size());
  ASSERT_EQ(mesh->second_uvs.size(), mesh->positions.size());
  for (size_t i = 0; i < mesh->positions.size(); ++i) {
    EXPECT_LT(glm::length(Vec3(mesh->colors[i]) - mesh->positions[i]), 1e-6F);
    EXPECT_LT(glm::length(mesh->second_uvs[i] - Vec2(mesh->positions[i])), 1e-6F);
  }
}

}  // namespace
}  // namespace hyades::core
