// Leases that are renewed and renewed while nothing becomes of them.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

using Progress = v1::LeaseProgress;

/// A farm whose first worker holds what it gets, and tells of it in its heartbeats.
struct Stalling {
  explicit Stalling(Progress::Stage stage, bool moves = false) {
    world.options.lease_time = 3s;
    world.options.stall_time = 1s;
    world.options.copy_after = 1h;
    world.start();
    job = world.submit(1);
    ScriptedWorker::Script script = world.script();
    script.hold = true;
    script.beat_every = 50ms;
    script.stage = stage;
    script.moves = moves;
    holder.emplace(world.address, script);
    EXPECT_TRUE(eventually([&] { return holder->unacknowledged() > 0; }));
  }
  bool log_says(const std::string& text) const {
    v1::LogsRequest request;
    request.set_job(job);
    const auto context = world.context();
    const auto reader = world.jobs->Logs(context.get(), request);
    bool found = false;
    v1::LogLine line;
    while (reader->Read(&line)) found |= line.text().find(text) != std::string::npos;
    (void)reader->Finish();
    return found;
  }
  uint64_t failed() const {
    v1::WorkersResponse workers;
    EXPECT_TRUE(world.farm_->Workers(world.context().get(), {}, &workers).ok());
    uint64_t failures = 0;
    for (const v1::Worker& worker : workers.workers()) failures += worker.units_failed();
    return failures;
  }
  std::string reasons() const {
    v1::JobRequest request;
    request.set_job(job);
    v1::ExplainResponse response;
    EXPECT_TRUE(world.jobs->Explain(world.context().get(), request, &response).ok());
    std::string all;
    for (const std::string& reason : response.reasons()) all += reason + "\n";
    return all;
  }
  FarmWorld world;
  uint64_t job = 0;
  std::optional<ScriptedWorker> holder;
};

TEST(Stall, AUnitWithoutProgressIsTakenBackAndGoesToOthers) {
  Stalling stalling(Progress::STAGE_RENDERING);
  EXPECT_TRUE(eventually([&] {
    return stalling.reasons().find("no progress for") != std::string::npos;
  })) << "explain says what is the matter before anything is done";
  ASSERT_TRUE(eventually([&] { return stalling.failed() > 0; }));
  EXPECT_TRUE(eventually([&] { return stalling.holder->stopped() > 0; }));
  EXPECT_TRUE(eventually([&] { return stalling.log_says("is taken back: no progress in"); }));
  const ScriptedWorker other(stalling.world.address, stalling.world.script(2));
  EXPECT_TRUE(eventually([&] { return other.acknowledged() > 0; }));
}

TEST(Stall, WhatMovesIsLeftAlone) {
  const Stalling stalling(Progress::STAGE_RENDERING, true);
  std::this_thread::sleep_for(2500ms);
  EXPECT_EQ(stalling.failed(), 0U);
  EXPECT_EQ(stalling.holder->stopped(), 0U);
}

TEST(Stall, FilmsThatWaitForTheCoordinatorAreLeftAlone) {
  const Stalling stalling(Progress::STAGE_FILM);
  std::this_thread::sleep_for(7s);  // also longer than what waits for a thread may take
  EXPECT_EQ(stalling.failed(), 0U);
  EXPECT_EQ(stalling.holder->stopped(), 0U);
}

TEST(Stall, ALoadingSceneHasLonger) {
  const Stalling stalling(Progress::STAGE_LOADING);
  std::this_thread::sleep_for(3s);
  EXPECT_EQ(stalling.failed(), 0U);
  EXPECT_TRUE(eventually([&] { return stalling.failed() > 0; }));
}

}  // namespace
}  // namespace hyades::coordinator
