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
      "hyades: 1\nmedia: {water: {scattering: 1}, air: {scattering: 2}, ink: {scattering: 3}, "
      "cloud: {scattering: 1, density: {noise: {scale: 1}}}}\n"
      "materials: {glass: {type: dielectric}, clear: {type: \"null\"}, clay: {type: lambert}}\n" +
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

TEST(Exteriors, OutsideOfAllBodiesIsTheAtmosphere) {
  for (const std::string shape : {"sphere", "box", "cylinder"}) {
    const std::string ball =
        "objects: {ball: {shape: " + shape + ", material: glass, exterior: water}}\n";
    EXPECT_EQ(error_of("atmosphere: water\n" + ball), "none") << shape;
    EXPECT_EQ(
        error_of("atmosphere: air\n" + ball),
        "job.yaml:5:17: object 'ball': its exterior is 'water', but there is 'air' next to it, "
        "expected the same");
    EXPECT_EQ(error_of(ball),
              "job.yaml:4:17: object 'ball': its exterior is 'water', but there is nothing next to "
              "it, expected the same");
  }
}

TEST(Exteriors, WithinABodyIsWhatFillsIt) {
  const std::string pond =
      "objects:\n  pond: {shape: box, size: [9, 9, 9], material: clear, interior: water}\n";
  EXPECT_EQ(error_of(pond + "  ball: {shape: sphere, material: glass, exterior: water}\n"), "none");
  EXPECT_EQ(error_of(pond + "  ball: {shape: sphere, material: glass, exterior: ink}\n"),
            "job.yaml:6:9: object 'ball': its exterior is 'ink', but there is 'water' next to it, "
            "expected the same");
  EXPECT_EQ(error_of("objects:\n  pond: {shape: box, size: [9, 9, 9], material: glass}\n"
                     "  ball: {shape: sphere, material: glass, exterior: ink}\n"),
            "job.yaml:6:9: object 'ball': its exterior is 'ink', but there is nothing next to it, "
            "expected the same");
  EXPECT_EQ(error_of("objects:\n  sky: {shape: box, size: [9, 9, 9], material: clear, interior: "
                     "cloud}\n  ball: {shape: sphere, material: glass, exterior: cloud}\n"),
            "none");
}

TEST(Exteriors, OfBodiesThatReachIntoAnotherAreNotOne) {
  for (const char* at : {"[4.5, 0, 0]", "[-4.5, 0, 0]", "[0, 4.5, 0]", "[0, 0, -4.5]"}) {
    EXPECT_EQ(
        error_of(std::string("objects:\n  pond: {shape: box, size: [9, 9, 9], material: clear, "
                             "interior: water}\n  ball: {shape: sphere, material: glass, "
                             "exterior: water, at: ") +
                 at + "}\n"),
        "job.yaml:6:9: object 'ball': its exterior is 'water', but there is nothing next to "
        "it, expected the same")
        << at;
  }
}

TEST(Priorities, BelongToWhatLightGoesInto) {
  EXPECT_EQ(
      error_of("objects: {a: {shape: box, material: clay, priority: 1}}\n"),
      "job.yaml:4:14: object 'a': it has a priority, but light does not go into it; expected a "
      "material such as dielectric, or an interior");
  EXPECT_EQ(error_of("objects: {a: {shape: box, material: glass, priority: 1}}\n"), "none");
}

}  // namespace
}  // namespace hyades::core
