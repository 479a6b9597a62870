// What a few can do to all others by having much of something.
#include <algorithm>
#include <ctime>

#include "coordinator/scheduler/frame_ledger.h"
#include "tests/coordinator/scheduler/conflicts_testing.h"

namespace hyades::coordinator {
namespace {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A frame of so many units, all of which have failed with the worker.
FrameLedger failed_with(WorkerId worker, uint32_t units) {
  std::vector<uint32_t> order(units);
  for (uint32_t tile = 0; tile < units; ++tile) order[tile] = tile;
  FrameLedger ledger(order, 1);
  const LeaseId lease{1, 1};
  for (uint32_t tile = 0; tile < units; ++tile) {
    const Extent e{tile, {0, 1}};
    ledger.assign(e, {worker, lease}, tile + 1);
    ledger.blame(e, worker, Witness{1});
    ledger.release(e, lease);
  }
  return ledger;
}

// It took seconds for each decision, of whatever worker.
TEST(Attacks, UnitsThatHaveFailedWithOneWorkerAreLookedAtOnce) {
  constexpr uint32_t kUnits = 100'000;
  const double begin = cpu_seconds();
  FrameLedger ledger = failed_with(kAnna, kUnits);
  size_t asked = 0;
  const auto judge_of = [&](WorkerId worker) {
    return [&asked, worker](const std::vector<WorkerId>& blamed, const std::vector<Witness>&) {
      ++asked;
      return !std::binary_search(blamed.begin(), blamed.end(), worker);
    };
  };
  EXPECT_FALSE(ledger.has_work(judge_of(kAnna)));
  EXPECT_EQ(asked, 1U);
  for (uint32_t i = 0; i < kUnits; ++i) {
    ASSERT_TRUE(ledger.has_work(judge_of(kBert)));
    const auto unit = ledger.next(judge_of(kBert), [](uint32_t) { return 1U; });
    ASSERT_TRUE(unit);
    ASSERT_EQ(unit->tile, i) << "whose turn it is first";
    ledger.assign(*unit, {kBert, {1, 2}}, kUnits + i);
    ledger.hold(*unit, {unit->batches, digest(1), kBert, {}});
    (void)ledger.end_assignment(*unit);
    ASSERT_EQ(ledger.take_blame(*unit), std::vector<WorkerId>{kAnna});
  }
  EXPECT_EQ(asked, 1 + 2 * size_t{kUnits});
  EXPECT_FALSE(ledger.any_retry());
  EXPECT_EQ(ledger.audit(), "");
  EXPECT_LT(cpu_seconds() - begin, 60.0) << "some tenths of a second; it would take minutes";
}

// Work that nobody has tried yet is there: nobody looks at what has failed.
TEST(Attacks, WhereOtherWorkIsLeftFailedUnitsAreNotLookedAt) {
  FrameLedger ledger({0, 1, 2}, 1);
  const Extent e{0, {0, 1}};
  ledger.assign(e, {kAnna, {1, 1}}, 1);
  ledger.blame(e, kAnna, Witness{1});
  ledger.release(e, {1, 1});
  size_t asked = 0;
  EXPECT_TRUE(ledger.has_work([&](const auto&, const auto&) { return ++asked == 0; }));
  EXPECT_EQ(asked, 0U);
}

TEST(Attacks, NobodyHasMoreUnitsToComeThanHeNeeds) {
  SchedulerBench b;
  b.tell(WorkerJoined{kAnna, 1, "class", {}});
  b.tell(WorkerJoined{kBert, 32, "class", {}});
  b.add(small_plan({1}, 1000));
  b.tell(FrameOpened{kJob, 1});
  for (const auto& [worker, most] : {std::pair(kAnna, 64U), std::pair(kBert, 128U)}) {
    b.tell(WorkRequested{worker, 100'000});
    EXPECT_EQ(b.scheduler.leased_units(worker), most);
    for (const Lease& lease : b.all<Lease>()) EXPECT_LE(lease.units.size(), 64U);
  }
}

TEST(Attacks, NobodyHasMoreUnitsThanHeMayBringAlong) {
  SchedulerBench b;
  b.join(kAnna);
  JobPlan plan = small_plan({1}, 25'000);
  plan.region = {0, 0, 32, 32};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  for (int i = 0; i < 400; ++i) {
    b.scheduler.handle(WorkRequested{kAnna, 64}, b.now);
  }
  EXPECT_EQ(b.scheduler.leased_units(kAnna), 20'000U);
  b.tell(WorkerLost{kAnna});
  EXPECT_EQ(b.scheduler.leased_units(kJob), 0U);
}

/// So many jobs, each with a late unit, of a worker that has a tag that others have not; and so
/// many workers that wait.
void begin_late_units(SchedulerBench& b, uint64_t jobs, uint64_t workers) {
  const WorkerId hoarder{100'000};
  b.scheduler.handle(WorkerJoined{hoarder, 4096, "class", {}, {"x"}}, b.now);
  for (uint64_t job = 1; job <= jobs; ++job) {
    JobPlan plan = small_plan({1}, 1);
    plan.region = {0, 0, 32, 32};
    plan.needs.tags = {"x"};
    b.scheduler.handle(JobAdded{JobId{job}, plan, {}}, b.now);
    b.scheduler.handle(FrameOpened{JobId{job}, 1}, b.now);
    b.scheduler.handle(WorkRequested{hoarder, 1}, b.now);
  }
  ASSERT_EQ(b.scheduler.leased_units(hoarder), jobs);
  for (uint64_t i = 1; i <= workers; ++i) {
    b.scheduler.handle(WorkerJoined{WorkerId{i}, 1, "class", {}}, b.now);
    b.scheduler.handle(WorkRequested{WorkerId{i}, 1}, b.now);
  }
}

// Each of the workers that wait looked at each of the jobs, four times a second.
TEST(Attacks, LateUnitsOfManyJobsCostNoMoreForManyWhoWait) {
  SchedulerBench b;
  begin_late_units(b, 2000, 3000);
  b.now += std::chrono::seconds(10);
  const double begin = cpu_seconds();
  for (int round = 0; round < 80; ++round) {
    b.now += std::chrono::milliseconds(250);
    b.scheduler.handle(Tick{}, b.now);
  }
  EXPECT_LT(cpu_seconds() - begin, 2.0) << "some tenths of a second; it would take many";
}

TEST(Attacks, WhoMayCopyIsAskedThoughManyWaitBeforeHimWhoMayNot) {
  SchedulerBench b;
  begin_late_units(b, 1000, 500);
  const WorkerId carl{200'000};
  b.scheduler.handle(WorkerJoined{carl, 1, "class", {}, {"x"}}, b.now);
  b.scheduler.handle(WorkRequested{carl, 1}, b.now);
  b.now += std::chrono::seconds(10);
  int rounds = 0;
  while (b.scheduler.leased_units(carl) == 0 && ++rounds < 100) {
    b.now += std::chrono::milliseconds(250);
    b.scheduler.handle(Tick{}, b.now);
  }
  EXPECT_EQ(b.scheduler.leased_units(carl), 1U);
}

/// What 20,000 requests take while so many jobs of a higher priority, or of as many different ones,
/// want a tag, and one job wants none; with every request a unit is leased.
double seconds_of_requests_beside(SchedulerBench& b, uint64_t jobs, const std::string& tag,
                                  bool priorities) {
  for (uint64_t job = 2; job <= jobs; ++job) {
    JobPlan plan = small_plan();
    plan.priority = priorities ? static_cast<int>(jobs - job + 1) : 5;
    plan.needs.tags = {tag};
    b.scheduler.handle(JobAdded{JobId{job}, plan, {}}, b.now);
    b.scheduler.handle(FrameOpened{JobId{job}, 1}, b.now);
  }
  constexpr uint32_t kRequests = 20'000;
  JobPlan plan = small_plan({1}, kRequests);
  plan.region = {0, 0, 32, 32};
  b.scheduler.handle(JobAdded{kJob, plan, {}}, b.now);
  b.scheduler.handle(FrameOpened{kJob, 1}, b.now);
  const double begin = cpu_seconds();
  for (uint32_t i = 0; i < kRequests; ++i) b.scheduler.handle(WorkRequested{kAnna, 1}, b.now);
  EXPECT_EQ(b.scheduler.leased_units(kJob), kRequests);
  return cpu_seconds() - begin;
}

TEST(Attacks, JobsThatNobodyMayRenderStandInNobodysWay) {
  SchedulerBench b;
  b.join(kAnna);
  EXPECT_LT(seconds_of_requests_beside(b, 10'000, "none has it", true), 1.0)
      << "some hundredths of a second; it would take many";
  // Once somebody comes who may, they are what is next.
  b.tell(WorkerJoined{kBert, 1, "class", {}, {"none has it"}});
  EXPECT_EQ(b.ask(kBert).job, JobId{2});
  b.tell(WorkerLost{kBert});
  EXPECT_EQ(b.scheduler.leased_units(JobId{2}), 0U);
}

TEST(Attacks, JobsThatOthersMayRenderStandInNobodysWay) {
  SchedulerBench b;
  b.join(kAnna);
  b.tell(WorkerJoined{kBert, 1, "class", {}, {"gpu"}});
  EXPECT_LT(seconds_of_requests_beside(b, 10'000, "gpu", false), 1.0)
      << "some hundredths of a second; it would take many";
}

// Who asks for nothing and who asks for something that is there stand in one line.
TEST(Attacks, JobsOfDifferentNeedsComeInTheirOrder) {
  SchedulerBench b;
  b.tell(WorkerJoined{kAnna, 1, "class", {}, {"a", "b"}, 64});
  const std::vector<std::vector<std::string>> needs{{"b"}, {}, {"a"}, {"c"}, {"a", "b"}, {}};
  for (uint64_t i = 0; i < needs.size(); ++i) {
    JobPlan plan = small_plan({1}, 1);
    plan.region = {0, 0, 32, 32};
    plan.needs.tags = needs[i];
    plan.needs.memory = i;
    b.add(plan, {}, JobId{i + 1});
    b.tell(FrameOpened{JobId{i + 1}, 1});
  }
  std::vector<JobId> order;
  for (int i = 0; i < 5; ++i) order.push_back(b.ask(kAnna).job);
  EXPECT_THAT(order, testing::ElementsAre(JobId{1}, JobId{2}, JobId{3}, JobId{5}, JobId{6}));
}

// Those who wait look at what there is as time goes by: not with each tick.
TEST(Attacks, WhoWaitsLooksAgainOnceASecond) {
  SchedulerBench b;
  for (uint64_t i = 1; i <= 1000; ++i) {
    b.scheduler.handle(WorkerJoined{WorkerId{i}, 1, "class", {}}, b.now);
    b.scheduler.handle(WorkRequested{WorkerId{i}, 1}, b.now);
  }
  const WorkerId choosy{5000};
  b.scheduler.handle(WorkerJoined{choosy, 1, "class", {}, {"gpu"}}, b.now);
  for (uint64_t job = 1; job <= 500; ++job) {
    JobPlan plan = small_plan();
    plan.priority = static_cast<int>(job);  // a share of its own
    plan.needs.tags = {"gpu"};
    b.scheduler.handle(JobAdded{JobId{job}, plan, {}}, b.now);
  }
  for (uint64_t job = 1; job <= 500; ++job) {
    b.scheduler.handle(LeasingHeld{true}, b.now);
    b.scheduler.handle(FrameOpened{JobId{job}, 1}, b.now);
  }
  b.scheduler.handle(LeasingHeld{false}, b.now);
  const double begin = cpu_seconds();
  for (int i = 0; i < 500; ++i) {
    b.now += std::chrono::milliseconds(1);
    b.scheduler.handle(Tick{}, b.now);
  }
  EXPECT_LT(cpu_seconds() - begin, 1.0) << "some hundredths of a second; it would take many";
}

// While a dispute was open all frames of all jobs were looked at with each event.
TEST_F(Conflicts, ThatAreOpenCostNoMoreForManyJobs) {
  deliver_durably(b.ask(kAnna), 1);
  for (uint64_t job = 2; job <= 5000; ++job) {
    b.scheduler.handle(JobAdded{JobId{job}, small_plan(), {}}, b.now);
    b.scheduler.handle(FrameOpened{JobId{job}, 1}, b.now);
  }
  const double begin = cpu_seconds();
  for (int i = 0; i < 20'000; ++i) b.scheduler.handle(WorkerAlive{kAnna, {}}, b.now);
  EXPECT_LT(cpu_seconds() - begin, 1.0) << "some hundredths of a second; it would take many";
  // It ends all the same.
  b.join(kCora);
  b.deliver(b.ask(kCora), 0, 1);
  EXPECT_EQ(b.only<Quarantine>().worker, kBert);
  b.scheduler.handle(Persisted{b.only<Persist>().id}, b.now);
  ASSERT_TRUE(b.scheduler.next_wake());
  b.now += std::chrono::milliseconds(100);
  b.tell(Tick{});
  EXPECT_FALSE(std::get<DisputeRecord>(b.only<Persist>().record).open);
}

}  // namespace
}  // namespace hyades::coordinator
