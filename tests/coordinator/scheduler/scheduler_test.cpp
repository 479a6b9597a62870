#include "coordinator/scheduler/scheduler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace hyades::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr JobId kJob{1};
constexpr WorkerId kAnna{1};
constexpr WorkerId kBert{2};

Digest digest(uint8_t value) {
  Digest d{};
  d[0] = value;
  return d;
}

/// A scheduler with a clock, and what it said last.
class Bench {
 public:
  explicit Bench(SchedulerOptions options = {}) : scheduler(options) {}

  std::vector<Action> tell(const Event& event) {
    said = scheduler.handle(event, now);
    EXPECT_EQ(scheduler.audit(), "");
    return said;
  }
  template <class T>
  std::vector<T> all() const {
    std::vector<T> found;
    for (const Action& a : said) {
      if (const T* t = std::get_if<T>(&a)) found.push_back(*t);
    }
    return found;
  }
  template <class T>
  T only() const {
    const std::vector<T> found = all<T>();
    EXPECT_EQ(found.size(), 1U);
    return found.empty() ? T{} : found.front();
  }

  void add(JobPlan plan, RestoredJob restored = {}, JobId job = kJob) {
    tell(JobAdded{job, std::move(plan), std::move(restored)});
  }
  void join(WorkerId worker, std::vector<UnitInHand> in_hand = {}) {
    tell(WorkerJoined{worker, 1, "class", std::move(in_hand)});
  }
  Lease ask(WorkerId worker, uint32_t units = 1) {
    tell(WorkRequested{worker, units});
    return only<Lease>();
  }
  /// Delivers a unit of the lease and says what followed.
  void deliver(const Lease& lease, size_t unit = 0, uint8_t bits = 1) {
    tell(ResultArrived{lease.worker, lease.lease, lease.job, lease.units.at(unit), digest(bits),
                       milliseconds(10)});
  }
  void deliver_durably(const Lease& lease, size_t unit = 0) {
    deliver(lease, unit);
    tell(Persisted{only<Persist>().id});
  }

  Scheduler scheduler;
  TimePoint now{};
  std::vector<Action> said;
};

JobPlan small_plan(std::vector<int32_t> frames = {1}, uint32_t batches = 2) {
  JobPlan plan;
  plan.frames = std::move(frames);
  plan.region = {0, 0, 64, 32};
  plan.tile_size = 32;
  plan.batches = batches;
  return plan;
}

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

TEST(Scheduler, AcknowledgesOnlyWhatIsDurable) {
  Bench b;
  b.join(kAnna);
  b.add(small_plan());
  b.tell(FrameOpened{kJob, 1});
  const Lease lease = b.ask(kAnna);
  b.deliver(lease);
  EXPECT_TRUE(b.all<Acknowledge>().empty());
  EXPECT_TRUE(b.all<Merge>().empty());
  const Persist persist = b.only<Persist>();
  b.deliver(lease);  // sent again before it is durable
  EXPECT_TRUE(b.all<Persist>().empty());
  EXPECT_TRUE(b.all<Acknowledge>().empty());
  b.tell(Persisted{persist.id});
  EXPECT_EQ(b.all<Merge>().size(), 1U);
  EXPECT_EQ(b.all<Acknowledge>().size(), 2U);
  b.deliver(lease);  // and once more after
  EXPECT_EQ(b.all<Acknowledge>().size(), 1U);
  EXPECT_TRUE(b.all<Merge>().empty());
}

TEST(Scheduler, AWaitingWorkerIsServedWhenWorkAppears) {
  Bench b;
  b.join(kAnna);
  b.tell(WorkRequested{kAnna, 2});
  EXPECT_TRUE(b.said.empty());
  b.add(small_plan());
  b.tell(FrameOpened{kJob, 1});
  EXPECT_EQ(b.only<Lease>().units.size(), 2U);
}

