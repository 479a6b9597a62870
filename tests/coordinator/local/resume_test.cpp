// What survives stops, kills and broken disks.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "coordinator/local/local_run.h"
#include "tests/coordinator/film_store/faulty_files.h"
#include "tests/coordinator/local/fake_render.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kLongWait = seconds(60);

LocalPlan plan_to_resume() {
  LocalPlan plan;
  plan.frames = {1, 2, 3, 4};
  plan.region = {0, 0, 40, 40};
  plan.samples = 40;
  plan.threads = 2;
  plan.tile_size = 16;
  plan.unit_time = Duration{1};  // one batch per unit: 27 units per frame
  return plan;
}

FilmStoreOptions log_in(const std::string& folder, bool resume) {
  FilmStoreOptions log;
  log.folder = folder;
  log.frame_key = [](int32_t frame) { return core::sha256("pixels " + std::to_string(frame)); };
  log.kept = resume ? KeptFilms::require : KeptFilms::erase;
  return log;
}

void expect_the_truth(const LocalPlan& plan, const FakeRender& render) {
  for (const int32_t frame : plan.frames) {
    const auto digests = render.digests();
    ASSERT_TRUE(digests.contains(frame)) << frame;
    EXPECT_EQ(digests.at(frame),
              oracle_digest(frame, plan.region, plan.samples, render.splat_region))
        << frame;
  }
}

/// Runs until the end or until `stop_after`; returns whether it ended.
bool run_for(const LocalPlan& plan, const FilmStoreOptions& log, FakeRender& render,
             Duration stop_after) {
  LocalRun run(plan, log, render, render);
  const core::Status started = run.start();
  EXPECT_TRUE(started) << (started ? "" : started.error().message);
  if (!started) return false;
  EXPECT_THAT(run.log_problems(), testing::IsEmpty());
  if (!run.wait_for(stop_after)) run.stop();
  EXPECT_TRUE(run.wait_for(kLongWait));
  EXPECT_EQ(run.outcome().error, "");
  return run.outcome().complete;
}

/// What a run that must not start says.
std::string refusal(const LocalPlan& plan, const FilmStoreOptions& log, FakeRender& render) {
  LocalRun run(plan, log, render, render);
  const core::Status started = run.start();
  EXPECT_FALSE(started);
  return started ? "" : started.error().message;
}

TEST(Resume, TenInterruptionsChangeNoBit) {
  for (const uint64_t compact_bytes : {uint64_t{1} << 30U, uint64_t{10'000}}) {
    test::TempFolder folder;
    LocalPlan plan = plan_to_resume();
    FakeRender render(plan.samples);
    render.unit_delay = milliseconds(4);
    int runs = 0;
    const uint64_t units = 9 * 3 * 4;  // tiles, batches, frames
    for (bool complete = false; !complete; ++runs) {
      ASSERT_LT(runs, 100);
      // Every run has another number of threads, and asks for another size of tiles in vain.
      plan.threads = 1 + runs % 3;
      plan.tile_size = 16 + runs % 5;
      FilmStoreOptions log = log_in(folder.file("log"), runs > 0);
      log.compact_bytes = compact_bytes;
      complete = run_for(plan, log, render, runs < 10 ? milliseconds(20) : kLongWait);
    }
    EXPECT_GE(runs, 11) << "it was too quick to be interrupted ten times";
    expect_the_truth(plan, render);
    // What was durable was not rendered again: each stop costs at most what was in the threads.
    EXPECT_LE(render.units(), units + 10 * 3);
  }
}

TEST(Resume, InterruptionsChangeNoBitOfFilmsWithSplats) {
  for (const uint64_t compact_bytes : {uint64_t{1} << 30U, uint64_t{10'000}}) {
    test::TempFolder folder;
    LocalPlan plan = plan_to_resume();
    FakeRender render(plan.samples);
    // What is rendered is a part of what the job renders, as with --crop.
    render.splat_region = {0, 0, 50, 44};
    render.unit_delay = milliseconds(4);
    int runs = 0;
    for (bool complete = false; !complete; ++runs) {
      ASSERT_LT(runs, 100);
      plan.threads = 1 + runs % 3;
      FilmStoreOptions log = log_in(folder.file("log"), runs > 0);
      log.compact_bytes = compact_bytes;
      complete = run_for(plan, log, render, runs < 10 ? milliseconds(20) : kLongWait);
    }
    EXPECT_GE(runs, 11) << "it was too quick to be interrupted ten times";
    expect_the_truth(plan, render);
    EXPECT_LE(render.units(), uint64_t{9 * 3 * 4} + 10 * 3);
  }
}

TEST(Resume, FinishedFramesAreNotRenderedAgain) {
  test::TempFolder folder;
  const LocalPlan plan = plan_to_resume();
  FakeRender render(plan.samples);
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), false), render, kLongWait));
  const uint64_t units = render.units();
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), true), render, kLongWait));
  EXPECT_EQ(render.units(), units);
  render.lose_output(2);
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), true), render, kLongWait));
  EXPECT_EQ(render.units(), units + units / 4);
  expect_the_truth(plan, render);
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), true), render, kLongWait));
  EXPECT_EQ(render.units(), units + units / 4);
}

