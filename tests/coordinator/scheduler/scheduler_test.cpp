// Jobs and frames, from opening to their end.
#include <ctime>
#include <deque>

#include "tests/coordinator/scheduler/scheduler_testing.h"

namespace hyades::coordinator {
namespace {

using Bench = SchedulerBench;

TEST(Scheduler, RunsAJobFromOpeningToItsEnd) {
  Bench b;
  b.join(kAnna);
  b.add(small_plan({7}, 1));
  EXPECT_EQ(b.only<OpenFrame>().frame, 7);
  b.tell(FrameOpened{kJob, 7});

  const Lease first = b.ask(kAnna);
  const Lease second = b.ask(kAnna);
  EXPECT_NE(first.units[0].tile, second.units[0].tile);
  b.deliver_durably(first);
  EXPECT_EQ(b.only<Merge>().unit, first.units[0]);
  EXPECT_EQ(b.only<Acknowledge>().lease, first.lease);
  EXPECT_TRUE(b.all<FinishFrame>().empty());
  b.deliver_durably(second);
  EXPECT_EQ(b.only<FinishFrame>().frame, 7);
  b.tell(FinishDone{kJob, 7});
  const Persist record = b.only<Persist>();
  EXPECT_TRUE(std::holds_alternative<FrameFinishedRecord>(record.record));
  EXPECT_TRUE(b.all<JobEnded>().empty());
  b.tell(Persisted{record.id});
  EXPECT_EQ(b.only<FrameDone>().frame, 7);
  EXPECT_EQ(b.only<JobEnded>().done, 1U);
}

TEST(Scheduler, AUnitThatFailsThreeTimesFailsItsFrameOnly) {
  Bench b;
  b.join(kAnna);
  JobPlan plan = small_plan({1, 2}, 1);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  for (int i = 0; i < 3; ++i) {
    const Lease lease = b.ask(kAnna);
    ASSERT_EQ(lease.units[0].frame, 1);
    b.tell(UnitFailed{kAnna, lease.lease, kJob, lease.units[0], "a NaN"});
  }
  const Persist record = b.only<Persist>();
  EXPECT_EQ(std::get<FrameFailedRecord>(record.record).failed.reason, "a NaN");
  b.tell(Persisted{record.id});
  EXPECT_EQ(b.only<FrameFailed>().frame, 1);
  b.tell(FrameOpened{kJob, 2});
  b.deliver_durably(b.ask(kAnna));
  b.tell(FinishDone{kJob, 2});
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_EQ(b.only<JobEnded>().done, 1U);
  EXPECT_EQ(b.only<JobEnded>().failed, 1U);
}

/// A frame of one unit, and as many workers.
class Failing : public testing::Test {
 protected:
  void begin(size_t workers) {
    for (size_t i = 1; i <= workers; ++i) b.join(WorkerId{i});
    JobPlan plan = small_plan({1}, 1);
    plan.region = {0, 0, 32, 32};
    b.add(plan);
    b.tell(FrameOpened{kJob, 1});
  }
  /// The worker gets the unit and fails it. Whether that fails its frame.
  bool fails(WorkerId worker) {
    const Lease lease = b.ask(worker);
    if (lease.units.empty()) return false;
    b.tell(UnitFailed{worker, lease.lease, kJob, lease.units[0], "a NaN"});
    return !b.all<Persist>().empty();
  }
  Bench b;
  const WorkerId carl_{3};
  const WorkerId dora_{4};
};

TEST_F(Failing, OnThreeWorkersStopsTheFrameThoughOthersAreThere) {
  begin(4);
  EXPECT_FALSE(fails(kAnna));
  EXPECT_FALSE(fails(kBert));
  EXPECT_TRUE(fails(carl_)) << "Dora is not asked any more";
}

TEST_F(Failing, GoesToEveryWorkerOfFewBeforeTheFrameStops) {
  begin(2);
  EXPECT_FALSE(fails(kAnna));
  b.tell(WorkRequested{kAnna, 1});
  EXPECT_TRUE(b.all<Lease>().empty()) << "Bert is there";
  EXPECT_FALSE(fails(kBert));
  // Both have failed it: Anna, who waits, gets it again at once.
  const Lease again = b.only<Lease>();
  EXPECT_EQ(again.worker, kAnna);
  b.tell(UnitFailed{kAnna, again.lease, kJob, again.units.at(0), "a NaN"});
  EXPECT_EQ(std::get<FrameFailedRecord>(b.only<Persist>().record).failed.reason, "a NaN");
}

TEST_F(Failing, ThreeTimesWithOneWorkerSaysNothingWhileAnotherMayTry) {
  begin(1);
  EXPECT_FALSE(fails(kAnna));
  EXPECT_FALSE(fails(kAnna));
  const Lease third = b.ask(kAnna);
  b.join(kBert);
  b.tell(UnitFailed{kAnna, third.lease, kJob, third.units.at(0), "a NaN"});
  EXPECT_TRUE(b.all<Persist>().empty());
  b.tell(WorkRequested{kAnna, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  EXPECT_EQ(b.ask(kBert).units, third.units);
}

TEST_F(Failing, EndsThoughWhoeverMightTryGoesAgain) {
  begin(1);
  EXPECT_FALSE(fails(kAnna));
  EXPECT_FALSE(fails(kAnna));
  const Lease third = b.ask(kAnna);
  b.join(kBert);
  b.tell(UnitFailed{kAnna, third.lease, kJob, third.units.at(0), "a NaN"});
  b.tell(WorkerBarred{kBert, true});
  EXPECT_TRUE(fails(kAnna));
}

TEST_F(Failing, IsNoWorkerForACopyOfTheSameUnit) {
  begin(2);
  EXPECT_FALSE(fails(kAnna));
  b.ask(kBert);
  b.tell(WorkRequested{kAnna, 1});
  b.now += std::chrono::seconds(20);
  b.tell(WorkerAlive{kBert, {}});
  b.tell(Tick{});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.join(carl_);
  b.tell(WorkRequested{carl_, 1});
  EXPECT_EQ(b.only<Lease>().worker, carl_);
}

TEST(Scheduler, AFinishedRecordThatFailsIsTriedAgain) {
  Bench b;
  b.join(kAnna);
  JobPlan plan = small_plan({1}, 1);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  b.deliver_durably(b.ask(kAnna));
  b.tell(FinishDone{kJob, 1});
  b.tell(PersistFailed{b.only<Persist>().id, "disk full"});
  EXPECT_TRUE(b.all<FrameDone>().empty());
  b.now = *b.scheduler.next_wake();
  b.tell(Tick{});
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_EQ(b.all<JobEnded>().size(), 1U);
}

TEST(Scheduler, AFinishedRecordOfACancelledJobIsNotTriedAgain) {
  Bench b;
  b.join(kAnna);
  JobPlan plan = small_plan({1}, 1);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  b.deliver_durably(b.ask(kAnna));
  b.tell(FinishDone{kJob, 1});
  const RecordId finished = b.only<Persist>().id;
  b.tell(PersistFailed{finished, "disk full"});
  b.tell(JobCancelled{kJob});
  b.now = *b.scheduler.next_wake();
  b.tell(Tick{});
  EXPECT_TRUE(b.all<Persist>().empty());
  b.tell(Persisted{finished});
  EXPECT_TRUE(b.said.empty());
}

TEST(Scheduler, RestartContinuesWithWhatWasAccepted) {
  Bench b;
  RestoredJob restored;
  restored.finished = {1};
  restored.failed = {2};
  const core::PixelRect left{0, 0, 32, 32};
  const core::PixelRect right{32, 0, 64, 32};
  restored.accepted = {{{3, left, {0, 1}}, digest(1), "class"},
                       {{4, left, {0, 2}}, digest(1), "class"},
                       {{4, right, {0, 2}}, digest(1), "class"}};
  b.add(small_plan({1, 2, 3, 4}), restored);
  EXPECT_EQ(b.only<FinishFrame>().frame, 4);
  EXPECT_EQ(b.only<OpenFrame>().frame, 3);
  b.tell(FrameOpened{kJob, 3});
  b.join(kAnna);
  EXPECT_THAT(b.ask(kAnna, 100).units, testing::SizeIs(3));
}

TEST(Scheduler, TheNextFrameOpensAtTheTailOfTheLast) {
  Bench b;
  b.join(kAnna);
  JobPlan plan = small_plan({1, 2, 3, 4, 5}, 1);
  plan.region = {0, 0, 320, 32};
  plan.frames_in_flight = 3;
  b.add(plan);
  EXPECT_EQ(b.only<OpenFrame>().frame, 1);
  b.tell(FrameOpened{kJob, 1});
  EXPECT_TRUE(b.all<OpenFrame>().empty());
  const Lease most = b.ask(kAnna, 5);
  EXPECT_EQ(b.only<OpenFrame>().frame, 2);
  const Lease rest = b.ask(kAnna, 5);
  EXPECT_TRUE(b.all<OpenFrame>().empty());
  b.tell(FrameOpened{kJob, 2});
  EXPECT_EQ(b.ask(kAnna, 10).units[0].frame, 2);
  EXPECT_EQ(b.only<OpenFrame>().frame, 3);
  b.tell(FrameOpened{kJob, 3});
  b.ask(kAnna, 10);
  EXPECT_TRUE(b.all<OpenFrame>().empty()) << "three are in flight";
}

TEST(Scheduler, AFrameThatCannotBeOpenedFails) {
  Bench b;
  b.add(small_plan({1, 2}));
  b.tell(FrameRefused{kJob, 1, "no such file"});
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_EQ(b.only<FrameFailed>().reason, "no such file");
  EXPECT_EQ(b.only<OpenFrame>().frame, 2);
}

TEST(Scheduler, AFrameWhoseFilmOutgrowsItsRoomFails) {
  Bench b;
  b.join(kAnna);
  b.add(small_plan({1, 2}));
  b.tell(FrameOpened{kJob, 1});
  const Lease lease = b.ask(kAnna);
  b.tell(FrameRefused{kJob, 1, "too many ids"});
  EXPECT_EQ(b.only<Revoke>().unit, lease.units[0]);
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_EQ(b.only<FrameFailed>().reason, "too many ids");
}

TEST(Scheduler, FinishingIsTriedThreeTimes) {
  Bench b;
  b.join(kAnna);
  JobPlan plan = small_plan({1}, 1);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  b.deliver_durably(b.ask(kAnna));
  for (int i = 0; i < 2; ++i) {
    b.tell(FinishFailed{kJob, 1, "disk full"});
    EXPECT_EQ(b.all<FinishFrame>().size(), 1U);
  }
  b.tell(FinishFailed{kJob, 1, "disk full"});
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_EQ(b.only<JobEnded>().failed, 1U);
}

TEST(Scheduler, JobsWithoutPixelsOrFramesEndToo) {
  Bench b;
  b.join(kAnna);
  b.add(small_plan({}));
  EXPECT_EQ(b.all<JobEnded>().size(), 1U);
  JobPlan plan = small_plan({1, 1}, 0);
  b.add(plan, {}, JobId{2});
  EXPECT_EQ(b.all<OpenFrame>().size(), 1U) << "one frame, named twice";
  b.tell(FrameOpened{JobId{2}, 1});
  b.tell(FinishDone{JobId{2}, b.only<FinishFrame>().frame});
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_EQ(b.only<JobEnded>().done, 1U);
}

/// What each frame costs does not grow with how many there are: 200,000 would take minutes.
TEST(Scheduler, VeryManyFailedFramesBeginAgain) {
  SchedulerBench bench;
  JobPlan plan;
  plan.region = {0, 0, 32, 32};
  RestoredJob restored;
  for (int32_t frame = 0; frame < 200'000; ++frame) {
    plan.frames.push_back(frame);
    if (frame > 0) restored.failed.push_back(frame);
  }
  const auto begin = std::clock();
  bench.scheduler.handle(JobAdded{kJob, plan, restored}, bench.now);
  std::deque<RecordId> records;
  size_t restarted = 0;
  const auto tell = [&](const Event& event) {
    const std::vector<Action> said = bench.scheduler.handle(event, bench.now);
    EXPECT_LE(said.size(), 1010U) << "some at a time: all together would take all memory";
    for (const Action& action : said) {
      if (const auto* persist = std::get_if<Persist>(&action)) records.push_back(persist->id);
    }
  };
  tell(FramesRetried{kJob});
  for (; !records.empty(); records.pop_front(), ++restarted) tell(Persisted{records.front()});
  EXPECT_EQ(restarted, 199'999U);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 20.0);
  EXPECT_TRUE(bench.scheduler.knows(kJob));
}

// Those that are done may be all that begin again at first, and the job goes on.
TEST(Scheduler, AJobWhoseFailedFramesBeginAgainSomeAtATimeEndsWithTheLast) {
  SchedulerBench bench;
  JobPlan plan;
  plan.region = {0, 0, 0, 0};  // a frame without pixels is done at once
  plan.frames_in_flight = 5000;
  RestoredJob restored;
  for (int32_t frame = 0; frame < 2500; ++frame) plan.frames.push_back(frame);
  plan.frames.push_back(9999);
  for (int32_t frame = 0; frame < 2500; ++frame) restored.failed.push_back(frame);
  std::deque<Event> events{JobAdded{kJob, plan, restored}, FramesRetried{kJob}};
  std::vector<JobEnded> ended;
  for (; !events.empty(); events.pop_front()) {
    for (const Action& action : bench.scheduler.handle(events.front(), bench.now)) {
      if (const auto* persist = std::get_if<Persist>(&action)) {
        events.emplace_back(Persisted{persist->id});
      } else if (const auto* open = std::get_if<OpenFrame>(&action)) {
        events.emplace_back(FrameOpened{open->job, open->frame});
      } else if (const auto* finish = std::get_if<FinishFrame>(&action)) {
        events.emplace_back(FinishDone{finish->job, finish->frame});
      } else if (const auto* end = std::get_if<JobEnded>(&action)) {
        ended.push_back(*end);
      }
    }
  }
  ASSERT_EQ(ended.size(), 1U);
  EXPECT_EQ(ended[0].done, 2501U);
}

TEST(Scheduler, PausedJobsLeaseNothingAndTakeWhatComes) {
  Bench b;
  b.join(kAnna);
  b.add(small_plan());
  b.tell(FrameOpened{kJob, 1});
  const Lease lease = b.ask(kAnna);
  b.tell(JobPaused{kJob});
  b.tell(WorkRequested{kAnna, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.deliver_durably(lease);
  EXPECT_EQ(b.all<Merge>().size(), 1U);
  b.tell(JobResumed{kJob});
  EXPECT_EQ(b.all<Lease>().size(), 1U);
}

TEST(Scheduler, ACancelledJobTakesItsLeasesBack) {
  Bench b;
  b.join(kAnna);
  b.add(small_plan());
  b.tell(FrameOpened{kJob, 1});
  const Lease lease = b.ask(kAnna, 2);
  b.deliver(lease);
  const Persist persist = b.only<Persist>();
  b.tell(JobCancelled{kJob});
  EXPECT_TRUE(b.only<JobEnded>().cancelled);
  EXPECT_EQ(b.only<Revoke>().unit, lease.units[1]);
  b.tell(Persisted{persist.id});
  EXPECT_TRUE(b.all<Merge>().empty());
  EXPECT_EQ(b.all<Acknowledge>().size(), 1U) << "the worker may forget it";
  b.deliver(lease, 1);
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::unknown);
}

}  // namespace
}  // namespace hyades::coordinator
