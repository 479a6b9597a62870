// Texts that are no jobs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "core/job/render_key.h"
#include "tests/core/job/hostile_reading.h"

namespace hyades::core {
namespace {

TEST(HostileJob, AliasInItsOwnAnchor) {
  expect_refused("hyades: 1\ntextures: &t {a: {type: checker, a: *t}}\n",
                 "job.yaml:2:37: this alias stands inside its own anchor");
}

TEST(HostileJob, DeepNesting) {
  expect_refused("hyades: 1\nobjects: " + repeated("{a: ", 3000) + "1" + repeated("}", 3000),
                 "job.yaml:2:262: nested deeper than 64 levels");
  expect_refused("hyades: 1\nobjects: " + repeated("[", 3000) + repeated("]", 3000),
                 "job.yaml:2:73: nested deeper than 64 levels");
  EXPECT_FALSE(read_hostile("hyades: 1\nobjects: " + repeated("[", 3000)).diagnostics.empty());
  expect_refused(repeated("- ", 100000), "job.yaml:1:129: nested deeper than 64 levels");
  expect_refused(repeated("? ", 100000), "job.yaml:1:129: nested deeper than 64 levels");
}

TEST(HostileJob, MillionsOfOpenBrackets) {
  expect_refused(repeated("[", 5'000'000), "job.yaml:1:10001: more than 10000 brackets left open");
  expect_refused(repeated("]", 5'000'000) + repeated("{", 5'000'000),
                 "job.yaml:1:5010001: more than 10000 brackets left open");
}

TEST(HostileJob, TextThatIsNoText) {
  expect_refused(std::string("hyades: 1\nname: a\0b\n", 20),
                 "job.yaml:2:8: the control character 0; a job is a UTF-8 YAML file");
  expect_refused(
      "\x7F"
      "ELF\x02\x01",
      "job.yaml:1:1: the control character 127; a job is a UTF-8 YAML file");
  expect_refused("hyades: 1\nname: caf\xE9\n",
                 "job.yaml:2:10: not UTF-8 text; a job is a UTF-8 YAML file");
  expect_refused(std::string("\xFF\xFEh\0y\0", 6),
                 "job.yaml:1:1: not UTF-8 text; a job is a UTF-8 YAML file");
  expect_refused("name: \xC0\xAF\n", "job.yaml:1:7: not UTF-8 text; a job is a UTF-8 YAML file");
  expect_refused("name: \xED\xA0\x80\n",
                 "job.yaml:1:7: not UTF-8 text; a job is a UTF-8 YAML file");
  expect_refused("hyades: 1\nname: \"a\\0b\"\n",
                 "job.yaml:2:7: a text with a control character in it");
}

TEST(HostileJob, YamlThatIsNoJob) {
  expect_refused("", "job.yaml:1:1: the job is nothing, expected a map of keys and values");
  expect_refused("just text",
                 "job.yaml:1:1: the job is 'just text', expected a map of keys and "
                 "values");
  expect_refused("- a\n- b\n",
                 "job.yaml:1:1: the job is a list of 2, expected a map of keys and "
                 "values");
  expect_refused("hyades: 1\n---\nhyades: 1\n",
                 "job.yaml:3:1: a second YAML document ('---'); a job is one document");
  expect_refused("hyades: 1\nname: !!binary aGVsbG8=\n",
                 "job.yaml:2:7: the tag 'tag:yaml.org,2002:binary'; jobs use no YAML tags");
  expect_refused("hyades: 1\nfilm:\n\tsize: [1, 1]\n",
                 "job.yaml:3:6: not valid YAML: illegal map value (line 3 is indented with a tab; "
                 "YAML wants spaces)");
  expect_refused("hyades: 1\ncamera: {<<: {fov: 3}}\n",
                 "job.yaml:2:10: '<<' is not supported; use `like: name` to copy another entry's "
                 "keys");
  expect_refused("hyades: 1\n[a, b]: c\n",
                 "job.yaml:2:1: a list or map as a key; keys are plain text");
  // yaml-cpp 0.8 adds the anchor's name.
  EXPECT_THAT(read_hostile("hyades: 1\nname: *nobody\n").first(),
              testing::StartsWith("job.yaml:2:7: not valid YAML: the referenced anchor "
                                  "is not defined"));
}

TEST(HostileJob, ExpressionsThatAskTooMuch) {
  expect_refused(
      "hyades: 1\ncamera: {fov: \"= " + repeated("(", 600) + "1" + repeated(")", 600) + "\"}\n",
      "job.yaml:2:15: fov: an expression of 1202 characters; at most 1000 are allowed");
  expect_refused("hyades: 1\ncamera: {fov: \"= system('reboot')\"}\n",
                 "job.yaml:2:15: fov: the expression holds ''', which means nothing there "
                 "(arithmetic of t and frame is expected)");
  for (const char* bad : {"=",          "= ",         "= ()",          "= ,",    "= 1,2",
                          "= t=3",      "= ?:",       "= 1?2",         "= 1 2",  "= sin",
                          "= sin()",    "= sin(1,2)", "= clamp(1,2)",  "= t(1)", "= 2pi",
                          "= 1..2",     "= .",        "= ^",           "= --",   "= e e",
                          "= )(",       "= (((",      "= frame frame", "= 1?2:", "= t?(1:2)",
                          "= noise(,)", "= +",        "= * 3"}) {
    const HostileReading reading =
        read_hostile("hyades: 1\ncamera: {fov: \"" + std::string(bad) + "\"}\n");
    EXPECT_FALSE(reading.diagnostics.empty()) << bad;
  }
}

TEST(HostileJob, PathsThatAreNoFiles) {
  auto files = make_file_resolver(".");
  Diagnostics diagnostics;
  parse_job(
      "hyades: 1\n"
      "environment: {image: /dev/zero}\n"
      "objects: {a: {mesh: .}, b: {mesh: /proc/self/mem/../../../nothing}}\n",
      "job.yaml", *files, diagnostics);
  ASSERT_EQ(diagnostics.list().size(), 3U) << diagnostics.to_string();
}

constexpr const char* kSeed = R"yaml(hyades: 1
name: fuzz
include: more.yaml
frames: {range: 1-120x2, fps: 24, shutter: 0.5}
film: {size: [960, 540], crop: [1, 2, 30, 40], filter: {type: mitchell, radius: 1.5}}
sampling: {samples: 256, seed: 7, sampler: sobol}
camera:
  look_from: [0, 1.6, "= 6 + t"]
  look_at: {keys: {1: [0, 1, 0], 120: [0.5, 1, 0]}, ease: smooth}
  aperture: {f_stop: 2.8, blades: 7}
  focus: ball
textures:
  swell: &s {type: perlin4d, scale: 3, time: "= 0.5 * t ^ 2 + clamp(t, 0, 1)"}
  tiles: {type: checker, scale: [8, 8], a: 0.05, b: "#d8c8a8"}
  more: *s
materials:
  chrome: {type: conductor, metal: silver, roughness: tiles, bump: {texture: swell, height: 1}}
  floor: {like: chrome, metal: gold}
  both: {type: mix, first: floor, second: chrome, amount: {type: fbm3d}}
groups:
  pair: {objects: {a: {shape: disk}, b: {shape: box, size: [1, 2, 3], at: [1, 0, 0]}}}
objects:
  ball: {shape: sphere, radius: 1, at: [0, 1, 0], material: both}
  two: {instance: pair, transform: [{rotate: {axis: [1, 1, 0], angle: "= 30 * t"}}, {scale: 2}]}
  in: {group: {objects: {x: {shape: cylinder, caps: false}}}}
  lamp: {like: ball, emit: {color: 3200K, power: 60}}
lights: {sun: {type: sun, direction: [0, -1, 0.5]}}
outputs:
  - {file: a.####.exr, layers: [beauty, albedo]}
  - {file: a.####.png, tone_map: filmic}
)yaml";

/// One random edit: a byte, a cut, a doubled piece, a swapped line, or a word with a meaning.
std::string mutated(std::string text, std::mt19937& random) {
  static const std::vector<std::string> words = {"&s",
                                                 "*s",
                                                 "{",
                                                 "}",
                                                 "[",
                                                 "]",
                                                 ": ",
                                                 ", ",
                                                 "\n",
                                                 "- ",
                                                 "? ",
                                                 "#",
                                                 "\"",
                                                 "'",
                                                 "| ",
                                                 "> ",
                                                 "!x ",
                                                 "%",
                                                 "@",
                                                 "---\n",
                                                 "~",
                                                 ".nan",
                                                 ".inf",
                                                 "1e999",
                                                 "-1",
                                                 "0",
                                                 "99999999999",
                                                 "\"= t\"",
                                                 "like: ball, ",
                                                 "= sin(",
                                                 "keys: {",
                                                 "type: mix",
                                                 "include: more.yaml\n",
                                                 "\t",
                                                 "\xC3\xA9",
                                                 "\xFF",
                                                 "group"};
  const auto below = [&](size_t n) { return n == 0 ? 0 : random() % n; };
  const size_t at = below(text.size());
  switch (below(5)) {
    case 0:
      text[at] = static_cast<char>(random() & 0xFFU);
      break;
    case 1:
      text.erase(at, below(20));
      break;
    case 2:
      text.insert(at, text.substr(below(text.size()), below(60)));
      break;
    case 3:
      text.insert(at, words[below(words.size())]);
      break;
    default: {
      const std::string& word = words[below(words.size())];
      text.replace(at, std::min(word.size(), text.size() - at), word);
    }
  }
  return text;
}

TEST(HostileJob, RandomEditsNeverDoMoreThanComplain) {
  MemoryAssets assets;
  assets.add("more.yaml", "lights: {bulb: {type: point, color: [1, \"= t\", 1]}}\n");
  std::mt19937 random(20240607);
  // More rounds on request: HYADES_FUZZ_ROUNDS=100000 under the sanitizers, say.
  const char* const wish = std::getenv("HYADES_FUZZ_ROUNDS");
  const int rounds = wish != nullptr ? std::atoi(wish) : 6000;
  int good = 0;
  double slowest = 0.0;
  for (int i = 0; i < rounds; ++i) {
    std::string text = kSeed;
    for (size_t edits = 1 + random() % 4; edits > 0; --edits) text = mutated(text, random);
    Diagnostics diagnostics;
    const double start = processor_seconds();
    const Job job = parse_job(text, "job.yaml", assets, diagnostics);
    if (diagnostics.empty()) {
      ++good;
      EXPECT_EQ(render_key(job, job.frames.first, {}).size(), 64U);
    }
    slowest = std::max(slowest, processor_seconds() - start);
  }
  // The seed itself is good, so some edits (in comments, names, numbers) must leave it good.
  EXPECT_GT(good, rounds / 300);
  EXPECT_LT(good, rounds / 2);
  EXPECT_LT(slowest, kPatience);
}

}  // namespace
}  // namespace hyades::core