TEST(Resume, AFrameBegunAgainBecauseItsOutputIsGoneIsResumedToo) {
  test::TempFolder folder;
  LocalPlan plan = plan_to_resume();
  plan.frames = {1};
  FakeRender render(plan.samples);
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), false), render, kLongWait));
  render.lose_output(1);
  render.unit_delay = milliseconds(10);
  ASSERT_FALSE(run_for(plan, log_in(folder.file("log"), true), render, milliseconds(70)));
  const uint64_t units = render.units();
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), true), render, kLongWait));
  EXPECT_LT(render.units(), units + 27) << "nothing was kept";
  expect_the_truth(plan, render);
}

TEST(Resume, AFrameWhoseOutputCouldNotBeWrittenIsOnlyFinishedAgain) {
  test::TempFolder folder;
  LocalPlan plan = plan_to_resume();
  plan.frames = {1, 2};
  FakeRender render(plan.samples);
  render.finish_fault = [](int32_t) -> core::Status { return core::Error{"no such folder"}; };
  FilmStoreOptions log = log_in(folder.file("log"), false);
  log.compact_bytes = 1000;
  ASSERT_TRUE(run_for(plan, log, render, kLongWait));
  EXPECT_TRUE(render.digests().empty());
  const uint64_t units = render.units();
  render.finish_fault = nullptr;
  log.kept = KeptFilms::require;
  ASSERT_TRUE(run_for(plan, log, render, kLongWait));
  EXPECT_EQ(render.units(), units);
  expect_the_truth(plan, render);
}

TEST(Resume, WithoutResumeItBeginsAfresh) {
  test::TempFolder folder;
  const LocalPlan plan = plan_to_resume();
  FakeRender render(plan.samples);
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), false), render, kLongWait));
  const uint64_t units = render.units();
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), false), render, kLongWait));
  EXPECT_EQ(render.units(), 2 * units);
}

TEST(Resume, AnotherJobsFilmsAreRefused) {
  test::TempFolder folder;
  LocalPlan plan = plan_to_resume();
  FakeRender render(plan.samples);
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), false), render, kLongWait));
  FilmStoreOptions other = log_in(folder.file("log"), true);
  other.frame_key = [](int32_t frame) { return core::sha256("others " + std::to_string(frame)); };
  EXPECT_THAT(refusal(plan, other, render), testing::HasSubstr("frame 1 are of another picture"));
  plan.samples += 1;
  EXPECT_THAT(refusal(plan, log_in(folder.file("log"), true), render),
              testing::HasSubstr("of 40 samples per pixel, the job has 41"));
}

/// Everything is rendered and kept, but no output can be written: the log holds all films.
void render_without_outputs(const LocalPlan& plan, const FilmStoreOptions& log,
                            FakeRender& render) {
  render.finish_fault = [](int32_t) -> core::Status { return core::Error{"no such folder"}; };
  ASSERT_TRUE(run_for(plan, log, render, kLongWait));
  render.finish_fault = nullptr;
}

TEST(Resume, OnlyTheFramesAskedForMustBeOfTheSamePixels) {
  for (const bool finished : {false, true}) {
    test::TempFolder folder;
    LocalPlan plan = plan_to_resume();
    plan.frames = {1, 2};
    FakeRender render(plan.samples);
    if (finished) {
      ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), false), render, kLongWait));
    } else {
      render_without_outputs(plan, log_in(folder.file("log"), false), render);
    }
    const uint64_t units = render.units();
    FilmStoreOptions changed = log_in(folder.file("log"), true);
    changed.frame_key = [](int32_t frame) {
      return core::sha256((frame == 2 ? "others " : "pixels ") + std::to_string(frame));
    };
    EXPECT_THAT(refusal(plan, changed, render),
                testing::HasSubstr("frame 2 are of another picture"));
    plan.frames = {1, 3};
    ASSERT_TRUE(run_for(plan, changed, render, kLongWait));
    EXPECT_EQ(render.units(), units + units / 2) << "frame 1 was there";
    expect_the_truth(plan, render);
  }
}

