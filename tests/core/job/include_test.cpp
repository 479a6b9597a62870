#include <gtest/gtest.h>

#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

struct ReadWithIncludes {
  Job job;
  std::string complaints;
};

ReadWithIncludes read_including(const std::string& text, MemoryAssets assets,
                                const std::string& name = "job.yaml") {
  ReadWithIncludes reading;
  Diagnostics diagnostics;
  reading.job = parse_job(text, name, assets, diagnostics);
  reading.complaints = diagnostics.to_string();
  return reading;
}

TEST(Include, OwnKeysWinAndNamesAreJoined) {
  MemoryAssets assets;
  assets.add("base.yaml",
             "name: base\n"
             "camera: {fov: 20, look_from: [0, 0, 9]}\n"
             "materials: {red: {type: lambert, color: [1, 0, 0]}}\n"
             "objects: {ball: {shape: sphere, material: red}}\n"
             "outputs: [{file: base.exr}]\n");
  const ReadWithIncludes r = read_including(
      "hyades: 1\ninclude: base.yaml\nname: mine\ncamera: {fov: 50}\n"
      "objects: {cube: {shape: box, material: red}}\noutputs: [{file: mine.png}]\n",
      assets);
  ASSERT_EQ(r.complaints, "");
  EXPECT_EQ(r.job.name, "mine");
  EXPECT_FLOAT_EQ(r.job.camera.fov.constant, 50.0F);
  EXPECT_FLOAT_EQ(r.job.camera.look_from.constant.z, 9.0F);
  ASSERT_EQ(r.job.objects.size(), 2U);
  EXPECT_EQ(r.job.objects[0].name, "cube");
  EXPECT_EQ(r.job.objects[1].name, "ball");
  ASSERT_EQ(r.job.outputs.size(), 1U);
  EXPECT_EQ(r.job.outputs[0].file, "mine.png");
  EXPECT_EQ(r.job.includes, std::vector<std::string>{"base.yaml"});
}

TEST(Include, FilesAreRelativeToWhereTheyAreWritten) {
  MemoryAssets assets;
  assets.add("parts/chairs/chair.yaml", "objects: {chair: {mesh: chair.obj}}\n");
  assets.add("parts/room.yaml",
             "include: chairs/chair.yaml\n"
             "textures: {wall: {type: image, file: ../images/wall.png}}\n"
             "environment: {image: sky.hdr}\n");
  assets.add("parts/chairs/chair.obj", "o");
  assets.add("images/wall.png", "p");
  assets.add("parts/sky.hdr", "h");
  const ReadWithIncludes r =
      read_including("hyades: 1\ninclude: parts/room.yaml\n", assets, "jobs/shot/job.yaml");
  ASSERT_EQ(r.complaints, "");
  EXPECT_EQ(r.job.objects[0].mesh, "parts/chairs/chair.obj");
  EXPECT_EQ(std::get<textures::Image>(r.job.textures[0].kind).file, "images/wall.png");
  EXPECT_EQ(r.job.environment->image, "parts/sky.hdr");
}

TEST(Include, ComplaintsNameTheFileTheyAreIn) {
  MemoryAssets assets;
  assets.add("parts/a.yaml", "camera: {fov: 999}\nobjects: {x: {mesh: no.obj}}\n");
  EXPECT_EQ(
      read_including("hyades: 1\ninclude: parts/a.yaml\n", assets, "jobs/job.yaml").complaints,
      "jobs/parts/a.yaml:1:15: fov is '999', expected a number above 0 and below 180\n"
      "jobs/parts/a.yaml:2:21: mesh of object 'x': parts/no.obj: no such file\n");
}

