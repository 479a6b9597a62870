// The surface of bodies that have a medium and no material.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
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
  for (const SceneObject& object : objects) {
    ASSERT_NE(object.body, nullptr) << object.name;
    EXPECT_NE(object.body->medium, nullptr) << object.name;
  }
}

TEST(BodySurface, WithASubsurfaceFillsBodies) {
  const auto scene = scene_of(R"(
materials:
  wax: {type: dielectric, ior: 1.4, subsurface: {color: [0.9, 0.6, 0.4], radius: 0.01, scale: 2}}
  glass: {type: dielectric}
media: {fog: {scattering: 1}}
objects:
  wax: {shape: cylinder, material: wax}
  other: {shape: sphere, material: wax}
  own: {shape: sphere, material: wax, interior: fog}
  glass: {shape: sphere, material: glass}
)");
  ASSERT_TRUE(scene->has_media);
  std::map<std::string, const Medium*> inside;
  for (const SceneObject& object : scene->objects) inside[object.name] = object.body->medium.get();
  EXPECT_NE(inside["wax"], nullptr);
  EXPECT_EQ(inside["wax"], inside["wax/top"]);
  EXPECT_EQ(inside["wax"], inside["other"]);
  EXPECT_NE(inside["own"], inside["wax"]);
  EXPECT_EQ(inside["glass"], nullptr);
  // Of extinction 1 / 0.02 per metre, since g is 0.
  const Ray ray{Vec3(0.0F), Vec3(0.0F, 1.0F, 0.0F), kInfinity, 0.0F};
  EXPECT_NEAR(inside["wax"]->transmittance(ray, 0.02F, Vec4(0.5F)).x, std::exp(-1.0F), 1e-4F);
}

TEST(BodySurface, WithASubsurfaceNeedsAnInside) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  const Job job = parse_job(
      "hyades: 1\nmaterials: {wax: {type: dielectric, subsurface: {radius: 1}}}\n"
      "objects: {sheet: {shape: rectangle, material: wax}}\n",
      "body.yaml", assets, diagnostics);
  ASSERT_EQ(diagnostics.to_string(), "");
  SceneCache cache(assets);
  const auto scene = build_scene(job, 1, cache);
  ASSERT_FALSE(scene);
  EXPECT_EQ(
      scene.error().message,
      "body.yaml:3:18: object 'sheet': material 'wax' has a subsurface, for which it needs an "
      "inside: a mesh, a sphere, a box or a cylinder with caps");
}

}  // namespace
}  // namespace hyades::core
