#include <gtest/gtest.h>

#include "core/job/layers.h"
#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "tests/core/job/test_assets.h"

// What outputs ask of a film, layer by layer and group by group.

namespace hyades::core {
namespace {

struct ReadLayers {
  Job job;
  std::string complaints;
};

ReadLayers read_layers(const std::string& body) {
  MemoryAssets assets;
  Diagnostics diagnostics;
  Job job = parse_job("hyades: 1\nname: a\n" + body, "shot.yaml", assets, diagnostics);
  return {std::move(job), diagnostics.to_string()};
}

const std::string kLights = R"(
lights:
  bulb: {type: point, light_group: key}
  spot: {type: spot, light_group: fill, at: [0, 3, 0]}
  sun: {type: sun}
environment: {color: 1, light_group: sky}
objects:
  all:
    group: {objects: {lamp: {shape: sphere, emit: {radiance: 3, light_group: lamps}}}}
)";

TEST(OutputLayers, SayWhatAFilmHolds) {
  const ReadLayers all =
      read_layers(kLights +
                  "outputs: [{file: a.exr, layers: [position, motion, components, "
                  "light_groups, crypto_object]}]\n");
  ASSERT_EQ(all.complaints, "");
  const LayerSet layers = needed_layers(all.job);
  EXPECT_TRUE(layers.position && layers.motion && layers.ids[0]);
  EXPECT_FALSE(layers.ids[1] || layers.depth || layers.albedo);
  for (const bool component : layers.components) EXPECT_TRUE(component);
  EXPECT_EQ(layers.light_groups, (std::vector<std::string>{"fill", "key", "lamps", "rest", "sky"}));

  const ReadLayers some =
      read_layers(kLights +
                  "outputs: [{file: a.exr, layers: [glossy_indirect, 'light_group:key']}, "
                  "{file: a.png, layer: material_id}]\n");
  ASSERT_EQ(some.complaints, "");
  const LayerSet few = needed_layers(some.job);
  EXPECT_EQ(layers_text(few), "glossy_indirect, materials, light_group:key");
}

TEST(OutputLayers, OneFileEach) {
  const ReadLayers split =
      read_layers(kLights +
                  "frames: 1-3\n"
                  "outputs: [{file: 'a.####.{layer}.exr', layers: [beauty, depth, "
                  "light_groups], half: true}]\n");
  ASSERT_EQ(split.complaints, "");
  std::vector<std::string> files;
  for (const OutputDesc& output : split.job.outputs) {
    files.push_back(output.file);
    EXPECT_EQ(output.layers.size(), 1U);
    EXPECT_TRUE(output.half);
  }
  EXPECT_EQ(files, (std::vector<std::string>{
                       "a.####.beauty.exr", "a.####.depth.exr", "a.####.light_group_fill.exr",
                       "a.####.light_group_key.exr", "a.####.light_group_lamps.exr",
                       "a.####.light_group_sky.exr", "a.####.light_group_rest.exr"}));
}

TEST(OutputLayers, MistakesAreNamed) {
  const auto complains = [](const std::string& outputs, const std::string& words) {
    const std::string found = read_layers(kLights + "outputs: [" + outputs + "]\n").complaints;
    EXPECT_NE(found.find(words), std::string::npos) << found;
  };
  complains("{file: a.exr, layers: ['light_group:kay']}", "did you mean 'light_group:key'?");
  complains("{file: a.exr, layers: [components, emission]}", "layer 'emission' is listed twice");
  complains("{file: a.png, layer: components}", "stands for several");
  complains("{file: a.png, layer: colour}", "layer is 'colour'");
  complains("{file: 'a.{layer}.png'}", "is for .exr files");
  complains("{file: 'a.{layer}.exr'}, {file: a.alpha.exr}", "writes already");
  EXPECT_NE(read_layers("environment: {light_group: rest}\n").complaints.find("of no group"),
            std::string::npos);
  EXPECT_NE(
      read_layers("environment: {light_group: a.b}\n").complaints.find("letters, digits, _ and -"),
      std::string::npos);
}

// Films that tell light apart in different ways must not be joined.
TEST(OutputLayers, GroupsBelongToTheRenderKey) {
  const auto key = [](const std::string& group) {
    return render_key(read_layers("environment: {color: 1" + group + "}\n").job, 1, {});
  };
  EXPECT_NE(key(", light_group: a"), key(""));
  EXPECT_NE(key(", light_group: a"), key(", light_group: b"));
}

// What a point does until the next frame decides the layer of motion, and nothing else.
TEST(OutputLayers, MotionLooksIntoTheNextFrame) {
  const auto key = [](const std::string& layers, const std::string& later) {
    return render_key(
        read_layers(
            "frames: 1-9\nobjects: {ball: {shape: sphere, at: [\"= frame < 2 ? 0 : " + later +
            "\", 0, 0]}}\noutputs: [{file: a.####.exr, layers: [" + layers + "]}]\n")
            .job,
        1, {});
  };
  EXPECT_NE(key("motion", "1"), key("motion", "2"));
  EXPECT_EQ(key("depth", "1"), key("depth", "2"));
}

}  // namespace
}  // namespace hyades::core
