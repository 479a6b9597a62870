// Accessors and primitives: how numbers are stored, and what triangles they make.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/import/gltf_builder.h"

namespace hyades::test {
namespace {

using ::testing::HasSubstr;
using Triangles = std::vector<std::array<uint32_t, 3>>;

/// A mesh of one primitive and the node that shows it.
std::shared_ptr<const core::TriangleMesh> built(GltfBuilder& b, const nlohmann::json& primitive) {
  b.add("nodes", {{"mesh", b.mesh(primitive)}});
  return mesh_of(b, "meshes/mesh.ply");
}

const std::vector<float> kFive = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};

TEST(GltfGeometry, StripsAndFansTurnAsTheSpecificationSays) {
  for (const auto& [mode, expected] : {std::pair(5, Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}),
                                       std::pair(6, Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}})}) {
    GltfBuilder b;
    const auto mesh =
        built(b, {{"attributes", {{"POSITION", b.floats(kFive, "VEC3")}}}, {"mode", mode}});
    EXPECT_EQ(mesh->triangles, expected) << mode;
    EXPECT_TRUE(mesh->normals.empty());
  }
}

TEST(GltfGeometry, PointsAndLinesAreNoted) {
  GltfBuilder b;
  const nlohmann::json attributes = {{"POSITION", b.floats(kFive, "VEC3")}};
  const int mesh = b.add(
      "meshes",
      {{"primitives",
        {{{"attributes", attributes}, {"mode", 1}}, {{"attributes", attributes}, {"mode", 5}}}}});
  b.add("nodes", {{"mesh", mesh}});
  const std::string job = job_of(b);
  EXPECT_THAT(job,
              HasSubstr("a.glb: meshes[0].primitives[0] is made of lines, which are left out"));
  EXPECT_THAT(job, HasSubstr("object-2: {mesh: meshes/mesh-2.ply"));
}

TEST(GltfGeometry, IndicesOfAllWidths) {
  for (int width = 1; width <= 4; width *= 2) {
    GltfBuilder b;
    nlohmann::json primitive = {{"attributes", {{"POSITION", b.floats(kFive, "VEC3")}}}};
    primitive["indices"] = width == 1   ? b.accessor<uint8_t>({0, 1, 2, 2, 1, 3}, "SCALAR")
                           : width == 2 ? b.accessor<uint16_t>({0, 1, 2, 2, 1, 3}, "SCALAR")
                                        : b.accessor<uint32_t>({0, 1, 2, 2, 1, 3}, "SCALAR");
    EXPECT_EQ(built(b, primitive)->triangles, (Triangles{{0, 1, 2}, {2, 1, 3}})) << width;
  }
}

TEST(GltfGeometry, WholeNumbersStandForFractionsWhereTheySaySo) {
  GltfBuilder b;
  nlohmann::json primitive;
  primitive["attributes"]["POSITION"] =
      b.accessor<int16_t>({0, 0, 0, 32767, 0, 0, 0, -32768, 16384}, "VEC3", true);
  primitive["attributes"]["NORMAL"] =
      b.accessor<int8_t>({127, 0, 0, -128, 0, 0, 0, 0, 127}, "VEC3", true);
  primitive["attributes"]["TEXCOORD_0"] =
      b.accessor<uint8_t>({0, 0, 255, 0, 51, 255}, "VEC2", true);
  const auto mesh = built(b, primitive);
  EXPECT_EQ(mesh->positions[1], core::Vec3(1, 0, 0));
  EXPECT_EQ(mesh->positions[2], core::Vec3(0, -1, 16384.0F / 32767.0F));
  EXPECT_EQ(mesh->normals[1], core::Vec3(-1, 0, 0));
  EXPECT_FLOAT_EQ(mesh->uvs[2].x, 0.2F);
  EXPECT_FLOAT_EQ(mesh->uvs[2].y, 0.0F);
}

TEST(GltfGeometry, QuantizedPositionsThatAreNoFractions) {
  GltfBuilder b;
  b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const auto mesh =
      built(b, {{"attributes",
                 {{"POSITION", b.accessor<uint16_t>({0, 0, 0, 500, 0, 0, 0, 65535, 7}, "VEC3")}}}});
  EXPECT_EQ(mesh->positions[2], core::Vec3(0, 65535, 7));
}

