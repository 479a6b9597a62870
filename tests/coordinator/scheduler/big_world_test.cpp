// A farm of some size over some minutes; bench_big_farm lives the same with 10,000 workers.
#include <gtest/gtest.h>

#include "tests/coordinator/scheduler/big_world.h"

namespace hyades::coordinator {
namespace {

BigWorldOptions some_minutes() {
  BigWorldOptions options;
  options.workers = 300;
  options.jobs = 8;
  options.frames = 2;
  options.region = {0, 0, 960, 540};
  options.batches = 128;
  return options;
}

TEST(BigWorld, IsBusyThoughWorkersArePreempted) {
  BigWorldReport r;
  try {
    r = BigWorld(some_minutes()).run();
  } catch (const std::string& wrong) {
    FAIL() << wrong;
  }
  print(r);
  EXPECT_EQ(r.frames_done, 16U);
  EXPECT_GE(r.preempted, 10U);
  EXPECT_GE(r.duration, 300);
  // Of which the first scenes and the last units are most.
  EXPECT_GE(r.efficiency(), 0.95);
}

/// Its last jobs are where a farm has more workers than frames to spread them over.
TEST(BigWorld, OneJobIsEnoughForManyWorkers) {
  BigWorldOptions options = some_minutes();
  options.workers = 400;
  options.jobs = 1;
  options.frames = 12;
  BigWorldReport r;
  try {
    r = BigWorld(options).run();
  } catch (const std::string& wrong) {
    FAIL() << wrong;
  }
  print(r);
  EXPECT_LE(r.enough.loading / r.enough.there, 0.001);
  EXPECT_LE(r.duration - r.enough_until, 20);
}

}  // namespace
}  // namespace hyades::coordinator