TEST(Include, TheSameNameTwiceNamesBothPlaces) {
  MemoryAssets assets;
  assets.add("a.yaml", "objects: {ball: {shape: sphere}}\ncamera: {fov: 20}\n");
  assets.add("b.yaml", "camera: {fov: 30}\nunits: cm\n");
  assets.add("c.yaml", "units: mm\n");
  EXPECT_EQ(read_including("hyades: 1\ninclude: a.yaml\nobjects:\n  ball: {shape: box}\n", assets)
                .complaints,
            "a.yaml:1:11: 'ball' is also at job.yaml:4; expected it in one file only\n");
  EXPECT_EQ(read_including("hyades: 1\ninclude: [a.yaml, b.yaml, c.yaml]\n", assets).complaints,
            "b.yaml:1:10: 'fov' is also at a.yaml:2; expected it in one file only\n"
            "c.yaml:1:1: 'units' is also at b.yaml:2; expected it in one file only\n");
}

TEST(Include, CyclesAreRefusedAndDiamondsCountOnce) {
  MemoryAssets assets;
  assets.add("a.yaml", "include: b.yaml\n");
  assets.add("b.yaml", "include: ./x/../a.yaml\n");
  EXPECT_EQ(read_including("hyades: 1\ninclude: a.yaml\n", assets).complaints,
            "b.yaml:1:10: './x/../a.yaml' includes itself in the end\n");
  EXPECT_EQ(read_including("hyades: 1\ninclude: job.yaml\n", assets).complaints,
            "job.yaml:2:10: 'job.yaml' includes itself in the end\n");
  MemoryAssets diamond;
  diamond.add("left.yaml", "include: base.yaml\n");
  diamond.add("right.yaml", "include: base.yaml\n");
  diamond.add("base.yaml", "objects: {ball: {shape: sphere}}\n");
  const ReadWithIncludes r =
      read_including("hyades: 1\ninclude: [left.yaml, right.yaml]\n", diamond);
  EXPECT_EQ(r.complaints, "");
  EXPECT_EQ(r.job.objects.size(), 1U);
}

TEST(Include, DepthAndNumberAreLimited) {
  MemoryAssets deep;
  for (int i = 0; i < 100; ++i) {
    deep.add("d" + std::to_string(i) + ".yaml", "include: d" + std::to_string(i + 1) + ".yaml\n");
  }
  EXPECT_EQ(read_including("hyades: 1\ninclude: d0.yaml\n", deep).complaints,
            "d15.yaml:1:10: too many includes: at most 16 deep and 256 in all\n");
  MemoryAssets wide;
  std::string list;
  for (int i = 0; i < 400; ++i) {
    const std::string name = "w" + std::to_string(i) + ".yaml";
    wide.add(name, "hyades: 1\n");
    list += name + ", ";
  }
  EXPECT_NE(
      read_including("hyades: 1\ninclude: [" + list + "]\n", wide).complaints.find("256 in all"),
      std::string::npos);
}

TEST(Include, ValuesOfAllFilesAreLimited) {
  // A million values each, nearly all of them by an alias.
  std::string many = "objects: {a: {mesh: [&row [0";
  for (int i = 0; i < 1000; ++i) many += ", 0";
  many += "]";
  for (int i = 0; i < 999; ++i) many += ", *row";
  many += "]}}\n";
  MemoryAssets files;
  for (const char* name : {"a", "b", "c", "d"}) files.add(std::string(name) + ".yaml", many);
  const std::string told =
      read_including("hyades: 1\ninclude: [a.yaml, b.yaml, c.yaml, d.yaml]\n", files).complaints;
  EXPECT_NE(told.find("the included files have more than 2097152 values in all"), std::string::npos)
      << told.substr(0, 500);
}

