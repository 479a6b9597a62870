#include "coordinator/local/local_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/coordinator/local/fake_render.h"

namespace hyades::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kLong = seconds(60);

LocalPlan small_plan() {
  LocalPlan plan;
  plan.frames = {3};
  plan.region = {5, 7, 5 + 70, 7 + 45};
  plan.samples = 40;  // two whole batches and a half
  plan.threads = 2;
  plan.tile_size = 16;
  return plan;
}

LocalOutcome run_to_the_end(const LocalPlan& plan, FakeRender& render,
                            const FilmStoreOptions& log = {}) {
  LocalRun run(plan, log, render, render);
  const core::Status started = run.start();
  EXPECT_TRUE(started) << (started ? "" : started.error().message);
  EXPECT_TRUE(run.wait_for(kLong)) << "the run does not end";
  return run.outcome();
}

TEST(LocalRun, SameBitsForAnyThreadsTilesAndOrder) {
  LocalPlan plan = small_plan();
  const std::string truth = oracle_digest(3, plan.region, plan.samples);
  for (const int threads : {1, 2, 7}) {
    for (const int32_t tile : {8, 13, 100}) {
      for (const uint64_t shuffle : {0, 99}) {
        plan.threads = threads;
        plan.tile_size = tile;
        plan.shuffle = shuffle;
        FakeRender render(plan.samples);
        const LocalOutcome outcome = run_to_the_end(plan, render);
        EXPECT_TRUE(outcome.complete);
        EXPECT_EQ(render.digests().at(3), truth)
            << threads << " threads, tiles of " << tile << ", shuffle " << shuffle;
      }
    }
  }
}

TEST(LocalRun, FramesArePipelinedWithinBounds) {
  LocalPlan plan = small_plan();
  plan.frames = {1, 2, 3, 4, 5, 6, 7, 8};
  FakeRender render(plan.samples);
  render.unit_delay = microseconds(500);
  render.finish_delay = milliseconds(5);
  const LocalOutcome outcome = run_to_the_end(plan, render);
  EXPECT_EQ(outcome.frames_done, 8U);
  for (const int32_t frame : plan.frames) {
    EXPECT_EQ(render.digests().at(frame), oracle_digest(frame, plan.region, plan.samples));
  }
  EXPECT_EQ(render.prepared(), plan.frames);
  EXPECT_TRUE(render.prepared_while_rendering());
  EXPECT_LE(render.most_alive(), 3);
}

TEST(LocalRun, AFrameWhoseIdsOutgrowTheirRoomFailsAndOthersDoNot) {
  LocalPlan plan = small_plan();
  plan.frames = {1, 2};
  plan.tile_size = 100;  // what completes the film makes it too large
  plan.samples = 16;
  core::LayerSet layers;
  layers.ids = {true, false};
  const core::FilmLayout layout = core::make_film_layout(layers);
  FakeRender render(plan.samples);
  render.film_of = [&](const core::Unit& unit) {
    core::Film film(layout, unit.tile);
    core::IdLayer& ids = film.mutable_ids(core::IdKind::object);
    const auto area = static_cast<uint32_t>(unit.tile.area());
    for (uint32_t b = unit.batches.first; b < unit.batches.end(); ++b) {
      film.deposit(unit.tile, b, core::samples_in_batch(b, plan.samples),
                   std::vector<float>(area * static_cast<size_t>(layout.deposited)));
    }
    for (uint32_t id = 1; id <= area; ++id) {
      ids.deposit({{id - 1, id, 1}});
      ids.name(id, std::string(unit.frame == 1 ? 5000 : 5, 'o'));
    }
    return film;
  };
  const LocalOutcome outcome = run_to_the_end(plan, render);
  EXPECT_TRUE(outcome.complete);
  EXPECT_EQ(outcome.frames_done, 1U);
  ASSERT_EQ(outcome.failures.size(), 1U);
  EXPECT_EQ(outcome.failures[0].frame, 1);
  EXPECT_THAT(outcome.failures[0].reason, testing::HasSubstr("crypto_object"));
  EXPECT_EQ(render.digests().count(1), 0U) << "no outputs of a film without pixels";
}

TEST(LocalRun, StopsWithinASecond) {
  LocalPlan plan = small_plan();
  FakeRender render(plan.samples);
  render.unit_delay = seconds(100);
  LocalRun run(plan, {}, render, render);
  ASSERT_TRUE(run.start());
  EXPECT_FALSE(run.wait_for(milliseconds(50)));
  const auto begin = std::chrono::steady_clock::now();
  run.stop();
  EXPECT_TRUE(run.wait_for(seconds(1)));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, seconds(1));
  EXPECT_FALSE(run.outcome().complete);
  EXPECT_EQ(run.outcome().error, "");
}

