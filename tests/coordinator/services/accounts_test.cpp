// What rendering took: jobs' accounts, the timeline, and what is told of workers.
#include <gtest/gtest.h>

#include <set>

#include "tests/coordinator/services/farm_world.h"
#include "tests/coordinator/services/troubled_store.h"

namespace hyades::coordinator {
namespace {

constexpr double kUnitSeconds = 0.001;  // as scripted workers tell of each unit

/// All steps of a job, fetched `limit` at a time.
std::vector<v1::TimelineStep> steps_of(const FarmWorld& world, uint64_t job, uint32_t limit = 0) {
  std::vector<v1::TimelineStep> all;
  v1::ListTimelineRequest request;
  request.set_job(job);
  request.set_limit(limit);
  for (;;) {
    v1::ListTimelineResponse page;
    const grpc::Status status = world.jobs->ListTimeline(world.context().get(), request, &page);
    EXPECT_TRUE(status.ok()) << status.error_message();
    if (!status.ok()) return all;
    for (const v1::TimelineStep& step : page.steps()) all.push_back(step);
    if (!page.more()) return all;
    EXPECT_GT(page.steps_size(), 0) << "there are more, and none comes";
    request.set_after(all.back().number());
  }
}

size_t count(const std::vector<v1::TimelineStep>& steps, v1::TimelineStep::Kind kind) {
  return static_cast<size_t>(std::count_if(
      steps.begin(), steps.end(), [&](const v1::TimelineStep& s) { return s.kind() == kind; }));
}

TEST(Accounts, CoreSecondsAndCostGrowWithResultsAndSurviveARestart) {
  FarmWorld world;
  world.options.unit_time = 1ms;
  world.options.price = {3600 * 2.0, "EUR"};  // two a second
  world.start();
  v1::InfoResponse info;
  ASSERT_TRUE(world.farm_->Info(world.context().get(), {}, &info).ok());
  EXPECT_EQ(info.currency(), "EUR");
  EXPECT_EQ(info.price_per_core_hour(), 7200);
  EXPECT_EQ(info.grpc_address(), world.address);
  const uint64_t job = world.submit(2);
  EXPECT_EQ(world.get(job).job().core_seconds(), 0);
  double seconds = 0;
  {
    ScriptedWorker::Script script = world.script();
    script.unit_time = 2ms;  // as it says, or longer
    const ScriptedWorker worker(world.address, script);
    ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
    const v1::Job done = world.get(job).job();
    seconds = done.core_seconds();
    const size_t units = count(steps_of(world, job), v1::TimelineStep::KIND_RENDER);
    EXPECT_GT(units, 1U);
    EXPECT_NEAR(seconds, static_cast<double>(units) * kUnitSeconds, 1e-6);
    EXPECT_NEAR(done.cost(), 2 * seconds, 1e-9);
  }
  world.stop();
  world.start();
  EXPECT_NEAR(world.get(job).job().core_seconds(), seconds, 1e-9);
}

TEST(Accounts, OfAnOpenJobSurviveARestart) {
  FarmWorld world;
  world.options.unit_time = 1ms;
  world.start();
  const uint64_t job = world.submit(3);
  {
    ScriptedWorker::Script script = world.script();
    script.unit_time = 5ms;
    const ScriptedWorker worker(world.address, script);
    ASSERT_TRUE(eventually([&] { return world.get(job).job().core_seconds() > 0; }));
    v1::JobRequest about;
    about.set_job(job);
    v1::JobResponse now;
    ASSERT_TRUE(world.jobs->Pause(world.context().get(), about, &now).ok());  // stores the job
    EXPECT_GT(now.job().core_seconds(), 0);
  }
  world.stop();
  world.start();
  EXPECT_GT(world.get(job).job().core_seconds(), 0);
}

TEST(Accounts, AJobThatIsCancelledWhileItWaitsToBeTakenUpTellsItsCost) {
  FarmWorld world;
  world.options.unit_time = 1ms;
  world.options.price = {3600 * 2.0, "EUR"};  // two a second
  const auto trouble = std::make_shared<Trouble>();
  world.wrap_store = [&](std::unique_ptr<JobStore> store) {
    return std::make_unique<TroubledStore>(std::move(store), trouble);
  };
  world.start();
  const uint64_t job = world.submit(3);
  v1::JobRequest about;
  about.set_job(job);
  v1::JobResponse now;
  {
    ScriptedWorker::Script script = world.script();
    script.unit_time = 5ms;
    const ScriptedWorker worker(world.address, script);
    ASSERT_TRUE(eventually([&] { return world.get(job).job().core_seconds() > 0; }));
    ASSERT_TRUE(world.jobs->Pause(world.context().get(), about, &now).ok());  // stores the job
  }
  world.stop();
  trouble->of_frames(Trouble::Kind::fails);
  world.start();
  ASSERT_TRUE(world.jobs->Cancel(world.context().get(), about, &now).ok());
  EXPECT_EQ(now.job().state(), v1::JOB_STATE_CANCELLED);
  EXPECT_GT(now.job().core_seconds(), 0);
  EXPECT_NEAR(now.job().cost(), 2 * now.job().core_seconds(), 1e-9);
}

TEST(Accounts, AResultThatDoesNotCountCostsNothing) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  ScriptedWorker::Script script = world.script();
  script.unit_time = 2ms;
  std::atomic<int> refused{0};
  script.meddle = [&](ScriptedWorker& worker, const v1::LeasedUnit& leased) {
    v1::WorkerMessage bad;
    v1::UnitResult& result = *bad.mutable_result();
    *result.mutable_lease() = leased.lease();
    result.set_job(leased.job());
    *result.mutable_unit() = leased.unit();
    result.set_film("no film");
    result.set_digest(std::string(32, 'x'));
    result.set_render_ns(UINT64_MAX);
    result.set_want(1);
    if (refused++ > 2) return true;
    worker.write(bad);
    return false;
  };
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  const size_t units = count(steps_of(world, job), v1::TimelineStep::KIND_RENDER);
  EXPECT_NEAR(world.get(job).job().core_seconds(), static_cast<double>(units) * kUnitSeconds, 1e-6);
}

TEST(Accounts, NoWorkerMakesAJobCostAnything) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  ScriptedWorker::Script script = world.script();
  script.render_ns = UINT64_MAX;
  const auto begun = std::chrono::steady_clock::now();
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  const size_t units = count(steps_of(world, job), v1::TimelineStep::KIND_RENDER);
  const std::chrono::duration<double> all = std::chrono::steady_clock::now() - begun;
  EXPECT_LE(world.get(job).job().core_seconds(), static_cast<double>(units) * all.count())
      << "no unit took longer than it was out";
}

