// A worker that knows several coordinators, of which one leads.

#include <gtest/gtest.h>

#include <chrono>

#include "tests/support/relay.h"
#include "tests/support/temp_folder.h"
#include "tests/worker/process/process_testing.h"

namespace hyades::worker {
namespace {

using std::chrono::seconds;

TEST(WorkerAddresses, TheOneThatLeadsIsFoundAndBringsTheFilesToo) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  const test::Relay silent;
  WorkerProcess worker(silent.address() + ",127.0.0.1:1," + coordinator.address(),
                       folder.path().string());
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  EXPECT_EQ(coordinator.seen().downloads, 3U);
  EXPECT_NE(worker.log().find("working for " + coordinator.address()), std::string::npos)
      << worker.log();
  EXPECT_EQ(worker.log().find("no connection"), std::string::npos)
      << "who stands by is nothing to tell of: " << worker.log();
}

TEST(WorkerAddresses, ALeaderThatFreezesIsLeftForTheNextOne) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator frozen(made.job);
  FakeCoordinator next(made.job);
  test::Relay relay(frozen.address());
  WorkerProcess worker(relay.address() + ",127.0.0.1:1," + next.address(), folder.path().string());
  ASSERT_TRUE(frozen.wait_until([](const auto& seen) { return seen.accepted >= 2; }))
      << worker.log();
  EXPECT_EQ(next.seen().hellos.size(), 0U);
  relay.freeze();
  EXPECT_TRUE(next.wait_until([](const auto& seen) { return !seen.hellos.empty(); }, seconds(8)))
      << worker.log();
  ASSERT_TRUE(next.wait_for_all()) << worker.log();
  expect_whole(next, made);
}

TEST(WorkerAddresses, ACoordinatorThatTakesTheStreamAndSaysNothingIsLeftForTheNextOne) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator silent({});
  silent.silent = true;
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(silent.address() + "," + coordinator.address(), folder.path().string());
  ASSERT_TRUE(silent.wait_until([](const auto& seen) { return !seen.hellos.empty(); }))
      << worker.log();
  EXPECT_TRUE(
      coordinator.wait_until([](const auto& seen) { return !seen.hellos.empty(); }, seconds(8)))
      << worker.log();
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  EXPECT_EQ(silent.seen().hellos.size(), 1U);
}

TEST(WorkerAddresses, WhereNobodyAnswersItIsToldOnceAndTriedOnAndOn) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.stop();
  const std::string all = "127.0.0.1:1," + coordinator.address();
  WorkerProcess worker(all, folder.path().string());
  EXPECT_EQ(worker.wait(seconds(6)), std::nullopt) << worker.log();
  const std::string log = worker.log();
  const size_t told = log.find("no connection to " + all + " (Connection refused)");
  ASSERT_NE(told, std::string::npos) << log;
  EXPECT_EQ(log.find("no connection", told + 1), std::string::npos) << log;
  coordinator.start();
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
}

}  // namespace
}  // namespace hyades::worker
