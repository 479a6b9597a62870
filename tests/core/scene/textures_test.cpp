// Textures of a job as the scene makes them.

#include <gtest/gtest.h>

#include "core/job/parse.h"
#include "core/scene/appearance.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

/// A Radiance file of two grey pixels side by side, of radiance 2^left and 2^right.
std::string greys(int left, int right) {
  std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
  for (const int n : {left, right}) file += {'\x80', '\x80', '\x80', static_cast<char>(129 + n)};
  return file;
}

struct Made {
  explicit Made(const std::string& texture, float units = 1.0F, int frame = 1) {
    MemoryAssets assets;
    assets.add("skin.1001.hdr", greys(0, 1));
    assets.add("skin.1013.hdr", greys(3, 4));
    Diagnostics diagnostics;
    job = parse_job("hyades: 1\nframes: {range: 1-25, fps: 24}\ntextures: {x: {" + texture + "}}\n",
                    "job.yaml", assets, diagnostics);
    EXPECT_EQ(diagnostics.to_string(), "");
    job.units = units;
    SceneCache cache(assets);
    Appearance looks(job, job.time_of(frame), cache);
    auto made = looks.texture("x");
    EXPECT_TRUE(made) << made.error().message;
    if (made) result = *made;
  }
  float at(const Vec3& place) const {
    return result->scalar({.uv = Vec2(place), .object = place, .world = place});
  }

  Job job;
  TexturePtr result;
};

TEST(SceneTextures, UdimTilesLieInTheirSquares) {
  const Made skin("type: image, file: skin.<UDIM>.hdr");
  EXPECT_FLOAT_EQ(skin.at({0.25F, 0.5F, 0}), 1.0F);
  EXPECT_FLOAT_EQ(skin.at({0.75F, 0.5F, 0}), 2.0F);
  EXPECT_FLOAT_EQ(skin.at({2.25F, 1.5F, 0}), 8.0F);
  EXPECT_FLOAT_EQ(skin.at({2.75F, 1.5F, 0}), 16.0F);
  EXPECT_EQ(skin.at({1.5F, 2.5F, 0}), 0.0F);
  EXPECT_EQ(skin.at({1.5F, 0.5F, 0}), 0.0F);
  const Made alpha("type: image, file: skin.<UDIM>.hdr, channel: alpha");
  EXPECT_EQ(alpha.at({2.5F, 1.5F, 0}), 1.0F);
  EXPECT_EQ(alpha.at({1.5F, 0.5F, 0}), 0.0F);
}

const std::string kGradient = "type: gradient, shape: linear, ";

TEST(SceneTextures, TransformsMoveThePlaceBeforeItIsScaled) {
  const Made moved(kGradient +
                   "mapping: {type: object, transform: [{translate: [0.25, 0, 0]}, {scale: 0.5}]}, "
                   "scale: 0.5, offset: 0.125");
  EXPECT_FLOAT_EQ(moved.at({0.75F, 0, 0}), 0.5F * (0.5F * (0.75F + 0.25F)) + 0.125F);
  const Made turned(kGradient + "mapping: {type: object, transform: [{rotate_z: \"= -90 * t\"}]}",
                    1.0F, 25);  // t = 1: y becomes x
  EXPECT_NEAR(turned.at({0.1F, 0.6F, 0}), 0.6F, 1e-6F);
}

// World positions are in metres, a job's lengths in its own unit; object space is the shape's own.
TEST(SceneTextures, WorldMappingsAreInTheUnitOfTheJob) {
  const std::string moved = "transform: [{translate: [0.25, 0, 0]}]}";
  EXPECT_FLOAT_EQ(Made(kGradient + "mapping: {type: world, " + moved, 0.01F).at({0.005F, 0, 0}),
                  0.75F);
  EXPECT_FLOAT_EQ(Made(kGradient + "mapping: {type: object, " + moved, 0.01F).at({0.5F, 0, 0}),
                  0.75F);
  EXPECT_FLOAT_EQ(
      Made(kGradient + "mapping: {type: planar, space: world, " + moved, 0.01F).at({0.005F, 0, 0}),
      0.75F);
}

TEST(SceneTextures, ProjectionsStartFromTheirSpace) {
  const Made around(kGradient + "mapping: {type: cylindrical}");
  EXPECT_NEAR(around.at({0, 5, -2}), 0.25F, 1e-6F);
  const Made box(kGradient + "mapping: triplanar");
  EXPECT_NEAR(box.at({0.25F, 0.5F, -0.5F}), (0.5F + 0.25F + 0.25F) / 3.0F, 1e-6F);
}

TEST(SceneTextures, NumbersOfPatternsFollowTime) {
  const Vec3 place(0.31F, 1.42F, 1.56F);
  const std::string brick = "type: brick, softness: 0.9, ";
  const std::string lines = "type: stripes, softness: 0.9, ";
  const std::string ramp = "input: {type: gradient, mapping: object}, ";
  for (const std::string& texture :
       {brick + "mortar", brick + "shift", std::string("type: brick, mortar: 0.2, softness"),
        lines + "width", std::string("type: cellular, jitter"), std::string("type: fbm3d, gain"),
        "type: threshold, level: 0.3, " + ramp + "softness"}) {
    const auto with = [&](const std::string& value, int frame) {
      return Made(texture + ": " + value, 1.0F, frame).at(place);
    };
    EXPECT_EQ(with("\"= 0.25 + 0.5 * t\"", 1), with("0.25", 1)) << texture;
    EXPECT_EQ(with("\"= 0.25 + 0.5 * t\"", 25), with("0.75", 1)) << texture;
    EXPECT_NE(with("0.25", 1), with("0.75", 1)) << texture;
  }
  EXPECT_EQ(Made("type: fbm3d, lacunarity: \"= 2 + t\"", 1.0F, 25).at(place),
            Made("type: fbm3d, lacunarity: 3").at(place));
  EXPECT_NE(Made("type: fbm3d, lacunarity: 2").at(place),
            Made("type: fbm3d, lacunarity: 3").at(place));
}

TEST(SceneTextures, TimeMakesFourDimensions) {
  const Vec3 place(0.3F, 0.4F, 0.6F);
  for (const std::string type : {"turbulence", "ridged", "marble", "wood", "cellular"}) {
    const float still = Made("type: " + type).at(place);
    EXPECT_EQ(still, Made("type: " + type, 1.0F, 25).at(place));
    EXPECT_NE(Made("type: " + type + ", time: \"= t\"").at(place),
              Made("type: " + type + ", time: \"= t\"", 1.0F, 25).at(place))
        << type;
  }
}

}  // namespace
}  // namespace hyades::core
