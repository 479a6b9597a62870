// What people do with workers while they run: quarantine, drain, release; and what is done with
// those that render other bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

/// A worker of other bits, which gives four films and keeps the first unit that it was leased.
struct DivergentRun {
  explicit DivergentRun(const FarmWorld& world) : script(world.script(1)) {
    script.corrupt = [](core::Film& film) { film.mutable_plane(0)[0] += core::Fixed128{0, 1}; };
    script.meddle = [this](ScriptedWorker&, const v1::LeasedUnit& unit) {
      if (given == 0) first = unit;
      return ++given <= 4;
    };
  }
  std::atomic<int> given{0};
  v1::LeasedUnit first;
  ScriptedWorker::Script script;
};

TEST(Steering, AQuarantinedWorkerGetsNothingUntilItIsReleased) {
  FarmWorld world;
  world.start();
  ScriptedWorker::Script script = world.script();
  script.unit_time = 2ms;
  const ScriptedWorker worker(world.address, script);
  v1::WorkerRequest request;
  request.set_worker("scripted/1");
  request.set_reason("smells of smoke");
  v1::WorkerResponse now;
  ASSERT_TRUE(eventually(
      [&] { return world.farm_->QuarantineWorker(world.context().get(), request, &now).ok(); }));
  EXPECT_EQ(now.worker().state(), v1::WORKER_STATE_QUARANTINED);
  const uint64_t job = world.submit(1);
  std::this_thread::sleep_for(400ms);
  EXPECT_EQ(worker.delivered(), 0U);
  ASSERT_TRUE(world.farm_->ReleaseWorker(world.context().get(), request, &now).ok());
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  ASSERT_TRUE(world.farm_->DrainWorker(world.context().get(), request, &now).ok());
  EXPECT_TRUE(eventually([&] { return worker.drained(); }));
}

TEST(Steering, AWorkerThatIsToLeaveIsNotActiveWhenItIsReleased) {
  FarmWorld world;
  world.start();
  ScriptedWorker drained(world.address, world.script(1));
  ScriptedWorker leaving(world.address, world.script(2));
  ASSERT_TRUE(eventually([&] { return drained.streams() == 1 && leaving.streams() == 1; }));
  v1::WorkerResponse now;
  const auto about_worker = [](const char* name, const char* reason) {
    v1::WorkerRequest request;
    request.set_worker(name);
    request.set_reason(reason);
    return request;
  };
  const auto drain = about_worker("scripted/1", "its disk is failing");
  ASSERT_TRUE(world.farm_->DrainWorker(world.context().get(), drain, &now).ok());
  EXPECT_EQ(now.worker().reason(), "its disk is failing");
  v1::WorkerMessage message;
  message.mutable_leaving()->set_reason("the cloud wants its machine");
  leaving.write(message);
  for (const char* name : {"scripted/1", "scripted/2"}) {
    ASSERT_TRUE(eventually([&] {
      v1::WorkersResponse workers;
      (void)world.farm_->Workers(world.context().get(), {}, &workers);
      return std::any_of(workers.workers().begin(), workers.workers().end(), [&](const auto& w) {
        return w.name() == name && w.state() == v1::WORKER_STATE_DRAINING;
      });
    })) << name;
    const auto smoke = about_worker(name, "smells of smoke");
    ASSERT_TRUE(world.farm_->QuarantineWorker(world.context().get(), smoke, &now).ok());
    EXPECT_EQ(now.worker().state(), v1::WORKER_STATE_QUARANTINED);
    const auto clear = about_worker(name, "the smoke is gone");
    ASSERT_TRUE(world.farm_->ReleaseWorker(world.context().get(), clear, &now).ok());
    EXPECT_EQ(now.worker().state(), v1::WORKER_STATE_DRAINING) << name;
  }
  const auto again = about_worker("scripted/1", "once more");
  ASSERT_TRUE(world.farm_->ReleaseWorker(world.context().get(), again, &now).ok());
  EXPECT_EQ(now.worker().reason(), "its disk is failing") << "nothing has changed";
  world.submit(1);
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(drained.delivered() + leaving.delivered(), 0U);
}

