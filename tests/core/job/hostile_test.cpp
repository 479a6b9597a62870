// Jobs that unfold to very much.
#include <gtest/gtest.h>

#include <string>

#include "tests/core/job/hostile_reading.h"

namespace hyades::core {
namespace {

TEST(HostileJob, AliasBomb) {
  std::string text = "hyades: 1\ntextures:\n  a0: &a0 {type: checker}\n";
  for (int i = 1; i < 60; ++i) {
    const std::string below = "*a" + std::to_string(i - 1);
    text += "  a" + std::to_string(i) + ": &a" + std::to_string(i) +
            " {type: checker, a: " + below + ", b: " + below + "}\n";
  }
  const HostileReading reading = read_hostile(text);
  EXPECT_NE(reading.first().find("more than 1048576 values (aliases counted in full)"),
            std::string::npos)
      << reading.first();
  EXPECT_LT(reading.seconds, kPatience);
}

/// Each takes kilobytes, so that a million of them would take all memory of a coordinator.
TEST(HostileJob, ExpressionBomb) {
  std::string text = "hyades: 1\nobjects:\n  o: {shape: box, at: &moves [= t, = t, = t]}\n";
  for (int i = 0; i < 7000; ++i) {
    text += "  o" + std::to_string(i) + ": {shape: box, at: *moves}\n";
  }
  const HostileReading reading = read_hostile(text);
  EXPECT_NE(reading.first().find("the job has more than 20000 expressions"), std::string::npos)
      << reading.first();
  EXPECT_LT(reading.seconds, kPatience);
}

TEST(HostileJob, LikeBomb) {
  // Each entry copies the one before it and adds a key: quadratically many keys.
  std::string text = "hyades: 1\nmaterials:\n  m0: {type: lambert}\n";
  for (int i = 1; i < 20000; ++i) {
    text += "  m" + std::to_string(i) + ": {like: m" + std::to_string(i - 1) + ", k" +
            std::to_string(i) + ": 1}\n";
  }
  const HostileReading reading = read_hostile(text);
  EXPECT_FALSE(reading.diagnostics.empty());
  EXPECT_LT(reading.seconds, kPatience);
}

TEST(HostileJob, InstanceBomb) {
  std::string text = "hyades: 1\ngroups:\n  g0: {objects: {a: {shape: sphere}}}\n";
  for (int i = 1; i < 32; ++i) {
    const std::string below = "{instance: g" + std::to_string(i - 1) + "}";
    text += "  g" + std::to_string(i) + ": {objects: {a: " + below + ", b: " + below + "}}\n";
  }
  expect_refused(text + "objects: {x: {instance: g31}}\n",
                 "job.yaml: the groups unfold to more than 4194304 objects");
}

TEST(HostileJob, LongChains) {
  const auto chain = [](const std::string& head, const std::string& entry, int count) {
    std::string text = head;
    for (int i = 0; i < count; ++i) {
      std::string line = entry;
      for (const auto& [mark, number] : {std::pair("I", i), std::pair("N", i + 1)}) {
        for (size_t at = 0; (at = line.find(mark, at)) != std::string::npos;) {
          line.replace(at, 1, std::to_string(number));
        }
      }
      text += line;
    }
    return text;
  };
  const std::string textures =
      chain("hyades: 1\ntextures:\n", "  xI: {type: scale, input: xN}\n", 20000);
  expect_refused(textures + "  x20000: {type: constant, value: 1}\n",
                 "job.yaml:19970:11: texture 'x19967' is made of more than 32 others in a row");
  const std::string materials =
      chain("hyades: 1\nmaterials:\n", "  xI: {type: mix, first: xN, second: xN}\n", 40);
  expect_refused(materials + "  x40: {type: mirror}\n",
                 "job.yaml:10:7: material 'x7' is made of more than 32 others in a row");
  // Short chains that fan out: 2^k lookups.
  const std::string scales =
      chain("hyades: 1\ntextures:\n", "  xI: {type: scale, input: xN, factor: xN}\n", 14);
  expect_refused(scales + "  x14: {type: constant, value: 1}\n",
                 "job.yaml:3:7: texture 'x0' is made of more than 4096 others, each counted as "
                 "often as it is used");
  const std::string mixes =
      chain("hyades: 1\nmaterials:\n", "  xI: {type: mix, first: xN, second: xN}\n", 14);
  expect_refused(mixes + "  x14: {type: mirror}\n",
                 "job.yaml:3:7: material 'x0' is made of more than 4096 others, each counted as "
                 "often as it is used");
  const std::string groups = chain(
      "hyades: 1\ngroups:\n",
      "  xI: {objects: {a: {group: {objects: {b: {group: {objects: {c: {instance: xN}}}}}}}}}\n",
      20);
  expect_refused(groups + "  x20: {objects: {}}\n",
                 "job.yaml:12:7: group 'x9' has more than 32 groups within each other");
}

TEST(HostileJob, HugeTexts) {
  expect_refused("hyades: 1\nname: " + repeated("a", 1'000'000),
                 "job.yaml:2:7: a text of 1000000 bytes; at most 65536 are allowed");
  expect_refused(repeated("x", 100'000'000),
                 "job.yaml: the file has 100000000 bytes; a job may have at most 33554432");
  expect_refused("hyades: 1\nmaterials: {" + repeated("a", 70'000) + ": 1}\n",
                 "job.yaml:2:13: an empty key; keys are plain text");
}

TEST(HostileJob, MillionsOfSmallValues) {
  expect_refused("hyades: 1\nobjects: [" + repeated("1,", 2'000'000) + "]\n",
                 "job.yaml:2:2097153: more than 1048576 values");
}

TEST(HostileJob, ManyMistakesDoNotTakeLong) {
  // Each of them could be compared with each good name.
  std::string text = "hyades: 1\n";
  std::string materials = "materials:\n";
  std::string lights = "lights:\n";
  std::string objects = "objects:\n";
  for (int i = 0; i < 8000; ++i) {
    const std::string n = std::to_string(i);
    materials += "  a_rather_long_name_" + n + ": {type: lambert, key_" + n + ": 1}\n";
    lights += "  another_long_name_" + n + ": {like: some_other_long_name_" + n + "}\n";
    objects += "  o" + n + ": {shape: box, material: a_rather_lung_name_x" + n + "}\n";
  }
  for (const std::string& part : {materials, lights, materials + objects, objects}) {
    const HostileReading reading = read_hostile(text + part);
    EXPECT_EQ(reading.diagnostics.list().size(), 101U);
    EXPECT_LT(reading.seconds, kPatience);
  }
}

TEST(HostileJob, ManyHonestObjectsAreFine) {
  std::string text = "hyades: 1\nobjects:\n";
  for (int i = 0; i < 20000; ++i) {
    text +=
        "  a" + std::to_string(i) + ": {shape: sphere, at: [" + std::to_string(i) + ", 0, 0]}\n";
  }
  const HostileReading reading = read_hostile(text);
  EXPECT_EQ(reading.diagnostics.to_string(), "");
  EXPECT_LT(reading.seconds, kPatience);
}

TEST(HostileJob, ManyExpressionsOverManyFrames) {
  std::string text = "hyades: 1\nframes: 0-9999999\nobjects:\n";
  for (int i = 0; i < 3000; ++i) {
    text += "  a" + std::to_string(i) + ": {shape: sphere, at: [\"= sin(t) + " + std::to_string(i) +
            "\", 0, 0]}\n";
  }
  const HostileReading reading = read_hostile(text);
  EXPECT_LT(reading.seconds, kPatience);
}

TEST(HostileJob, LongExpressionsOverManyFrames) {
  std::string power = "t";
  while (power.size() < 990) power += "^t";
  std::string text = "hyades: 1\nframes: 0-9999999\nobjects:\n";
  for (int i = 0; i < 4000; ++i) {
    text += "  a" + std::to_string(i) + ": {shape: sphere, at: [\"= " + power + "\", 0, 0]}\n";
  }
  EXPECT_LT(read_hostile(text).seconds, kPatience);
}

}  // namespace
}  // namespace hyades::core
