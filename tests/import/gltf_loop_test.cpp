// Animations that begin again where they end, and what is told of those that are not played.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/import/gltf_builder.h"

namespace hyades::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

nlohmann::json channel(int sampler, int node, const char* path) {
  return {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}};
}

core::SceneRequest looped(float fps) {
  core::SceneRequest request;
  request.fps = fps;
  request.loop = true;
  return request;
}

/// Two squares; the clip lasts for 0.85 s, the second one moves from 0.2 to 0.4 s only.
GltfBuilder two_squares() {
  GltfBuilder b;
  const int mesh = b.mesh(b.square());
  b.add("nodes", {{"mesh", mesh}});
  b.add("nodes", {{"mesh", mesh}});
  const int times = b.floats({0, 0.5F, 0.85F}, "SCALAR");
  const int places = b.floats({0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3");
  const int others = b.floats({0.2F, 0.4F}, "SCALAR");
  const int heights = b.floats({0, 1, 0, 0, 2, 0}, "VEC3");
  b.add("animations", {{"samplers",
                        {{{"input", times}, {"output", places}},
                         {{"input", others}, {"output", heights}, {"interpolation", "STEP"}}}},
                       {"channels", {channel(0, 0, "translation"), channel(1, 1, "translation")}}});
  return b;
}

TEST(GltfLoop, KeysRepeatFromTheClipsBeginningToItsEnd) {
  const std::string job = job_of(two_squares(), looped(10));
  EXPECT_THAT(job, HasSubstr("{1: [0, 0, 0], 6: [1, 0, 0], 9.5: [0, 0, 0]}, repeat: loop}"));
  EXPECT_THAT(job, HasSubstr("{1: [0, 1, 0], 3: [0, 1, 0], 5: [0, 2, 0], 9.5: [0, 2, 0]}, ease: "
                             "step, repeat: loop}"));
  // What is shown is one round.
  EXPECT_THAT(job, HasSubstr("frames: {range: 1-9, fps: 10}"));
  EXPECT_THAT(job_of(two_squares()), Not(HasSubstr("loop")));
}

TEST(GltfLoop, TheFrameAtTheSeamIsNotShownTwice) {
  const core::SceneRequest request = looped(20);  // 0.85 s are 17 frames
  EXPECT_THAT(job_of(two_squares(), request), HasSubstr("range: 1-17,"));
}

TEST(GltfLoop, SplinesAndCamerasAreToldToTheSeam) {
  GltfBuilder b = two_squares();
  const int times = b.floats({0, 0.85F}, "SCALAR");
  const int cubic = b.floats({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 3, 0, 0, 0, 0, 0}, "VEC3");
  b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}});
  b.add("nodes", {{"camera", 0}});
  nlohmann::json& animation = b.json["animations"][0];
  animation["samplers"].push_back(
      {{"input", times}, {"output", cubic}, {"interpolation", "CUBICSPLINE"}});
  animation["channels"].push_back(channel(2, 2, "translation"));
  b.json["nodes"][0]["children"] = {3};
  b.add("nodes", {{"mesh", 0}});
  const std::string job = job_of(b, looped(10));
  EXPECT_THAT(job, HasSubstr("9: [2.9700794, 0, -0.04152255]\n      9.5: [3, 0, 0]\n    "
                             "repeat: loop"));
}

/// A square of one bone that turns, once in a second.
GltfBuilder turning() {
  GltfBuilder b;
  nlohmann::json square = b.square();
  square["attributes"]["JOINTS_0"] = b.accessor<uint8_t>(std::vector<uint8_t>(16, 0), "VEC4");
  square["attributes"]["WEIGHTS_0"] =
      b.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  b.add("nodes", {{"mesh", b.mesh(square)}, {"skin", 0}, {"name", "Flag"}});
  b.add("nodes", {{"name", "Bone"}});
  b.add("skins", {{"joints", {1}}});
  const int times = b.floats({0, 0.5F, 1}, "SCALAR");
  const int turns = b.floats({0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1}, "VEC4");
  b.add("animations", {{"name", "Turn"},
                       {"samplers", {{{"input", times}, {"output", turns}}}},
                       {"channels", {channel(0, 1, "rotation")}}});
  return b;
}

