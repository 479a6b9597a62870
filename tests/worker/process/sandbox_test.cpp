// `hyades worker --sandbox`: the whole worker renders in it.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "core/base/hash.h"
#include "tests/support/temp_folder.h"
#include "tests/worker/process/process_testing.h"

namespace hyades::worker {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(WorkerSandbox, TheSameBitsInAWholeOne) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--sandbox", "require"});
  const bool all = coordinator.wait_for_all();
  if (has(worker.log(), "has no whole sandbox")) GTEST_SKIP() << worker.log();
  ASSERT_TRUE(all) << worker.log();
  expect_whole(coordinator, made);
  const std::string status = read_file("/proc/" + std::to_string(worker.renderer()) + "/status");
  EXPECT_TRUE(has(status, "NoNewPrivs:\t1")) << status;
  EXPECT_TRUE(has(status, "Seccomp:\t2")) << status;
  std::vector<std::string> open;
  for (const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(worker.renderer()) + "/fd")) {
    open.push_back(std::filesystem::read_symlink(entry.path()).string());
  }
  std::sort(open.begin(), open.end());
  ASSERT_EQ(open.size(), 5U) << "nothing, nothing, the log, the pipe, a file for texels";
  EXPECT_EQ(std::count(open.begin(), open.end(), "/dev/null"), 2);
  EXPECT_EQ(std::count_if(open.begin(), open.end(),
                          [](const auto& name) { return has(name, "/hyades-texels-"); }),
            1);
}

/// The sandbox refuses to write this, so that it has to be said before.
TEST(WorkerSandbox, TheRendererIsTheFirstToGoWhenMemoryRunsOut) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  const std::string renderer = "/proc/" + std::to_string(worker.renderer());
  EXPECT_GE(std::stoi("0" + read_file(renderer + "/oom_score_adj")), 800);
  EXPECT_FALSE(has(worker.log(), "first to go")) << worker.log();
}

/// Also by who has taken it over: the file for texels is all that it may write.
TEST(WorkerSandbox, TheRendererWritesNoLongFiles) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--texture-disk", "100M"});
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  const std::string limits = read_file("/proc/" + std::to_string(worker.renderer()) + "/limits");
  const size_t at = limits.find("Max file size");
  ASSERT_NE(at, std::string::npos);
  std::istringstream line(limits.substr(at + std::string("Max file size").size()));
  std::string soft;
  std::string hard;
  line >> soft >> hard;
  EXPECT_EQ(soft, "104857600");
  EXPECT_EQ(hard, "104857600");
}

/// The process that renders notices, and its worker removes.
TEST(WorkerSandbox, ADamagedFileOfTheCacheIsFetchedAnew) {
  const test::TempFolder folder;
  const Made made = make_job();
  const std::string& mesh = made.job.files.at("vase.ply");
  const std::filesystem::path cache = folder.path() / "cache";
  std::filesystem::create_directories(cache / "files");
  std::ofstream(cache / "files" / core::to_hex(core::sha256(mesh)))
      << std::string(mesh.size(), '?');
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  ASSERT_GE(coordinator.seen().failures.size(), 1U);
  EXPECT_TRUE(has(coordinator.seen().failures[0].reason(), "damaged"));
}

TEST(WorkerSandbox, OffItSaysSo) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--sandbox", "off"});
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  EXPECT_TRUE(has(worker.log(), "is not wholly sandboxed: switched off")) << worker.log();
}

/// A sandbox holds on to the folder that was there when it was entered.
TEST(WorkerSandbox, ACacheThatBecomesAnotherFolderIsReadAllTheSame) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.stop();
  WorkerProcess worker(coordinator.address(), folder.path().string());
  const std::filesystem::path cache = folder.path() / "cache";
  // Its renderer is ready by then.
  for (int i = 0; i < 600 && !has(worker.log(), "no connection"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::filesystem::rename(cache, folder.path() / "elsewhere");
  std::filesystem::copy(folder.path() / "elsewhere", cache,
                        std::filesystem::copy_options::recursive);
  coordinator.start();
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  EXPECT_EQ(coordinator.seen().failures.size(), 0U);
}

}  // namespace
}  // namespace hyades::worker
