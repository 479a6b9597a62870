#include "core/finish/video.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/image/write_image.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

/// A folder with two pictures for film.mp4, and PATH with a program called ffmpeg that is `script`.
class Video : public testing::Test {
 protected:
  Video() {
    video_.file = "film.mp4";
    video_.pictures = "film.mp4.frames/####.png";
    frames_.folder = folder_.path();
    frames_.numbers = {1, 2};
    std::filesystem::create_directory(folder_.file("film.mp4.frames"));
    for (const int32_t number : frames_.numbers) write_picture(number, 8);
  }
  ~Video() override { setenv("PATH", old_path_.c_str(), 1); }

  void write_picture(int32_t number, int width) {
    Image image = make_image(width, 8, {"R", "G", "B"});
    const std::string path = folder_.file("film.mp4.frames/000" + std::to_string(number) + ".png");
    ASSERT_TRUE(write_png(path, image, {{"hyades.job", "film"}}).ok());
  }
  void be_ffmpeg(const std::string& script) {
    const std::string path = folder_.file("ffmpeg");
    std::ofstream(path) << "#!/bin/sh\n" << script;
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    setenv("PATH", (folder_.path().string() + ":" + old_path_).c_str(), 1);
  }
  std::string failure(const VideoPatience& patience = {}) {
    const Status made = make_video(video_, frames_, patience);
    EXPECT_FALSE(made.ok());
    EXPECT_FALSE(std::filesystem::exists(folder_.file("film.mp4")));
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      EXPECT_FALSE(entry.path().string().ends_with(".tmp"));
    }
    EXPECT_TRUE(missing_pictures(video_, frames_).empty());
    return made.ok() ? "" : made.error().message.substr(made.error().message.find("film.mp4"));
  }

  const std::string old_path_ = getenv("PATH");
  test::TempFolder folder_;
  VideoDesc video_;
  VideoFrames frames_;
};

TEST_F(Video, OneWithoutProgressIsEnded) {
  be_ffmpeg("exec sleep 60");
  VideoPatience patience;
  patience.still = std::chrono::milliseconds(200);
  EXPECT_EQ(failure(patience), "film.mp4: ffmpeg made no progress for 0.2 s and was ended");
}

TEST_F(Video, OneThatGetsOnMayTakeItsTime) {
  be_ffmpeg(
      "for last; do :; done; for i in 1 2 3 4 5 6 7 8; do echo x; sleep 0.1; done >${last#file:}");
  VideoPatience patience;
  patience.still = std::chrono::milliseconds(500);
  EXPECT_TRUE(make_video(video_, frames_, patience).ok());
  EXPECT_EQ(std::filesystem::file_size(folder_.file("film.mp4")), 16U);
}

TEST_F(Video, StopsWhenItIsAskedTo) {
  be_ffmpeg("exec sleep 60");
  VideoPatience patience;
  patience.stop = [] { return true; };
  EXPECT_EQ(failure(patience), "film.mp4: stopped");
}

TEST_F(Video, WhatFfmpegSaysIsTold) {
  be_ffmpeg("echo 'Unknown encoder libx264' >&2; exit 1");
  EXPECT_EQ(failure(), "film.mp4: ffmpeg failed (1): Unknown encoder libx264");
}

TEST_F(Video, WithoutFfmpegItSaysWhatToInstall) {
  setenv("PATH", "/nowhere", 1);
  EXPECT_FALSE(have_ffmpeg());
  EXPECT_EQ(failure(),
            "film.mp4: ffmpeg is not here (no such program in PATH): install it (apt install "
            "ffmpeg)");
}

TEST_F(Video, PicturesOfOtherSizesAreNotMixed) {
  be_ffmpeg("cat >/dev/null");
  write_picture(2, 10);
  EXPECT_NE(
      failure().find("0002.png is of another rendering than the first picture: 10 x 8 pixels, "
                     "not 8 x 8"),
      std::string::npos);
}

TEST(VideoFrames, MotionKeepsItsSpeed) {
  Job job;
  job.frames = {1, 9, 2, 24.0F};
  EXPECT_DOUBLE_EQ(video_frames(job, "", {1, 3, 5}).rate, 12);
  EXPECT_DOUBLE_EQ(video_frames(job, "", {5, 1, 9}).rate, 6);
  EXPECT_EQ(video_frames(job, "", {5, 1, 9}).numbers, (std::vector<int32_t>{1, 5, 9}));
  EXPECT_DOUBLE_EQ(video_frames(job, "", {7}).rate, 24);
  EXPECT_TRUE(are_all_frames(job, {1, 3, 5, 7, 9}));
  EXPECT_FALSE(are_all_frames(job, {1, 3, 5, 7}));
  EXPECT_FALSE(are_all_frames(job, {1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace hyades::core
