#include "core/scene/media_around.h"

#include <gtest/gtest.h>

#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

/// What is around the beginnings of a camera's rays, from the left edge of the picture to the
/// right one: how many bodies, as digits. A tank of ink stands in the camera's plane, left of its
/// middle, and moves to the right by the picture's width while the shutter is open.
std::string around(const std::string& camera, float time) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  const Job job = parse_job(
      "hyades: 1\nframes: {range: 1, fps: 1, shutter: 1}\nfilm: {size: [4, 1]}\n"
      "camera: {" +
          camera +
          "look_from: [0, 0, 3], look_at: [0, 0, 0]}\n"
          "media: {ink: {absorption: 1}}\nmaterials: {air: {type: \"null\"}}\n"
          "objects:\n  tank: {shape: box, size: [2, 2, 2], at: [\"= -1 + 4 * t\", 0, 3], "
          "material: air, interior: ink}\n",
      "job.yaml", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  SceneCache cache(assets);
  const auto scene = build_scene(job, 1, cache);
  EXPECT_TRUE(scene) << scene.error().message;
  if (!scene) return "";
  std::string found;
  for (int x = 0; x < 4; ++x) {
    const Ray ray =
        (*scene)->camera->generate({static_cast<float>(x) + 0.4F, 0.5F}, Vec2(0.5F), time);
    found += bodies_around_lens(**scene, ray).empty() ? '0' : '1';
  }
  return found;
}

TEST(MediaAround, EachRayOfAnOrthographicCameraBeginsInWhatIsAroundItsBeginning) {
  EXPECT_EQ(around("type: orthographic, height: 1, ", 0.0F), "1100");
  EXPECT_EQ(around("type: orthographic, height: 1, ", 0.5F), "0011");
  EXPECT_EQ(around("type: orthographic, height: 1, ", 1.0F), "0000");
}

TEST(MediaAround, AllRaysOfAPerspectiveCameraBeginInWhatIsAroundItsEye) {
  EXPECT_EQ(around("", 0.0F), around("", 0.5F));
}

}  // namespace
}  // namespace hyades::core
