// Media of a file for the materials of a scene: --media.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/job/parse.h"
#include "import/job_files.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

using testing::HasSubstr;
using testing::Not;

class FillWithMedia : public testing::Test {
 protected:
  FillWithMedia() {
    write(
        "media.json",
        R"([{"name": "jade", "absorption": [1, 2, 3], "scattering": [40, 60, 45], "index": 1.6}])");
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.file(name), std::ios::binary) << text;
  }

  /// The job of a scene with these media, or what is wrong.
  std::string job_of(const std::string& scene) const {
    write("s.pbrt", "Camera \"perspective\" WorldBegin\n" + scene);
    JobFileOptions options;
    options.media = folder_.file("media.json");
    const auto files = JobFiles::open(folder_.file("s.pbrt"), options);
    if (!files) return files.error().message;
    const auto bytes = (*files)->files().open((*files)->document());
    if (!bytes) return bytes.error().message;
    const std::string text(bytes->chars(), bytes->size());
    Diagnostics diagnostics;
    parse_job(text, (*files)->document(), (*files)->files(), diagnostics);
    return diagnostics.empty() ? text : diagnostics.to_string();
  }

  test::TempFolder folder_;
};

constexpr const char* kJade = "MakeNamedMaterial \"jade\" \"string type\" \"diffuse\"\n";

// Copies of a group share what fills it.
TEST_F(FillWithMedia, FillsObjectsOfGroups) {
  const std::string job = job_of(std::string(kJade) +
                                 "ObjectBegin \"stone\" NamedMaterial \"jade\" Shape \"sphere\" "
                                 "Material \"diffuse\" Shape \"disk\" ObjectEnd\n"
                                 "ObjectInstance \"stone\" Translate 3 0 0 "
                                 "ObjectInstance \"stone\"");
  EXPECT_THAT(job, HasSubstr("media: {file: media.json}"));
  EXPECT_THAT(job, HasSubstr("interior: jade"));
  const size_t group = job.find("groups:");
  const size_t filled = job.find("interior: jade");
  ASSERT_NE(group, std::string::npos) << job;
  EXPECT_LT(group, filled);
  EXPECT_EQ(job.find("interior", filled + 1), std::string::npos) << job;
  // The medium's own index stands in for the material.
  EXPECT_THAT(job, Not(HasSubstr("material: jade")));
}

// What the scene fills by itself, and the file does not name, stays.
TEST_F(FillWithMedia, LeavesTheScenesOwnMedia) {
  const std::string job = job_of(std::string(kJade) +
                                 "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
                                 "NamedMaterial \"jade\" Shape \"sphere\"\n"
                                 "MediumInterface \"fog\" \"\" Material \"interface\" "
                                 "Translate 4 0 0 Shape \"sphere\"");
  EXPECT_THAT(job, HasSubstr("interior: jade"));
  EXPECT_THAT(job, HasSubstr("interior: fog"));
}

TEST_F(FillWithMedia, SaysWhatItFoundWhereNothingFits) {
  EXPECT_THAT(job_of("MakeNamedMaterial \"granite\" \"string type\" \"diffuse\" "
                     "NamedMaterial \"granite\" Shape \"sphere\" Shape \"disk\""),
              HasSubstr("none of its media (jade) has the name of a material of s.pbrt (granite"));
}

}  // namespace
}  // namespace hyades::core
