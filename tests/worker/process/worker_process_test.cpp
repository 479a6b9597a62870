// The worker's real processes against a coordinator of the test's own.

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "core/render/class_probe.h"
#include "farm/backoff.h"
#include "tests/support/temp_folder.h"
#include "tests/worker/process/process_testing.h"

namespace hyades::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(WorkerProcess, RendersTheBitsOfASingleMachine) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  const auto seen = coordinator.seen();
  EXPECT_EQ(seen.failures.size(), 0U);
  EXPECT_EQ(seen.hellos.front().worker_class(), *core::this_class(core::RenderClass::native));
  EXPECT_EQ(seen.hellos.front().portable_class(), *core::this_class(core::RenderClass::portable));
  EXPECT_EQ(seen.downloads, 3U);
  worker.signal(SIGTERM);
  EXPECT_EQ(worker.wait(seconds(5)), 0) << worker.log();
}

TEST(WorkerProcess, FilesAreFetchedOnceForAllWorkersOfAFolder) {
  const test::TempFolder folder;
  const Made made = make_job();
  for (int i = 0; i < 2; ++i) {
    FakeCoordinator coordinator(made.job);
    WorkerProcess worker(coordinator.address(), folder.path().string());
    ASSERT_TRUE(coordinator.wait_until([](const auto& seen) { return seen.accepted > 0; }))
        << worker.log();
    EXPECT_EQ(coordinator.seen().downloads, i == 0 ? 3U : 0U);
  }
}

TEST(WorkerProcess, KilledInTheMidstItCostsOnlyItsLeases) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  for (size_t done = 5; done <= 15; done += 5) {
    WorkerProcess worker(coordinator.address(), folder.path().string());
    ASSERT_TRUE(coordinator.wait_until([&](const auto& s) { return s.accepted >= done; }))
        << worker.log();
    const pid_t renderer = worker.renderer();
    worker.signal(SIGKILL);
    EXPECT_EQ(worker.wait(seconds(5)), -SIGKILL);
    for (int i = 0; i < 200 && ::kill(renderer, 0) == 0; ++i) {
      std::this_thread::sleep_for(milliseconds(10));
    }
    EXPECT_NE(::kill(renderer, 0), 0) << "its child goes with it";
    coordinator.expire_leases();
  }
  WorkerProcess last(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_for_all()) << last.log();
  expect_whole(coordinator, made);
}

TEST(WorkerProcess, AskedToLeaveItHandsOverWholeBatchesWithinTwoSeconds) {
  const test::TempFolder folder;
  const Made made = make_job(16);
  FakeCoordinator coordinator(made.job);
  {
    WorkerProcess worker(coordinator.address(), folder.path().string());
    ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 2; }))
        << worker.log();
    const auto begin = std::chrono::steady_clock::now();
    worker.signal(SIGTERM);
    EXPECT_EQ(worker.wait(seconds(10)), 0);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(2300)) << worker.log();
  }
  const auto seen = coordinator.seen();
  EXPECT_EQ(seen.leavings.size(), 1U);
  EXPECT_GE(seen.returned + seen.shortened, 2U) << "what was in work and what waited";
  WorkerProcess next(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_for_all()) << next.log();
  expect_whole(coordinator, made);
}

TEST(WorkerProcess, ACrashTakesDownOnlyTheRenderingChild) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string());
  for (size_t done = 4; done <= 12; done += 4) {
    ASSERT_TRUE(coordinator.wait_until([&](const auto& s) { return s.accepted >= done; }))
        << worker.log();
    if (const pid_t renderer = worker.renderer(); renderer > 0) ::kill(renderer, SIGSEGV);
  }
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  EXPECT_EQ(coordinator.seen().hellos.size(), 1U) << "the worker itself never left";
  EXPECT_NE(worker.log().find("signal 11"), std::string::npos);
}

TEST(WorkerProcess, AHungRenderingChildIsKilledAndItsUnitsAreRenderedAgain) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--hang-limit", "2"});
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 4; }))
      << worker.log();
  const pid_t hung = worker.renderer();
  ASSERT_GT(hung, 0);
  ::kill(hung, SIGSTOP);
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  EXPECT_NE(worker.renderer(), hung);
  EXPECT_NE(worker.log().find("s and was killed"), std::string::npos) << worker.log();
  EXPECT_EQ(worker.log().find("out of memory"), std::string::npos) << worker.log();
  EXPECT_EQ(coordinator.seen().hellos.size(), 1U) << "the worker itself never left";
}

/// A job of short units, and first of one that takes minutes.
Made make_job_with_a_long_unit() {
  Made made = make_job();
  std::string yaml = kYaml;
  yaml.replace(yaml.find("samples: 256"), 12, "samples: 65536");
  made.job.files["job.yaml"] = yaml;
  made.job.units.resize(8);
  made.job.units.push_front({1, {0, 0, 96, 64}, {0, 4096}});
  return made;
}

