// What a glTF file says, in the language of jobs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/import/gltf_builder.h"

namespace hyades::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(GltfScene, TexturedSquareWithACamera) {
  GltfBuilder b;
  const int picture = b.view("\x89PNG....", 8);
  b.add("images", {{"bufferView", picture}, {"mimeType", "image/png"}, {"name", "wood"}});
  b.add("samplers", {{"wrapS", 33071}, {"wrapT", 33071}, {"magFilter", 9728}});
  b.add("textures", {{"source", 0}, {"sampler", 0}});
  b.add("materials", {{"name", "Table top"},
                      {"pbrMetallicRoughness",
                       {{"baseColorTexture", {{"index", 0}}},
                        {"baseColorFactor", {0.5, 1, 1, 1}},
                        {"metallicRoughnessTexture", {{"index", 0}}},
                        {"roughnessFactor", 0.25}}}});
  nlohmann::json square = b.square();
  square["material"] = 0;
  b.add("nodes", {{"mesh", b.mesh(square)}, {"name", "Table"}, {"translation", {1, 2, 3}}});
  b.add("cameras", {{"type", "perspective"},
                    {"perspective", {{"yfov", 0.78539816}, {"znear", 0.1}, {"aspectRatio", 1.5}}}});
  b.add("nodes", {{"camera", 0}, {"translation", {0, 0, 5}}});
  core::SceneRequest request;
  request.prefix = "room";
  request.made = "made/";
  const std::string job = job_of(b, request);
  EXPECT_THAT(job, HasSubstr("film: {size: [1080, 720]}"));
  EXPECT_THAT(job, HasSubstr("camera: {fov: 45, look_from: [0, 0, 5], look_at: [0, 0, 4], "
                             "up: [0, 1, 0]}"));
  EXPECT_THAT(job, HasSubstr("room.wood: {type: image, file: made/images/wood.png, wrap: clamp, "
                             "filter: nearest}"));
  EXPECT_THAT(job, HasSubstr("base_color: {type: scale, input: room.wood, factor: [0.5, 1, 1]}"));
  EXPECT_THAT(job, HasSubstr("metallic: room.wood.blue"));
  EXPECT_THAT(job, HasSubstr("roughness: {type: scale, input: room.wood.green, factor: 0.25}"));
  EXPECT_THAT(job, HasSubstr("mesh: made/meshes/Table.ply"));
  EXPECT_THAT(job, HasSubstr("material: room.Table top"));
  EXPECT_THAT(job, HasSubstr("[1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1]"));
  EXPECT_THAT(job, Not(HasSubstr("#")));

  const auto mesh = mesh_of(b, "meshes/Table.ply");
  ASSERT_EQ(mesh->positions.size(), 4U);
  EXPECT_EQ(mesh->triangles.size(), 2U);
  // Of the file v grows downwards, of jobs upwards.
  EXPECT_EQ(mesh->uvs[0], core::Vec2(0, 0));
  EXPECT_EQ(mesh->uvs[2], core::Vec2(1, 1));
  const auto source = read_glb(b.glb());
  const auto bytes = (*source)->made_file("images/wood.png");
  ASSERT_TRUE(bytes.ok());
  EXPECT_EQ(std::string(bytes->chars(), bytes->size()), std::string("\x89PNG....", 8));
}

