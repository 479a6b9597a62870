#include <gtest/gtest.h>

#include "core/base/color.h"
#include "core/geometry/read_mesh.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

MeshParts coloured_parts(const std::string& text) {
  MemoryAssets assets;
  assets.add("it.obj", text);
  auto parts = read_mesh_parts(assets, "it.obj");
  EXPECT_TRUE(parts) << (parts ? "" : parts.error().message);
  return parts ? *parts : MeshParts{};
}

std::vector<Vec4> colors_of(const std::string& vertices) {
  return coloured_parts(vertices + "f 1 2 3\n").parts.at(0).mesh->colors;
}

TEST(ObjColors, AreCodesOfSrgbBehindPositions) {
  const auto colors = colors_of("v 0 0 0 1 0.5 0\nv 1 0 0 0 0 0 0.25\nv 0 1 0 0 0 1 # blue\n");
  ASSERT_EQ(colors.size(), 3U);
  EXPECT_EQ(colors[0], Vec4(1.0F, srgb_decode(0.5F), 0.0F, 1.0F));
  EXPECT_EQ(colors[1], Vec4(0.0F, 0.0F, 0.0F, 0.25F));
  EXPECT_EQ(colors[2], Vec4(0.0F, 0.0F, 1.0F, 1.0F));
}

TEST(ObjColors, OfWholeNumbersArePartsOf255) {
  const auto colors = colors_of("v 0 0 0 255 128 0\nv 1 0 0 1 0 0\nv 0 1 0 0 0 0 255\n");
  EXPECT_EQ(colors.at(0), Vec4(1.0F, srgb_decode(128.0F / 255.0F), 0.0F, 1.0F));
  EXPECT_EQ(colors.at(1).x, srgb_decode(1.0F / 255.0F));
  EXPECT_EQ(colors.at(2), Vec4(0.0F, 0.0F, 0.0F, 1.0F));
}

TEST(ObjColors, AreNotTheWeightsOfCurves) {
  EXPECT_TRUE(colors_of("v 0 0 0 0.5\nv 1 0 0 1\nv 0 1 0 1\n").empty());
  EXPECT_TRUE(colors_of("v 0 0 0\nv 1 0 0 1 1\nv 0 1 0\n").empty());
}

TEST(ObjColors, AreWhiteWhereOthersHaveOne) {
  const auto colors = colors_of("v 0 0 0\nv 1 0 0 0 0 0\nv 0 1 0 1\n");
  ASSERT_EQ(colors.size(), 3U);
  EXPECT_EQ(colors[0], Vec4(1.0F));
  EXPECT_EQ(colors[1], Vec4(0.0F, 0.0F, 0.0F, 1.0F));
  EXPECT_EQ(colors[2], Vec4(1.0F));
}

TEST(ObjColors, AreThereForThePartsThatHaveSome) {
  const MeshParts found = coloured_parts(
      "v 0 0 0 0 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\n"
      "usemtl painted\nf 1 2 3\nusemtl plain\nf 4 5 6\n");
  EXPECT_EQ(found.parts.at(0).mesh->colors.size(), 3U);
  EXPECT_TRUE(found.parts.at(1).mesh->colors.empty());
}

// A vertex of the next chunk of a large file has the colour behind it, not that of another one.
TEST(ObjColors, StayWithTheirVerticesOverChunks) {
  std::string text;
  constexpr int kVertices = 40'000;
  for (int i = 0; i < kVertices; ++i) {
    text += "v " + std::to_string(i) + " 0 0";
    if (i >= kVertices / 2) text += i % 2 == 0 ? " 1 1 1" : " 0 0 0";
    text += "\n";
  }
  for (int i = 1; i + 2 <= kVertices; ++i) {
    const std::string a = std::to_string(i), b = std::to_string(i + 1), c = std::to_string(i + 2);
    text += "f " + a + " " + b + " " + c + "\n";
  }
  const auto mesh = coloured_parts(text).parts.at(0).mesh;
  ASSERT_EQ(mesh->colors.size(), size_t{kVertices});
  for (size_t i = 0; i < kVertices; ++i) {
    ASSERT_EQ(mesh->positions[i].x, static_cast<float>(i));
    ASSERT_EQ(mesh->colors[i].x, i < kVertices / 2 || i % 2 == 0 ? 1.0F : 0.0F) << i;
  }
}

TEST(ObjColors, AreFinite) {
  MemoryAssets assets;
  assets.add("it.obj", "v 0 0 0 1 nan 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto mesh = read_mesh(assets, "it.obj");
  ASSERT_FALSE(mesh);
  EXPECT_NE(mesh.error().message.find("it.obj: line 1: expected 'v x y z'"), std::string::npos);
}

}  // namespace
}  // namespace hyades::core
