// Runs whose tiles stop at a noise.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>

#include "coordinator/local/local_run.h"
#include "coordinator/scheduler/tile_grid.h"
#include "tests/coordinator/local/fake_render.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

constexpr Duration kWholeRun = std::chrono::seconds(60);

/// Samples are uniform in [0, 1): after 55 of them the noise is 0.055 in the mean, and tiles stop
/// after different rounds about there.
LocalPlan noisy_plan() {
  LocalPlan plan;
  plan.frames = {1, 2, 3};
  plan.region = {5, 3, 70, 50};
  plan.samples = 1000;
  plan.threads = 2;
  plan.tile_size = 16;
  plan.threshold = core::make_noise_threshold({0.055F, 0, 32}, plan.samples);
  return plan;
}

/// What every way of rendering the frame must give, tile by tile; `batches` of each are counted.
core::Film film_of_tiles(const LocalPlan& plan, int32_t frame, std::map<uint32_t, int>& batches) {
  core::Film film = fake_film({frame, {}, {}}, plan.samples);
  core::Film whole(film.layout(), plan.region);
  const TileGrid grid(plan.region, plan.tile_size);
  for (uint32_t i = 0; i < grid.size(); ++i) {
    const core::PixelRect tile = grid.tile(i);
    uint32_t count = core::batch_count(plan.samples);
    for (const uint32_t round : plan.threshold.rounds) {
      if (!core::is_clean(fake_film({frame, tile, {0, round}}, plan.samples), tile,
                          plan.threshold)) {
        continue;
      }
      count = round;
      break;
    }
    ++batches[count];
    EXPECT_TRUE(whole.merge(fake_film({frame, tile, {0, count}}, plan.samples)).ok());
  }
  return whole;
}

void expect_what_tiles_need(const LocalPlan& plan, const FakeRender& render, size_t kinds = 3) {
  std::map<uint32_t, int> batches;
  for (const int32_t frame : plan.frames) {
    const auto digests = render.digests();
    ASSERT_TRUE(digests.contains(frame)) << frame;
    EXPECT_EQ(digests.at(frame), film_of_tiles(plan, frame, batches).digest()) << frame;
  }
  EXPECT_GE(batches.size(), kinds) << "tiles are to differ, or nothing is shown";
}

TEST(Adaptive, TilesStopWhereTheirOwnFilmsSaySoWhateverTheThreads) {
  for (const int threads : {1, 2, 5}) {
    LocalPlan plan = noisy_plan();
    plan.threads = threads;
    plan.shuffle = static_cast<uint64_t>(threads);
    FakeRender render(plan.samples);
    LocalRun run(plan, {}, render, render);
    ASSERT_TRUE(run.start().ok());
    ASSERT_TRUE(run.wait_for(kWholeRun));
    EXPECT_TRUE(run.outcome().complete);
    expect_what_tiles_need(plan, render);
    const Progress progress = run.progress();
    EXPECT_EQ(progress.samples, progress.samples_done) << "what is not needed does not count";
    EXPECT_LT(progress.samples, 200U * 65 * 47 * 3);
  }
}

TEST(Adaptive, InterruptionsChangeNoBit) {
  const test::TempFolder folder;
  LocalPlan plan = noisy_plan();
  plan.unit_time = Duration{1};
  FilmStoreOptions log;
  log.folder = folder.path();
  log.compact_bytes = 100'000;
  log.kept = KeptFilms::require;
  FakeRender render(plan.samples);
  render.unit_delay = std::chrono::microseconds(200);
  int interruptions = 0;
  for (bool over = false; !over;) {
    LocalRun run(plan, log, render, render);
    const core::Status started = run.start();
    ASSERT_TRUE(started) << started.error().message;
    over = run.wait_for(std::chrono::milliseconds(15));
    if (!over) run.stop();
    EXPECT_TRUE(run.wait_for(kWholeRun));
    EXPECT_EQ(run.outcome().error, "");
    ASSERT_LT(++interruptions, 500);
  }
  EXPECT_GT(interruptions, 3);
  expect_what_tiles_need(plan, render);
}

void run_to_its_end(const LocalPlan& plan, const FilmStoreOptions& log, FakeRender& render) {
  LocalRun run(plan, log, render, render);
  const core::Status started = run.start();
  ASSERT_TRUE(started) << started.error().message;
  ASSERT_TRUE(run.wait_for(kWholeRun));
}

TEST(Adaptive, AnotherCropJudgesItsTilesByItself) {
  const test::TempFolder folder;
  LocalPlan plan = noisy_plan();
  plan.frames = {1, 2};
  FilmStoreOptions log;
  log.folder = folder.path();
  FakeRender render(plan.samples);
  for (const core::PixelRect& region :
       {core::PixelRect{0, 0, 80, 64}, core::PixelRect{0, 0, 70, 50}}) {
    plan.region = region;
    // What is rendered is kept, and has no outputs.
    render.finish_fault = [](int32_t) { return core::Error{"no room"}; };
    run_to_its_end(plan, log, render);
    log.kept = KeptFilms::require;
    render.finish_fault = {};
    run_to_its_end(plan, log, render);
    // Of the first crop all tiles are whole, and alike.
    expect_what_tiles_need(plan, render, plan.region.x1 == 70 ? 2 : 1);
    for (const int32_t frame : plan.frames) render.lose_output(frame);
  }
}

TEST(Adaptive, OfSomeBatchesAloneNothingCanBeTold) {
  LocalPlan plan = noisy_plan();
  plan.batches = {2, 4};
  FakeRender render(plan.samples);
  LocalRun run(plan, {}, render, render);
  const core::Status started = run.start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().message.find("some batches"), std::string::npos);
}

}  // namespace
}  // namespace hyades::coordinator