/// A bar of two bones: the lower square stands, the upper one turns about z at its foot.
GltfBuilder bending_bar() {
  GltfBuilder b;
  nlohmann::json square = b.square();
  square["attributes"]["POSITION"] = b.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  square["attributes"]["NORMAL"] = b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  square["attributes"]["JOINTS_0"] =
      b.accessor<uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  square["attributes"]["WEIGHTS_0"] =
      b.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const int mesh = b.mesh(square);
  b.add("nodes", {{"mesh", mesh}, {"skin", 0}, {"name", "Bar"}, {"translation", {9, 9, 9}}});
  b.add("nodes", {{"name", "Foot"}, {"children", {2}}});
  b.add("nodes", {{"name", "Head"}, {"translation", {0, 1, 0}}});
  const int binds = b.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                             "MAT4");
  b.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", binds}});
  const int times = b.floats({0, 1}, "SCALAR");
  const int turns = b.floats({0, 0, 0, 1, 0, 0, 0.70710678F, 0.70710678F}, "VEC4");
  b.add("animations",
        {{"name", "Bend it"},
         {"samplers", {{{"input", times}, {"output", turns}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}});
  return b;
}

TEST(GltfScene, SkinnedMeshesAreFilesOfFrames) {
  const GltfBuilder b = bending_bar();
  const std::string job = job_of(b);
  EXPECT_THAT(job, HasSubstr("frames: {range: 1-25, fps: 24}"));
  EXPECT_THAT(job, HasSubstr("mesh: \"meshes/24/Bend_it/Bar.####.ply\""));
  // A skin places its mesh by its bones, not by its node.
  EXPECT_THAT(job, Not(HasSubstr("transform")));
  const auto first = mesh_of(b, "meshes/24/Bend_it/Bar.0001.ply");
  EXPECT_EQ(first->positions[2], core::Vec3(1, 1, 0));
  const auto last = mesh_of(b, "meshes/24/Bend_it/Bar.0025.ply");
  EXPECT_NEAR(last->positions[2].x, 0.0F, 1e-6F);
  EXPECT_NEAR(last->positions[2].y, 2.0F, 1e-6F);
  EXPECT_EQ(last->positions[0], core::Vec3(0, 0, 0));
  const auto half = mesh_of(b, "meshes/24/Bend_it/Bar.0013.ply");
  EXPECT_NEAR(half->positions[2].x, std::sqrt(0.5F), 1e-6F);
  EXPECT_NEAR(half->positions[2].y, 1.0F + std::sqrt(0.5F), 1e-6F);
  // Beyond its end an animation stays where it is.
  EXPECT_EQ(mesh_of(b, "meshes/24/Bend_it/Bar.0099.ply")->positions, last->positions);
}

/// Bones are scaled to 0 to hide what hangs on them; their matrices have no inverse.
TEST(GltfScene, BonesMayVanish) {
  GltfBuilder b = bending_bar();
  b.json["nodes"][2]["scale"] = {0, 0, 0};
  const auto mesh = mesh_of(b, "meshes/24/Bend_it/Bar.0013.ply");
  EXPECT_EQ(mesh->positions[2], core::Vec3(0, 1, 0));
  for (const core::Vec3& normal : mesh->normals) EXPECT_EQ(normal, core::Vec3(0, 0, 1));
}

TEST(GltfScene, TurnsGoTheShorterWay) {
  GltfBuilder b = bending_bar();
  const int times = b.floats({0, 1}, "SCALAR");
  // The same turns; the second quaternion has the other sign.
  const int turns = b.floats({0, 0, 0, 1, 0, 0, -0.70710678F, -0.70710678F}, "VEC4");
  b.json["animations"][0]["samplers"][0] = {{"input", times}, {"output", turns}};
  const auto half = mesh_of(b, "meshes/24/Bend_it/Bar.0013.ply");
  EXPECT_NEAR(half->positions[2].x, std::sqrt(0.5F), 1e-6F);
  EXPECT_NEAR(half->positions[2].y, 1.0F + std::sqrt(0.5F), 1e-6F);
}

TEST(GltfScene, AnimationsAreChosenByName) {
  const GltfBuilder b = bending_bar();
  core::SceneRequest still;
  still.animation = "none";
  EXPECT_THAT(job_of(b, still), HasSubstr("mesh: meshes/Bar.ply"));
  EXPECT_THAT(job_of(b, still), Not(HasSubstr("frames")));
  core::SceneRequest wrong;
  wrong.animation = "Walk";
  EXPECT_EQ(job_of(b, wrong), "a.glb: it has no animation 'Walk'; it has 'Bend it'");
}

TEST(GltfScene, NodesMoveByKeys) {
  GltfBuilder b;
  b.add("nodes", {{"children", {1}}, {"name", "Arm"}, {"scale", {2, 2, 2}}});
  b.add("nodes", {{"mesh", b.mesh(b.square())}, {"translation", {0, 1, 0}}});
  const int times = b.floats({0, 0.5F, 2}, "SCALAR");
  const int places = b.floats({0, 0, 0, 1, 0, 0, 1, 0, 4}, "VEC3");
  b.add("animations",
        {{"samplers", {{{"input", times}, {"output", places}, {"interpolation", "STEP"}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
  core::SceneRequest request;
  request.fps = 10;
  const std::string job = job_of(b, request);
  EXPECT_THAT(job, HasSubstr("frames: {range: 1-21, fps: 10}"));
  EXPECT_THAT(job, HasSubstr("- {matrix: [1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1]}\n"
                             "      - {scale: [2, 2, 2]}\n"
                             "      - {translate: {keys: {1: [0, 0, 0], 6: [1, 0, 0], "
                             "21: [1, 0, 4]}, ease: step}}"));
}

TEST(GltfScene, WhatHasNoTrianglesIsLeftOutAndTold) {
  GltfBuilder builder;
  nlohmann::json empty = builder.square();
  empty["indices"] = builder.accessor<uint16_t>({0, 1}, "SCALAR");
  builder.add("meshes", {{"primitives", {builder.square(), empty}}});
  builder.add("nodes", {{"mesh", 0}});
  builder.json["scenes"] = {{{"nodes", {0}}}};
  const std::string job = job_of(builder);
  EXPECT_NE(job.find("meshes[0].primitives[1] has no triangles and is left out"), std::string::npos)
      << job;
  EXPECT_NE(job.find("objects:"), std::string::npos) << job;
}

}  // namespace
}  // namespace hyades::test
