// `hyades worker --preemption`: machines that a cloud takes away.

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "tests/support/temp_folder.h"
#include "tests/worker/clouds/fake_cloud.h"
#include "tests/worker/process/process_testing.h"

namespace hyades::worker {
namespace {

using std::chrono::seconds;

class WorkerOfACloud : public testing::TestWithParam<Cloud> {};

TEST_P(WorkerOfACloud, HandsOverWhatIsDoneAndGivesBackTheRestAtOnce) {
  const test::TempFolder folder;
  const std::string name = name_of(GetParam());
  FakeCloud cloud(GetParam());
  const Made made = make_job(16);
  FakeCoordinator coordinator(made.job);
  coordinator.lease_ms = 600'000;  // nothing of what follows waits for a lease to run out
  {
    WorkerProcess worker(coordinator.address(), folder.path().string(),
                         {"--preemption", name, "--preemption-endpoint", cloud.url()});
    ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 1; }))
        << worker.log();
    // So that there is still work when the cloud is asked again, however fast the machine is.
    const pid_t renderer = worker.renderer();
    ASSERT_GT(renderer, 0);
    ::kill(renderer, SIGSTOP);
    cloud.preempt(40);
    for (int i = 0; i < 600 && worker.log().find("pre-empted by") == std::string::npos; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ::kill(renderer, SIGCONT);
    EXPECT_EQ(worker.wait(seconds(60)), 0) << worker.log();
    EXPECT_NE(worker.log().find("pre-empted by " + name + " at 20"), std::string::npos)
        << worker.log();
  }
  const auto seen = coordinator.seen();
  ASSERT_EQ(seen.leavings.size(), 1U);
  EXPECT_TRUE(seen.leavings.front().reason().starts_with("pre-empted by " + name + " at 20"))
      << seen.leavings.front().reason();
  EXPECT_GE(seen.returned + seen.shortened, 2U) << "what was in work and what waited";
  WorkerProcess next(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_for_all()) << next.log();
  expect_whole(coordinator, made);
}

INSTANTIATE_TEST_SUITE_P(Clouds, WorkerOfACloud,
                         testing::Values(Cloud::aws, Cloud::gcp, Cloud::azure),
                         [](const auto& cloud) { return std::string(name_of(cloud.param)); });

TEST(WorkerPreemption, ASilentServiceDisturbsNothing) {
  const test::TempFolder folder;
  FakeCloud cloud(Cloud::aws);
  cloud.behave(FakeCloud::Manner::silent);
  // It is never gone through; gRPC would, to the coordinator.
  ::setenv("http_proxy", "http://127.0.0.1:1", 1);
  ::setenv("no_grpc_proxy", "127.0.0.1", 1);
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string(),
                       {"--preemption", "aws", "--preemption-endpoint", cloud.url()});
  ::unsetenv("http_proxy");
  ::unsetenv("no_grpc_proxy");
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  EXPECT_GE(cloud.asked(), 1U);
  worker.signal(SIGTERM);
  EXPECT_EQ(worker.wait(seconds(10)), 0) << worker.log();
}

TEST(WorkerPreemption, IsOffWithoutBeingAskedFor) {
  const test::TempFolder folder;
  WorkerProcess worker("127.0.0.1:1", folder.path().string(), {"--exit-when-idle", "0.5s"});
  EXPECT_EQ(worker.wait(seconds(60)), 0) << worker.log();
  EXPECT_EQ(worker.log().find("pre-emption"), std::string::npos) << worker.log();
}

TEST(WorkerPreemption, SaysWhatItTakes) {
  const test::TempFolder folder;
  const auto refused = [&](std::vector<std::string> words, const std::string& why) {
    WorkerProcess worker("127.0.0.1:1", folder.path().string(), std::move(words));
    EXPECT_EQ(worker.wait(seconds(30)), 2);
    EXPECT_NE(worker.log().find(why), std::string::npos) << worker.log();
  };
  refused({"--preemption", "azur"}, "--preemption azur: expected aws or");
  refused({"--preemption-endpoint", "http://127.0.0.1:1"}, "--preemption");
  refused({"--preemption", "aws", "--preemption-endpoint", "ftp://x"}, "expected http://HOST:PORT");
}

}  // namespace
}  // namespace hyades::worker