TEST(Scheduler, LostWorkersUnitsGoToOthers) {
  Bench b;
  b.join(kAnna);
  b.join(kBert);
  b.add(small_plan({1}, 1));
  b.tell(FrameOpened{kJob, 1});
  const Lease lost = b.ask(kAnna, 2);
  b.tell(WorkRequested{kBert, 2});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.tell(WorkerLost{kAnna});
  EXPECT_THAT(b.only<Lease>().units, testing::UnorderedElementsAreArray(lost.units));
}

TEST(Scheduler, ALeaseThatIsNotRenewedRunsOut) {
  SchedulerOptions options;
  options.lease_time = seconds(10);
  options.copy_after = Duration{0};
  Bench b(options);
  b.join(kAnna);
  b.join(kBert);
  b.add(small_plan({1}, 1));
  b.tell(FrameOpened{kJob, 1});
  const Lease kept = b.ask(kAnna);
  const Lease forgotten = b.ask(kAnna);
  b.tell(WorkRequested{kBert, 1});
  b.now += seconds(8);
  b.tell(WorkerAlive{kAnna, {kept.lease}});
  b.now += seconds(4);
  ASSERT_TRUE(b.scheduler.next_wake().has_value());
  EXPECT_LE(*b.scheduler.next_wake(), b.now);
  b.tell(Tick{});
  EXPECT_EQ(b.only<Revoke>().unit, forgotten.units[0]);
  EXPECT_EQ(b.only<Lease>().units[0], forgotten.units[0]);
}

TEST(Scheduler, ALateResultCountsOnceAndStopsItsSuccessor) {
  Bench b;
  b.join(kAnna);
  b.join(kBert);
  b.add(small_plan({1}, 1));
  b.tell(FrameOpened{kJob, 1});
  const Lease old = b.ask(kAnna);
  b.tell(WorkerLost{kAnna});
  b.join(kAnna);
  const Lease again = b.ask(kBert);
  ASSERT_EQ(again.units[0], old.units[0]);
  b.deliver(old);
  EXPECT_EQ(b.only<Revoke>().lease, again.lease);
  EXPECT_EQ(b.all<Persist>().size(), 1U);
  b.deliver(again);
  EXPECT_TRUE(b.all<Persist>().empty());
}

TEST(Scheduler, OverlappingExtentsAreDroppedAndTheRestIsLeasedAgain) {
  Bench b;
  b.join(kAnna);
  JobPlan plan = small_plan({1}, 4);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  const core::PixelRect tile{0, 0, 32, 32};
  const auto result = [&](core::BatchRange batches) {
    return ResultArrived{kAnna, {}, kJob, {1, tile, batches}, digest(1), Duration{0}};
  };
  b.tell(result({1, 2}));
  b.tell(Persisted{b.only<Persist>().id});
  b.tell(result({0, 2}));
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::overlap);
  b.tell(result({2, 2}));
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::overlap);
  std::set<uint32_t> leased;
  for (int i = 0; i < 2; ++i) {
    const Lease lease = b.ask(kAnna);
    EXPECT_EQ(lease.units[0].batches.count, 1U);
    leased.insert(lease.units[0].batches.first);
  }
  EXPECT_THAT(leased, testing::ElementsAre(0U, 3U));
}

TEST(Scheduler, TwoRenderingsThatDifferAreReported) {
  Bench b;
  b.join(kAnna);
  b.join(kBert);
  b.add(small_plan());
  b.tell(FrameOpened{kJob, 1});
  const Lease lease = b.ask(kAnna);
  b.deliver_durably(lease);
  Lease stranger = lease;
  stranger.worker = kBert;
  b.deliver(stranger, 0, 2);
  EXPECT_EQ(b.only<Conflict>().first, kAnna);
  EXPECT_EQ(b.only<Conflict>().second, kBert);
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::conflict);
}