TEST(Resume, AnotherCropKeepsTheTilesThatItShares) {
  for (const uint64_t compact_bytes : {uint64_t{1} << 30U, uint64_t{10'000}}) {
    test::TempFolder folder;
    LocalPlan plan = plan_to_resume();
    plan.frames = {1, 2};
    FakeRender render(plan.samples);
    FilmStoreOptions log = log_in(folder.file("log"), false);
    log.compact_bytes = compact_bytes;
    render_without_outputs(plan, log, render);
    log.kept = KeptFilms::require;
    const auto new_units = [&](const core::PixelRect& region) {
      const uint64_t before = render.units();
      plan.region = region;
      render_without_outputs(plan, log, render);
      const uint64_t units = render.units() - before;
      EXPECT_TRUE(run_for(plan, log, render, kLongWait));
      EXPECT_EQ(render.units(), before + units) << "only outputs were missing";
      expect_the_truth(plan, render);
      return units;
    };
    const uint64_t per_tile = 3 * 2;  // batches, frames
    EXPECT_EQ(new_units({16, 0, 40, 32}), 0U);
    if (compact_bytes < 1'000'000) continue;  // what no run asks for is not kept for ever
    EXPECT_EQ(new_units({3, 5, 40, 40}), 0U);
    // Its tiles at the right and lower edge reach farther than those that are there.
    EXPECT_EQ(new_units({0, 0, 48, 48}), 5 * per_tile);
    EXPECT_EQ(new_units({40, 40, 48, 48}), 0U);
    EXPECT_EQ(new_units({0, 0, 40, 40}), 0U);
    EXPECT_EQ(new_units({0, 0, 49, 48}), 3 * per_tile);
  }
}

TEST(Resume, FilmsWithSplatsAreOfNoUseToAnotherCrop) {
  test::TempFolder folder;
  LocalPlan plan = plan_to_resume();
  plan.frames = {1};
  FakeRender render(plan.samples);
  render.splat_region = {0, 0, 48, 48};
  const FilmStoreOptions begin = log_in(folder.file("log"), false);
  render_without_outputs(plan, begin, render);
  const FilmStoreOptions log = log_in(folder.file("log"), true);
  uint64_t before = render.units();
  plan.region = {0, 0, 16, 32};  // two whole tiles
  render_without_outputs(plan, log, render);
  EXPECT_EQ(render.units(), before + uint64_t{2 * 3});
  before = render.units();
  ASSERT_TRUE(run_for(plan, log, render, kLongWait));
  EXPECT_EQ(render.units(), before) << "only outputs were missing";
  expect_the_truth(plan, render);
  // The films of the first run are still there.
  plan.region = plan_to_resume().region;
  ASSERT_TRUE(run_for(plan, log, render, kLongWait));
  EXPECT_EQ(render.units(), before);
  expect_the_truth(plan, render);
}

TEST(Resume, AFrameFinishedForAnotherCropIsNotTakenForThisOne) {
  test::TempFolder folder;
  LocalPlan plan = plan_to_resume();
  plan.frames = {1};
  FakeRender render(plan.samples);
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), false), render, kLongWait));
  for (const core::PixelRect region :
       {core::PixelRect{0, 0, 20, 20}, core::PixelRect{0, 0, 40, 40}}) {
    plan.region = region;
    ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), true), render, kLongWait));
    expect_the_truth(plan, render);
  }
}

TEST(Resume, MoreFramesCanBeAskedForLater) {
  test::TempFolder folder;
  LocalPlan plan = plan_to_resume();
  plan.frames = {1, 2};
  FakeRender render(plan.samples);
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), false), render, kLongWait));
  const uint64_t units = render.units();
  plan.frames = {1, 2, 3};
  ASSERT_TRUE(run_for(plan, log_in(folder.file("log"), true), render, kLongWait));
  EXPECT_EQ(render.units(), units + units / 2);
  expect_the_truth(plan, render);
}

/// In a child process: renders, and leaves a frame's digest in a file as its output.
class FileSink final : public FrameSink {
 public:
  explicit FileSink(std::string folder) : folder_(std::move(folder)) {}
  core::Status finish(int32_t frame, const core::Film& film) override {
    {
      std::ofstream file(path(frame) + ".part");
      file << film.digest();
    }
    std::filesystem::rename(path(frame) + ".part", path(frame));
    return {};
  }
  bool outputs_exist(int32_t frame) override { return std::filesystem::exists(path(frame)); }
  std::string path(int32_t frame) const { return folder_ + "/" + std::to_string(frame); }

 private:
  std::string folder_;
};

