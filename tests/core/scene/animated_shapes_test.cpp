#include <gtest/gtest.h>

#include <string>

#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "core/scene/flatten.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

/// Sizes that follow the frame; the shutter is open for the whole of it.
constexpr const char* kShapes = R"yaml(
hyades: 1
frames: {range: 1-10, fps: 1, shutter: 1}
outputs: [{file: a.####.exr, layers: [motion]}]
objects:
  ball: {shape: sphere, radius: "= frame"}
  disk: {shape: disk, radius: {keys: {1: 1, 5: 3}}}
  floor: {shape: rectangle, size: ["= frame", 3]}
  crate: {shape: box, size: {keys: {1: [1, 1, 1], 3: [3, 5, 1]}}}
  post: {shape: cylinder, radius: "= 0.1 * frame", height: "= 2 * frame"}
  still: {shape: box}
)yaml";

class AnimatedShapes : public testing::Test {
 protected:
  AnimatedShapes() : cache_(assets_) {
    Diagnostics diagnostics;
    job_ = parse_job(kShapes, "job.yaml", assets_, diagnostics);
    EXPECT_EQ(diagnostics.to_string(), "");
  }

  std::shared_ptr<const Scene> scene_of(int32_t frame) {
    const auto scene = build_scene(job_, frame, cache_);
    EXPECT_TRUE(scene) << scene.error().message;
    return scene ? *scene : nullptr;
  }

  MemoryAssets assets_;
  SceneCache cache_;
  Job job_;
};

Vec3 size_of(const Scene& scene, uint32_t object) {
  return bounds_of(scene.world->placement(object).shape).size();
}

TEST_F(AnimatedShapes, HaveTheSizesOfTheirFrame) {
  for (const int32_t frame : {1, 3}) {
    const auto scene = scene_of(frame);
    ASSERT_NE(scene, nullptr);
    const auto f = static_cast<float>(frame);
    EXPECT_EQ(scene->world->placement(0).shape.radius, f);
    EXPECT_EQ(scene->world->placement(1).shape.radius, frame == 1 ? 1.0F : 2.0F);
    EXPECT_EQ(size_of(*scene, 2), Vec3(f, 0.0F, 3.0F));
    EXPECT_EQ(size_of(*scene, 3), frame == 1 ? Vec3(1.0F) : Vec3(3.0F, 5.0F, 1.0F));
    EXPECT_EQ(scene->world->placement(4).shape.radius, 0.1F * f);
    EXPECT_EQ(scene->world->placement(4).shape.height, 2.0F * f);
  }
}

TEST_F(AnimatedShapes, CapsFollowTheirCylinder) {
  const auto scene = scene_of(4);
  ASSERT_NE(scene, nullptr);
  for (uint32_t i = 5; i < 7; ++i) {
    const Placement& cap = scene->world->placement(i);
    EXPECT_EQ(cap.shape.radius, 0.4F);
    for (const float shutter : {0.0F, 1.0F})
      EXPECT_EQ(scene->world->transform_at(i, shutter)[3].y, i == 5 ? 0.0F : 8.0F);
  }
}

TEST_F(AnimatedShapes, OnlyThoseThatChangeAreMadeAnew) {
  auto flat = flatten_objects(job_, 2, cache_);
  ASSERT_TRUE(flat);
  ASSERT_EQ(flat->size(), 8U);
  for (size_t i = 0; i < flat->size(); ++i)
    EXPECT_EQ((*flat)[i].placement.changes_between_frames, i < 7) << i;
  const std::weak_ptr<const TriangleMesh> crate = (*flat)[3].placement.shape.mesh;
  flat->clear();
  EXPECT_TRUE(crate.expired()) << "old sizes must not pile up";
}

}  // namespace
}  // namespace hyades::core
