#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "core/base/hash.h"
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

TEST(RenderKey, TellsNoObjectsFromAllObjects) {
  const std::vector<std::string> linkings = {"",
                                             ", light_linking: {include: []}",
                                             ", light_linking: {include: [a]}",
                                             ", light_linking: {exclude: [a]}",
                                             ", shadow_linking: {include: [a]}",
                                             ", shadow_linking: {include: []}"};
  std::set<std::string> keys;
  for (const std::string& linking : linkings)
    keys.insert(key("objects: {a: {shape: sphere}}\nlights: {l: {type: sun" + linking + "}}\n"));
  EXPECT_EQ(keys.size(), linkings.size());
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

/// What decides the first frame's pixels, but for the renderer's own revision.
std::string lines_of_job(const std::string& body) {
  MemoryAssets assets;
  for (const char* file : {"n.png", "a.png", "a.hair", "a.vdb", "a.obj", "p.ply"})
    assets.add(file, std::string("content of ") + file);
  Diagnostics diagnostics;
  const Job job = parse_job("hyades: 1\n" + body, "job.yaml", assets, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  const std::string text = resolved_job_text(job, 1);
  return text.substr(text.find('\n') + 1);
}

// Films are kept by these lines for longer than one version of the program. A key that is new must
// not change those of a job that does not have it; within a map that may be absent (bump, emit,
// ...) it wants a row in the table of old lines (core/job/*_text.cpp).
TEST(RenderKey, StaysWhereAJobHasNoneOfTheNewKeys) {
  const std::map<std::string, std::string> jobs = {
      {"camera: {focus: 3, aperture: {f_stop: 2}}\n"
       "lights: {a: {type: spot}, b: {type: sun}}\n",
       "a91ccfef7798774e996486ab798056b535dfc9756076e265d6eb8a2581976bd1"},
      {"materials: {a: {type: dielectric}, b: {type: dielectric, roughness: 0.3}}\n",
       "ea080a18555997f2ce5c927c390389695a67aca6c4956bdb6e60d66863b1d07d"},
      {"materials: {a: {type: principled, subsurface: {radius: 0.1}}}\n",
       "782ad5d33812e608651611971b374e2be215f9789f951419d1babeaccc4b12b2"},
      {"materials: {a: {type: principled}}\n",
       "42baf9b70a1dae38be539bd248a0226a84eaa999281fc26de35a939456df6157"},
      {"objects: {a: {shape: sphere, emit: {color: 2}, at: [1, 0, 0], transform: [{rotate_y: "
       "9}]}}\n",
       "6dcddb13547c1c327e5707e33ce1b2a27ba95ae12c1bcf9d7411ea0939de90a1"},
      {"textures: {n: {type: perlin3d}}\n"
       "materials: {a: {type: conductor, normal_map: {texture: n}}}\n",
       "d684b060c666f89b01aa9ef2654d7a5a51af5330aa05f64224b16334838824ed"},
      {"textures: {n: {type: perlin3d}}\n"
       "materials: {a: {type: lambert, bump: {texture: n}}}\n",
       "6853bac7e265ba4c3152d400134070e145cc431a95c8cb1b1c9efa240551f7ff"},
      {"textures: {n: {type: image, file: n.png, mapping: {type: planar}}}\n",
       "be7ef394426c09533916d102b91ebeac53f26007ef1e03f787b62f972a01bb26"},
      {"materials: {a: {type: hair}}\nobjects: {a: {curves: a.hair, material: a}}\n",
       "23549a7c3577ff3cb7824a626bd52dbeea5f294a59f5be3da2c7789f1dbc31ec"},
      {"media: {m: {scattering: 1, density: {noise: {scale: 2}}}}\n",
       "0e7f9d384a68943ea90030b39d4562516f9ec3bde1a8156ee33684000f2dd454"},
      {"media: {m: {scattering: 1, density: {shell: {image: a.png}}}}\n",
       "94772cc245a56b09d0abd88adf781dec484066ccb1792eace92d9ef94df8f8c8"},
      {"media: {m: {scattering: 1, density: {vdb: a.vdb}, emission: {strength: 2}}}\n",
       "5ef1189a95f4c8e7fa31f8617c4f82bb845b0eca05f0533ec7f731f6441a1d96"},
      {"textures: {n: {type: perlin3d}}\n"
       "objects: {a: {mesh: a.obj, displacement: {texture: n}}, b: {instance: g, places: p.ply}}\n"
       "groups: {g: {objects: {c: {shape: box}}}}\n",
       "675e1e7cd8668b547977509a89115c461e93487305f34f335afe91303ce7cec9"},
      {"environment: {sky: {elevation: 20}}\nfilm: {filter: {type: gaussian}}\n"
       "integrator: mlt\n",
       "04d30b0620b09287c40d31d01166fb124af33a18dfc3d55501fac9b9b6b48ab6"},
  };
  for (const auto& [body, known] : jobs) {
    const std::string lines = lines_of_job(body);
    EXPECT_EQ(to_hex(sha256(lines)), known) << body << "is now\n" << lines;
  }
}

}  // namespace
}  // namespace hyades::core