TEST(Scheduler, MalformedUnitsAreRejected) {
  Bench b;
  b.join(kAnna);
  b.add(small_plan());
  b.tell(FrameOpened{kJob, 1});
  const core::PixelRect tile{0, 0, 32, 32};
  const std::vector<core::Unit> bad = {
      {1, {0, 0, 16, 32}, {0, 1}},
      {1, tile, {0, 3}},
      {1, tile, {2, 1}},
      {1, tile, {0, 0}},
      {1, {-32, 0, 0, 32}, {0, 1}},
      {1, tile, {0xFFFFFFFF, 2}},
      {1, {64, 0, 96, 32}, {0, 1}},
  };
  for (const core::Unit& unit : bad) {
    b.tell(ResultArrived{kAnna, {}, kJob, unit, digest(1), Duration{0}});
    EXPECT_EQ(b.only<Reject>().reason, RejectReason::malformed);
  }
  b.tell(ResultArrived{kAnna, {}, kJob, {2, tile, {0, 1}}, digest(1), Duration{0}});
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::unknown);
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

TEST(Scheduler, AFailedUnitGoesToSomebodyElseFirst) {
  Bench b;
  b.join(kAnna);
  b.join(kBert);
  JobPlan plan = small_plan({1}, 1);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  const Lease lease = b.ask(kAnna);
  b.tell(UnitFailed{kAnna, lease.lease, kJob, lease.units[0], "bad luck"});
  b.tell(WorkRequested{kAnna, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.tell(WorkerLost{kBert});
  EXPECT_EQ(b.only<Lease>().worker, kAnna) << "nobody else is left";
}

TEST(Scheduler, AFailureToPersistFreesTheBatchesAndHoldsWorkBack) {
  Bench b;
  b.join(kAnna);
  JobPlan plan = small_plan({1}, 1);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  const Lease lease = b.ask(kAnna);
  b.deliver(lease);
  b.tell(PersistFailed{b.only<Persist>().id, "disk full"});
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now);
  b.tell(WorkRequested{kAnna, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.now = *b.scheduler.next_wake();
  b.tell(Tick{});
  EXPECT_EQ(b.only<Lease>().units[0], lease.units[0]);
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

TEST(Scheduler, RestartContinuesWithWhatWasAccepted) {
  Bench b;
  RestoredJob restored;
  restored.finished = {1};
  restored.failed = {{2, "no"}};
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

TEST(Scheduler, AfterARestartUnitsInHandAreAdopted) {
  SchedulerOptions options;
  options.incarnation = 2;
  Bench b(options);
  b.add(small_plan({1}, 4));
  b.tell(FrameOpened{kJob, 1});
  const core::Unit unit{1, {0, 0, 32, 32}, {1, 2}};
  const LeaseId old{1, 99};
  b.join(kAnna, {{old, kJob, unit}});
  const Lease adopted = b.only<Lease>();
  EXPECT_TRUE(adopted.adopted);
  EXPECT_EQ(adopted.units[0], unit);
  EXPECT_EQ(adopted.lease.incarnation, 2U);
  b.join(kBert, {{old, kJob, unit}});
  EXPECT_EQ(b.only<Revoke>().worker, kBert) << "Anna has it";
  b.deliver_durably(adopted);
  EXPECT_EQ(b.only<Merge>().unit, unit);
  // What is left is leased without the adopted part.
  uint32_t batches = 0;
  for (const core::Unit& u : b.ask(kBert, 100).units) batches += u.batches.count;
  EXPECT_EQ(batches, 6U);
}

TEST(Scheduler, IdleWorkersGetOneCopyOfTheOldestUnits) {
  SchedulerOptions options;
  options.copy_after = seconds(5);
  Bench b(options);
  constexpr WorkerId kCarl{3};
  b.join(kAnna);
  b.join(kBert);
  b.join(kCarl);
  JobPlan plan = small_plan({1}, 1);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  const Lease slow = b.ask(kAnna);
  b.tell(WorkRequested{kAnna, 1});
  b.tell(WorkRequested{kBert, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.now += seconds(6);
  b.tell(Tick{});
  const Lease copy = b.only<Lease>();
  EXPECT_EQ(copy.worker, kBert);
  EXPECT_EQ(copy.units, slow.units);
  b.tell(WorkRequested{kCarl, 1});
  EXPECT_TRUE(b.all<Lease>().empty()) << "nothing is copied twice";
  b.deliver(copy);
  EXPECT_EQ(b.only<Revoke>().lease, slow.lease);
}

TEST(Scheduler, APartOfAUnitEndsItsLeaseAndTheRestIsFree) {
  Bench b;
  b.join(kAnna);
  b.join(kBert);
  JobPlan plan = small_plan({1}, 4);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  b.join(kBert, {{{1, 50}, kJob, {1, plan.region, {0, 4}}}});
  const Lease whole = b.only<Lease>();
  b.tell(ResultArrived{kBert, whole.lease, kJob, {1, plan.region, {0, 3}}, digest(1), seconds(3)});
  EXPECT_EQ(b.all<Persist>().size(), 1U);
  EXPECT_EQ(b.ask(kAnna).units[0].batches, (core::BatchRange{3, 1}));
}

TEST(Scheduler, AReturnedUnitIsNobodysFault) {
  Bench b;
  b.join(kAnna);
  b.add(small_plan({1}, 1));
  b.tell(FrameOpened{kJob, 1});
  for (int i = 0; i < 5; ++i) {
    const Lease lease = b.ask(kAnna);
    b.tell(UnitReturned{kAnna, lease.lease, kJob, lease.units[0]});
    EXPECT_TRUE(b.said.empty());
  }
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

TEST(Scheduler, AFrameStaysWithTheClassItBeganWith) {
  Bench b;
  b.add(small_plan());
  b.tell(FrameOpened{kJob, 1});
  b.join(kAnna);
  b.tell(WorkerJoined{kBert, 1, "other class", {}});
  const Lease lease = b.ask(kAnna);
  b.tell(WorkRequested{kBert, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  Lease stranger = b.ask(kAnna);
  stranger.worker = kBert;
  b.deliver(stranger);
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::unknown);
  b.deliver(lease);
  EXPECT_EQ(std::get<UnitRecord>(b.only<Persist>().record).accepted.worker_class, "class");
}

TEST(Scheduler, PriorityGoesFirstThenTheOwnerWhoHasLess) {
  Bench b;
  b.join(kAnna);
  const auto add = [&](uint64_t id, int priority, const char* owner) {
    JobPlan plan = small_plan({1}, 4);
    plan.priority = priority;
    plan.owner = owner;
    b.add(plan, {}, JobId{id});
    b.tell(FrameOpened{JobId{id}, 1});
  };
  add(1, 0, "eve");
  add(2, 0, "eve");
  add(3, 0, "fay");
  add(4, 1, "gil");
  std::vector<uint64_t> order;
  for (int i = 0; i < 14; ++i) order.push_back(static_cast<uint64_t>(b.ask(kAnna).job));
  EXPECT_THAT(order, testing::ElementsAre(4, 4, 4, 4, 4, 4, 4, 4, 1, 3, 1, 3, 1, 3));
}

TEST(Scheduler, RunsGrowToTheTimeAUnitShallTake) {
  SchedulerOptions options;
  options.unit_time = milliseconds(500);
  Bench b(options);
  b.join(kAnna);
  JobPlan plan = small_plan({1}, 1000);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  const Lease first = b.ask(kAnna);
  EXPECT_EQ(first.units[0].batches.count, 1U) << "nothing is known yet";
  b.deliver_durably(first);  // 10 ms
  EXPECT_EQ(b.ask(kAnna).units[0].batches.count, 50U);
}

}  // namespace
}  // namespace hyades::coordinator
