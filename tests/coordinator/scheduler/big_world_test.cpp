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

}  // namespace
}  // namespace hyades::coordinator