TEST(Include, WhatIsNoMapIsRefused) {
  MemoryAssets assets;
  assets.add("list.yaml", "- a\n");
  assets.add("empty.yaml", "# nothing\n");
  assets.add("bad.yaml", "a: [\n");
  EXPECT_EQ(read_including("hyades: 1\ninclude: list.yaml\n", assets).complaints,
            "list.yaml:1:1: the included file holds a list of 1, expected a map of a job's "
            "sections\n");
  EXPECT_EQ(read_including("hyades: 1\ninclude: empty.yaml\n", assets).complaints,
            "empty.yaml:1:1: the included file holds nothing, expected a map of a job's "
            "sections\n");
  EXPECT_NE(read_including("hyades: 1\ninclude: bad.yaml\n", assets)
                .complaints.find("bad.yaml:2:1: not valid"),
            std::string::npos);
  EXPECT_EQ(
      read_including("hyades: 1\ninclude: {a: b}\n", assets).complaints,
      "job.yaml:2:10: include is a map, expected a file name, {lua: script.lua, set: {...}} or "
      "a list of them\n");
}

TEST(Like, CopiesKeysThatAreNotOverridden) {
  const ReadWithIncludes r = read_including(
      "hyades: 1\n"
      "materials:\n"
      "  fine: {like: coarse, roughness: 0.1}\n"
      "  coarse: {type: conductor, metal: copper, roughness: 0.6}\n"
      "  mine: {like: fine, eta: 0.2, k: 3}\n"
      "objects:\n"
      "  a: {shape: sphere, radius: 2, material: fine, at: [1, 0, 0]}\n"
      "  b: {like: a, at: [2, 0, 0]}\n"
      "  c: {like: a, shape: disk}\n",
      {});
  ASSERT_EQ(r.complaints, "");
  const auto& fine = std::get<ConductorDesc>(r.job.materials[0].kind);
  EXPECT_EQ(fine.metal, "copper");
  EXPECT_FLOAT_EQ(fine.roughness.value.constant, 0.1F);
  const auto& mine = std::get<ConductorDesc>(r.job.materials[2].kind);
  EXPECT_EQ(mine.metal, "custom");
  EXPECT_FLOAT_EQ(mine.roughness.value.constant, 0.1F);
  EXPECT_FLOAT_EQ(r.job.objects[1].at.constant.x, 2.0F);
  EXPECT_FLOAT_EQ(r.job.objects[1].radius.constant, 2.0F);
  EXPECT_EQ(r.job.objects[1].material, "fine");
  EXPECT_EQ(r.job.objects[2].shape, "disk");
}

TEST(Like, UnknownNamesAndCycles) {
  EXPECT_EQ(read_including("hyades: 1\nlights: {sun: {type: sun}, b: {like: son, type: sun}}\n", {})
                .complaints,
            "job.yaml:2:38: like is 'son', expected another name of this list, did you mean "
            "'sun'?\n");
  EXPECT_EQ(read_including("hyades: 1\nlights: {a: {like: a, type: sun}}\n", {}).complaints,
            "job.yaml:2:20: 'a' is like 'a', which in the end is like itself\n");
}

TEST(Like, LongChainsDoNotOverflow) {
  std::string text = "hyades: 1\nlights:\n";
  const int count = 30000;
  for (int i = 0; i < count; ++i) {
    text += "  l" + std::to_string(i) + ": {like: l" + std::to_string(i + 1) + "}\n";
  }
  text += "  l" + std::to_string(count) + ": {type: sun, irradiance: 2}\n";
  const ReadWithIncludes r = read_including(text, {});
  ASSERT_EQ(r.complaints, "");
  EXPECT_FLOAT_EQ(std::get<SunLightDesc>(r.job.lights[0].kind).irradiance.constant, 2.0F);
}

TEST(Alias, SharesValues) {
  const ReadWithIncludes r = read_including(
      "hyades: 1\nmaterials:\n  a: {type: lambert, color: &red [0.8, 0, 0]}\n"
      "  b: {type: glossy, color: *red}\n",
      {});
  ASSERT_EQ(r.complaints, "");
  EXPECT_FLOAT_EQ(std::get<GlossyDesc>(r.job.materials[1].kind).color.value.constant.x, 0.8F);
}

}  // namespace
}  // namespace hyades::core
