#include <gtest/gtest.h>

#include <string>

#include "core/base/elementary.h"
#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

std::shared_ptr<const Scene> sky_scene(const std::string& sky, int32_t frame = 1) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  const Job job = parse_job("hyades: 1\nframes: 1-10\nenvironment: {" + sky + "}\n", "sky.yaml",
                            assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  SceneCache cache(assets);
  const auto scene = build_scene(job, frame, cache);
  EXPECT_TRUE(scene);
  return *scene;
}

/// The direction towards the sun's disc.
Vec3 towards_sun(const Scene& scene) {
  EXPECT_EQ(scene.light_names, (std::vector<std::string>{"environment", "sun"}));
  return scene.lights[1]->sample_direct({}, 0.0F, 0.0F, Vec2(0.5F))->direction;
}

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT(glm::length(a - b), 0.01F) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(SkyScene, HasItsSunWhereTheJobSays) {
  const float s = std::sqrt(0.5F);
  expect_near(towards_sun(*sky_scene("sky: {elevation: 45}")), {0, s, -s});
  expect_near(towards_sun(*sky_scene("sky: {elevation: 45, azimuth: 90}")), {-s, s, 0});
  expect_near(towards_sun(*sky_scene("sky: {elevation: 45, azimuth: 60}, rotate_y: 30")),
              {-s, s, 0});
  expect_near(towards_sun(*sky_scene("sky: {sun_direction: [3, 4, 0]}")), {0.6F, 0.8F, 0.0F});
  expect_near(towards_sun(*sky_scene("sky: {elevation: {keys: {1: 0, 10: 90}}}", 10)), {0, 1, 0});
}

TEST(SkyScene, IsBrightestAroundTheSun) {
  for (const char* azimuth : {"0", "70", "200"}) {
    const auto scene = sky_scene(std::string("sky: {elevation: 20, azimuth: ") + azimuth + "}");
    const Vec3 sun = towards_sun(*scene);
    const auto sky = [&](const Vec3& d) {
      return luminance(scene->lights[0]->radiance({}, -glm::normalize(d)));
    };
    const float there = sky(sun + Vec3(0.0F, 0.08F, 0.0F));
    EXPECT_GT(there, 2.0F * sky({-sun.x, sun.y + 0.08F, -sun.z}));
    EXPECT_GT(there, 1.5F * sky({sun.z, sun.y + 0.08F, -sun.x}));
    EXPECT_GT(there, 1.5F * sky({-sun.z, sun.y + 0.08F, sun.x}));
  }
}

TEST(SkyScene, CanBeWithoutItsSun) {
  EXPECT_EQ(sky_scene("sky: {sun: false}")->lights.size(), 1U);
  EXPECT_EQ(sky_scene("sky: {elevation: -5}")->lights.size(), 1U);
}

TEST(SkyScene, ScalesSkyAndSun) {
  const auto one = sky_scene("sky: {elevation: 30}");
  const auto two =
      sky_scene("sky: {elevation: 30, irradiance: 2}, strength: 4, color: [1, 0.5, 1]");
  for (size_t i = 0; i < 2; ++i) {
    const auto a = one->lights[i]->sample_direct({}, 0.0F, 0.0F, Vec2(0.3F));
    const auto b = two->lights[i]->sample_direct({}, 0.0F, 0.0F, Vec2(0.3F));
    ASSERT_TRUE(a && b);
    EXPECT_NEAR(b->radiance.x / a->radiance.x, 2.0F, 1e-4F);
    EXPECT_NEAR(b->radiance.y / a->radiance.y, 1.0F, 1e-4F);
  }
}

/// Three ways of saying a third of a turn about y.
TEST(Transforms, TurnByQuaternionsAsByAngles) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  const Job job = parse_job(R"yaml(
hyades: 1
frames: 1-9
objects:
  a: {shape: box, transform: [{rotate_y: 120}]}
  b: {shape: box, transform: [{rotate: {quaternion: [0, 0.8660254, 0, 0.5]}}]}
  c: {shape: box, transform: [{rotate: {quaternion: {keys: {1: [0, 0, 0, 1], 9: [0, 1, 0, 0]}}}}]}
  d: {shape: box, transform: [{rotate: {axis: [1, 2, 3], angle: 50}}]}
  e: {shape: box, transform: [{rotate: {quaternion: [0.22589, 0.45178, 0.67767, 1.81262]}}]}
)yaml",
                            "turns.yaml", assets, diagnostics);
  ASSERT_EQ(diagnostics.to_string(), "");
  SceneCache cache(assets);
  const auto at = [&](int32_t frame) { return *build_scene(job, frame, cache); };
  const auto matrix = [](const Scene& scene, uint32_t i) {
    return scene.world->placement(i).to_world[0];
  };
  const auto expect_same = [](const Mat4& a, const Mat4& b) {
    for (int c = 0; c < 4; ++c) EXPECT_LT(glm::length(a[c] - b[c]), 1e-4F);
  };
  const auto first = at(1);
  expect_same(matrix(*first, 0), matrix(*first, 1));
  expect_same(matrix(*first, 3), matrix(*first, 4));
  // 180 degrees over eight frames: 90 at the fifth.
  const auto middle = at(5);
  expect_same(matrix(*middle, 2),
              Mat4(Vec4(0, 0, -1, 0), Vec4(0, 1, 0, 0), Vec4(1, 0, 0, 0), Vec4(0, 0, 0, 1)));
}

}  // namespace
}  // namespace hyades::core
