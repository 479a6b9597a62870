// Bodies that the camera does not see: light paths that are joined to the lens cannot tell what is
// around the camera's way then.

#include <gtest/gtest.h>

#include <string>

#include "core/job/parse.h"
#include "core/scene/build_scene.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

std::string error_of(const std::string& integrator, const std::string& ball) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  const Job job =
      parse_job("hyades: 1\nintegrator: " + integrator +
                    "\nmedia: {fog: {scattering: 1}}\nmaterials: {air: {type: "
                    "\"null\"}, glass: {type: dielectric}, skin: {type: "
                    "dielectric, subsurface: {radius: 0.1}}}\nobjects:\n  ball: {shape: sphere, " +
                    ball + "}\n",
                "job.yaml", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  SceneCache cache(assets);
  const auto scene = build_scene(job, 1, cache);
  return scene ? "none" : scene.error().message;
}

TEST(HiddenBodies, WithAnInteriorAreRefusedWhereLightPathsSplat) {
  const std::string body = "material: air, interior: fog, visible_to_camera: false";
  for (const char* integrator : {"bdpt", "mlt", "{type: mlt, over: bdpt}"}) {
    EXPECT_EQ(error_of(integrator, body),
              "job.yaml:6:9: object 'ball': it is not visible to the camera but has an interior, "
              "which light paths would show; expected visible_to_camera: true, or integrator: path")
        << integrator;
  }
  EXPECT_EQ(error_of("path", body), "none");
  EXPECT_EQ(error_of("bdpt", "material: air, interior: fog"), "none");
  EXPECT_EQ(error_of("bdpt", "visible_to_camera: false"), "none");
}

TEST(HiddenBodies, AreRefusedWhereRaysWouldNotComeOutOfThem) {
  const std::string filled =
      "job.yaml:6:9: object 'ball': it has an interior or a subsurface, which all rays but the "
      "camera's must see; expected visible_to_diffuse, _glossy, _transmission, _volume and "
      "_shadow: true";
  for (const std::string ray : {"diffuse", "glossy", "transmission", "volume", "shadow"}) {
    const std::string off = ", visible_to_" + ray + ": false";
    EXPECT_EQ(error_of("path", "material: air, interior: fog" + off), filled);
    const bool glassy = ray == "transmission";
    const std::string glass =
        "job.yaml:6:9: object 'ball': light goes into it and must come out again; expected "
        "visible_to_transmission: true";
    EXPECT_EQ(error_of("path", "material: skin" + off), glassy ? glass : filled);
    EXPECT_EQ(error_of("path", "material: glass" + off), glassy ? glass : "none");
  }
}

}  // namespace
}  // namespace hyades::core
