#include "core/geometry/obj_vertices.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <map>
#include <random>
#include <tuple>

#include "core/geometry/read_mesh.h"
#include "core/geometry/write_ply.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

/// Makes this process, and the threads that it starts, run on one processor while it lives.
class OneProcessor {
 public:
  OneProcessor() {
    sched_getaffinity(0, sizeof(before_), &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    sched_setaffinity(0, sizeof(one), &one);
  }
  ~OneProcessor() { sched_setaffinity(0, sizeof(before_), &before_); }

 private:
  cpu_set_t before_{};
};

std::vector<ObjCorner> random_corners(size_t count, int positions, int others, uint32_t seed) {
  std::mt19937 random(seed);
  const auto below = [&](int n) {
    return static_cast<int32_t>(random() % static_cast<uint32_t>(n));
  };
  std::vector<ObjCorner> corners(count);
  for (ObjCorner& c : corners) c = {below(positions), below(others) - 1, below(others) - 1};
  return corners;
}

/// The same, one corner after the other.
ObjVertices in_order(const std::vector<ObjCorner>& corners, std::span<const size_t> part_ends) {
  ObjVertices out;
  size_t c = 0;
  for (const size_t end : part_ends) {
    std::map<std::tuple<int32_t, int32_t, int32_t>, uint32_t> known;
    for (; c < end; ++c) {
      const auto key = std::tuple(corners[c].v, corners[c].vt, corners[c].vn);
      const auto number = static_cast<uint32_t>(out.first.size());
      const auto [found, fresh] = known.emplace(key, number);
      if (fresh) out.first.push_back(static_cast<uint32_t>(c));
      out.of_corner.push_back(found->second);
    }
  }
  return out;
}

TEST(ObjVertices, AreNumberedAsIfOneCornerCameAfterTheOther) {
  const auto few = random_corners(1000, 20, 3, 1);
  const auto many = random_corners(300'000, 5'000, 4, 2);
  const auto with_a_hub = random_corners(200'000, 2, 1'000, 3);
  for (const auto& corners : {few, many, with_a_hub}) {
    const size_t n = corners.size();
    const int32_t positions = 5'000;
    const std::vector<std::vector<size_t>> cuts = {{n}, {n / 3, n}, {1, 2, 3, n / 2, n - 1, n}};
    for (const std::vector<size_t>& ends : cuts) {
      const ObjVertices expected = in_order(corners, ends);
      const ObjVertices found = number_vertices(corners, positions, ends);
      EXPECT_EQ(found.of_corner, expected.of_corner);
      EXPECT_EQ(found.first, expected.first);
    }
  }
}

TEST(ObjVertices, OfOnePositionWithManyUvsTakeNoSquareOfTheirNumber) {
  std::vector<ObjCorner> corners(1'000'000);
  for (size_t i = 0; i < corners.size(); ++i) corners[i] = {0, static_cast<int32_t>(i), -1};
  const size_t ends[] = {corners.size()};
  EXPECT_EQ(number_vertices(corners, 1, ends).first.size(), corners.size());
}

/// A field of n x n quads with all that a file may have, of 7 materials in turn.
std::string field(int n) {
  std::string text;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      text += "v " + std::to_string(i) + " " + std::to_string(j) + " 0 0.5 " +
              std::to_string(j % 2) + " 1\nvt " + std::to_string(j) + " 1\nvn 0 0 1\n";
    }
  }
  for (int i = 0; i < n; ++i) {
    text += "usemtl m" + std::to_string(i % 7) + "\n";
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j + 1;
      text += "f";
      for (const int c : {a, a + 1, a + n + 2, a + n + 1}) {
        text +=
            " " + std::to_string(c) + "/" + std::to_string(c % 100 + 1) + "/-" + std::to_string(c);
      }
      text += "\n";
    }
  }
  return text;
}

std::string all_bytes(const MeshParts& parts) {
  std::string out;
  for (const MeshPart& part : parts.parts) {
    const Bytes ply = ply_bytes(*part.mesh);
    out += part.name + std::string(ply.chars(), ply.size());
  }
  return out;
}

TEST(ReadObj, GivesTheSameBytesOnAnyNumberOfThreads) {
  MemoryAssets assets;
  assets.add("field.obj", field(150));  // several chunks of text, corners and vertices
  const std::string parts = all_bytes(*read_mesh_parts(assets, "field.obj"));
  const std::string whole = all_bytes({{{"", *read_mesh(assets, "field.obj")}}, {}});
  const OneProcessor one;
  EXPECT_EQ(all_bytes(*read_mesh_parts(assets, "field.obj")), parts);
  EXPECT_EQ(all_bytes({{{"", *read_mesh(assets, "field.obj")}}, {}}), whole);
}

TEST(ReadObj, TakesListsThatAreNumberedAlikeAsTheyAre) {
  MemoryAssets assets;
  const std::string lists =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 9 9 9\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n"
      "vn 0 0 1\nvn 0 1 0\nvn 1 0 0\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\n";
  assets.add("alike.obj", lists + "f 4/4/4 2/2/2 1/1/1\nf 1/1/1 3/3/3 4/4/4\n");
  assets.add("not.obj", lists + "f 4/4/4 2/2/2 1/1/1\nf 1/1/1 3/3/3 4/4/1\n");
  const auto alike = *read_mesh(assets, "alike.obj");
  ASSERT_EQ(alike->positions.size(), 4U);
  EXPECT_EQ(alike->positions[0], Vec3(0.0F));
  EXPECT_EQ(alike->uvs[1], Vec2(1.0F, 0.0F));
  EXPECT_EQ(alike->normals[2], Vec3(1.0F, 0.0F, 0.0F));
  EXPECT_EQ(alike->triangles[0], (std::array<uint32_t, 3>{3, 1, 0}));
  EXPECT_EQ((*read_mesh(assets, "not.obj"))->positions.size(), 5U);
}

// Each material used to look at all positions of the file: minutes here.
TEST(MeshParts, OfThousandsOfMaterialsTakeLinearTime) {
  std::string text;
  constexpr int kVertices = 300'000;
  constexpr int kMaterials = 30'000;
  for (int i = 0; i < kVertices; ++i)
    text += "v " + std::to_string(i) + " " + std::to_string(i % 2) + " 0\n";
  for (int i = 0; i < kMaterials; ++i) {
    text += "usemtl " + std::to_string(i) + "\nf";
    for (int k = 1; k <= 3; ++k) text += " " + std::to_string(i * 10 + k);
    text += "\n";
  }
  MemoryAssets assets;
  assets.add("many.obj", text);
  const auto found = read_mesh_parts(assets, "many.obj");
  ASSERT_TRUE(found);
  ASSERT_EQ(found->parts.size(), size_t{kMaterials});
  EXPECT_EQ(found->parts[7].name, "7");
  EXPECT_EQ(found->parts[7].mesh->positions.size(), 3U);
  EXPECT_EQ(found->parts[7].mesh->positions[2].x, 72.0F);
}

}  // namespace
}  // namespace hyades::core
