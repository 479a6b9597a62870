// Paths in words.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "core/job/layers.h"
#include "core/render/frame_renderer.h"
#include "tests/core/integrators/scene_of.h"

namespace hyades::core {
namespace {

TEST(Replay, TellsBothPathsOfBdptAndAllThatTheyBring) {
  const TestScene test(R"yaml(
film: {size: [24, 16]}
sampling: {samples: 16, seed: 3}
integrator: {type: bdpt, max_depth: 6}
camera: {look_from: [0, 1, 4], look_at: [0, 0.5, 0], fov: 40}
objects:
  floor: {shape: rectangle, size: [4, 4]}
  lamp: {shape: rectangle, size: [1, 1], transform: [{rotate_x: 180}], at: [0, 2, 0], emit: {radiance: 5}}
)yaml");
  const FrameRenderer renderer(test.scene, test.job, 1, needed_layers(test.job));
  bool lamp = false;
  bool floor = false;
  for (uint32_t sample = 0; sample < 16; ++sample) {
    PathLog log;
    const PixelSample result = renderer.replay({12, 9}, sample, log);
    Vec3 sum(0.0F);
    for (const std::string& line : log.lines) {
      int s = 0;
      int t = 0;
      Vec3 light(0.0F);
      if (std::sscanf(line.c_str(), "strategy (%d, %d) brings (%f, %f, %f)", &s, &t, &light.x,
                      &light.y, &light.z) == 5 &&
          t > 1) {
        sum += light;
      }
      lamp = lamp || line.find("1: begins at the light 'lamp' at (") != std::string::npos;
      floor = floor || line.find("2: meets 'floor' at (") != std::string::npos;
    }
    EXPECT_NEAR(sum.x, result.radiance.x, 1e-4F * (1.0F + result.radiance.x)) << sample;
  }
  EXPECT_TRUE(lamp);
  EXPECT_TRUE(floor);
}

}  // namespace
}  // namespace hyades::core
