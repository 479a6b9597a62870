// Jobs of very many things that have to be looked up.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "core/job/ocio_files.h"
#include "tests/core/job/hostile_reading.h"

namespace hyades::core {
namespace {

using testing::HasSubstr;

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
            "job.yaml:1004:17: mesh of object 'o1000': the job's sequences of files have more "
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
