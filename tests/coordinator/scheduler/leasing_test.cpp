// Who gets which unit.
#include "tests/coordinator/scheduler/scheduler_testing.h"

namespace hyades::coordinator {
namespace {

using Bench = SchedulerBench;
using std::chrono::milliseconds;
using std::chrono::seconds;

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
  b.begin(small_plan({1}, 1));
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
  b.begin(small_plan({1}, 1));
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

/// A frame of one tile and two batches, of which Anna has rendered one and has the other.
Lease last_batch_out(Bench& b) {
  b.join(kAnna);
  JobPlan plan = small_plan({1}, 2);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  b.deliver_durably(b.ask(kAnna));  // 10 ms
  return b.ask(kAnna);
}

TEST(Copies, AUnitThatShouldTakeLittleIsCopiedSooner) {
  SchedulerOptions options;
  options.copy_after = seconds(10);
  Bench b(options);
  b.join(kBert);
  const Lease late = last_batch_out(b);
  b.tell(WorkRequested{kBert, 1});
  b.now += milliseconds(900);
  b.tell(Tick{});
  EXPECT_TRUE(b.all<Lease>().empty()) << "films travel too";
  b.now += milliseconds(300);
  ASSERT_TRUE(b.scheduler.next_wake());
  EXPECT_LE(*b.scheduler.next_wake(), b.now);
  b.tell(Tick{});
  EXPECT_EQ(b.only<Lease>().units, late.units);
}

/// A unit that two workers of one token have, one of them as a copy, and Bert has none of.
Lease held_by_two_of_one_token(Bench& b, bool bert = true) {
  constexpr WorkerId kCarl{3};
  const auto join = [&b](WorkerId worker, const std::string& machine, const std::string& token) {
    b.tell(WorkerJoined{worker, 1, "class", {}, {}, 0, machine, token});
  };
  join(kAnna, "machine 1", "token 1");
  join(kCarl, "machine 3", "token 1");
  JobPlan plan = small_plan({1}, 1);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  const Lease lease = b.ask(kAnna);
  b.tell(WorkRequested{kCarl, 1});
  if (bert) join(kBert, "machine 2", "token 2");
  b.now += seconds(6);
  b.tell(Tick{});
  EXPECT_EQ(b.only<Lease>().worker, kCarl);
  return lease;
}

TEST(Copies, WhatTwoOfOneTokenKeepIsCopiedForAnother) {
  Bench b;
  const Lease lease = held_by_two_of_one_token(b);
  b.tell(WorkRequested{kBert, 2});
  EXPECT_TRUE(b.all<Lease>().empty()) << "they have just begun";
  b.now += seconds(6);
  b.tell(Tick{});
  EXPECT_EQ(b.only<Lease>().worker, kBert);
  EXPECT_EQ(b.only<Lease>().units, lease.units);
  b.now += seconds(6);
  b.tell(Tick{});
  EXPECT_TRUE(b.all<Lease>().empty()) << "he has it";
}

TEST(Copies, WhoComesLaterByAnotherTokenHelpsToo) {
  Bench b;
  const Lease lease = held_by_two_of_one_token(b, false);
  b.now += seconds(60);
  b.tell(Tick{});
  b.tell(WorkerJoined{kBert, 1, "class", {}, {}, 0, "machine 2", "token 2"});
  EXPECT_EQ(b.ask(kBert).units, lease.units);
}

TEST(Copies, WhoComesAnewAgainAndAgainIsLateAllTheSame) {
  Bench b;
  b.begin(small_plan({1}, 1));
  Lease lease = b.ask(kAnna, 2);
  b.tell(WorkRequested{kBert, 1});
  bool copied = false;
  for (int i = 0; i < 6 && !copied; ++i) {
    std::vector<UnitInHand> all;
    for (const core::Unit& unit : lease.units) all.push_back({lease.lease, kJob, unit});
    b.now += seconds(2);
    b.tell(Tick{});
    for (const Lease& given : b.all<Lease>()) copied = copied || given.worker == kBert;
    b.join(kAnna, all);
    for (const Lease& given : b.all<Lease>()) copied = copied || given.worker == kBert;
    lease.units.clear();
    for (const Lease& given : b.all<Lease>()) {
      if (given.worker != kAnna) continue;
      lease.lease = given.lease;
      lease.units.push_back(given.units[0]);
      break;
    }
  }
  EXPECT_TRUE(copied);
}

TEST(Copies, WhatTwoKeepIsCopiedForNoneOfTheirOwn) {
  Bench b;
  held_by_two_of_one_token(b);
  b.tell(WorkerJoined{WorkerId{4}, 1, "class", {}, {}, 0, "machine 4", "token 1"});
  b.tell(WorkRequested{WorkerId{4}, 1});
  b.now += seconds(6);
  b.tell(Tick{});
  EXPECT_TRUE(b.all<Lease>().empty());
}

/// Anna has one unit that is late, after hundreds of `other`, of a job that needs `tags`.
void expect_bert_helps_anna_beside(const WorkerJoined& other, std::vector<std::string> tags) {
  SchedulerOptions options;
  options.unit_time = milliseconds(1);  // one batch
  Bench b(options);
  b.tell(other);
  JobPlan many = small_plan({1}, 200);
  many.needs.tags = std::move(tags);
  b.add(many);
  b.tell(FrameOpened{kJob, 1});
  for (int lease = 0; lease < 8; ++lease) {
    ASSERT_EQ(b.ask(other.worker, 50).units.size(), 50U);
  }
  b.join(kAnna);
  b.join(kBert);
  const JobId job{2};
  JobPlan plan = small_plan({1}, 1);
  plan.region = {0, 0, 32, 32};
  b.add(plan, {}, job);
  b.tell(FrameOpened{job, 1});
  const Lease late = b.ask(kAnna);
  ASSERT_EQ(late.job, job);
  b.tell(WorkRequested{kBert, 1});
  b.now += seconds(6);
  b.tell(Tick{});
  EXPECT_EQ(b.only<Lease>().worker, kBert);
  EXPECT_EQ(b.only<Lease>().units, late.units);
}

TEST(Copies, UnitsOfAnotherClassStandInNobodysWay) {
  expect_bert_helps_anna_beside({WorkerId{7}, 1, "odd", {}}, {});
}

TEST(Copies, UnitsThatOneMayNotRenderStandInNobodysWay) {
  expect_bert_helps_anna_beside({WorkerId{3}, 1, "class", {}, {"large"}}, {"large"});
}

TEST(Copies, AUnitThatShouldTakeLongIsNotLateBeforeThat) {
  SchedulerOptions options;
  options.copy_after = seconds(10);
  options.unit_time = seconds(1);
  Bench b(options);
  b.begin(small_plan({1}, 1));
  const Lease first = b.ask(kAnna);
  const Lease second = b.ask(kAnna);
  b.tell(ResultArrived{kAnna, first.lease, kJob, first.units[0], digest(1), seconds(2)});
  b.tell(WorkRequested{kBert, 1});
  b.now += seconds(6);
  b.tell(Tick{});
  EXPECT_TRUE(b.all<Lease>().empty()) << "two seconds for it, and as much in the queue";
  b.now += seconds(2);
  b.tell(Tick{});
  EXPECT_EQ(b.only<Lease>().units, second.units);
}

TEST(Copies, WhoHasToLoadTheSceneWaitsLongerAndTakesOne) {
  SchedulerOptions options;
  options.copy_after = seconds(5);
  options.unit_time = seconds(2);
  Bench b(options, seconds(3));
  b.join(kAnna);
  b.add(small_plan({1}, 2));
  b.tell(FrameOpened{kJob, 1});
  const Lease first = b.ask(kAnna);
  b.now += seconds(6);
  b.tell(ResultArrived{kAnna, first.lease, kJob, first.units[0], digest(1), seconds(2)});
  ASSERT_EQ(b.ask(kAnna, 3).units.size(), 3U);
  b.join(kBert);
  b.tell(WorkRequested{kBert, 3});
  b.now += seconds(8);
  b.tell(Tick{});
  EXPECT_TRUE(b.all<Lease>().empty()) << "five seconds, and four to load";
  b.now += seconds(2);
  b.tell(Tick{});
  EXPECT_EQ(b.only<Lease>().units.size(), 1U);
  b.now += seconds(1);
  b.tell(Tick{});
  EXPECT_TRUE(b.all<Lease>().empty()) << "the scene may come too late for the rest";
}

TEST(Scheduler, NothingIsLeasedWhileLeasingIsHeld) {
  SchedulerOptions options;
  options.copy_after = seconds(5);
  Bench b(options);
  b.begin(small_plan({1}, 4));
  const Lease out = b.ask(kAnna);
  b.tell(LeasingHeld{true});
  b.tell(WorkRequested{kBert, 2});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.now += seconds(6);
  b.tell(Tick{});
  EXPECT_TRUE(b.all<Lease>().empty()) << "no copies either";
  b.deliver_durably(out);
  EXPECT_EQ(b.only<Merge>().unit, out.units[0]) << "what is out goes on";
  EXPECT_TRUE(b.all<Lease>().empty());
  b.tell(LeasingHeld{false});
  EXPECT_EQ(b.only<Lease>().worker, kBert) << "wishes stand";
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

TEST(Scheduler, WhoTakesUnitsAndGivesThemBackLeavesSomeToOthers) {
  Bench b;
  b.begin(small_plan({1}, 512));
  size_t taken = 0;
  for (; taken < 10'000; ++taken) {
    b.tell(WorkRequested{kAnna, 1});
    if (b.all<Lease>().empty()) break;
    const Lease lease = b.only<Lease>();
    b.tell(UnitReturned{kAnna, lease.lease, kJob, lease.units[0]});
  }
  EXPECT_LT(taken, 100U);
  EXPECT_GT(taken, 32U) << "a few have reasons";
  EXPECT_EQ(b.ask(kBert).worker, kBert);
  b.now += seconds(2);
  b.tell(Tick{});
  EXPECT_EQ(b.only<Lease>().worker, kAnna) << "later she may try again";
  b.deliver(b.only<Lease>());
  EXPECT_EQ(b.ask(kAnna).worker, kAnna);
}

TEST(Scheduler, KnowsWhatWhoHasUnderWhichLease) {
  Bench b;
  b.begin(small_plan({1}, 64));
  const Lease anna = b.ask(kAnna, 3);
  const Lease bert = b.ask(kBert);
  EXPECT_TRUE(b.scheduler.holds(kAnna, anna.lease, kJob, anna.units[2]));
  EXPECT_FALSE(b.scheduler.holds(kBert, anna.lease, kJob, anna.units[2]));
  EXPECT_FALSE(b.scheduler.holds(kAnna, bert.lease, kJob, anna.units[2]));
  EXPECT_FALSE(b.scheduler.holds(kAnna, anna.lease, JobId{2}, anna.units[2]));
  EXPECT_FALSE(b.scheduler.holds(kAnna, anna.lease, kJob, bert.units[0]));
  core::Unit other = anna.units[2];
  other.frame = 2;
  EXPECT_FALSE(b.scheduler.holds(kAnna, anna.lease, kJob, other));
  other = anna.units[2];
  other.batches.count += 50;
  EXPECT_FALSE(b.scheduler.holds(kAnna, anna.lease, kJob, other));
  EXPECT_TRUE(b.scheduler.has_lease(kAnna, anna.lease));
  EXPECT_FALSE(b.scheduler.has_lease(kBert, anna.lease));
}

TEST(Scheduler, PriorityGoesFirstThenTheOwnerWhoHasLess) {
  SchedulerOptions options;
  options.affinity_time = Duration{0};
  Bench b(options);
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

TEST(Leasing, WishesThatWereHeldAreServedAsSoonAsThereIsRoom) {
  SchedulerBench b;
  b.begin(small_plan());
  b.tell(LeasingHeld{true});
  b.tell(WorkRequested{kAnna, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.tell(LeasingHeld{false});
  EXPECT_EQ(b.only<Lease>().worker, kAnna) << "nothing else may happen for long";
}

}  // namespace
}  // namespace hyades::coordinator
