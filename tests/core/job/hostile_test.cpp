#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "core/job/ocio_files.h"
#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "tests/core/job/test_assets.h"

/// Texts that mean harm, and texts that are merely broken: refused with a complaint, in bounded
/// time and memory.
namespace hyades::core {
namespace {

using testing::HasSubstr;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct HostileReading {
  Diagnostics diagnostics;
  double seconds = 0.0;  ///< of processor time: the machine may be busy
  std::string first() const {
    return diagnostics.empty() ? "" : diagnostics.list().front().to_string();
  }
};

HostileReading read_hostile(const std::string& text, MemoryAssets assets = {}) {
  HostileReading reading;
  const double begin = processor_seconds();
  parse_job(text, "job.yaml", assets, reading.diagnostics);
  reading.seconds = processor_seconds() - begin;
  return reading;
}

/// Generous: sanitizers are slow. What is guarded against takes minutes or hours.
constexpr double kPatience = 20.0;

void expect_refused(const std::string& text, const std::string& complaint) {
  const HostileReading reading = read_hostile(text);
  EXPECT_EQ(reading.first(), complaint);
  EXPECT_LT(reading.seconds, kPatience);
}

std::string repeated(const std::string& piece, size_t times) {
  std::string all;
  all.reserve(piece.size() * times);
  for (size_t i = 0; i < times; ++i) all += piece;
  return all;
}

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

/// They are copied wherever they are used.
TEST(HostileJob, LongTextsOfManyPlaces) {
  std::string aliases =
      "hyades: 1\ntextures:\n  a: {type: checker, a: &long " + std::string(60'000, 'x') + "}\n";
  std::string likes =
      "hyades: 1\nobjects:\n  base: {shape: sphere, material: " + std::string(60'000, 'x') + "}\n";
  for (int i = 0; i < 4000; ++i) {
    aliases += "  t" + std::to_string(i) + ": {type: image, file: *long}\n";
    likes += "  o" + std::to_string(i) + ": {like: base}\n";
  }
  EXPECT_THAT(read_hostile(aliases).first(),
              HasSubstr("more than 1048576 values (aliases counted in full)"));
  const std::string said = read_hostile(likes).diagnostics.to_string();
  EXPECT_THAT(said, HasSubstr("the job unfolds to more than 4194304 values"));
  std::string deep = "x";
  while (deep.size() < 5000) deep += "/a";
  for (const std::string head :
       {"textures: {t: {type: image, file: ", "include: ", "media: {file: "}) {
    const std::string end(std::count(head.begin(), head.end(), '{'), '}');
    EXPECT_THAT(read_hostile("hyades: 1\n" + head + deep + end + "\n").first(),
                HasSubstr("is a name of 5001 bytes, expected at most 4096"))
        << head;
  }
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

/// Keys that each ask for all others would take minutes.
TEST(HostileJob, ManyKeysInTwoFiles) {
  MemoryAssets assets;
  for (const std::string file : {"a", "b"}) {
    std::string text;
    for (int i = 0; i < 200'000; ++i) text += file + std::to_string(i) + ": 1\n";
    assets.add(file + ".yaml", text);
  }
  const HostileReading reading = read_hostile("hyades: 1\ninclude: [a.yaml, b.yaml]\n", assets);
  EXPECT_THAT(reading.first(), HasSubstr("unknown key 'a0'"));
  EXPECT_LT(reading.seconds, kPatience);
}

TEST(HostileJob, ManyKeysThatAreLikeOthers) {
  std::string text = "hyades: 1\nmaterials:\n";
  for (const std::string name : {"a", "b"}) {
    text += "  " + name + ":\n    " + (name == "b" ? "like: a" : "type: lambert") + "\n";
    for (int i = 0; i < 200'000; ++i) text += "    " + name + std::to_string(i) + ": 1\n";
  }
  const HostileReading reading = read_hostile(text);
  EXPECT_THAT(reading.first(), HasSubstr("unknown key 'a0'"));
  EXPECT_LT(reading.seconds, kPatience);
}

/// What libstdc++ multiplies by in std::hash of texts, which is MurmurHash64A (Austin Appleby).
constexpr uint64_t kMurmur = 0xc6a4a7935bd1e995U;

uint64_t shift_mix(uint64_t value) { return value ^ (value >> 47U); }

/// Texts of letters and digits for which std::hash gives the same number, by 16 bytes at a time
/// that lead from one state to the same next one.
std::vector<std::string> texts_of_one_hash(size_t count) {
  constexpr size_t kChoices = 20;
  constexpr size_t kBlocks = 4;
  uint64_t inverse = 1;  // of kMurmur modulo 2^64, by Newton's steps
  for (int i = 0; i < 6; ++i) inverse *= 2 - kMurmur * inverse;
  const auto mixed = [](uint64_t word) { return shift_mix(word * kMurmur) * kMurmur; };
  const auto unmixed = [&](uint64_t word) { return shift_mix(word * inverse) * inverse; };
  constexpr std::string_view kPlain =
      "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
  std::mt19937 random(7);
  const auto plain_word = [&] {
    std::string word(8, '0');
    for (char& letter : word) letter = kPlain[random() % kPlain.size()];
    return word;
  };
  const auto number = [](const std::string& word) {
    uint64_t value = 0;
    std::memcpy(&value, word.data(), 8);
    return value;
  };
  std::vector<std::string> texts = {""};
  uint64_t state = 0xc70f6907U ^ (16 * kBlocks * kMurmur);
  for (size_t block = 0; block < kBlocks; ++block) {
    const auto after_one = [&](const std::string& word) {
      return (state ^ mixed(number(word))) * kMurmur;
    };
    std::vector<std::string> choices = {plain_word() + plain_word()};
    const uint64_t next = after_one(choices[0].substr(0, 8)) ^ mixed(number(choices[0].substr(8)));
    while (choices.size() < kChoices) {
      const std::string first = plain_word();
      const uint64_t second = unmixed(after_one(first) ^ next);
      std::string word(8, '0');
      std::memcpy(word.data(), &second, 8);
      if (word.find_first_not_of(kPlain) == std::string::npos) choices.push_back(first + word);
    }
    state = next * kMurmur;
    std::vector<std::string> longer;
    for (const std::string& text : texts) {
      for (const std::string& choice : choices) longer.push_back(text + choice);
    }
    texts = std::move(longer);
  }
  texts.resize(count);
  return texts;
}

/// A table of hashes is a list where somebody chose the keys so.
TEST(HostileJob, ManyKeysOfOneHash) {
  const std::vector<std::string> keys = texts_of_one_hash(100'000);
  ASSERT_EQ(std::hash<std::string>()(keys.front()), std::hash<std::string>()(keys.back()));
  std::string text = "hyades: 1\nmaterials:\n";
  for (const std::string& key : keys) text += "  " + key + ": {like: " + keys.front() + "}\n";
  const HostileReading reading = read_hostile(text);
  EXPECT_THAT(reading.first(), HasSubstr("which in the end is like itself"));
  EXPECT_LT(reading.seconds, kPatience);
  MemoryAssets assets;
  std::string lights = "lights:\n";
  std::string materials = "materials:\n";
  for (size_t i = 0; i < keys.size(); i += 2) {
    materials += "  " + keys[i] + ": {type: mirror}\n";
    lights += "  " + keys[i + 1] + ": {type: point}\n";
  }
  assets.add("materials.yaml", materials);
  assets.add("lights.yaml", lights);
  const HostileReading joined =
      read_hostile("hyades: 1\ninclude: [materials.yaml, lights.yaml]\n", assets);
  EXPECT_EQ(joined.first(), "");
  EXPECT_LT(joined.seconds, kPatience);
}

/// A file of many keys and files of few, which cost what they hold, not what there is already.
TEST(HostileJob, IncludesCostWhatTheyHold) {
  MemoryAssets assets;
  std::string many = "materials:\n";
  for (int i = 0; i < 150'000; ++i) many += "  m" + std::to_string(i) + ": {type: mirror}\n";
  assets.add("many.yaml", many);
  const auto seconds_with = [&](int files) {
    std::string text = "hyades: 1\ninclude:\n  - many.yaml\n";
    for (int i = 0; i < files; ++i) {
      const std::string name = "f" + std::to_string(i) + ".yaml";
      assets.add(name, "materials:\n  f" + std::to_string(i) + ": {type: mirror}\n");
      text += "  - " + name + "\n";
    }
    const HostileReading reading = read_hostile(text, assets);
    EXPECT_EQ(reading.first(), "");
    return reading.seconds;
  };
  // Joined with all before it, each would take a part of what the large file takes: 15 times it.
  EXPECT_LT(seconds_with(250), 4.0 * seconds_with(1));
}

TEST(HostileJob, ManyMediaInAFileAndManyKeysInOne) {
  MemoryAssets assets;
  std::string list;
  std::string keys = "broth:\n";
  for (int i = 0; i < 200'000; ++i) {
    list += "- {name: m" + std::to_string(i) + ", absorption: 1}\n";
    keys += "  k" + std::to_string(i) + ": 1\n";
  }
  assets.add("list.yaml", list);
  assets.add("keys.yaml", keys);
  const HostileReading good = read_hostile("hyades: 1\nmedia: {file: list.yaml}\n", assets);
  EXPECT_EQ(good.first(), "");
  EXPECT_LT(good.seconds, kPatience);
  const HostileReading bad = read_hostile("hyades: 1\nmedia: {file: keys.yaml}\n", assets);
  EXPECT_THAT(bad.first(), HasSubstr("unknown key 'k0'"));
  EXPECT_LT(bad.seconds, kPatience);
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

/// Each transform could be looked for up to the end of the text, and each file in every folder.
TEST(HostileJob, ColourConfigurationsAreReadOnce) {
  const std::string transforms = repeated("<FileTransform>", 500'000);
  EXPECT_THAT(ocio_file_candidates("src\n" + transforms), testing::IsEmpty());
  EXPECT_THAT(ocio_file_candidates(repeated("<FileTransform>src:x ", 50'000)),
              testing::ElementsAre("./x"));
  std::string config = "search_path: ";
  for (int i = 0; i < 10'000; ++i) config += "p" + std::to_string(i) + ":";
  config += "\n";
  std::string same = config;
  for (int i = 0; i < 200'000; ++i) {
    config += "!<FileTransform> {src: f" + std::to_string(i) + "}\n";
    same += i % 2 == 0 ? "!<FileTransform> {src: a}\n" : "!<FileTransform> {src: a/a}\n";
  }
  EXPECT_EQ(ocio_file_candidates(config).size(), 10'000U);
  EXPECT_EQ(ocio_file_candidates(same).size(), 10'000U);
  const std::string longest = std::string(5000, 'x');
  EXPECT_THAT(ocio_file_candidates("search_path: a:" + longest + "\n!<FileTransform> {src: " +
                                   longest + "}\n!<FileTransform> {src: f}"),
              testing::ElementsAre("a/f"));
}

/// Has every file, and counts which are opened.
class EveryFile : public AssetResolver {
 public:
  Result<Bytes> open(const std::string& reference, const std::string&) override {
    ++opened[reference];
    return Bytes();
  }
  bool exists(const std::string&) override { return true; }

  std::map<std::string, int> opened;
};

/// Runs of # of any length mean the same file at long frame numbers.
TEST(HostileJob, ManySequencesOfTheSameFiles) {
  std::string text = "hyades: 1\nframes: {range: 1000000-1000499, shutter: 0.5}\nobjects:\n";
  for (int i = 0; i < 1500; ++i) {
    text += "  o" + std::to_string(i) + ": {mesh: a" + std::string(1 + i % 7, '#') + "b" +
            std::string(1 + i / 7 % 7, '#') + "c" + std::string(1 + i / 49 % 7, '#') + "d" +
            std::string(1 + i / 343, '#') + ".ply}\n";
  }
  EveryFile files;
  Diagnostics diagnostics;
  parse_job(text, "job.yaml", files, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  EXPECT_EQ(files.opened.size(), 501U);
  for (const auto& [file, times] : files.opened) EXPECT_EQ(times, 1) << file;

  text.replace(text.find("1000499"), 7, "1000999");
  parse_job(text, "job.yaml", files, diagnostics);
  ASSERT_FALSE(diagnostics.empty());
  EXPECT_EQ(diagnostics.list().front().to_string(),
            "job.yaml:1004:17: mesh of object 'o1000': the job's sequences of meshes have more "
            "than 1,000,000 files");
  EXPECT_EQ(files.opened.size(), 1001U);
}

/// Each could be compared with the names of all groups.
TEST(HostileJob, ManyWrongLayersOfManyLightGroups) {
  std::string lights = "lights:\n";
  for (int i = 0; i < 10'000; ++i) {
    const std::string n = std::to_string(i);
    lights += "  t" + n + ": {type: point, light_group: g" + n + "}\n";
  }
  const std::string head = "hyades: 1\n" + lights + "outputs:\n  - {file: a.exr, layers: [";
  const HostileReading wrong = read_hostile(head + repeated("x, ", 50'000) + "beauty]}\n");
  EXPECT_EQ(wrong.diagnostics.list().size(), 101U);
  EXPECT_LT(wrong.seconds, kPatience);
  const HostileReading aliases =
      read_hostile(head + "&wrong x, " + repeated("*wrong, ", 20'000) + "beauty]}\n");
  EXPECT_THAT(aliases.first(), HasSubstr("layer is 'x', expected beauty, alpha"));
  EXPECT_LT(aliases.seconds, kPatience);
}

/// What each is made of could be looked through for each.
TEST(HostileJob, ManyTwoSidedMaterialsOfTheSame) {
  const auto two_sided = [](const std::string& front, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
      text +=
          "  s" + std::to_string(i) + ": {type: two-sided, front: " + front + ", back: m3999}\n";
    }
    return text;
  };
  std::string chain = "hyades: 1\nmaterials:\n  m0: {type: lambert}\n";
  std::string tree = "hyades: 1\nmaterials:\n";
  for (int i = 1; i < 20'000; ++i) {
    chain += "  m" + std::to_string(i) + ": {type: mix, first: m" + std::to_string(i - 1) +
             ", second: m0}\n";
  }
  for (int i = 1; i < 4000; ++i) {
    const std::string n = std::to_string(i);
    tree += i >= 2000 ? "  m" + n + ": {type: lambert}\n"
                      : "  m" + n + ": {type: mix, first: m" + std::to_string(2 * i) +
                            ", second: m" + std::to_string(2 * i + 1) + "}\n";
  }
  const HostileReading refused = read_hostile(chain + two_sided("m19999", 20'000));
  EXPECT_EQ(refused.diagnostics.to_string(),
            "job.yaml:36:8: material 'm33' is made of more than 32 others in a row\n");
  EXPECT_LT(refused.seconds, kPatience);
  const HostileReading good = read_hostile(tree + two_sided("m1", 20'000));
  EXPECT_EQ(good.diagnostics.to_string(), "");
  EXPECT_LT(good.seconds, kPatience);
}

TEST(HostileJob, ManyStopsOfOneRamp) {
  std::string text =
      "hyades: 1\ntextures:\n  q: {type: checker}\n  r:\n    type: ramp\n"
      "    input: q\n    stops:\n";
  for (int i = 0; i < 150'000; ++i) text += "      " + std::to_string(i) + ": 0.5\n";
  const HostileReading reading = read_hostile(text);
  EXPECT_EQ(reading.diagnostics.to_string(), "");
  EXPECT_LT(reading.seconds, kPatience);
}

TEST(HostileJob, ManyObjectsWithOneName) {
  std::string text = "hyades: 1\nobjects:\n";
  for (int i = 0; i < 50000; ++i) text += "  a: {shape: sphere}\n";
  const HostileReading reading = read_hostile(text);
  EXPECT_EQ(reading.first(), "job.yaml:4:3: duplicate key 'a' (first at line 3)");
  EXPECT_EQ(reading.diagnostics.list().size(), 101U);
  EXPECT_LT(reading.seconds, kPatience);
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

TEST(HostileJob, ManyExpressionsOverManyFrames) {
  std::string text = "hyades: 1\nframes: 0-9999999\nobjects:\n";
  for (int i = 0; i < 3000; ++i) {
    text += "  a" + std::to_string(i) + ": {shape: sphere, at: [\"= sin(t) + " + std::to_string(i) +
            "\", 0, 0]}\n";
  }
  const HostileReading reading = read_hostile(text);
  EXPECT_LT(reading.seconds, kPatience);
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

TEST(HostileJob, ManyOutputsInDeepFolders) {
  // A file of each layer, and so of each group, for each of them.
  std::string text = "hyades: 1\nlights:\n";
  for (int i = 0; i < 30; ++i) {
    text +=
        "  l" + std::to_string(i) + ": {type: point, light_group: g" + std::to_string(i) + "}\n";
  }
  text += "outputs:\n";
  std::string folder;
  for (int i = 0; i < 1900; ++i) folder += "d/";
  for (int i = 0; i < 100; ++i) {
    text +=
        "  - {file: \"" + folder + std::to_string(i) + ".{layer}.exr\", layers: [light_groups]}\n";
  }
  const HostileReading reading = read_hostile(text);
  EXPECT_EQ(reading.diagnostics.to_string(), "");
  EXPECT_LT(reading.seconds, kPatience);
}

}  // namespace
}  // namespace hyades::core
