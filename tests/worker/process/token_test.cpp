// Tokens that are changed while a worker runs.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/support/temp_folder.h"
#include "tests/worker/process/process_testing.h"

namespace hyades::worker {
namespace {

const std::string kOld = "the-token-of-the-first-year";
const std::string kNew = "the-token-of-the-second-year";

void write_token(const std::string& path, const std::string& token) {
  std::ofstream(path + ".new") << token << "\n";
  std::filesystem::permissions(
      path + ".new", std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  std::filesystem::rename(path + ".new", path);
}

bool says(const WorkerProcess& worker, const std::string& text) {
  for (int i = 0; i < 600; ++i) {
    if (worker.log().find(text) != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

TEST(WorkerToken, ANewOneInTheFileIsTakenWhenTheOldOneIsRevoked) {
  const test::TempFolder folder;
  const std::string file = folder.file("token");
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.token = kOld;
  write_token(file, kOld);
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--token-file", file});
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 2; }))
      << worker.log();
  write_token(file, kNew);
  coordinator.stop();
  coordinator.token = kNew;
  coordinator.start();
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  EXPECT_TRUE(says(worker, "shows the coordinator the token that " + file + " holds now"));
}

TEST(WorkerToken, WhoWasKnownWaitsForTheNewOne) {
  const test::TempFolder folder;
  const std::string file = folder.file("token");
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.token = kOld;
  write_token(file, kOld);
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--token-file", file});
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 2; }))
      << worker.log();
  coordinator.stop();
  coordinator.token = kNew;
  coordinator.start();
  ASSERT_TRUE(says(worker, "not a token of this coordinator")) << worker.log();
  write_token(file, kNew);
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
}

TEST(WorkerToken, WhoWasNeverKnownEnds) {
  const test::TempFolder folder;
  const std::string file = folder.file("token");
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.token = kNew;
  write_token(file, kOld);
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--token-file", file});
  EXPECT_EQ(worker.wait(std::chrono::seconds(60)), 2) << worker.log();
}

}  // namespace
}  // namespace hyades::worker
