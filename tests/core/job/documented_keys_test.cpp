#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "core/job/scene_document.h"
#include "tests/core/job/documented_keys.h"
#include "tests/core/job/test_assets.h"

/// Holds docs/job.md against the reader: every key that the reader knows is documented and the
/// other way round, every example is accepted and changes the render key or what is written, and
/// every default is what happens without the key.
namespace hyades::core {
namespace {

constexpr const char* kBase = R"yaml(
textures: {marble: {type: fbm3d, octaves: 5}, tiles: {type: checker, scale: 3}}
materials: {clay: {type: lambert, color: 0.3}, steel: {type: conductor, metal: iron}}
media: {mist: {scattering: 0.1}, milk: {scattering: 5}}
groups: {tree: {objects: {a: {shape: sphere}, b: {shape: box}}}}
objects: {ball: {shape: sphere, radius: 3, at: ["= t", 0, 0]}}
lights: {bulb: {type: point, power: 5}}
)yaml";

struct Outcome {
  std::string complaints;
  std::string fingerprint;
  int moving = 0;  ///< values that are no constants
};

/// What importers would make of scenes of other tools.
void add_scenes(MemoryAssets& assets) {
  for (const char* scene : {"robot.glb", "room.pbrt", "chair.obj"}) {
    for (const char* animation : {"", "Walk"}) {
      const std::string shape = *animation != '\0' ? "box" : "sphere";
      assets.add(reference_of({scene, "x", 24.0F, animation}),
                 "objects: {x." + std::string(1, *scene) + ": {shape: " + shape + "}}\n");
    }
    assets.add(reference_of({scene, "x", 24.0F, "", true}), "objects: {x.o: {shape: disk}}\n");
  }
}

/// Everything that decides pixels, and everything else that a job says about what is written.
Outcome outcome_of(const std::string& text) {
  MemoryAssets inner;
  inner.add("base.yaml", kBase);
  inner.add("sky.yaml", "environment: {color: 0.3}\n");
  for (const char* file :
       {"knot.ply", "forest.ply", "fur.hair", "chair.obj", "wood.png", "bricks.png", "sky.hdr",
        "smoke.vdb", "cloud.vdb", "aces/config.ocio", "view.ocio"}) {
    inner.add(file, std::string("content of ") + file);
  }
  add_scenes(inner);
  RecordingResolver assets(inner);
  Diagnostics diagnostics;
  const Job job = parse_job(text, "sample.yaml", assets, diagnostics);
  Outcome outcome;
  outcome.complaints = diagnostics.to_string();
  if (!diagnostics.empty()) return outcome;
  std::stringstream all;
  for (const int32_t frame : {job.frames.first, job.frames.first + 4, job.frames.last}) {
    all << render_key(job, frame, assets.records()) << "\n";
  }
  if (job.film.crop) all << job.film.crop->x0 << " " << job.film.crop->y1 << " ";
  all << job.name << " " << job.keep_films << " " << job.frames.first << " " << job.frames.last
      << " " << job.frames.step;
  for (const OutputDesc& output : job.outputs) {
    all << "\n"
        << output.file << " " << output.tone_map << " " << output.exposure << " " << output.half
        << " " << output.transparent << " " << output.denoise << " " << output.jpeg_quality << " "
        << output.bits;
    for (const std::string& layer : output.layers) all << " " << layer;
  }
  if (const auto& color = job.color) {
    all << "\n"
        << color->config << " " << color->display << " " << color->view << " " << color->look << " "
        << color->working_space;
  }
  for (const VideoDesc& video : job.videos) all << "\n" << video.file << " " << video.rate_factor;
  outcome.fingerprint = all.str();
  for (const Curve& curve : job.curves) {
    const auto constant = [](const auto& value) { return value.is_constant(); };
    if (!std::visit(constant, curve.value)) ++outcome.moving;
  }
  return outcome;
}

/// Keys whose range has one value in this version: any other one must be refused.
bool has_one_value(const JobKey& id) { return id == JobKey{"job", "hyades"}; }

TEST(DocumentedKeys, AreThoseThatTheReaderKnows) {
  std::set<JobKey> documented;
  for (const DocumentedKey& key : read_page()) {
    EXPECT_TRUE(documented.insert(key.id).second)
        << key.id.section << " / " << key.id.key << " is documented twice";
  }
  const std::set<JobKey> known = known_job_keys();
  for (const JobKey& id : known) {
    EXPECT_TRUE(documented.contains(id)) << "not in docs/job.md: " << id.section << " / " << id.key;
  }
  for (const JobKey& id : documented) {
    EXPECT_TRUE(known.contains(id))
        << "the reader never asks for " << id.section << " / " << id.key;
  }
  EXPECT_GT(known.size(), 150U);
}

TEST(DocumentedKeys, EveryExampleIsAcceptedAndChangesSomething) {
  for (const DocumentedKey& key : read_page()) {
    SCOPED_TRACE("docs/job.md:" + std::to_string(key.line) + " " + key.id.section + " / " +
                 key.id.key);
    ASSERT_FALSE(key.example.empty());
    const std::string with = text_with(key.id, key.example);
    const Outcome changed = outcome_of(with);
    EXPECT_EQ(changed.complaints, "") << with;
    if (has_one_value(key.id)) {
      EXPECT_NE(outcome_of(text_with(key.id, "other")).complaints, "");
      continue;
    }
    const std::string without = sample_text(key.id);
    const Outcome plain = outcome_of(without);
    EXPECT_EQ(plain.complaints, "") << without;
    EXPECT_NE(plain.fingerprint, changed.fingerprint) << without << "\n" << with;
  }
}

TEST(DocumentedKeys, DefaultsAreWhatHappensWithoutTheKey) {
  int checked = 0;
  for (const DocumentedKey& key : read_page()) {
    if (key.default_value.empty()) continue;
    SCOPED_TRACE("docs/job.md:" + std::to_string(key.line) + " " + key.id.section + " / " +
                 key.id.key);
    const std::string with = text_with(key.id, key.default_value);
    const Outcome spelled_out = outcome_of(with);
    EXPECT_EQ(spelled_out.complaints, "") << with;
    const std::string absent = text_with(key.id, std::nullopt);
    const Outcome silent = outcome_of(absent);
    EXPECT_EQ(silent.complaints, "") << absent;
    EXPECT_EQ(spelled_out.fingerprint, silent.fingerprint) << absent << "\n" << with;
    ++checked;
  }
  EXPECT_GT(checked, 80);
}

TEST(DocumentedKeys, WithoutAValueAreOneComplaintWithItsPlace) {
  for (const DocumentedKey& key : read_page()) {
    SCOPED_TRACE("docs/job.md:" + std::to_string(key.line) + " " + key.id.section + " / " +
                 key.id.key);
    Pairs pairs = base_pairs(key.id);
    pairs.emplace_back("like", "");
    const std::string text = key.id.key == "like" ? job_text(key.id, pairs) : text_with(key.id, "");
    const std::string complaints = outcome_of(text).complaints;
    EXPECT_TRUE(complaints.starts_with("sample.yaml:")) << complaints << "\n" << text;
    EXPECT_THAT(complaints, testing::HasSubstr(key.id.key));
    EXPECT_LE(std::count(complaints.begin(), complaints.end(), '\n'), 1) << complaints << "\n"
                                                                         << text;
  }
}

/// What one key asks of another must not trip over one that is empty.
TEST(DocumentedKeys, WithoutAValueAreComplaintsBesideAnyOther) {
  const std::vector<DocumentedKey> all = read_page();
  for (const DocumentedKey& key : all) {
    for (const DocumentedKey& other : all) {
      if (other.id.section != key.id.section || other.id.key == key.id.key) continue;
      Pairs pairs = {{key.id.key, ""}, {other.id.key, other.example}};
      for (const auto& pair : base_pairs(key.id)) {
        if (pair.first != key.id.key && pair.first != other.id.key) pairs.push_back(pair);
      }
      EXPECT_THAT(outcome_of(job_text(key.id, pairs)).complaints,
                  testing::HasSubstr("sample.yaml:"))
          << job_text(key.id, pairs);
    }
  }
  for (const char* text :
       {"hyades: 1\ncolor: {config: view.ocio}\noutputs: [{file: a.png, tone_map: }]\n",
        "hyades: 1\ntextures: {x: {type: image, file: a.<UDIM>.png, wrap: }}\n"}) {
    EXPECT_THAT(outcome_of(text).complaints, testing::HasSubstr("is empty, expected a value"));
  }
}

/// A plain value of the key, to be given at two frames; empty where the page has names and
/// expressions only.
std::string value_to_keep(const DocumentedKey& key) {
  for (const std::string& value : {key.example, key.default_value}) {
    if (value.empty() || value.find("keys") != std::string::npos ||
        value.find("\"=") != std::string::npos)
      continue;
    if (std::string("[-.0123456789").find(value[0]) != std::string::npos) return value;
  }
  return "";
}

TEST(DocumentedKeys, WhatIsSaidToBeAnimatedFollowsKeys) {
  int checked = 0;
  for (const DocumentedKey& key : read_page()) {
    const bool animated = key.type.find("animated") != std::string::npos ||
                          key.type.find("or texture") != std::string::npos;
    const std::string value = value_to_keep(key);
    if (!animated || value.empty()) continue;
    const std::string keyed =
        text_with(key.id, "{keys: {1: " + value + ", 10: " + value + "}, ease: smooth}");
    const Outcome still = outcome_of(text_with(key.id, value));
    const Outcome moving = outcome_of(keyed);
    EXPECT_EQ(moving.complaints, "") << "docs/job.md:" << key.line << "\n" << keyed;
    EXPECT_EQ(moving.moving, still.moving + 1) << "docs/job.md:" << key.line << "\n" << keyed;
    ++checked;
  }
  EXPECT_GT(checked, 150);
}

TEST(DocumentedKeys, RequiredKeysAreRequired) {
  for (const DocumentedKey& key : read_page()) {
    if (!key.required) continue;
    SCOPED_TRACE("docs/job.md:" + std::to_string(key.line) + " " + key.id.section + " / " +
                 key.id.key);
    Pairs pairs = key.id.section == "job" ? Pairs{{"include", "base.yaml"}}
                                          : places().at(key.id.section).pairs;
    std::erase_if(pairs, [&](const auto& pair) { return pair.first == key.id.key; });
    EXPECT_NE(outcome_of(job_text(key.id, pairs)).complaints, "");
  }
}

}  // namespace
}  // namespace hyades::core
