// `hyades watch --display`.
#include "cli/client/film_display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "cli/client_commands.h"
#include "core/image/write_image.h"
#include "tests/cli/client/fake_farm.h"
#include "tests/support/fake_viewer.h"
#include "tests/support/temp_folder.h"

namespace hyades::cli {
namespace {

using test::FakeViewer;

/// A film of one layer besides beauty, with so many batches.
core::Film film_of(uint32_t batches) {
  core::Film film(core::make_film_layout({.albedo = true}), {0, 0, 90, 40});
  std::vector<float> values(90UL * 40 * static_cast<size_t>(film.layout().deposited));
  for (uint32_t batch = 0; batch < batches; ++batch) {
    for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 97 + batch);
    film.deposit({0, 0, 90, 40}, batch, 16, values);
  }
  return film;
}

bool shows(const FakeViewer::Seen& seen, const std::string& name, const core::Image& picture) {
  const auto found = seen.pictures.find(name);
  return found != seen.pictures.end() && found->second.width == picture.width &&
         found->second.channels == picture.channels && found->second.values == picture.data;
}

class Display : public ::testing::Test {
 protected:
  Display() {
    v1::Job job;
    job.set_id(1);
    job.set_name("walk");
    job.set_state(v1::JOB_STATE_RUNNING);
    farm_.jobs.push_back(job);
  }

  /// News of one frame of a job of two.
  void tell(v1::JobState job, int32_t frame, v1::FrameState state, uint64_t samples) {
    v1::WatchEvent event;
    event.mutable_job()->set_id(1);
    event.mutable_job()->set_name("walk");
    event.mutable_job()->set_frames(2);
    event.mutable_job()->set_state(job);
    v1::Frame& changed = *event.add_changed();
    changed.set_frame(frame);
    changed.set_state(state);
    changed.set_samples(32);
    changed.set_samples_done(samples);
    farm_.events.push_back(event);
  }

  int watch() {
    std::vector<std::string> words{"watch",         "1",         "--quiet",        "--coordinator",
                                   farm_.address(), "--display", viewer_.address()};
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    return watch_command(static_cast<int>(argv.size()), argv.data());
  }

  FakeFarm farm_;
  FakeViewer viewer_;
};

TEST_F(Display, FilmsAreShownInMidRenderAndInTheEnd) {
  tell(v1::JOB_STATE_RUNNING, 7, v1::FRAME_STATE_RENDERING, 16);
  tell(v1::JOB_STATE_RUNNING, 7, v1::FRAME_STATE_FINISHING, 32);
  tell(v1::JOB_STATE_DONE, 7, v1::FRAME_STATE_DONE, 32);
  farm_.films[7] = film_of(1);
  bool first_seen = false;
  bool second_seen = false;
  farm_.before_event = [&](size_t event) {
    if (event == 1) {
      first_seen = viewer_.wait_until(
          [](const auto& seen) { return shows(seen, "walk.0007", film_of(1).normalised()); });
      farm_.films[7] = film_of(2);
    }
    if (event == 2) {
      second_seen = viewer_.wait_until(
          [](const auto& seen) { return shows(seen, "walk.0007", film_of(2).normalised()); });
      farm_.films.clear();
    }
  };
  EXPECT_EQ(watch(), kDone);
  EXPECT_TRUE(first_seen);
  EXPECT_TRUE(second_seen);
  EXPECT_THAT(viewer_.seen().wrong, testing::IsEmpty());
}

TEST_F(Display, AFrameWhoseFilmIsGoneIsShownAsItsExr) {
  const test::TempFolder folder;
  const core::Image picture = film_of(2).normalised();
  ASSERT_TRUE(core::write_exr(folder.file("a.exr"), picture));
  std::stringstream bytes;
  bytes << std::ifstream(folder.file("a.exr"), std::ios::binary).rdbuf();
  farm_.outputs["walk.0007.exr"] = bytes.str();
  farm_.outputs["walk.0007.png"] = "no picture";
  farm_.frame_of_outputs = 7;
  tell(v1::JOB_STATE_DONE, 7, v1::FRAME_STATE_DONE, 32);
  EXPECT_EQ(watch(), kDone);
  EXPECT_TRUE(
      viewer_.wait_until([](const auto& seen) { return seen.pictures.contains("walk.0007"); }));
  const auto seen = viewer_.seen();
  const FakeViewer::Picture& shown = seen.pictures.at("walk.0007");
  EXPECT_THAT(shown.channels, testing::UnorderedElementsAreArray(picture.channels));
  EXPECT_THAT(seen.wrong, testing::IsEmpty());
}

TEST_F(Display, WhatIsNoFilmIsNotShown) {
  tell(v1::JOB_STATE_DONE, 7, v1::FRAME_STATE_DONE, 32);
  farm_.outputs["walk.0007.exr"] = std::string(5000, 'x');
  farm_.frame_of_outputs = 7;
  EXPECT_EQ(watch(), kDone);
  EXPECT_TRUE(viewer_.seen().pictures.empty());
}

}  // namespace
}  // namespace hyades::cli
