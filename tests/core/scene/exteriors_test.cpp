// What objects say of their outside.

#include <gtest/gtest.h>

#include <string>

#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

Result<std::shared_ptr<const Scene>> build(const std::string& rest) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  const Job job = parse_job(
      "hyades: 1\nmedia: {water: {scattering: 1}, air: {scattering: 2}, ink: {scattering: 3}}\n"
      "materials: {glass: {type: dielectric}, clear: {type: \"null\"}}\n" +
          rest,
      "job.yaml", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  SceneCache cache(assets);
  return build_scene(job, 1, cache);
}

std::string error_of(const std::string& rest) {
  const auto scene = build(rest);
  return scene ? "none" : scene.error().message;
}

TEST(Exteriors, OutsideOfAllBodiesSayWhatTheAtmosphereIs) {
  for (const char* shape : {"sphere", "box", "cylinder"}) {
    const auto scene =
        build(std::string("objects: {ball: {shape: ") + shape +
              ", at: [5, 0, 0], material: glass, exterior: water}, other: {shape: sphere, at: [0, "
              "9, 0], material: glass, exterior: water}}\n");
    ASSERT_TRUE(scene) << shape;
    ASSERT_NE((*scene)->atmosphere, nullptr) << shape;
    EXPECT_EQ((*scene)->around_camera.medium(), (*scene)->atmosphere.get());
  }
}

TEST(Exteriors, MustAgreeWithTheAtmosphereAndWithEachOther) {
  EXPECT_EQ(error_of("atmosphere: air\nobjects: {ball: {shape: sphere, material: glass, exterior: "
                     "water}}\n"),
            "job.yaml:5:17: object 'ball': its exterior is 'water', but outside of it there is "
            "'air', expected the same");
  EXPECT_EQ(error_of("objects:\n  a: {shape: sphere, material: glass, exterior: water}\n"
                     "  b: {shape: sphere, at: [9, 0, 0], material: glass, exterior: air}\n"),
            "job.yaml:6:6: object 'b': its exterior is 'air', but outside of it there is 'water', "
            "expected the same");
}

TEST(Exteriors, WithinABodyMustBeWhatFillsIt) {
  const std::string pond =
      "objects:\n  pond: {shape: box, size: [9, 9, 9], material: clear, interior: water}\n";
  EXPECT_EQ(error_of(pond + "  ball: {shape: sphere, material: glass, exterior: water}\n"), "none");
  EXPECT_EQ(error_of(pond + "  ball: {shape: sphere, material: glass, exterior: ink}\n"),
            "job.yaml:6:9: object 'ball': its exterior is 'ink', but outside of it there is "
            "'water', expected the same");
  EXPECT_EQ(error_of("objects:\n  pond: {shape: box, size: [9, 9, 9], material: glass}\n"
                     "  ball: {shape: sphere, material: glass, exterior: ink}\n"),
            "job.yaml:6:9: object 'ball': its exterior is 'ink', but outside of it there is "
            "nothing, expected the same");
}

}  // namespace
}  // namespace hyades::core
