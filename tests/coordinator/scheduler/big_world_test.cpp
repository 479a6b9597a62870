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

void report(const BigWorldReport& r) {
  std::printf(
      "%.0f s: efficiency %.2f %%, lost %.2f %%, waiting for scenes %.2f %%; %llu units, %llu "
      "scenes loaded, %llu pre-empted, %llu events\n",
      r.duration, 100 * r.efficiency(), 100 * r.lost / r.thread_seconds,
      100 * r.waiting_for_scene / r.thread_seconds, static_cast<unsigned long long>(r.units),
      static_cast<unsigned long long>(r.scenes_loaded),
      static_cast<unsigned long long>(r.preempted), static_cast<unsigned long long>(r.events));
}

TEST(BigWorld, IsBusyThoughWorkersArePreempted) {
  BigWorldReport r;
  try {
    r = BigWorld(some_minutes()).run();
  } catch (const std::string& wrong) {
    FAIL() << wrong;
  }
  report(r);
  EXPECT_EQ(r.frames_done, 16U);
  EXPECT_GE(r.preempted, 10U);
  EXPECT_GE(r.duration, 300);
  // Of which the first scenes and the last units are most.
  EXPECT_GE(r.efficiency(), 0.95);
}

}  // namespace
}  // namespace hyades::coordinator
