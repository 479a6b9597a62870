// Keys of materials get to what is made of them.
#include <gtest/gtest.h>

#include <string>

#include "core/job/parse.h"
#include "core/materials/shaded_surface.h"
#include "core/scene/build_scene.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

/// The material of a ball, by the keys that it has in a job.
MaterialPtr material(const std::string& keys) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  const Job job = parse_job(
      "hyades: 1\ntextures: {slope: {type: fbm3d, scale: 3, offset: [0.2, 0.3, 0.4]}}\nmaterials: "
      "{m: {" +
          keys + "}}\nobjects: {ball: {shape: sphere, material: m}}\n",
      "job.yaml", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  SceneCache cache(assets);
  const auto scene = build_scene(job, job.frames.first, cache);
  EXPECT_TRUE(scene) << scene.error().message;
  return (*scene)->objects[0].material;
}

/// What radiance straight through a surface of a material is multiplied by, seen from outside.
float through(const std::string& keys) {
  const MaterialPtr made = material(keys);
  BsdfArena arena;
  SurfacePoint point;
  point.outside_index = 1.0F;
  const ShadedSurface surface(point, *made, arena);
  const auto sample =
      surface.sample({0.0F, 0.0F, 1.0F}, 1.0F - 0x1p-24F, {0.5F, 0.5F}, TransportMode::radiance);
  EXPECT_TRUE(sample && sample->transmitted) << keys;
  return sample ? sample->weight.x : 0.0F;
}

TEST(MaterialKeys, GlassScalesRadianceUnlessItShallNot) {
  for (const std::string glass :
       {"type: dielectric, ior: 1.5",
        "type: principled, base_color: 1, roughness: 0, ior: 1.5, transmission: 1"}) {
    EXPECT_NEAR(through(glass), 1.0F / 2.25F, 1e-5F) << glass;
    EXPECT_NEAR(through(glass + ", scale_radiance: true"), 1.0F / 2.25F, 1e-5F) << glass;
    EXPECT_NEAR(through(glass + ", scale_radiance: false"), 1.0F, 1e-5F) << glass;
  }
}

TEST(MaterialKeys, BumpsAreAsStrongAsTheySay) {
  const auto normal = [](const std::string& strength) {
    const MaterialPtr made =
        material("type: lambert, bump: {texture: slope, height: 1" + strength + "}");
    BsdfArena arena;
    const SurfacePoint point;
    return ShadedSurface(point, *made, arena).frame().n;
  };
  const Vec3 whole = normal("");
  EXPECT_LT(whole.z, 0.9F);
  EXPECT_EQ(normal(", strength: 0"), Vec3(0.0F, 0.0F, 1.0F));
  const Vec3 half = glm::normalize(0.5F * whole + 0.5F * Vec3(0.0F, 0.0F, 1.0F));
  EXPECT_LT(glm::distance(normal(", strength: 0.5"), half), 1e-6F);
}

}  // namespace
}  // namespace hyades::core
