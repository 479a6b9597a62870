// The worker's real processes against a coordinator of the test's own.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

#include "core/base/assets.h"
#include "core/job/layers.h"
#include "core/job/parse.h"
#include "core/render/class_probe.h"
#include "core/render/render_frame.h"
#include "core/scene/build_scene.h"
#include "farm/backoff.h"
#include "tests/support/temp_folder.h"
#include "tests/worker/process/fake_coordinator.h"

namespace hyades::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

constexpr const char* kYaml = R"(
hyades: 1
film: {size: [96, 64]}
sampling: {samples: 256, seed: 3}
camera: {look_from: [4.2, 3.6, 7.2], look_at: [0, 0, 0], fov: 40}
materials:
  gold: {type: conductor, metal: gold, roughness: 0.3}
objects:
  vase: {mesh: vase.ply, material: gold}
  ground: {shape: rectangle, size: [60, 60], at: [0, -1.7, 0]}
environment: {image: dusk.exr}
)";

/// A job of one frame, what a coordinator needs of it, and its film as this process renders it.
struct Made {
  FakeCoordinator::Job job;
  std::string digest;
};

class MapResolver : public core::AssetResolver {
 public:
  explicit MapResolver(const std::map<std::string, std::string>& files) : files_(files) {}
  core::Result<core::Bytes> open(const std::string& reference, const std::string& from) override {
    const auto found = files_.find(core::resolve_reference(reference, from));
    if (found == files_.end()) return core::Error{reference + ": no such file"};
    return core::Bytes{nullptr, std::as_bytes(std::span(found->second))};
  }

 private:
  const std::map<std::string, std::string>& files_;
};

Made make_job(uint32_t batches_per_unit = 4) {
  Made made;
  made.job.files = {{"job.yaml", kYaml},
                    {"vase.ply", read_file("jobs/quickstart/vase.ply")},
                    {"dusk.exr", read_file("jobs/quickstart/dusk.exr")}};
  MapResolver files(made.job.files);
  core::Diagnostics diagnostics;
  const core::Job job = core::parse_job(kYaml, "job.yaml", files, diagnostics);
  EXPECT_TRUE(diagnostics.empty()) << diagnostics.to_string();
  core::SceneCache cache(files);
  const auto scene = core::build_scene(job, 1, cache);
  EXPECT_TRUE(scene.ok());
  const core::FrameRenderer renderer(*scene, job, 1, core::needed_layers(job));
  const core::PixelRect window = core::render_window(job.film);
  core::RenderFrameOptions options;
  options.threads = 2;
  made.digest =
      core::render_frame(renderer, window, job.sampling.samples, 1, options).film.digest();
  made.job.film = core::Film(renderer.layout(), window);
  const uint32_t batches = core::batch_count(job.sampling.samples);
  for (uint32_t first = 0; first < batches; first += batches_per_unit) {
    for (int y = window.y0; y < window.y1; y += 16) {
      for (int x = window.x0; x < window.x1; x += 16) {
        made.job.units.push_back({1,
                                  intersection(window, {x, y, x + 16, y + 16}),
                                  {first, std::min(batches_per_unit, batches - first)}});
      }
    }
  }
  return made;
}

/// A worker's processes, ended with the object.
class WorkerProcess {
 public:
  WorkerProcess(const std::string& address, const std::string& folder,
                std::vector<std::string> more = {}) {
    log_ = folder + "/worker." + std::to_string(++count_) + ".log";
    std::vector<std::string> words = {HYADES_WORKER,     "--coordinator", address, "--cache",
                                      folder + "/cache", "--threads",     "2"};
    words.insert(words.end(), more.begin(), more.end());
    pid_ = ::fork();
    if (pid_ == 0) {
      const int log = ::open(log_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
      ::dup2(log, 2);
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      ::execv(arguments[0], arguments.data());
      ::_exit(127);
    }
  }
  ~WorkerProcess() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  void signal(int number) const { ::kill(pid_, number); }

  /// The exit status, within `limit`; nothing where it runs on, -N where signal N ended it.
  std::optional<int> wait(seconds limit) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (std::chrono::steady_clock::now() < end) {
      int status = 0;
      if (::waitpid(pid_, &status, WNOHANG) == pid_) {
        pid_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
      }
      std::this_thread::sleep_for(milliseconds(10));
    }
    return std::nullopt;
  }

  /// The process that renders; 0 where there is none.
  pid_t renderer() const {
    std::ifstream file("/proc/" + std::to_string(pid_) + "/task/" + std::to_string(pid_) +
                       "/children");
    pid_t child = 0;
    file >> child;
    return child;
  }
  std::string log() const { return read_file(log_); }

 private:
  static inline int count_ = 0;
  pid_t pid_ = 0;
  std::string log_;
};

void expect_whole(const FakeCoordinator& coordinator, const Made& made) {
  EXPECT_EQ(coordinator.film_digest(), made.digest);
  for (const std::string& damage : coordinator.seen().damage) ADD_FAILURE() << damage;
}

TEST(WorkerProcess, RendersTheBitsOfASingleMachine) {
  const test::TempFolder folder;
  const Made made = make_job();
  FakeCoordinator coordinator(made.job);
  WorkerProcess worker(coordinator.address(), folder.path().string());
  ASSERT_TRUE(coordinator.wait_for_all()) << worker.log();
  expect_whole(coordinator, made);
  const auto seen = coordinator.seen();
  EXPECT_EQ(seen.failures.size(), 0U);
  EXPECT_EQ(seen.hellos.front().worker_class(), *core::this_class());
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
      << "or its units go to others: BrainOptions::adoption_time";
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
  EXPECT_EQ(worker.wait(seconds(1)), std::nullopt);
  worker.signal(SIGTERM);
  EXPECT_EQ(worker.wait(seconds(2)), 128 + SIGTERM);
}

}  // namespace
}  // namespace hyades::worker
