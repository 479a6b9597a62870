#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/job/parse.h"
#include "core/job/render_key.h"
#include "tests/core/job/test_assets.h"

namespace hyades::core {
namespace {

using testing::HasSubstr;

struct ReadMediaFile {
  Job job;
  std::string complaints;
  std::vector<AssetRecord> assets;
};

ReadMediaFile read_with_media(const std::string& text, MemoryAssets files) {
  RecordingResolver assets(files);
  Diagnostics diagnostics;
  ReadMediaFile result;
  result.job = parse_job("hyades: 1\n" + text, "jobs/job.yaml", assets, diagnostics);
  result.complaints = diagnostics.to_string();
  result.assets = assets.records();
  return result;
}

ReadMediaFile read_file(const std::string& content) {
  MemoryAssets assets;
  assets.add("media.json", content);
  return read_with_media("media: {file: media.json}\n", assets);
}

constexpr const char* kMilk =
    R"({"name": "milk", "absorption": [0.1, 0.2, 0.3], "scattering":[7,8,9],"g":0.9,"index":1.33})";

void expect_milk(const MediumDesc& milk) {
  EXPECT_EQ(milk.name, "milk");
  EXPECT_EQ(milk.absorption.constant, Rgb(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(milk.scattering.constant, Rgb(7.0F, 8.0F, 9.0F));
  EXPECT_EQ(milk.g.constant, Rgb(0.9F));
  EXPECT_EQ(milk.index->constant, 1.33F);
}

TEST(MediaFile, HoldsOneMediumOrSeveralInAnyOfTheFormsOfTheSimpleKind) {
  const std::string one = kMilk;
  const std::string tabs =
      "{\n\t\"name\":\t\"milk\",\n\t\"sigma_a\": [0.1, 0.2, 0.3],\n"
      "\t\"sigma_s\": [7, 8, 9],\n\t\"g\": [0.9, 0.9, 0.9],\n\t\"ior\": 1.33\n}\n";
  const std::string section =
      R"({"media": {"milk": {"absorption": [1e-1, 2E-1, 0.3], "scattering": [7, 8, 9], "g": 0.9,
          "index": 1.33}}})";
  const std::string yaml =
      "media:\n  milk: {absorption: [0.1, 0.2, 0.3], scattering: [7, 8, 9], g: 0.9, index: 1.33}\n";
  for (const std::string& text :
       {one, "[" + one + "]", tabs, section, yaml, R"({"media": [)" + one + "]}"}) {
    const ReadMediaFile found = read_file(text);
    ASSERT_EQ(found.complaints, "") << text;
    ASSERT_EQ(found.job.media.size(), 1U) << text;
    expect_milk(found.job.media[0]);
  }
}

TEST(MediaFile, StandsBesideOtherMediaAndFilesAndCanBeLike) {
  MemoryAssets assets;
  assets.add("parts/glass.yaml", "media: {file: [../media.json, wax.json]}\n");
  assets.add("media.json", std::string("[") + kMilk + R"(, {"name": "ink", "absorption": 50}])");
  assets.add("parts/wax.json", R"({"name": "wax", "scattering": 4})");
  const ReadMediaFile found = read_with_media(
      "include: parts/glass.yaml\n"
      "media: {file: media.json, thin: {like: milk, scale: 0.1}}\n"
      "objects: {drop: {shape: sphere, interior: ink}}\natmosphere: thin\n",
      assets);
  ASSERT_EQ(found.complaints, "");
  std::vector<std::string> names;
  for (const MediumDesc& medium : found.job.media) names.push_back(medium.name);
  EXPECT_THAT(names, testing::UnorderedElementsAre("thin", "milk", "ink", "wax"));
  for (const MediumDesc& medium : found.job.media) {
    if (medium.name != "thin") continue;
    EXPECT_EQ(medium.scattering.constant, Rgb(7.0F, 8.0F, 9.0F));
    EXPECT_EQ(medium.scale.constant, 0.1F);
  }
}

TEST(MediaFile, DecidesThePictureByItsValuesAlone) {
  const auto key = [](const std::string& content) {
    const ReadMediaFile found = read_file(content);
    EXPECT_EQ(found.complaints, "");
    return render_key(found.job, 1, found.assets);
  };
  EXPECT_EQ(key(R"({"name": "a", "scattering": 2})"), key(R"([{"name":"a","sigma_s":[2,2,2.0]}])"));
  EXPECT_NE(key(R"({"name": "a", "scattering": 2})"), key(R"({"name": "a", "scattering": 3})"));
}

TEST(MediaFile, MayBeTheNameOfAMedium) {
  const ReadMediaFile found =
      read_with_media("media: {file: {scattering: 2}}\natmosphere: file\n", {});
  ASSERT_EQ(found.complaints, "");
  EXPECT_EQ(found.job.media.at(0).name, "file");
}

TEST(MediaFile, ThatCannotBeReadIsTheOnlyComplaint) {
  MemoryAssets assets;
  assets.add("media.json", "[{\"name\": \"jade\"");
  const ReadMediaFile found = read_with_media(
      "media: {file: media.json}\nobjects: {a: {shape: sphere, interior: jade}}\n", assets);
  EXPECT_EQ(std::count(found.complaints.begin(), found.complaints.end(), '\n'), 1)
      << found.complaints;
}

TEST(MediaFile, ComplaintsTellFileAndLine) {
  EXPECT_EQ(read_file("{\"name\": \"milk\",\n \"absorbtion\": 2}").complaints,
            "jobs/media.json:2:2: unknown key 'absorbtion' in medium 'milk', did you mean "
            "'absorption'?\n");
  EXPECT_THAT(read_file(R"([{"absorption": 2}])").complaints,
              HasSubstr("jobs/media.json:1:2: a medium is a map, expected a map with a name"));
  EXPECT_THAT(read_file("[\n" + std::string(kMilk) + ",\n" + kMilk + "]").complaints,
              HasSubstr("jobs/media.json:3:2: there is another medium 'milk'"));
  EXPECT_THAT(read_file(R"({"name": "a", "g": 0.1, "sigma_a": 1, "absorption": 2})").complaints,
              HasSubstr("media.json:1:39: there is another key that means absorption"));
  EXPECT_THAT(read_file(R"({"name": "a", "g": 1})").complaints,
              HasSubstr("jobs/media.json:1:20: g is '1', expected"));
  EXPECT_THAT(read_file("12").complaints, HasSubstr("expected a medium or a list of them"));
  EXPECT_THAT(read_file("{\"name\": \"a\"").complaints, HasSubstr("jobs/media.json:"));
  EXPECT_THAT(read_with_media("media: {file: gone.json}", {}).complaints,
              HasSubstr("job.yaml:2:15: file of media: gone.json: no such file"));
  EXPECT_THAT(read_with_media("media: {file: [[a]]}", {}).complaints,
              HasSubstr("file of media is a list of 1, expected a file name"));
  MemoryAssets assets;
  assets.add("media.json", kMilk);
  EXPECT_THAT(read_with_media("media: {file: media.json, milk: {}}", assets).complaints,
              HasSubstr("'milk' is also at jobs/job.yaml:2; expected it in one file only"));
}

}  // namespace
}  // namespace hyades::core