TEST(GltfGeometry, InterleavedElements) {
  GltfBuilder b;
  struct Vertex {
    float position[3];
    float uv[2];
  };
  const Vertex vertices[3] = {{{0, 0, 0}, {0, 1}}, {{1, 0, 0}, {1, 1}}, {{0, 1, 0}, {0, 0}}};
  const int view = b.view(vertices, sizeof vertices, sizeof(Vertex));
  nlohmann::json primitive;
  primitive["attributes"]["POSITION"] = b.add(
      "accessors", {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
  primitive["attributes"]["TEXCOORD_0"] = b.add("accessors", {{"bufferView", view},
                                                              {"byteOffset", 12},
                                                              {"componentType", 5126},
                                                              {"count", 3},
                                                              {"type", "VEC2"}});
  const auto mesh = built(b, primitive);
  EXPECT_EQ(mesh->positions[2], core::Vec3(0, 1, 0));
  EXPECT_EQ(mesh->uvs[1], core::Vec2(1, 0));
  EXPECT_EQ(mesh->uvs[2], core::Vec2(0, 1));
}

TEST(GltfGeometry, ColoursSecondCoordinatesAndTangents) {
  GltfBuilder b;
  b.add("images", {{"uri", "wood.png"}});
  b.add("textures", {{"source", 0}});
  b.add("materials",
        {{"name", "Paint"},
         {"alphaMode", "BLEND"},
         {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}});
  nlohmann::json square = b.square();
  square["attributes"]["NORMAL"] = b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  square["attributes"]["TANGENT"] =
      b.floats({1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}, "VEC4");
  square["attributes"]["TEXCOORD_1"] =
      b.accessor<uint16_t>({0, 0, 65535, 0, 65535, 65535, 0, 65535}, "VEC2", true);
  square["attributes"]["COLOR_0"] =
      b.accessor<uint8_t>({255, 0, 51, 255, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3", true);
  square["material"] = 0;
  const auto mesh = built(b, square);
  ASSERT_EQ(mesh->colors.size(), 4U);
  // Colours of vertices are linear.
  EXPECT_EQ(mesh->colors[0], core::Vec4(1, 0, 0.2F, 1));
  ASSERT_EQ(mesh->second_uvs.size(), 4U);
  EXPECT_EQ(mesh->second_uvs[0], core::Vec2(0, 1));
  EXPECT_EQ(mesh->second_uvs[2], core::Vec2(1, 0));
  ASSERT_EQ(mesh->vertex_tangents.size(), 4U);
  EXPECT_EQ(mesh->vertex_tangents[0], core::Vec4(1, 0, 0, -1));
  const std::string job = job_of(b);
  EXPECT_THAT(job, HasSubstr("mapping: uv1"));
  EXPECT_THAT(job, HasSubstr("base_color: {type: scale, input: texture, factor: {type: "
                             "vertex-color}}"));
  EXPECT_THAT(job, HasSubstr("opacity: {type: scale, input: texture.alpha, factor: {type: "
                             "vertex-color, channel: alpha}}"));
}

TEST(GltfGeometry, SparseElementsReplaceOthersOrZeros) {
  for (const bool with_base : {true, false}) {
    GltfBuilder b;
    nlohmann::json square = b.square();
    nlohmann::json& accessor = b.json["accessors"][0];
    const std::vector<uint8_t> indices = {1, 3};
    const std::vector<float> values = {5, 6, 7, 8, 9, 10};
    accessor["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", b.view(indices.data(), 2)}, {"componentType", 5121}}},
        {"values", {{"bufferView", b.view(values.data(), 24)}}}};
    if (!with_base) accessor.erase("bufferView");
    const auto mesh = built(b, square);
    EXPECT_EQ(mesh->positions[1], core::Vec3(5, 6, 7));
    EXPECT_EQ(mesh->positions[3], core::Vec3(8, 9, 10));
    EXPECT_EQ(mesh->positions[2], with_base ? core::Vec3(1, 1, 0) : core::Vec3(0));
  }
}

TEST(GltfGeometry, MorphTargetsMoveByTheirWeights) {
  GltfBuilder b;
  nlohmann::json square = b.square();
  square["attributes"]["NORMAL"] = b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  square["targets"] = {{{"POSITION", b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}},
                       {{"POSITION", b.floats({0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3")},
                        {"NORMAL", b.floats({1, 0, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3")}}};
  const int mesh =
      b.add("meshes", {{"name", "Face"}, {"primitives", {square}}, {"weights", {0.5, 0}}});
  b.add("nodes", {{"mesh", mesh}});
  b.add("nodes", {{"mesh", mesh}, {"weights", {0, 1}}});
  const int times = b.floats({0, 1, 2}, "SCALAR");
  const int weights = b.floats({0, 0, 1, 0, 1, 1}, "SCALAR");
  b.add("animations",
        {{"name", "Smile"},
         {"samplers", {{{"input", times}, {"output", weights}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
  // At rest: the mesh's weights, and the node's own.
  EXPECT_EQ(mesh_of(b, "meshes/Face.ply")->positions[0], core::Vec3(0, 0, 0.5F));
  EXPECT_EQ(mesh_of(b, "meshes/Face-2.ply")->positions[0], core::Vec3(0, 4, 0));
  EXPECT_EQ(mesh_of(b, "meshes/Face-2.ply")->normals[0], core::Vec3(1, 0, 0));
  const std::string job = job_of(b);
  EXPECT_THAT(job, HasSubstr("\"meshes/24/Smile/Face.####.ply\""));
  EXPECT_THAT(job, HasSubstr("meshes/Face-2.ply"));
  EXPECT_EQ(mesh_of(b, "meshes/24/Smile/Face.0013.ply")->positions[0], core::Vec3(0, 0, 0.5F));
  EXPECT_EQ(mesh_of(b, "meshes/24/Smile/Face.0037.ply")->positions[0], core::Vec3(0, 2, 1));
}

TEST(GltfGeometry, CubicSplinesGoByTheirTangents) {
  GltfBuilder b;
  nlohmann::json square = b.square();
  square["targets"] = {{{"POSITION", b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}}};
  b.add("nodes", {{"mesh", b.mesh(square)}});
  const int times = b.floats({0, 2}, "SCALAR");
  // In-tangent, value, out-tangent of two keys.
  const int weights = b.floats({0, 0, 1, 0.5F, 1, 0}, "SCALAR");
  b.add("animations",
        {{"samplers", {{{"input", times}, {"output", weights}, {"interpolation", "CUBICSPLINE"}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
  // Half-way: (v0 + v1) / 2 + span (out0 - in1) / 8.
  const auto mesh = mesh_of(b, "meshes/24/animation/mesh.0025.ply");
  EXPECT_FLOAT_EQ(mesh->positions[0].z, 0.5F + 2.0F * (1.0F - 0.5F) / 8.0F);
}

TEST(GltfGeometry, InstancesAreObjects) {
  GltfBuilder b;
  const int places = b.floats({1, 0, 0, 0, 2, 0}, "VEC3");
  const int sizes = b.floats({1, 1, 1, 3, 3, 3}, "VEC3");
  b.add("nodes", {{"mesh", b.mesh(b.square())},
                  {"name", "Tree"},
                  {"translation", {0, 0, 5}},
                  {"extensions",
                   {{"EXT_mesh_gpu_instancing",
                     {{"attributes", {{"TRANSLATION", places}, {"SCALE", sizes}}}}}}}});
  const std::string job = job_of(b);
  EXPECT_THAT(job, HasSubstr("Tree:"));
  EXPECT_THAT(job, HasSubstr("Tree-2:"));
  EXPECT_THAT(job, HasSubstr("- {matrix: [3, 0, 0, 0, 0, 3, 0, 2, 0, 0, 3, 0, 0, 0, 0, 1]}\n"
                             "      - {matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5, 0, 0, 0, 1]}"));
}

}  // namespace
}  // namespace hyades::test
