// `hyades worker --exit-when-idle`: it ends by itself where there is nothing to do.

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/support/temp_folder.h"
#include "tests/worker/process/process_testing.h"

namespace hyades::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(WorkerExitWhenIdle, EndsOnlyWhenAllIsRenderedAndDelivered) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--exit-when-idle", "4s"});
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  EXPECT_EQ(worker.wait(seconds(30)), 0) << worker.log();
  EXPECT_NE(worker.log().find("no work for 4"), std::string::npos) << worker.log();
  const auto seen = coordinator.seen();
  ASSERT_EQ(seen.leavings.size(), 1U);
  EXPECT_EQ(seen.leavings.front().reason(), "without work");
  EXPECT_EQ(seen.returned, 0U);
}

TEST(WorkerExitWhenIdle, FilmsThatWaitForTheirAcknowledgementAreWork) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.acknowledge = false;
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--exit-when-idle", "2s"});
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 6; }))
      << worker.log();
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  EXPECT_EQ(worker.wait(seconds(4)), std::nullopt) << worker.log();
}

TEST(WorkerExitWhenIdle, ACoordinatorThatIsNotThereIsNoWork) {
  const test::TempFolder folder;
  WorkerProcess worker("127.0.0.1:1", folder.path().string(), {"--exit-when-idle", "1s"});
  EXPECT_EQ(worker.wait(seconds(30)), 0) << worker.log();
}

TEST(WorkerExitWhenIdle, ACoordinatorThatGoesForGoodHoldsNobody) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.lease_ms = 1000;
  coordinator.acknowledge = false;
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--exit-when-idle", "3s"});
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 2; }))
      << worker.log();
  coordinator.stop();
  EXPECT_EQ(worker.wait(seconds(60)), 0) << worker.log();
  EXPECT_NE(worker.log().find("films were not acknowledged in time"), std::string::npos)
      << worker.log();
}

TEST(WorkerExitWhenIdle, ACoordinatorThatComesBackInTimeIsWorkedFor) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--exit-when-idle", "12s"});
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 2; }))
      << worker.log();
  coordinator.stop();
  std::this_thread::sleep_for(seconds(1));
  coordinator.start();
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
}

TEST(WorkerExitWhenIdle, SaysWhatItTakes) {
  const test::TempFolder folder;
  WorkerProcess worker("127.0.0.1:1", folder.path().string(), {"--exit-when-idle", "5min"});
  EXPECT_EQ(worker.wait(seconds(30)), 2);
  EXPECT_NE(worker.log().find("--exit-when-idle 5min: expected a length of time such as 90s, 5m"),
            std::string::npos)
      << worker.log();
}

}  // namespace
}  // namespace hyades::worker
