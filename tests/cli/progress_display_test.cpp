// What is said of how far a run is.
#include "cli/progress_display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace hyades::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string said_of(const coordinator::Progress& progress) {
  return progress_line("shot", progress, false);
}

TEST(ProgressDisplay, SaysThatFramesAreBeingFinished) {
  coordinator::Progress progress;
  progress.frames = 48;
  progress.frames_done = 33;
  progress.frames_finishing = 15;
  progress.samples = progress.samples_done = 1000;
  progress.samples_per_second = 10;
  progress.seconds_left = 90;
  EXPECT_THAT(said_of(progress), HasSubstr("making the outputs of 15 frames"));
  EXPECT_THAT(said_of(progress), HasSubstr("left"));
  // Rendering tells of itself as long as there is some.
  progress.samples_done = 900;
  EXPECT_THAT(said_of(progress), Not(HasSubstr("making")));
  EXPECT_THAT(said_of(progress), HasSubstr("samples/s"));
}

}  // namespace
}  // namespace hyades::cli