TEST(LocalRun, AUnitThatAlwaysFailsFailsItsFrameOnly) {
  LocalPlan plan = small_plan();
  plan.frames = {1, 2, 3};
  FakeRender render(plan.samples);
  std::atomic<int> attempts = 0;
  render.unit_fault = [&](const core::Unit& unit) -> core::Status {
    if (unit.frame != 2 || !unit.tile.contains(40, 30) || unit.batches.first != 0) return {};
    ++attempts;
    return core::Error{"the walls fell down"};
  };
  const LocalOutcome outcome = run_to_the_end(plan, render);
  EXPECT_TRUE(outcome.complete);
  EXPECT_EQ(outcome.frames_done, 2U);
  ASSERT_EQ(outcome.failures.size(), 1U);
  EXPECT_EQ(outcome.failures[0].frame, 2);
  EXPECT_THAT(outcome.failures[0].reason, testing::HasSubstr("the walls fell down"));
  EXPECT_EQ(attempts, 3);
}

TEST(LocalRun, AUnitThatFailsOnceIsRenderedAgain) {
  LocalPlan plan = small_plan();
  FakeRender render(plan.samples);
  std::atomic<int> failures = 0;
  render.unit_fault = [&](const core::Unit&) -> core::Status {
    if (failures.fetch_add(1) == 4) throw std::runtime_error("a passing cloud");
    return {};
  };
  EXPECT_EQ(run_to_the_end(plan, render).frames_done, 1U);
  EXPECT_EQ(render.digests().at(3), oracle_digest(3, plan.region, plan.samples));
}

TEST(LocalRun, AFilmOfSomethingElseIsAFailure) {
  class Wrong final : public FrameSource, public FrameWork {
    core::Result<std::shared_ptr<const FrameWork>> prepare(int32_t) override {
      return std::shared_ptr<const FrameWork>(std::make_shared<Wrong>());
    }
    core::Result<core::Film> render(const core::Unit& unit,
                                    const std::atomic<bool>&) const override {
      core::Unit other = unit;
      other.batches.first += 1;
      return fake_film(other, 1000);
    }
  };
  const LocalPlan plan = small_plan();
  Wrong wrong;
  FakeRender sink(plan.samples);
  LocalRun run(plan, {}, wrong, sink);
  ASSERT_TRUE(run.start());
  ASSERT_TRUE(run.wait_for(kLong));
  ASSERT_EQ(run.outcome().failures.size(), 1U);
  EXPECT_THAT(run.outcome().failures[0].reason, testing::HasSubstr("something else"));
}

TEST(LocalRun, AFrameThatCannotBeLoadedFailsAlone) {
  LocalPlan plan = small_plan();
  plan.frames = {1, 2, 3};
  FakeRender render(plan.samples);
  render.prepare_fault = [](int32_t frame) -> core::Status {
    if (frame == 2) return core::Error{"dragon.ply: no such file"};
    return {};
  };
  const LocalOutcome outcome = run_to_the_end(plan, render);
  EXPECT_EQ(outcome.frames_done, 2U);
  ASSERT_EQ(outcome.failures.size(), 1U);
  EXPECT_EQ(outcome.failures[0].reason, "dragon.ply: no such file");
}

TEST(LocalRun, FinishingIsTriedThreeTimes) {
  LocalPlan plan = small_plan();
  plan.frames = {1, 2};
  FakeRender render(plan.samples);
  std::map<int32_t, int> attempts;
  render.finish_fault = [&](int32_t frame) -> core::Status {
    const int attempt = ++attempts[frame];
    if (frame == 2 || attempt < 3) return core::Error{"no room"};
    return {};
  };
  const LocalOutcome outcome = run_to_the_end(plan, render);
  EXPECT_EQ(outcome.frames_done, 1U);
  EXPECT_EQ(render.digests().at(1), oracle_digest(1, plan.region, plan.samples));
  ASSERT_EQ(outcome.failures.size(), 1U);
  EXPECT_EQ(outcome.failures[0].frame, 2);
}

TEST(LocalRun, ProgressGoesFromNothingToAll) {
  LocalPlan plan = small_plan();
  plan.frames = {1, 2};
  plan.samples = 640;
  FakeRender render(plan.samples);
  render.unit_delay = milliseconds(2);
  LocalRun run(plan, {}, render, render);
  ASSERT_TRUE(run.start());
  uint64_t before = 0;
  while (!run.wait_for(milliseconds(5))) {
    const Progress p = run.progress();
    EXPECT_GE(p.samples_done, before);
    EXPECT_LE(p.samples_done, p.samples);
    before = p.samples_done;
  }
  const Progress p = run.progress();
  EXPECT_EQ(p.samples, 2ULL * 70 * 45 * 640);
  EXPECT_EQ(p.samples_done, p.samples);
  EXPECT_EQ(p.frames_done, 2U);
  EXPECT_EQ(p.seconds_left, 0);
  EXPECT_TRUE(p.frames_in_flight.empty());
}

TEST(LocalRun, RefusesNothingToRender) {
  LocalPlan plan = small_plan();
  plan.region = {};
  FakeRender render(plan.samples);
  LocalRun run(plan, {}, render, render);
  EXPECT_FALSE(run.start());
}

TEST(LocalRun, NoFramesIsAnEnd) {
  LocalPlan plan = small_plan();
  plan.frames = {};
  FakeRender render(plan.samples);
  EXPECT_TRUE(run_to_the_end(plan, render).complete);
}

}  // namespace
}  // namespace hyades::coordinator