TEST(Timeline, TellsOfEveryStepOncePageByPage) {
  FarmWorld world;
  world.options.unit_time = 1ms;
  world.start();
  const uint64_t job = world.submit(2);
  ScriptedWorker::Script script = world.script();
  script.thread = 2;
  script.unit_time = 2ms;
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  const auto all = steps_of(world, job);
  EXPECT_EQ(count(all, v1::TimelineStep::KIND_FINISH), 2U);
  EXPECT_EQ(count(all, v1::TimelineStep::KIND_MERGE), count(all, v1::TimelineStep::KIND_RENDER));
  std::set<std::string> units;
  uint64_t last = 0;
  for (const v1::TimelineStep& step : all) {
    EXPECT_GT(step.number(), last);
    last = step.number();
    EXPECT_LE(step.begun_us(), step.ended_us());
    if (step.kind() != v1::TimelineStep::KIND_RENDER) continue;
    EXPECT_TRUE(units.insert(step.unit().SerializeAsString()).second) << "the same unit twice";
    EXPECT_EQ(step.worker(), "scripted/1");
    EXPECT_EQ(step.thread(), 2U);
    EXPECT_EQ(step.ended_us() - step.begun_us(), 1000);
  }
  EXPECT_EQ(steps_of(world, job, 3).size(), all.size());
  v1::ListTimelineRequest other;
  other.set_job(job + 1);
  v1::ListTimelineResponse page;
  EXPECT_EQ(world.jobs->ListTimeline(world.context().get(), other, &page).error_code(),
            grpc::StatusCode::NOT_FOUND);
}

