// What textures in a job may say, and the files that they are made of.

#include <gtest/gtest.h>

#include "core/base/udim.h"
#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

std::string complaints(const std::string& texture, AssetResolver& assets) {
  Diagnostics diagnostics;
  parse_job("hyades: 1\ntextures: {x: {" + texture + "}}\n", "job.yaml", assets, diagnostics);
  return diagnostics.to_string();
}

std::string complaints(const std::string& texture) {
  MemoryAssets assets;
  return complaints(texture, assets);
}

void expect_said(const std::string& texture, const std::string& said) {
  EXPECT_NE(complaints(texture).find(said), std::string::npos) << complaints(texture);
}

TEST(Udim, TilesAreNumberedByColumnAndRow) {
  EXPECT_TRUE(is_udim("skin.<UDIM>.png"));
  EXPECT_FALSE(is_udim("skin.1001.png"));
  EXPECT_EQ(udim_file("a/skin.<UDIM>.png", 1012), "a/skin.1012.png");
  MemoryAssets assets;
  for (const char* file : {"s.1001.png", "s.1010.png", "s.1100.png", "s.1101.png", "s.1000.png"})
    assets.add(file, "x");
  const auto tiles = udim_tiles(assets, "s.<UDIM>.png");
  ASSERT_TRUE(tiles);
  EXPECT_EQ(*tiles, (std::vector<int>{1001, 1010, 1100}));
}

// All tiles come with the job, and each of them decides its pixels.
TEST(Udim, AllTilesBelongToTheJob) {
  const auto key_of = [](const std::string& content, size_t& count) {
    MemoryAssets inner;
    inner.add("skin.1001.png", "one");
    inner.add("skin.1012.png", content);
    RecordingResolver assets(inner);
    Diagnostics diagnostics;
    const Job job = parse_job("hyades: 1\ntextures: {x: {type: image, file: skin.<UDIM>.png}}\n",
                              "job.yaml", assets, diagnostics);
    EXPECT_EQ(diagnostics.to_string(), "");
    count = assets.records().size();
    return render_key(job, 1, assets.records());
  };
  size_t count = 0;
  const auto key = key_of("two", count);
  EXPECT_EQ(count, 2U);
  EXPECT_EQ(key, key_of("two", count));
  EXPECT_NE(key, key_of("three", count));
}

TEST(Udim, WithoutATileItSaysWhatWasLookedFor) {
  expect_said("type: image, file: skin.<UDIM>.png",
              "skin.<UDIM>.png: no tile exists, expected skin.1001.png to skin.1100.png");
  MemoryAssets assets;
  assets.add("s.1001.png", "x");
  EXPECT_NE(complaints("type: image, file: s.<UDIM>.png, wrap: clamp", assets)
                .find("the tiles of <UDIM> lie side by side"),
            std::string::npos);
}

TEST(Textures, WrapIsOneModeOrTwo) {
  MemoryAssets assets;
  assets.add("a.png", "x");
  EXPECT_EQ(complaints("type: image, file: a.png, wrap: [repeat, clamp]", assets), "");
  for (const char* wrong : {"[repeat]", "[repeat, clamp, mirror]", "[repeat, wound]", "[]"}) {
    EXPECT_NE(complaints("type: image, file: a.png, wrap: " + std::string(wrong), assets)
                  .find("expected one or two of repeat, clamp, mirror or black"),
              std::string::npos)
        << wrong;
  }
}

TEST(Textures, MappingsAreOneWordOrAMap) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  const Job job = parse_job(R"(
hyades: 1
textures:
  a: {type: checker, mapping: world}
  b: {type: fbm3d, mapping: {type: spherical, space: world, transform: [{rotate_y: "= 20 * t"}, {scale: 2}]}}
)",
                            "job.yaml", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  ASSERT_EQ(job.textures.size(), 2U);
  EXPECT_EQ(mapping_of(job.textures[0]).type, "world");
  EXPECT_EQ(mapping_of(job.textures[1]).type, "spherical");
  EXPECT_EQ(mapping_of(job.textures[1]).space, "world");
  EXPECT_EQ(mapping_of(job.textures[1]).transform.size(), 2U);
  expect_said("type: checker, mapping: sideways", "mapping is 'sideways', expected default, uv");
  expect_said("type: checker, mapping: {type: uv, space: world}", "space belongs to the mappings");
  expect_said("type: checker, mapping: {type: planar, blend: 1}", "blend belongs to the mapping");
  expect_said("type: checker, mapping: {at: [1, 2, 3]}", "at");
}

TEST(Textures, StopsAreNumbersWithColours) {
  EXPECT_EQ(
      complaints("type: ramp, input: 0.5, stops: {-1: 0, 0.5: \"#fff\", 2e1: {type: checker}}"),
      "");
  expect_said("type: ramp, input: 0.5, stops: {0: 1}", "stops is a map, expected two or more");
  expect_said("type: ramp, input: 0.5, stops: {0: 1, high: 2}",
              "a stop stands at 'high', expected a number");
  expect_said("type: ramp, input: 0.5, stops: {1: 1, 1.0: 2}", "two stops stand at 1.0");
  expect_said("type: ramp, input: 0.5, stops: {0: 1, 1: blue}", "'blue', which does not exist");
  expect_said("type: ramp, input: x, stops: {0: 1, 1: 2}", "texture 'x' is made of itself");
  expect_said("type: ramp, input: 0.1, stops: {0: 1, 1: x}", "texture 'x' is made of itself");
  expect_said("type: mix, a: 0, b: 1, amount: x", "texture 'x' is made of itself");
}

}  // namespace
}  // namespace hyades::core
