// Copies of a group at the places of a file, from a job's text to a scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "core/scene/build_scene.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

using testing::HasSubstr;

constexpr const char* kPlaces =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nproperty float scale\nend_header\n0 0 0 1\n10 0 0 2\n0 0 -10 0.5\n";

constexpr const char* kGroups = R"yaml(
units: 0.5
frames: 1-10
materials: {bark: {type: lambert}, leaf: {type: lambert, color: 0.2}, glass: {type: dielectric}}
media: {milk: {scattering: 1}, fog: {scattering: 1, density: {noise: {scale: 2}}}}
groups:
  tree:
    objects:
      trunk: {mesh: trunk.obj, material: bark}
      crown: {shape: sphere, radius: 0.5, at: [0, 1, 0], material: leaf}
  lamp: {objects: {bulb: {shape: sphere, emit: {radiance: 1}}}}
  pond: {objects: {water: {shape: sphere, material: glass, interior: fog}}}
  drops: {objects: {drop: {shape: sphere, material: glass, interior: milk}}}
  copse: {objects: {trees: {instance: tree, places: forest.ply}}}
)yaml";

class Copies : public testing::Test {
 protected:
  Copies() : records_(assets_) {
    assets_.add("forest.ply", kPlaces);
    assets_.add("trunk.obj", "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nf 1 2 3 4\n");
  }

  std::shared_ptr<const Scene> scene_of(const std::string& objects, int32_t frame = 1) {
    Diagnostics diagnostics;
    job_ = parse_job("hyades: 1\n" + std::string(kGroups) + "objects:\n" + objects, "d.yaml",
                     records_, diagnostics);
    error_ = diagnostics.to_string();
    if (!diagnostics.empty()) return nullptr;
    auto scene = build_scene(job_, frame, cache_);
    if (!scene) error_ = scene.error().message;
    return scene ? *scene : nullptr;
  }

  static Ray down(float x, float z) {
    return {{x, 20.0F, z}, {0.0F, -1.0F, 0.0F}, kInfinity, 0.0F};
  }

  MemoryAssets assets_;
  RecordingResolver records_;
  SceneCache cache_{assets_};
  Job job_;
  std::string error_;
};

TEST_F(Copies, StandAtTheirPlacesInTheJobsUnit) {
  const auto scene = scene_of("  forest: {instance: tree, places: forest.ply, at: [0, 2, 0]}\n");
  ASSERT_NE(scene, nullptr) << error_;
  ASSERT_EQ(scene->objects.size(), 2U);
  EXPECT_EQ(scene->objects[0].name, "forest/trunk");
  EXPECT_EQ(scene->objects[1].name, "forest/crown");
  EXPECT_EQ(scene->triangles, 6U);
  const auto top = [&](float x, float z) {
    SurfacePoint p;
    return scene->world->nearest(down(x, z), RayKind::camera, p) ? p.position.y : -1.0F;
  };
  // The crown ends at 1.5 times the copy's scale over its place.
  EXPECT_NEAR(top(0.0F, 0.0F), 0.5F * (2.0F + 1.5F), 1e-5F);
  EXPECT_NEAR(top(5.0F, 0.0F), 0.5F * (2.0F + 3.0F), 1e-5F);
  EXPECT_NEAR(top(0.0F, -5.0F), 0.5F * (2.0F + 0.75F), 1e-5F);
  EXPECT_NEAR(top(5.0F, 0.9F), 1.0F, 1e-5F);  // the trunk of the large one
  EXPECT_EQ(top(2.5F, 0.0F), -1.0F);
}

TEST_F(Copies, TakeOverridesAndMaterialsOfTheGroup) {
  const auto scene =
      scene_of("  forest: {instance: tree, places: forest.ply, override: {leaf: bark}}\n");
  ASSERT_NE(scene, nullptr) << error_;
  EXPECT_EQ(scene->objects[1].material_name, "bark");
}

TEST_F(Copies, MoveAsAWhole) {
  const auto scene = scene_of(
      "  forest: {instance: tree, places: forest.ply, at: [\"= 2 * (frame - 1)\", 0, 0]}\n", 3);
  ASSERT_NE(scene, nullptr) << error_;
  SurfacePoint p;
  ASSERT_TRUE(scene->world->nearest(down(2.0F, 0.0F), RayKind::camera, p));
  EXPECT_NEAR(p.position.y, 0.75F, 1e-5F);
}

TEST_F(Copies, TheFileTravelsWithTheJobAndDecidesTheFrame) {
  ASSERT_NE(scene_of("  forest: {instance: tree, places: forest.ply}\n"), nullptr) << error_;
  auto records = records_.records();
  const std::string before = render_key(job_, 1, records);
  bool found = false;
  for (AssetRecord& record : records) {
    if (record.reference != "forest.ply") continue;
    found = true;
    record.sha256 = "other";
  }
  EXPECT_TRUE(found);
  EXPECT_NE(render_key(job_, 1, records), before);
}

TEST_F(Copies, WhatTheyCannotDoIsRefused) {
  EXPECT_EQ(scene_of("  lamps: {instance: lamp, places: forest.ply}\n"), nullptr);
  EXPECT_THAT(error_, HasSubstr("object 'lamps': 'lamps/bulb' gives off light"));
  EXPECT_EQ(scene_of("  ponds: {instance: pond, places: forest.ply}\n"), nullptr);
  EXPECT_THAT(error_, HasSubstr("'fog', which varies"));
  EXPECT_NE(scene_of("  rain: {instance: drops, places: forest.ply}\n"), nullptr) << error_;
  EXPECT_EQ(scene_of("  woods: {instance: copse, places: forest.ply}\n"), nullptr);
  EXPECT_THAT(error_, HasSubstr("copied in their turn"));
  EXPECT_NE(scene_of("  woods: {instance: copse}\n"), nullptr) << error_;
  EXPECT_EQ(scene_of("  forest: {instance: tree, places: none.ply}\n"), nullptr);
  EXPECT_THAT(error_, HasSubstr("none.ply"));
  assets_.add("broken.ply", std::string(kPlaces).substr(0, 140));
  EXPECT_EQ(scene_of("  forest: {instance: tree, places: broken.ply}\n"), nullptr);
  EXPECT_THAT(error_, HasSubstr("object 'forest': broken.ply: "));
}

}  // namespace
}  // namespace hyades::core