TEST(WorkerProcess, AUnitThatTakesTooLongFailsAloneAndItsProcessGoesOn) {
  const test::TempFolder folder;
  const Made made = make_job_with_a_long_unit();
  FakeCoordinator coordinator(made.job);
  coordinator.answer_failures = false;
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--unit-time-limit", "8s"});
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 1; }))
      << worker.log();
  const pid_t renderer = worker.renderer();
  ASSERT_TRUE(coordinator.wait_until(
      [&](const auto& s) { return !s.failures.empty() && s.accepted == made.job.units.size() - 1; },
      seconds(120)))
      << worker.log();
  const auto seen = coordinator.seen();
  ASSERT_EQ(seen.failures.size(), 1U) << worker.log();
  EXPECT_EQ(seen.failures[0].unit().unit().batches(), 4096U);
  EXPECT_EQ(seen.failures[0].reason(), "took longer than 8.00 s (--unit-time-limit of the worker)");
  EXPECT_EQ(worker.renderer(), renderer) << "the same process goes on";
  EXPECT_EQ(seen.hellos.size(), 1U);
}

TEST(WorkerProcess, AProcessThatDoesNotStopAUnitThatTookTooLongIsKilled) {
  const test::TempFolder folder;
  const Made made = make_job_with_a_long_unit();
  FakeCoordinator coordinator(made.job);
  coordinator.answer_failures = false;
  WorkerProcess worker(coordinator.address(), folder.path().string(),
                       {"--unit-time-limit", "8s", "--hang-limit", "0"});
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 1; }))
      << worker.log();
  const pid_t stopped = worker.renderer();
  ASSERT_GT(stopped, 0);
  ::kill(stopped, SIGSTOP);
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return !s.failures.empty(); }))
      << worker.log();
  const auto before = coordinator.seen().accepted;
  ASSERT_TRUE(coordinator.wait_until([&](const auto& s) { return s.accepted > before; }))
      << worker.log();
  EXPECT_NE(worker.renderer(), stopped);
  EXPECT_NE(worker.log().find("did not stop a unit that took longer than"), std::string::npos)
      << worker.log();
  EXPECT_EQ(coordinator.seen().hellos.size(), 1U) << "the worker itself never left";
}

TEST(WorkerProcess, WhoseIdAnotherHasTakesANewOneAndKeepsIt) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.twins = 1;
  {
    WorkerProcess worker(coordinator.address(), folder.path().string());
    ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 2; }))
        << worker.log();
    EXPECT_NE(worker.log().find("takes a new one"), std::string::npos) << worker.log();
  }
  coordinator.expire_leases();
  WorkerProcess next(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.hellos.size() >= 3; }))
      << next.log();
  const auto hellos = coordinator.seen().hellos;
  EXPECT_NE(hellos[0].worker_id(), hellos[1].worker_id());
  EXPECT_EQ(hellos[0].instance(), hellos[1].instance());
  EXPECT_EQ(hellos[1].worker_id(), hellos[2].worker_id());
  EXPECT_NE(hellos[1].instance(), hellos[2].instance());
}

TEST(WorkerProcess, LeavesACoordinatorThatIsTooOld) {
  const test::TempFolder folder;
  FakeCoordinator coordinator(make_job().job);
  coordinator.protocol = 1;
  WorkerProcess worker(coordinator.address(), folder.path().string());
  EXPECT_EQ(worker.wait(seconds(20)), 2) << worker.log();
  EXPECT_NE(worker.log().find("speaks protocol 1"), std::string::npos) << worker.log();
}

TEST(WorkerProcess, ASceneThatTakesTooMuchMemoryFailsWithThatReason) {
  const test::TempFolder folder;
  Made made = make_job();
  // A sky of 8192 x 8192 pixels, run-length encoded: small on disk, a gigabyte in memory.
  std::string row = {2, 2, 0x20, 0};
  for (int component = 0; component < 4; ++component) {
    for (int x = 0; x < 8192; x += 64) row += {static_cast<char>(128 + 64), static_cast<char>(128)};
  }
  std::string sky = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8192 +X 8192\n";
  for (int y = 0; y < 8192; ++y) sky += row;
  made.job.files["dusk.exr"] = sky;
  FakeCoordinator coordinator(made.job);
  coordinator.answer_failures = false;
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--memory", "200M"});
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.failures.size() >= 3; }))
      << worker.log();
  const std::string reason = coordinator.seen().failures.front().reason();
  EXPECT_NE(reason.find("memory"), std::string::npos) << reason;
  EXPECT_EQ(coordinator.seen().hellos.size(), 1U);
}