TEST(Resume, KilledAtRandomAgainAndAgain) {
  test::TempFolder folder;
  LocalPlan plan = plan_to_resume();
  plan.frames = {1, 2, 3};
  FileSink sink(folder.path().string());
  std::mt19937 random(20);
  int kills = 0;
  for (bool complete = false; !complete;) {
    ASSERT_LT(kills, 300);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      FakeRender render(plan.samples);
      render.unit_delay = milliseconds(3);
      FilmStoreOptions log = log_in(folder.file("log"), true);
      log.compact_bytes = 20'000;
      bool ended = false;
      {
        LocalRun run(plan, log, render, sink);
        ended = run.start().ok() && run.wait_for(kLongWait) && run.outcome().complete;
      }
      ::_exit(ended ? 0 : 1);
    }
    // Later kills come later, so that a slow machine (or a sanitizer) gets on as well.
    const int longest = 40'000 + kills * kills * 400;
    std::this_thread::sleep_for(microseconds(std::uniform_int_distribution(0, longest)(random)));
    if (kills < 60) ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    if (WIFEXITED(status)) {
      ASSERT_EQ(WEXITSTATUS(status), 0);
      complete = true;
    } else {
      ++kills;
    }
  }
  EXPECT_GE(kills, 5) << "it was too quick to be killed";
  EXPECT_LT(kills, 60) << "the run never came to its end under fire: nothing was kept";
  for (const int32_t frame : plan.frames) {
    std::ifstream file(sink.path(frame));
    std::string digest;
    file >> digest;
    EXPECT_EQ(digest, oracle_digest(frame, plan.region, plan.samples));
  }
}

FilmStoreOptions log_on(FaultyFiles& files) {
  FilmStoreOptions log = log_in("log", true);
  log.files = &files;
  log.compact_bytes = 20'000;
  return log;
}

TEST(Resume, LostPowerCostsRenderingNeverBits) {
  const LocalPlan plan = plan_to_resume();
  for (uint32_t seed = 1; seed <= 12; ++seed) {
    std::mt19937 random(seed);
    FaultyFiles files;
    FakeRender render(plan.samples);
    render.unit_delay = microseconds(300);
    bool complete = false;
    for (int outage = 0; outage < 8 && !complete; ++outage) {
      files.fail_from_operation(files.operations() + random() % 60);
      {
        FilmStoreOptions log = log_on(files);
        log.patience = milliseconds(20);
        LocalRun run(plan, log, render, render);
        if (run.start()) {
          ASSERT_TRUE(run.wait_for(kLongWait)) << "seed " << seed;
          complete = run.outcome().complete;
        }
      }
      files.crash(random);
    }
    LocalRun run(plan, log_on(files), render, render);
    const core::Status started = run.start();
    ASSERT_TRUE(started) << "seed " << seed << ": " << started.error().message;
    ASSERT_TRUE(run.wait_for(kLongWait));
    EXPECT_TRUE(run.outcome().complete) << "seed " << seed << ": " << run.outcome().error;
    expect_the_truth(plan, render);
  }
}

TEST(Resume, AFullDiskHoldsTheRunUntilThereIsRoom) {
  const LocalPlan plan = plan_to_resume();
  FaultyFiles files;
  FakeRender render(plan.samples);
  FilmStoreOptions log = log_on(files);
  log.compact_bytes = uint64_t{1} << 30U;
  files.set_capacity(30'000);
  LocalRun run(plan, log, render, render);
  ASSERT_TRUE(run.start());
  for (int i = 0; run.progress().trouble.empty() && i < 1000; ++i) run.wait_for(milliseconds(5));
  EXPECT_THAT(run.progress().trouble, testing::HasSubstr("no space left"));
  EXPECT_FALSE(run.wait_for(milliseconds(20)));
  files.set_capacity(UINT64_MAX);
  ASSERT_TRUE(run.wait_for(kLongWait));
  EXPECT_TRUE(run.outcome().complete);
  EXPECT_EQ(run.progress().trouble, "");
  expect_the_truth(plan, render);
}

TEST(Resume, ADiskThatStaysFullEndsTheRunWithTheReason) {
  const LocalPlan plan = plan_to_resume();
  FaultyFiles files;
  FakeRender render(plan.samples);
  FilmStoreOptions log = log_on(files);
  log.patience = milliseconds(50);
  files.set_capacity(10'000);
  {
    LocalRun run(plan, log, render, render);
    ASSERT_TRUE(run.start());
    ASSERT_TRUE(run.wait_for(kLongWait));
    EXPECT_FALSE(run.outcome().complete);
    EXPECT_THAT(run.outcome().error, testing::HasSubstr("no space left"));
  }
  files.set_capacity(UINT64_MAX);
  LocalRun run(plan, log, render, render);
  ASSERT_TRUE(run.start());
  ASSERT_TRUE(run.wait_for(kLongWait));
  EXPECT_TRUE(run.outcome().complete);
  expect_the_truth(plan, render);
}

}  // namespace
}  // namespace hyades::coordinator
