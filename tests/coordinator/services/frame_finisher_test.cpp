// What the finisher is told, and makes of films that lack something or do not have all yet; what is
// counted of frames.
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "coordinator/controller/disk_watch.h"
#include "coordinator/controller/frame_finisher.h"
#include "coordinator/controller/frame_progress.h"
#include "coordinator/controller/worker_table.h"
#include "coordinator/film_store/disk_film_logs.h"
#include "coordinator/finisher/finish_process.h"
#include "coordinator/finisher/finish_task.h"
#include "coordinator/meters/meters.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

constexpr JobId kJob{1};
constexpr core::PixelRect kRegion{0, 0, 32, 32};
constexpr uint32_t kSamples = 2 * core::kBatchSamples;

/// Keeps why frames fail, and does nothing of what the scheduler wants.
class Failures final : public Dispatcher::ActionHandler {
 public:
  void act(const std::vector<Action>& actions, Turn&, Delivery*) override {
    const std::lock_guard lock(mutex_);
    for (const Action& action : actions) {
      const auto* persist = std::get_if<Persist>(&action);
      if (persist == nullptr) continue;
      const auto* failed = std::get_if<FrameFailedRecord>(&persist->record);
      if (failed != nullptr) reason_ = failed->failed.reason;
    }
  }
  void carry_out(const DeferredAction&) override {}
  std::string reason() {
    const std::lock_guard lock(mutex_);
    return reason_;
  }

 private:
  std::mutex mutex_;
  std::string reason_;
};

/// The finisher, with a job of one frame in two batches, all of which the scheduler takes for done.
struct FinisherWorld {
  FinisherWorld() {
    std::filesystem::create_directories(folder.file("data"));
    auto store = open_sqlite_job_store(folder.file("data/state.db"));
    EXPECT_TRUE(store.ok());
    auto assets = farm::ContentStore::open({folder.file("data/assets"), 0});
    EXPECT_TRUE(assets.ok());
    ControllerOptions options;
    options.folder = folder.file("data");
    options.files = options.folder;
    options.finisher = "/nonexistent";
    context.emplace(options, std::move(*store), disk_film_logs(folder.file("data/films")),
                    std::move(*assets), 1, "secret");
    dispatcher.emplace(context->mutex, SchedulerOptions{});
    dispatcher->set_action_handler(failures);
    jobs.emplace(context->mutex);
    disk.emplace(*context, *dispatcher, *jobs);
    finisher.emplace(*context, *dispatcher, *jobs, *disk, timelines);

    auto owned = std::make_unique<ActiveJob>(StoredJob{}, v1::JobSpec{});
    active = owned.get();
    active->id = kJob;
    active->region = kRegion;
    active->samples = kSamples;
    JobAdded added;
    added.job = kJob;
    added.plan.frames = {1};
    added.plan.region = kRegion;
    added.plan.tile_size = 32;
    added.plan.batches = 2;
    added.plan.max_attempts = 1;
    added.restored.accepted = {{{1, kRegion, {0, 2}}, {}, {}}};
    Turn turn(*dispatcher);
    jobs->add(std::move(owned));
    turn.tell(added);
  }
  ~FinisherWorld() { finisher->end(); }

  static core::Film film_of(core::BatchRange batches) {
    return fake_film({1, kRegion, batches}, kSamples, core::make_film_layout({}));
  }

  test::TempFolder folder;
  Failures failures;
  Timelines timelines;
  std::optional<ControllerContext> context;
  std::optional<Dispatcher> dispatcher;
  std::optional<JobTable> jobs;
  std::optional<DiskWatch> disk;
  std::optional<FrameFinisher> finisher;
  ActiveJob* active = nullptr;
};

/// A film store's owner that takes its time before it merges a film.
class SlowMerger final : public FilmStore::Listener {
 public:
  explicit SlowMerger(ActiveJob& active) : active_(active) {}
  void persisted(RecordId record) override {
    begun = true;
    while (!goes_on) std::this_thread::sleep_for(1ms);
    EXPECT_TRUE(active_.film_store->merge(record).ok());
  }
  void not_persisted(RecordId, const std::string&) override {}
  void outgrown(int32_t, const std::string&) override {}
  void try_again() override {}
  void storage_failed(const std::string&) override {}
  void drained() override {}
  std::atomic<bool> begun{false};
  std::atomic<bool> goes_on{false};

 private:
  ActiveJob& active_;
};

TEST(FrameFinisher, FailsAFrameWhoseFilmIsNotWhole) {
  FinisherWorld world;
  {
    const StateLock lock(world.context->mutex);
    // Of the two batches that are said to be there one is missing.
    world.active->complete[1] = std::make_shared<core::Film>(FinisherWorld::film_of({0, 1}));
    world.finisher->add(*world.active, {kJob, 1, 2 * static_cast<uint64_t>(kRegion.area()), {}},
                        {});
  }
  EXPECT_TRUE(eventually([&] { return !world.failures.reason().empty(); }));
  EXPECT_NE(world.failures.reason().find("not whole"), std::string::npos)
      << world.failures.reason();
}

