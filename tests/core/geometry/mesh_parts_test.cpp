#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/read_mesh.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

using testing::ElementsAre;

constexpr const char* kTwo =
    "mtllib glass and milk.mtl\n"
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 5\nv 1 0 5\nv 0 1 5\nv 9 9 9\n"
    "f 1 2 3\n"
    "usemtl milk \n"
    "f 4 5 6\n"
    "\tusemtl  old glass\r\n"
    "f 1/1 2/2 3/3\nvt 0 0\nvt 1 0\nvt 0 1\n"
    "usemtl milk\n"
    "f 1 2 6 4\n"
    "usemtl nothing\n";

MeshParts parts_of(const std::string& text) {
  MemoryAssets assets;
  assets.add("two.obj", text);
  auto parts = read_mesh_parts(assets, "two.obj");
  EXPECT_TRUE(parts) << (parts ? "" : parts.error().message);
  return parts ? *parts : MeshParts{};
}

TEST(MeshParts, AreTheFacesOfEachMaterial) {
  const MeshParts found = parts_of(kTwo);
  ASSERT_EQ(found.parts.size(), 3U);
  EXPECT_THAT(found.libraries, ElementsAre("glass and milk.mtl"));
  EXPECT_EQ(found.parts[0].name, kNoMaterial);
  EXPECT_EQ(found.parts[0].mesh->triangles.size(), 1U);
  EXPECT_EQ(found.parts[0].mesh->positions.size(), 3U);
  EXPECT_EQ(found.parts[1].name, "milk");
  EXPECT_EQ(found.parts[1].mesh->triangles.size(), 3U);
  EXPECT_EQ(found.parts[1].mesh->bounds.upper, Vec3(1.0F, 1.0F, 5.0F));
  EXPECT_TRUE(found.parts[1].mesh->uvs.empty());
  EXPECT_EQ(found.parts[2].name, "old glass");
  EXPECT_EQ(found.parts[2].mesh->uvs.size(), 3U);
}

// Large files are read in chunks: a material holds on into the next ones.
TEST(MeshParts, GoOnOverTheChunksOfALargeFile) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  constexpr int kFaces = 40'000;
  for (const char* name : {"a", "b", "a"}) {
    text += std::string("usemtl ") + name + "\n";
    for (int i = 0; i < kFaces; ++i) text += "f 1 2 3 # face\n";
  }
  const MeshParts found = parts_of(text);
  ASSERT_EQ(found.parts.size(), 2U);
  EXPECT_EQ(found.parts[0].mesh->triangles.size(), 2U * kFaces);
  EXPECT_EQ(found.parts[1].mesh->triangles.size(), 1U * kFaces);
}

TEST(MeshParts, OfAFileWithoutMaterialsAreOne) {
  const MeshParts found = parts_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_EQ(found.parts.size(), 1U);
  EXPECT_EQ(found.parts[0].name, kNoMaterial);
}

}  // namespace
}  // namespace hyades::core