TEST(GltfLoop, MeshesOfFramesRepeat) {
  const GltfBuilder b = turning();
  EXPECT_THAT(job_of(b, looped(24)), HasSubstr("mesh: \"meshes/loop/24/Turn/Flag.####.ply\""));
  const auto at = [&](const char* name) { return mesh_of(b, name)->positions; };
  EXPECT_EQ(at("meshes/loop/24/Turn/Flag.0025.ply"), at("meshes/loop/24/Turn/Flag.0001.ply"));
  EXPECT_EQ(at("meshes/loop/24/Turn/Flag.0030.ply"), at("meshes/loop/24/Turn/Flag.0006.ply"));
  EXPECT_EQ(at("meshes/loop/24/Turn/Flag.0006.ply"), at("meshes/24/Turn/Flag.0006.ply"));
  EXPECT_NE(at("meshes/24/Turn/Flag.0030.ply"), at("meshes/24/Turn/Flag.0006.ply"));
  const auto source = read_glb(b.glb());
  for (const char* wrong :
       {"meshes/loop/Flag.ply", "meshes/loop/24/Flag.0001.ply",
        "meshes/loop/loop/24/Turn/Flag.1.ply", "meshes/loop/x/Turn/Flag.0001.ply"}) {
    EXPECT_FALSE((*source)->made_file(wrong).ok()) << wrong;
  }
}

TEST(GltfLoop, AnimationsThatAreNotPlayedAreTold) {
  GltfBuilder b = turning();
  for (const char* name : {"Wave", "Fall"}) {
    b.json["animations"].push_back(b.json["animations"][0]);
    b.json["animations"].back()["name"] = name;
  }
  EXPECT_THAT(job_of(b), HasSubstr("a.glb: of its 3 animations 'Turn' is played; others: "
                                   "'Wave', 'Fall'"));
  core::SceneRequest chosen;
  chosen.animation = "Wave";
  EXPECT_THAT(job_of(b, chosen), Not(HasSubstr("animations")));
}

TEST(GltfLeftOut, ChannelsThatMoveNothingAreTold) {
  GltfBuilder b = turning();
  b.add("nodes", {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
  nlohmann::json& animation = b.json["animations"][0];
  animation["samplers"].push_back(
      {{"input", b.floats({0, 1}, "SCALAR")}, {"output", b.floats({0, 0, 0, 1, 1, 1}, "VEC3")}});
  animation["channels"].push_back(channel(1, 2, "translation"));
  animation["channels"].push_back(channel(0, 1, "rotation"));
  animation["channels"].push_back(channel(1, 0, "weights"));
  const std::string job = job_of(b);
  EXPECT_THAT(job, HasSubstr("animations[0].channels[1] is left out: it moves nodes[2], which has "
                             "a matrix"));
  EXPECT_THAT(job,
              HasSubstr("channels[2] is left out: it moves nodes[1], as another channel does"));
  EXPECT_THAT(job, HasSubstr("channels[3] is left out: it moves nodes[0], which has no morph"));
}

TEST(GltfLeftOut, WhatVerticesHaveBesidesIsTold) {
  GltfBuilder b = turning();
  nlohmann::json& primitive = b.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["COLOR_1"] = b.floats(std::vector<float>(12, 1.0F), "VEC3");
  primitive["attributes"]["_AGE"] = b.floats(std::vector<float>(4, 1.0F), "SCALAR");
  primitive["targets"] = {{{"POSITION", b.floats(std::vector<float>(12, 1.0F), "VEC3")},
                           {"COLOR_0", b.floats(std::vector<float>(12, 1.0F), "VEC3")}}};
  b.json["meshes"][0]["primitives"].push_back(primitive);
  const std::string job = job_of(b);
  EXPECT_THAT(job, HasSubstr("a.glb: COLOR_1 of meshes[0].primitives[0] and 1 more is left out"));
  EXPECT_THAT(job, HasSubstr("a.glb: _AGE of meshes[0].primitives[0] and 1 more is left out"));
  EXPECT_THAT(job, HasSubstr("COLOR_0 in the morph targets of meshes[0].primitives[0] and 1 more"));
  EXPECT_THAT(job, Not(HasSubstr("JOINTS")));
}

TEST(GltfSkins, AllSetsOfBonesCount) {
  GltfBuilder b = turning();
  nlohmann::json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
  b.add("nodes", {{"name", "Far"}, {"translation", {8, 0, 0}}});
  b.json["skins"][0]["joints"].push_back(2);
  for (const char* set : {"1", "2"}) {
    const bool last = set[0] == '2';
    attributes[std::string("JOINTS_") + set] =
        b.accessor<uint8_t>(std::vector<uint8_t>(16, last ? 1 : 0), "VEC4");
    attributes[std::string("WEIGHTS_") + set] =
        b.floats(std::vector<float>(16, last ? 0.25F : 0.0F), "VEC4");
  }
  // Of weights 1 and 4 * 0.25 half of the way to the far bone.
  EXPECT_EQ(mesh_of(b, "meshes/Flag.ply")->positions[1], core::Vec3(5, 0, 0));
}

}  // namespace
}  // namespace hyades::test