TEST(Timelines, OldStepsGoAndAreCounted) {
  Timelines timelines;
  for (int i = 0; i < 40'010; ++i) {
    timelines.note(1, {v1::TimelineStep::KIND_MERGE, {}, 0, {}, 0, 5});  // one moment for all
  }
  const auto page = timelines.page(1, 0, 3);
  EXPECT_EQ(page.dropped, 10U);
  ASSERT_EQ(page.steps.size(), 3U);
  EXPECT_TRUE(page.more);
  EXPECT_LT(page.steps[0].number, page.steps[1].number);
  EXPECT_EQ(timelines.page(1, page.steps[1].number, 1).steps.at(0).number, page.steps[2].number);
  EXPECT_TRUE(timelines.page(2, 0, 3).steps.empty());
}

TEST(Previews, TheFrameInWorkStandsForAJobThenTheLastOne) {
  FarmWorld world;
  world.options.unit_time = 1ms;
  world.start();
  const uint64_t job = world.submit(3);
  EXPECT_FALSE(world.get(job).job().has_preview_frame()) << "nothing is there yet";
  ScriptedWorker::Script script = world.script();
  script.unit_time = 5ms;
  std::atomic<bool> seen{false};
  // However slow this machine looks: the first frame is in work until that was seen.
  script.meddle = [&](ScriptedWorker& self, const v1::LeasedUnit&) {
    return self.acknowledged() == 0 || eventually([&] { return seen.load(); });
  };
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(eventually([&] {
    const v1::GetJobResponse now = world.get(job);
    if (!now.job().has_preview_frame()) return false;
    const v1::Frame& shown = now.frames(now.job().preview_frame() - 1);
    if (shown.state() == v1::FRAME_STATE_RENDERING) seen = true;
    EXPECT_GT(shown.samples_done(), 0U);
    return now.job().state() == v1::JOB_STATE_DONE;
  }));
  EXPECT_TRUE(seen);
  const int32_t last = world.get(job).job().preview_frame();
  world.stop();
  world.start();
  EXPECT_EQ(world.get(job).job().preview_frame(), last);
}

TEST(Frames, OfOneStateAreTold) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(3);
  const auto in_state = [&](v1::FrameState state) {
    v1::GetJobRequest request;
    request.set_job(job);
    request.set_state(state);
    v1::GetJobResponse response;
    EXPECT_TRUE(world.jobs->Get(world.context().get(), request, &response).ok());
    return response.frames_size();
  };
  EXPECT_EQ(in_state(v1::FRAME_STATE_WAITING), 3);
  EXPECT_EQ(in_state(v1::FRAME_STATE_DONE), 0);
  const ScriptedWorker worker(world.address, world.script());
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  EXPECT_EQ(in_state(v1::FRAME_STATE_DONE), 3) << "of a job that has ended, from the store";
  EXPECT_EQ(in_state(v1::FRAME_STATE_FAILED), 0);
}

TEST(Workers, TellWhatTheyWorkOnAndOfTheirCache) {
  FarmWorld world;
  world.options.unit_time = 1ms;
  world.start();
  const uint64_t job = world.submit(2);
  ScriptedWorker::Script script = world.script();
  script.hold = true;
  const ScriptedWorker worker(world.address, script);
  v1::WorkersResponse all;
  ASSERT_TRUE(eventually([&] {
    all.Clear();
    (void)world.farm_->Workers(world.context().get(), {}, &all);
    return all.workers_size() == 1 && all.workers(0).work_size() > 0;
  }));
  uint32_t units = 0;
  for (const v1::WorkInHand& work : all.workers(0).work()) {
    EXPECT_EQ(work.job(), job);
    EXPECT_TRUE(work.frame() == 1 || work.frame() == 2);
    units += work.units();
  }
  EXPECT_EQ(units, all.workers(0).leased());
}

TEST(Workers, TellOfTheirCache) {
  FarmWorld world;
  world.start();
  ScriptedWorker::Script script = world.script();
  script.beat_every = 20ms;
  script.cache_bytes = 123;
  const ScriptedWorker worker(world.address, script);
  EXPECT_TRUE(eventually([&] {
    v1::WorkersResponse all;
    (void)world.farm_->Workers(world.context().get(), {}, &all);
    return all.workers_size() == 1 && all.workers(0).cache_bytes() == 123 &&
           all.workers(0).cache_limit_bytes() == 1000 && all.workers(0).cache_hits() == 7 &&
           all.workers(0).cache_misses() == 3;
  }));
}

}  // namespace
}  // namespace hyades::coordinator
