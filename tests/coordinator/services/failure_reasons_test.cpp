// Why frames have failed, of which there may be very many.
#include "coordinator/controller/failure_reasons.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

std::string long_reason(int32_t frame) {
  std::string reason = std::to_string(frame) + " ";
  reason.resize(4000, '.');
  return reason;
}

TEST(FailureReasons, TakeNoMoreThanTheyMay) {
  FailureReasons reasons;
  std::vector<FailureReasons::Reason> all;
  std::set<const std::string*> different;
  size_t bytes = 0;
  for (int32_t frame = 0; frame < 100'000; ++frame) {
    all.push_back(reasons.share(long_reason(frame)));
    if (different.insert(all.back().get()).second) bytes += all.back()->size();
  }
  EXPECT_LE(bytes, FailureReasons::kMostBytes);
  EXPECT_EQ(*all[0], long_reason(0));
  EXPECT_EQ(reasons.share(long_reason(1)), all[1]) << "what many have in common is there once";
  EXPECT_NE(all.back()->find("told when the job has ended"), std::string::npos);
  all.clear();
  EXPECT_EQ(*reasons.share(long_reason(99)), long_reason(99)) << "the frames have begun again";
}

size_t long_reasons(const FarmWorld& world, uint64_t job) {
  size_t found = 0;
  v1::GetJobRequest request;
  request.set_job(job);
  for (bool more = true; more;) {
    v1::GetJobResponse page;
    const grpc::Status status = world.jobs->Get(world.context().get(), request, &page);
    EXPECT_TRUE(status.ok()) << status.error_message();
    for (const v1::Frame& frame : page.frames()) {
      found += frame.reason() == long_reason(frame.frame());
      request.set_after(frame.frame());
    }
    more = page.more();
  }
  return found;
}

TEST(FailureReasons, OfMoreFramesThanHaveRoomAreToldWhenTheJobHasEnded) {
  FarmWorld world;
  world.start();
  const uint64_t job =
      world.submit(40, [](v1::SubmitRequest& asked) { asked.set_max_attempts(1); });
  {
    ScriptedWorker::Script script = world.script();
    script.meddle = [](ScriptedWorker& worker, const v1::LeasedUnit& unit) {
      const int32_t frame = unit.unit().frame();
      return frame < 40 && worker.fail(unit, long_reason(frame));
    };
    const ScriptedWorker worker(world.address, script);
    ASSERT_TRUE(eventually([&] { return world.get(job).job().frames_failed() == 39; }));
  }
  const std::string explained = world.explain(job);
  EXPECT_NE(explained.find("frame 20 failed"), std::string::npos) << explained;
  EXPECT_EQ(explained.find("frame 21 failed"), std::string::npos);
  EXPECT_NE(explained.find("19 more frames failed"), std::string::npos) << explained;
  for (int life = 0; life < 2; ++life) {
    EXPECT_GE(long_reasons(world, job), 10U);
    EXPECT_LE(long_reasons(world, job), FailureReasons::kMostBytes / 4000);
    world.stop();
    world.start();
  }
  v1::JobResponse now;
  ASSERT_TRUE(world.jobs->Cancel(world.context().get(), about(job), &now).ok());
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_CANCELLED));
  EXPECT_TRUE(eventually([&] { return long_reasons(world, job) == 39; }));
}

}  // namespace
}  // namespace hyades::coordinator
