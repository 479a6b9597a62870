// The surface of bodies that have a medium and no material.

#include <gtest/gtest.h>

#include <string>

#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

std::shared_ptr<const Scene> scene_of(const std::string& text) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  const Job job = parse_job("hyades: 1\n" + text, "body.yaml", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  SceneCache cache(assets);
  auto scene = build_scene(job, 1, cache);
  EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
  return *scene;
}

TEST(BodySurface, IsTheMediumsOwnWhereThereIsNoMaterial) {
  const auto scene = scene_of(R"(
materials: {clay: {type: lambert}}
media:
  milk: {preset: whole-milk}
  air: {scattering: 1, index: 1}
  fog: {scattering: 1}
objects:
  milk: {shape: sphere, interior: milk}
  air: {shape: sphere, interior: air}
  fog: {shape: sphere, interior: fog}
  clay: {shape: sphere, interior: milk, material: clay}
  group: {material: clay, group: {objects: {inherited: {shape: sphere, interior: milk}}}}
)");
  const auto& objects = scene->objects;
  ASSERT_EQ(objects.size(), 5U);
  EXPECT_TRUE(objects[0].material->leads_inside());
  EXPECT_FALSE(objects[0].material->is_null());
  EXPECT_TRUE(objects[1].material->is_null());
  for (const size_t opaque : {2, 3, 4}) {
    EXPECT_FALSE(objects[opaque].material->leads_inside()) << opaque;
  }
  for (const SceneObject& object : objects) EXPECT_NE(object.interior, nullptr) << object.name;
}

}  // namespace
}  // namespace hyades::core
