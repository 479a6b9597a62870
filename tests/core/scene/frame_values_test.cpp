#include <gtest/gtest.h>

#include <string>

#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "tests/core/job/test_assets.h"

/// Reading a long job tries some of its frames; every frame is checked before it is built.
namespace hyades::core {
namespace {

/// What building `frame` complains about; a job of 5,000 frames that reading finds nothing in.
std::string complaint(const std::string& body, int32_t frame) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  const Job job = parse_job("hyades: 1\nframes: 1-5000\n" + body, "long.yaml", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  SceneCache cache(assets);
  const auto scene = build_scene(job, frame, cache);
  return scene ? "" : scene.error().message;
}

TEST(FrameValues, AFrameThatReadingDidNotTryIsCheckedWhenItIsBuilt) {
  const std::string camera = "camera: {fov: \"= frame == 3332 ? 200 : 40\"}\n";
  EXPECT_EQ(complaint(camera, 3331), "");
  EXPECT_EQ(complaint(camera, 3332),
            "long.yaml:3:15: fov is 200 at frame 3332, expected a number above 0 and below 180");
  EXPECT_EQ(complaint("objects: {a: {shape: box, emit: {radiance: \"= frame == 3336 ? -1 : "
                      "1\"}}}\n",
                      3336),
            "long.yaml:3:44: radiance is -1 at frame 3336, expected a number >= 0");
  EXPECT_EQ(complaint("lights: {s: {type: sun, direction: [0, \"= frame == 3336 ? 0 : -1\", "
                      "0]}}\n",
                      3336),
            "long.yaml:3:36: direction is [0, 0, 0] at frame 3336, expected a direction, not "
            "[0, 0, 0]");
}

}  // namespace
}  // namespace hyades::core
