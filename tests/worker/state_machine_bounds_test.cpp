// What a coordinator that means ill may not have of a worker.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/worker/state_machine_testing.h"
#include "worker/worker_context.h"

namespace hyades::worker {
namespace {

bool asks_for_units(const v1::WorkerMessage& message) {
  return message.has_request() || message.result().want() > 0 || message.failure().want() > 0;
}

TEST(StateMachineBounds, ASecondWelcomeEndsTheStream) {
  WorkerWorld world;
  world.begin();
  EXPECT_TRUE(world.ports.broken_off.empty());
  world.welcome();
  ASSERT_EQ(world.ports.broken_off.size(), 1U);
  EXPECT_EQ(world.ports.broken_off[0], "the coordinator welcomed this worker twice");
  EXPECT_FALSE(world.machine->attended());
  world.take_sent();
  world.job(8);
  world.lease(WorkerWorld::unit(0));
  EXPECT_TRUE(world.machine->empty()) << "what still comes on this stream is not heard";
  world.machine->stream_opened(world.now);
  world.welcome();
  EXPECT_TRUE(world.machine->attended()) << "the next one is another";
  EXPECT_EQ(world.ports.broken_off.size(), 1U);
}

TEST(StateMachineBounds, UnitsThatNobodyAskedForEndTheStream) {
  WorkerWorld world(2, 1);
  world.begin();
  for (const int x : {0, 8, 16}) world.lease(WorkerWorld::unit(x));
  EXPECT_TRUE(world.ports.broken_off.empty());
  world.lease(WorkerWorld::unit(24));
  ASSERT_EQ(world.ports.broken_off.size(), 1U);
  EXPECT_EQ(world.machine->in_hand(), 3U) << "of what it has nothing is lost";
  // On the next stream it may have those again, and no others in their place.
  world.machine->stream_opened(world.now);
  world.welcome();
  world.job();
  for (const int x : {0, 8, 16}) world.lease(WorkerWorld::unit(x, 2), true);
  EXPECT_EQ(world.ports.broken_off.size(), 1U);
  world.take_sent();
  world.lease(WorkerWorld::unit(32, 2), true);
  EXPECT_EQ(world.ports.broken_off.size(), 2U);
  EXPECT_TRUE(world.take_sent().empty()) << "a unit given back for each would be an answer too";
}

TEST(StateMachineBounds, AProofThatIsNoneEndsTheStream) {
  WorkerWorld world;
  world.begin();
  auto unit = WorkerWorld::unit(0);
  unit.mutable_unit()->set_proof(std::string(16, 'p'));
  world.lease(unit);
  EXPECT_TRUE(world.ports.broken_off.empty());
  unit = WorkerWorld::unit(8);
  unit.mutable_unit()->set_proof(std::string(100'000, 'p'));
  world.lease(unit);
  EXPECT_EQ(world.ports.broken_off.size(), 1U);
  EXPECT_EQ(world.machine->in_hand(), 1U);
}

TEST(StateMachineBounds, JobsBeyondTheirRoomEndTheStreamAndAreForgottenOnTheNext) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  const std::string long_name(size_t{100} << 10U, 'n');
  uint64_t jobs = 100;
  for (; jobs < 200 && world.ports.broken_off.empty(); ++jobs) world.job(jobs, {}, long_name);
  ASSERT_EQ(world.ports.broken_off.size(), 1U);
  EXPECT_LE(jobs, 100U + 11U);
  // Jobs of former streams make room, but for that of the unit in hand.
  world.machine->stream_opened(world.now);
  world.welcome();
  world.job();
  for (uint64_t job = 300; job < 308; ++job) world.job(job, {}, long_name);
  EXPECT_EQ(world.ports.broken_off.size(), 1U);
  world.lease(WorkerWorld::unit(0, 2), true);
  world.film(world.token_of(0));
  EXPECT_EQ(world.machine->unacknowledged(), 1U);
}

TEST(StateMachineBounds, TheSameJobCountsOnceAndOneThatIsOverNotAtAll) {
  WorkerWorld world;
  world.begin();
  const std::string long_name(size_t{100} << 10U, 'n');
  for (int i = 0; i < 100; ++i) world.job(300, {}, long_name);
  for (int i = 0; i < 1000; ++i) world.job(301);
  for (uint64_t job = 1000; job < 1100; ++job) {
    world.job(job, {}, long_name);
    v1::CoordinatorMessage over;
    over.mutable_over()->set_job(job);
    world.machine->coordinator_says(over, world.now);
  }
  EXPECT_TRUE(world.ports.broken_off.empty());
  for (uint64_t job = 2000; job < 3000; ++job) world.job(job);
  EXPECT_EQ(world.ports.broken_off.size(), 1U) << "short ones count too";
}

TEST(StateMachineBounds, TextsArePassedOnUpToALength) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.film(world.token_of(0));
  v1::CoordinatorMessage message;
  *message.mutable_rejected()->mutable_unit() = WorkerWorld::unit(0);
  message.mutable_rejected()->set_reason(v1::Rejected::REASON_DAMAGED);
  message.mutable_rejected()->set_text(std::string(1'000'000, 't'));
  world.machine->coordinator_says(message, world.now);
  ASSERT_FALSE(world.ports.notes.empty());
  EXPECT_LT(world.ports.notes.back().size(), 5000U);
  world.take_sent();
  message.mutable_drain()->set_reason(std::string(1'000'000, 't'));
  world.machine->coordinator_says(message, world.now);
  const auto sent = world.take_sent();
  EXPECT_LT(first(sent, &v1::WorkerMessage::has_leaving).leaving().reason().size(), 5000U);
}

TEST(StateMachineBounds, AsksForNothingWhileTooManySmallFilmsWait) {
  StateMachineOptions options;
  options.worker_id = "0123456789abcdef";
  options.threads = 1;
  options.max_kept = 2;
  WorkerWorld world;
  world.machine.emplace(options, world.ports);
  world.begin();
  int x = 0;
  for (; x < 50; ++x) {
    const auto sent = world.take_sent();
    const bool asks = std::any_of(sent.begin(), sent.end(), asks_for_units);
    if (x > 1 && !asks) break;
    world.lease(WorkerWorld::unit(8 * x));
    if (x == 0) world.machine->files_are_there(WorkerWorld::kJob);
    if (world.token_of(8 * x) == 0) world.machine->files_are_there(WorkerWorld::kJob);
    world.film(world.token_of(8 * x));
  }
  EXPECT_LE(x, 5);
  EXPECT_LE(world.machine->unacknowledged(), 5U);
}

TEST(WorkerLog, HasManyLinesAtOnceAndFewInTheLongRun) {
  WorkerLog log("w");
  TimePoint now = std::chrono::steady_clock::now() + std::chrono::hours(1);
  const auto written = [&](int tries) {
    testing::internal::CaptureStderr();
    for (int i = 0; i < tries; ++i) log.note(farm::LogLevel::info, "said", {}, now);
    return testing::internal::GetCapturedStderr();
  };
  const auto lines = [](const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_EQ(lines(written(5000)), WorkerLog::kLinesAtOnce);
  now += std::chrono::seconds(1);
  const std::string next = written(10);
  EXPECT_NE(next.find("too much to tell: 4000 lines left out"), std::string::npos) << next;
  EXPECT_EQ(lines(next), 2);
  int64_t later = 0;
  for (int i = 0; i < 1000; ++i) {
    now += std::chrono::milliseconds(100);
    later += lines(written(10));
  }
  EXPECT_NEAR(static_cast<double>(later), 200, 4) << "one a second, and what it left out";
}

}  // namespace
}  // namespace hyades::worker
