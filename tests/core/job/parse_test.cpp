#include <gtest/gtest.h>

#include "core/job/parse.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

// Jobs without a name are called like their files, and two files never alike.
TEST(ParseJob, IsCalledLikeItsFile) {
  const auto name_of = [](const std::string& file) {
    MemoryAssets assets;
    Diagnostics diagnostics;
    return parse_job("hyades: 1\n", file, assets, diagnostics).name;
  };
  EXPECT_EQ(name_of("a/shot 1.yaml"), "shot 1");
  EXPECT_EQ(name_of("shot (1).yaml"), "shot _1_");
  EXPECT_EQ(name_of("shot (2).yaml"), "shot _2_");
  EXPECT_EQ(name_of("it's.yaml"), "it_s");
  EXPECT_EQ(name_of("-x.yaml"), "_x");
  EXPECT_EQ(name_of("(.yaml"), "_");
  EXPECT_EQ(name_of("trail .yaml"), "trail");
  EXPECT_EQ(name_of(std::string(120, 'a') + ".yaml"), std::string(100, 'a'));
  EXPECT_EQ(name_of(std::string(99, 'a') + "\u00e4b.yaml"), std::string(99, 'a'));
  EXPECT_EQ(name_of(" .yaml"), "job");
}

TEST(ParseJob, ReadsTheExampleOfTheDesign) {
  MemoryAssets assets;
  assets.add("meshes/flask.ply", "ply");
  assets.add("sky/dusk.hdr", "hdr");
  Diagnostics diagnostics;
  const Job job = parse_job(R"yaml(hyades: 1
name: perlin-sphere
frames: {range: 1-120, fps: 24, shutter: 0.5}          # t = (frame - 1) / fps
film: {size: [960, 540], filter: {type: blackman-harris, radius: 1.5}}
sampling: {samples: 256, seed: 7}
integrator: {type: path, max_depth: 32}
camera:
  look_from: [0, 1.6, 6]
  look_at: {keys: {1: [0, 1, 0], 120: [0.5, 1, 0]}, ease: smooth}
  fov: 35                                              # vertical
  aperture: {f_stop: 2.8, blades: 7}
  focus: ball                                          # an object, or a distance
textures:
  swell: {type: perlin4d, scale: 3, octaves: 4, time: "= 0.5 * t"}
  tiles: {type: checker, scale: 8, a: 0.05, b: "#d8c8a8"}
materials:
  chrome: {type: conductor, metal: silver, roughness: 0.1, bump: {texture: swell, height: 0.02}}
  floor:  {type: glossy, color: tiles, reflectiveness: 0.3, glossiness: 0.8}
  glass:  {type: dielectric, ior: 1.5}
objects:
  ground: {shape: rectangle, size: [40, 40], material: floor}
  ball:   {shape: sphere, radius: 1, at: [0, 1, 0], material: chrome}
  flask:
    mesh: meshes/flask.ply
    material: glass
    transform: [{scale: 0.01}, {rotate_y: "= 30 * t"}, {translate: [2, 0, 0]}]
  lamp:   {shape: sphere, radius: 0.2, at: ["= 3 * cos(t)", 3, "= 3 * sin(t)"],
           emit: {color: 3200K, power: 60}}
environment: {image: sky/dusk.hdr, rotate_y: 90, strength: 0.5}
outputs:
  - {file: perlin.####.exr, layers: [beauty, albedo, normal, variance]}
  - {file: perlin.####.png, tone_map: filmic, exposure: 0.5}
)yaml",
                            "perlin.yaml", assets, diagnostics);
  ASSERT_EQ(diagnostics.to_string(), "");
  EXPECT_EQ(job.name, "perlin-sphere");
  EXPECT_EQ(job.frames.last, 120);
  EXPECT_FLOAT_EQ(job.frames.shutter, 0.5F);
  EXPECT_EQ(job.film.width, 960);
  EXPECT_EQ(job.sampling.samples, 256U);
  EXPECT_EQ(job.camera.focus_object, "ball");
  ASSERT_TRUE(job.camera.aperture.f_stop.has_value());
  EXPECT_EQ(job.camera.aperture.blades, 7);
  EXPECT_FLOAT_EQ(job.camera.look_at.at(job.time_of(120)).x, 0.5F);
  EXPECT_FLOAT_EQ(job.camera.look_at.at(job.time_of(1)).x, 0.0F);
  ASSERT_EQ(job.textures.size(), 2U);
  const auto& noise = std::get<textures::Perlin4d>(job.textures[0].kind);
  EXPECT_FLOAT_EQ(noise.time.at(job.time_of(49)), 1.0F);
  EXPECT_EQ(noise.octaves, 4);
  const auto& checker = std::get<textures::Checker>(job.textures[1].kind);
  EXPECT_NEAR(checker.b.value.constant.x, 0.6867F, 1e-3F);
  ASSERT_EQ(job.materials.size(), 3U);
  EXPECT_EQ(std::get<ConductorDesc>(job.materials[0].kind).metal, "silver");
  ASSERT_TRUE(job.materials[0].bump.has_value());
  EXPECT_EQ(job.materials[0].bump->texture, "swell");
  EXPECT_EQ(std::get<GlossyDesc>(job.materials[1].kind).color.texture, "tiles");
  ASSERT_EQ(job.objects.size(), 4U);
  EXPECT_EQ(job.objects[2].mesh, "meshes/flask.ply");
  ASSERT_EQ(job.objects[2].transform.size(), 3U);
  EXPECT_FLOAT_EQ(job.objects[2].transform[1].angle.at(job.time_of(25)), 30.0F);
  EXPECT_NEAR(job.objects[3].at.at(job.time_of(1)).x, 3.0F, 1e-6F);
  ASSERT_TRUE(job.objects[3].emit.has_value());
  EXPECT_EQ(job.objects[3].emit->unit, EmitDesc::Unit::power);
  ASSERT_TRUE(job.environment.has_value());
  EXPECT_EQ(job.environment->image, "sky/dusk.hdr");
  ASSERT_EQ(job.outputs.size(), 2U);
  EXPECT_EQ(job.outputs[1].tone_map, "filmic");
}

}  // namespace
}  // namespace hyades::core
