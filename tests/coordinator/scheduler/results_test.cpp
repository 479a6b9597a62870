// Which results count, and when they are acknowledged.
#include <set>

#include "tests/coordinator/scheduler/scheduler_testing.h"

namespace hyades::coordinator {
namespace {

using Bench = SchedulerBench;
using std::chrono::seconds;

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

TEST(Scheduler, ALateResultCountsOnceAndStopsItsSuccessor) {
  Bench b;
  b.begin(small_plan({1}, 1));
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
  b.begin(small_plan());
  const Lease lease = b.ask(kAnna);
  b.deliver_durably(lease);
  Lease stranger = lease;
  stranger.worker = kBert;
  b.deliver(stranger, 0, 2);
  EXPECT_EQ(b.only<Conflict>().first, kAnna);
  EXPECT_EQ(b.only<Conflict>().second, kBert);
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now) << "the log does not know yet";
  b.tell(Persisted{b.only<Persist>().id});
  b.deliver(stranger, 0, 2);
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

}  // namespace
}  // namespace hyades::coordinator
