#include "core/geometry/read_mesh.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

#include "tests/support/shared_assets.h"

namespace hyades::core {
namespace {

TEST(ReadMesh, ReadsTheScans) {
  const std::string dragon = test::shared_file("assets/meshes/dragon_100k.ply");
  HYADES_SKIP_WITHOUT(dragon);
  const auto files = make_file_resolver("");
  auto mesh = read_mesh(*files, dragon);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ((*mesh)->triangles.size(), 100012U);
  EXPECT_EQ((*mesh)->positions.size(), 49692U);  // 47 of 49739 belong to no face
  mesh = read_mesh(*files, test::shared_file("assets/meshes/bunny_closed_75k.obj"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ((*mesh)->triangles.size(), 75408U);
  mesh = read_mesh(*files, test::shared_file("assets/meshes/teapot.obj"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ((*mesh)->triangles.size(), 6320U);
  mesh = read_mesh(*files, test::shared_file("assets/meshes/igea_tristrips.ply"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ((*mesh)->positions.size(), 134345U);
  EXPECT_EQ((*mesh)->triangles.size(), 268686U);
}

}  // namespace
}  // namespace hyades::core