TEST(WorkerProcess, ABadJobFailsItsUnitsWithItsComplaints) {
  const test::TempFolder folder;
  Made made = make_job();
  made.job.files["job.yaml"] = "hyades: 1\nobjects: {ball: {shape: ball}}\n";
  FakeCoordinator coordinator(made.job);
  coordinator.answer_failures = false;
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return !s.failures.empty(); }))
      << worker.log();
  const std::string reason = coordinator.seen().failures.front().reason();
  EXPECT_NE(reason.find("job.yaml:2"), std::string::npos) << reason;
}

TEST(WorkerProcess, JobsReachNoFileOutsideTheirManifest) {
  const test::TempFolder folder;
  Made made = make_job();
  std::string yaml = kYaml;
  yaml.replace(yaml.find("dusk.exr"), 8, "/etc/passwd");
  made.job.files["job.yaml"] = yaml;
  FakeCoordinator coordinator(made.job);
  coordinator.answer_failures = false;
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return !s.failures.empty(); }))
      << worker.log();
  EXPECT_NE(coordinator.seen().failures.front().reason().find("not among the files"),
            std::string::npos)
      << coordinator.seen().failures.front().reason();
}

TEST(WorkerProcess, StoppedPastItsLeaseItGivesItsUnitsUp) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.lease_ms = 1000;
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 2; }))
      << worker.log();
  worker.signal(SIGSTOP);
  const pid_t renderer = worker.renderer();
  ::kill(renderer, SIGSTOP);
  coordinator.expire_leases();
  std::this_thread::sleep_for(seconds(2));
  ::kill(renderer, SIGCONT);
  worker.signal(SIGCONT);
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  EXPECT_NE(worker.log().find("units given up"), std::string::npos) << worker.log();
}

TEST(WorkerProcess, KeepsFilmsThroughARestartOfTheCoordinator) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.acknowledge = false;
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 6; }))
      << worker.log();
  coordinator.stop();
  coordinator.acknowledge = true;
  std::this_thread::sleep_for(milliseconds(500));
  coordinator.start();
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  const auto seen = coordinator.seen();
  ASSERT_EQ(seen.hellos.size(), 2U);
  EXPECT_EQ(seen.hellos[0].worker_id(), seen.hellos[1].worker_id());
  EXPECT_GE(seen.hellos[1].in_hand_size(), 6);
  EXPECT_GE(seen.doubles, 6U) << "films that were not acknowledged come again";
}

TEST(WorkerProcess, IsBackSoonAfterALongOutage) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 2; }))
      << worker.log();
  coordinator.stop();
  std::this_thread::sleep_for(seconds(8));  // so that its waits are as long as they become
  coordinator.start();
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.hellos.size() == 2; }))
      << worker.log();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, farm::kLongestReconnect + milliseconds(1500))
      << "or its units go to others: ControllerOptions::adoption_time";
}

TEST(WorkerProcess, ASecondSignalEndsItAtOnce) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.acknowledge = false;  // so that leaving would wait
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--grace", "60"});
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 2; }))
      << worker.log();
  worker.signal(SIGTERM);
  std::this_thread::sleep_for(milliseconds(200));
  worker.signal(SIGTERM);  // the same one, come by another way
  EXPECT_EQ(worker.wait(seconds(2)), std::nullopt) << worker.log();
  worker.signal(SIGTERM);
  EXPECT_EQ(worker.wait(seconds(2)), 128 + SIGTERM);
}

TEST(WorkerProcess, ASignalOfAnotherKindIsASecondOne) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  coordinator.acknowledge = false;
  WorkerProcess worker(coordinator.address(), folder.path().string(), {"--grace", "60"});
  ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 2; }))
      << worker.log();
  worker.signal(SIGTERM);
  std::this_thread::sleep_for(milliseconds(100));
  worker.signal(SIGINT);
  EXPECT_EQ(worker.wait(seconds(2)), 128 + SIGINT);
}

TEST(WorkerProcess, WhoWasToldToLeaveEndsWithTheStatusThatWasAskedFor) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  const std::vector<std::string> words = {"--exit-status-when-told", "143"};
  {
    WorkerProcess told(coordinator.address(), folder.path().string(), words);
    ASSERT_TRUE(coordinator.wait_until([](const auto& s) { return s.accepted >= 2; }))
        << told.log();
    told.signal(SIGTERM);
    EXPECT_EQ(told.wait(seconds(10)), 143) << told.log();
    EXPECT_NE(told.log().find("are handed over"), std::string::npos) << told.log();
  }
  std::vector<std::string> idle_words = words;
  idle_words.insert(idle_words.end(), {"--exit-when-idle", "1s"});
  WorkerProcess idle(coordinator.address(), folder.path().string(), idle_words);
  ASSERT_TRUE(coordinator.wait_for_all()) << idle.log();
  EXPECT_EQ(idle.wait(seconds(30)), 0) << "its work is done: " << idle.log();
}

}  // namespace
}  // namespace hyades::worker
