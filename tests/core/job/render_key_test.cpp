#include <gtest/gtest.h>

#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "core/job/resolved_text.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

/// The key of frame `frame` of a job that consists of `body`, with `files` beside it.
std::string key(const std::string& body, int32_t frame = 1,
                const std::map<std::string, std::string>& files = {},
                const std::string& job_name = "job.yaml") {
  MemoryAssets inner;
  for (const auto& [name, content] : files) inner.add(name, content);
  RecordingResolver assets(inner);
  Diagnostics diagnostics;
  const Job job = parse_job("hyades: 1\n" + body, job_name, assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  return render_key(job, frame, assets.records());
}

TEST(RenderKey, IgnoresHowAValueWasWritten) {
  const std::string plain = key("camera: {fov: 40}\nmaterials: {a: {type: lambert, color: 0.5}}\n");
  EXPECT_EQ(plain, key("# a comment\nmaterials:\n  a:\n    color: [5e-1, 0.50, .5]\n    type: "
                       "\"lambert\"\ncamera:\n  fov: 40.0\n"));
  EXPECT_EQ(plain, key("camera: {fov: \"= 30 + 10\"}\nmaterials: {a: {type: lambert}}\n"));
  EXPECT_EQ(plain, key("camera: {fov: {keys: {1: 40, 9: 40}}}\nmaterials: {a: {type: lambert}}\n"));
  EXPECT_EQ(plain, key("materials: {a: {type: lambert}}\n"));
}

TEST(RenderKey, IgnoresNameOutputsRangeAndFiles) {
  const std::string plain = key("objects: {a: {shape: sphere}}\n", 3);
  EXPECT_EQ(plain, key("name: other\nobjects: {a: {shape: sphere}}\n", 3, {}, "elsewhere/x.yaml"));
  EXPECT_EQ(plain,
            key("objects: {a: {shape: sphere}}\noutputs: [{file: b.exr, layers: [depth]}]\n", 3));
  EXPECT_EQ(plain, key("keep_films: true\nobjects: {a: {shape: sphere}}\n", 3));
  EXPECT_EQ(plain, key("frames: 1-100\nobjects: {a: {shape: sphere}}\n", 3));
  EXPECT_EQ(plain, key("include: part.yaml\n", 3,
                       {{"part.yaml", "objects: {a: {shape: sphere}} # split\n"}}));
}

TEST(RenderKey, KnowsTheCropOnlyWhereLightPathsSplat) {
  const std::string crop = "film: {size: [64, 64], crop: [0, 0, 32, 32]}\n";
  const std::string whole = "film: {size: [64, 64]}\n";
  EXPECT_EQ(key(crop), key(whole));
  EXPECT_NE(key(crop + "integrator: bdpt\n"), key(whole + "integrator: bdpt\n"));
}

TEST(RenderKey, KnowsTheExposureOnlyWhereTilesStopAtANoise) {
  const std::string dark = "outputs: [{file: a.exr}, {file: a.png}]\n";
  const std::string light = "outputs: [{file: a.exr}, {file: a.png, exposure: 1}]\n";
  EXPECT_EQ(key(dark), key(light));
  const std::string noise = "sampling: {noise: 0.1}\n";
  EXPECT_NE(key(dark), key(noise + dark));
  EXPECT_NE(key(noise + dark), key(noise + light));
  EXPECT_NE(key(noise + dark), key("sampling: {noise: 0.1, min_samples: 48}\n" + dark));
}

TEST(RenderKey, DependsOnTheFrameAndOnMotionWithinTheShutter) {
  const std::string moving =
      "frames: {range: 1-9, shutter: SHUTTER}\nobjects: {a: {shape: sphere, "
      "at: [\"= frame < 3.1 ? 0 : frame - 3.1\", 0, 0]}}\n";
  const auto with = [&](const std::string& shutter) {
    std::string text = moving;
    return text.replace(text.find("SHUTTER"), 7, shutter);
  };
  EXPECT_NE(key(with("0"), 2), key(with("0"), 3));
  const std::string still = "frames: {range: 1-9, shutter: 0.5}\nobjects: {a: {shape: sphere}}\n";
  // At frame 3 it starts to move while the shutter is open; at frame 2 it does not.
  EXPECT_NE(key(with("0.5"), 3), key(still, 3));
  EXPECT_EQ(key(with("0.5"), 2), key(still, 2));
}

TEST(RenderKey, FollowsTheContentOfFilesNotTheirNames) {
  const std::string a = "environment: {image: a.hdr}\n";
  const std::string b = "environment: {image: b.hdr}\n";
  EXPECT_EQ(key(a, 1, {{"a.hdr", "light"}}), key(b, 1, {{"b.hdr", "light"}}));
  EXPECT_NE(key(a, 1, {{"a.hdr", "light"}}), key(a, 1, {{"a.hdr", "night"}}));
  const std::string two = "objects: {x: {mesh: a.obj}, y: {mesh: b.obj}}\n";
  EXPECT_NE(key(two, 1, {{"a.obj", "cat"}, {"b.obj", "dog"}}),
            key(two, 1, {{"a.obj", "dog"}, {"b.obj", "cat"}}));
}

TEST(RenderKey, CountsFilesThatFilesNameButNotIncludes) {
  MemoryAssets inner;
  inner.add("part.yaml", "objects: {a: {mesh: a.obj}}\n");
  inner.add("a.obj", "mtllib a.mtl");
  Diagnostics diagnostics;
  RecordingResolver assets(inner);
  const Job job = parse_job("hyades: 1\ninclude: part.yaml\n", "job.yaml", assets, diagnostics);
  ASSERT_TRUE(diagnostics.empty());
  auto records = assets.records();
  ASSERT_EQ(records.size(), 2U);
  const std::string before = render_key(job, 1, records);
  for (AssetRecord& record : records) {
    if (record.reference == "part.yaml") record.sha256 = "changed";
  }
  EXPECT_EQ(render_key(job, 1, records), before);
  records.push_back({"a.mtl", "abc", 1});
  EXPECT_NE(render_key(job, 1, records), before);
}

TEST(RenderKey, TextIsOneFieldPerLine) {
  Job job;
  job.name = "secret";
  const std::string text = resolved_job_text(job, 12);
  EXPECT_NE(text.find("\nframe=12\n"), std::string::npos);
  EXPECT_NE(text.find("\ncamera.fov=42200000\n"), std::string::npos);  // the bits of 40
  EXPECT_EQ(text.find("secret"), std::string::npos);
}

}  // namespace
}  // namespace hyades::core