TEST(FrameFinisher, WaitsForAFilmThatIsStillBeingMerged) {
  FinisherWorld world;
  WorkerTable workers(*world.context, *world.jobs);
  FrameProgress progress(*world.context, *world.dispatcher, *world.jobs, workers, *world.finisher,
                         world.timelines);
  SlowMerger merger(*world.active);
  auto& store = world.active->film_store;
  store = std::make_unique<FilmStore>(FilmSet{{1}, kRegion, kSamples}, FilmStoreOptions{}, merger);
  ASSERT_TRUE(store->start(32).ok());
  store->append(RecordId{1}, UnitRecord{kJob, {{1, kRegion, {0, 2}}, {}, {}}},
                FinisherWorld::film_of({0, 2}));
  ASSERT_TRUE(eventually([&] { return merger.begun.load(); }));
  {
    const StateLock lock(world.context->mutex);
    progress.finish(*world.active, {kJob, 1, 2 * static_cast<uint64_t>(kRegion.area()), {}});
  }
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(world.failures.reason(), "") << "it was finished without the film";
  merger.goes_on = true;
  // There is no document of it that could say what to make: it has come that far.
  EXPECT_TRUE(eventually([&] { return !world.failures.reason().empty(); }));
  EXPECT_EQ(world.failures.reason().find("not whole"), std::string::npos)
      << world.failures.reason();
  store->drain();
  store->join();
}

TEST(FrameProgress, AFrameThatIsToldOverAfterItsJobIsNotCountedTwice) {
  FinisherWorld world;
  WorkerTable workers(*world.context, *world.jobs);
  FrameProgress progress(*world.context, *world.dispatcher, *world.jobs, workers, *world.finisher,
                         world.timelines);
  ActiveJob& active = *world.active;
  SlowMerger merger(active);
  const StateLock lock(world.context->mutex);
  active.film_store =
      std::make_unique<FilmStore>(FilmSet{{1}, kRegion, kSamples}, FilmStoreOptions{}, merger);
  // The turn of another thread was quicker, and has counted the frame with all others.
  active.stored.frames_done = 1;
  active.making_videos = true;
  progress.done(active, {kJob, 1});
  EXPECT_EQ(active.stored.frames_done, 1U);
  EXPECT_EQ(active.frames[1].state, v1::FRAME_STATE_DONE);
  active.making_videos = false;
  active.ending = true;
  progress.done(active, {kJob, 1});
  progress.failed(active, {kJob, 1, "too late"});
  EXPECT_EQ(active.stored.frames_done, 1U);
  EXPECT_EQ(active.stored.frames_failed, 0U);
  active.film_store.reset();
}

/// A program that leaves what looks like a result, and fails.
std::string failing_finisher(const test::TempFolder& folder) {
  const std::string path = folder.file("finisher");
  std::ofstream(path) << "#!/bin/sh\necho '[]' > \"$2/result.json\"\nexit 1\n";
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

TEST(FinishProcess, ThatNobodyCanWaitForIsNoSuccess) {
  const test::TempFolder folder;
  const std::string program = failing_finisher(folder);
  const std::atomic<bool> stop{false};
  // The system forgets children whose end is ignored.
  struct sigaction ignore {};
  struct sigaction before {};
  ignore.sa_handler = SIG_IGN;
  ASSERT_EQ(sigaction(SIGCHLD, &ignore, &before), 0);
  const auto made =
      run_finisher(program, folder.file("work"), {}, FinisherWorld::film_of({0, 1}), stop);
  sigaction(SIGCHLD, &before, nullptr);
  EXPECT_FALSE(made.ok());
}

TEST(FinishTask, ReachesTheFinisherWithAllThatOutputsAndColoursSay) {
  const test::TempFolder folder;
  FinishTask task;
  // All members of both: who adds one finds that it has to be told to the finisher, too.
  auto& [where, file, layers, tone_map, exposure, half, transparent, denoise, quality, bits] =
      task.outputs.emplace_back();
  file = "balls.####.jpg";
  layers = {"albedo", "depth"};
  tone_map = "agx";
  exposure = 1.25F;
  half = true;
  transparent = true;
  denoise = "oidn";
  quality = 55;
  bits = 16;
  auto& [named_at, config, files, display, view, look, space] = task.color.emplace();
  config = "grading/studio.ocio";
  display = "a display";
  view = "a view";
  look = "a, -b";
  space = "linear";
  ASSERT_TRUE(write_finish_task(folder.path().string(), task, FinisherWorld::film_of({0, 1})).ok());
  const auto read = read_finish_task(folder.path().string());
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->outputs.size(), 1U);
  const core::OutputDesc& output = read->outputs[0];
  EXPECT_EQ(output.file, file);
  EXPECT_EQ(output.layers, layers);
  EXPECT_EQ(output.tone_map, tone_map);
  EXPECT_EQ(output.exposure, exposure);
  EXPECT_EQ(output.half, half);
  EXPECT_EQ(output.transparent, transparent);
  EXPECT_EQ(output.denoise, denoise);
  EXPECT_EQ(output.jpeg_quality, quality);
  EXPECT_EQ(output.bits, bits);
  ASSERT_TRUE(read->color);
  EXPECT_TRUE(read->color->config.ends_with("/studio.ocio")) << read->color->config;
  EXPECT_EQ(read->color->display, display);
  EXPECT_EQ(read->color->view, view);
  EXPECT_EQ(read->color->look, look);
  EXPECT_EQ(read->color->working_space, space);
}

}  // namespace
}  // namespace hyades::coordinator