TEST(Steering, ADrainedWorkerIsToldAgainWhenItComesBack) {
  FarmWorld world;
  world.start();
  ScriptedWorker::Script script = world.script();
  script.instance = "the-same-process";
  std::optional<ScriptedWorker> worker(std::in_place, world.address, script);
  ASSERT_TRUE(eventually([&] { return worker->streams() == 1; }));
  worker.reset();
  v1::WorkerRequest request;
  request.set_worker("scripted/1");
  v1::WorkerResponse now;
  ASSERT_TRUE(world.farm_->DrainWorker(world.context().get(), request, &now).ok());
  worker.emplace(world.address, script);
  EXPECT_TRUE(eventually([&] { return worker->drained(); }));
  const uint64_t job = world.submit(1);
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(worker->delivered(), 0U);
  worker.reset();
  script.instance = "another-process-of-it";
  worker.emplace(world.address, script);
  EXPECT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  EXPECT_FALSE(worker->drained());
}

TEST(Steering, AWorkerWithOtherBitsThanTwoOthersIsQuarantinedAndItsFilmsDoNotCount) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  DivergentRun divergent(world);
  const ScriptedWorker broken(world.address, divergent.script);
  ASSERT_TRUE(eventually([&] { return broken.acknowledged() >= 4; }));
  // Another renders one of its units too, and then a third is asked.
  std::atomic<bool> compared{false};
  ScriptedWorker::Script good = world.script(2);
  good.meddle = [&](ScriptedWorker& self, const v1::LeasedUnit&) {
    if (!compared.exchange(true)) self.deliver(world.leased_to(self, divergent.first));
    return true;
  };
  const ScriptedWorker second(world.address, good);
  // Not before the log knows.
  ASSERT_TRUE(eventually([&] { return second.rejections().size() > 1; }));
  EXPECT_EQ(second.rejections().front().reason(), v1::Rejected::REASON_NOT_NOW);
  EXPECT_EQ(second.rejections().back().reason(), v1::Rejected::REASON_CONFLICT);
  v1::ExplainResponse why;
  ASSERT_TRUE(world.jobs->Explain(world.context().get(), about(job), &why).ok());
  EXPECT_NE(why.reasons(0).find("rendered differently"), std::string::npos) << why.reasons(0);
  const ScriptedWorker third(world.address, world.script(3));
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  world.expect_truth(job, 1);
  EXPECT_EQ(world.get(job).job().samples_done(),
            uint64_t{FarmWorld::kWidth} * FarmWorld::kHeight * FarmWorld::kSamples);
  world.stop();
  world.start();
  const auto found = [&] {
    v1::WorkersResponse workers;
    (void)world.farm_->Workers(world.context().get(), {}, &workers);
    for (const v1::Worker& worker : workers.workers()) {
      if (worker.name() == "scripted/1") return worker;
    }
    return v1::Worker();
  };
  ASSERT_TRUE(eventually([&] { return found().state() == v1::WORKER_STATE_QUARANTINED; }));
  EXPECT_NE(found().reason().find("other bits than two other workers"), std::string::npos);
}

TEST(Steering, WhatWorkersDisagreedAboutDoesNotCountAfterARestart) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  {
    DivergentRun divergent(world);
    const ScriptedWorker broken(world.address, divergent.script);
    ASSERT_TRUE(eventually([&] { return broken.acknowledged() >= 4; }));
    std::atomic<bool> compared{false};
    ScriptedWorker::Script good = world.script(2);
    good.meddle = [&](ScriptedWorker& self, const v1::LeasedUnit&) {
      if (!compared.exchange(true)) self.deliver(world.leased_to(self, divergent.first));
      return false;
    };
    const ScriptedWorker second(world.address, good);
    ASSERT_TRUE(eventually([&] {
      const auto rejected = second.rejections();
      return !rejected.empty() && rejected.back().reason() == v1::Rejected::REASON_CONFLICT;
    }));
    world.stop();
  }
  // There is no third who decides, only a coordinator that has forgotten who was who.
  world.start();
  const ScriptedWorker alone(world.address, world.script(2));
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  world.expect_truth(job, 1);
  EXPECT_EQ(world.get(job).job().samples_done(),
            uint64_t{FarmWorld::kWidth} * FarmWorld::kHeight * FarmWorld::kSamples);
  world.stop();
}

}  // namespace
}  // namespace hyades::coordinator
