// Which work a worker prefers, may have, and does not get any more.
#include <map>

#include "tests/coordinator/scheduler/scheduler_testing.h"

namespace hyades::coordinator {
namespace {

using Bench = SchedulerBench;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;

constexpr WorkerId kCarl{3};

JobPlan plan_of(const char* owner, uint32_t batches = 100, int priority = 0) {
  JobPlan plan = small_plan({1}, batches);
  plan.owner = owner;
  plan.priority = priority;
  return plan;
}

void join_with(Bench& b, WorkerId worker, std::vector<std::string> tags, uint64_t memory) {
  b.tell(WorkerJoined{worker, 1, "class", {}, std::move(tags), memory});
}

TEST(Preference, UnitsGoOnlyToWorkersWithAllTagsAndTheMemory) {
  Bench b;
  join_with(b, kAnna, {"gpu"}, 100);
  join_with(b, kBert, {"quiet", "gpu", "other"}, 50);
  join_with(b, kCarl, {"gpu", "quiet"}, 100);
  JobPlan plan = plan_of("eve", 1);
  plan.needs = {{"quiet", "gpu"}, 80};
  for (const WorkerId w : {kAnna, kBert, kCarl}) b.tell(WorkRequested{w, 1});
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  EXPECT_EQ(b.only<Lease>().worker, kCarl);
  b.tell(WorkerLost{kCarl});
  EXPECT_TRUE(b.all<Lease>().empty());
  join_with(b, WorkerId{4}, {"gpu", "quiet"}, 0);
  b.tell(WorkRequested{WorkerId{4}, 1});
  EXPECT_EQ(b.all<Lease>().size(), 1U) << "it knows no limit of its memory";
}

TEST(Preference, NobodyCopiesUnitsThatAreNotForThem) {
  Bench b;
  join_with(b, kAnna, {"gpu"}, 0);
  join_with(b, kBert, {}, 0);
  JobPlan plan = plan_of("eve", 1);
  plan.region = {0, 0, 32, 32};
  plan.needs.tags = {"gpu"};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  b.ask(kAnna);
  b.tell(WorkRequested{kBert, 1});
  b.now += seconds(30);
  b.tell(Tick{});
  EXPECT_TRUE(b.all<Lease>().empty());
}

TEST(Preference, AFailedUnitDoesNotWaitForWorkersThatItIsNotFor) {
  Bench b;
  join_with(b, kAnna, {"gpu"}, 0);
  join_with(b, kBert, {}, 0);
  JobPlan plan = plan_of("eve", 1);
  plan.region = {0, 0, 32, 32};
  plan.needs.tags = {"gpu"};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  const Lease lease = b.ask(kAnna);
  b.tell(UnitFailed{kAnna, lease.lease, kJob, lease.units[0], "bad luck"});
  EXPECT_EQ(b.ask(kAnna).units, lease.units) << "Bert may not try";
}

TEST(Preference, AFrameWhoseClassHasNobodyWithTheTagsBeginsAgain) {
  SchedulerOptions options;
  options.class_patience = seconds(60);
  Bench b(options);
  b.tell(WorkerJoined{kAnna, 1, "old", {}, {"gpu"}});
  b.tell(WorkerJoined{kBert, 1, "old", {}});
  b.tell(WorkerJoined{kCarl, 1, "new", {}, {"gpu"}});
  JobPlan plan = plan_of("eve", 1);
  plan.needs.tags = {"gpu"};
  b.add(plan);
  b.tell(FrameOpened{kJob, 1});
  b.ask(kAnna);
  b.tell(WorkerLost{kAnna});
  bool again = false;
  for (int i = 0; i < 10 && !again; ++i) {
    b.now += seconds(10);
    b.tell(Tick{});
    again = !b.all<Persist>().empty();
  }
  EXPECT_TRUE(again) << "Bert is of the class, but has no such tag";
}

TEST(Preference, ProgressiveJobsSeeEveryFrameEarly) {
  Bench b;
  b.join(kAnna);
  JobPlan plan = small_plan({1, 2, 3}, 4);  // of 2 tiles
  plan.frames_in_flight = 3;
  plan.order = FrameOrder::progressive;
  b.add(plan);
  EXPECT_EQ(b.all<OpenFrame>().size(), 3U);
  for (const int32_t f : {1, 2, 3}) b.tell(FrameOpened{kJob, f});
  std::vector<int32_t> order;
  std::map<int32_t, uint32_t> started;
  uint32_t longest = 0;
  while (started[1] + started[2] + started[3] < 24) {
    const Lease lease = b.ask(kAnna);
    order.push_back(lease.units[0].frame);
    started[order.back()] += lease.units[0].batches.count;
    longest = std::max(longest, lease.units[0].batches.count);
    b.deliver_durably(lease);
    for (const auto& [f, n] : started) {
      EXPECT_LE(n, 2 * std::max(started[3], 2U)) << "no frame gets more than a doubling ahead";
    }
  }
  EXPECT_THAT(std::vector(order.begin(), order.begin() + 6), ElementsAre(1, 1, 2, 2, 3, 3));
  EXPECT_EQ(longest, 2U) << "the last pass doubles";
}

TEST(Preference, AFrameThatSomebodyLooksAtIsRefinedAsAWhole) {
  for (const bool watched : {false, true}) {
    Bench b;
    b.join(kAnna);
    b.add(small_plan({1}, 64));  // of 2 tiles
    b.tell(FrameOpened{kJob, 1});
    if (watched) b.tell(FrameWatched{kJob, 1});
    const auto next_run = [&] {
      const Lease lease = b.ask(kAnna);
      b.deliver_durably(lease);
      return lease.units[0].batches.count;
    };
    EXPECT_EQ(next_run(), 1U) << "what a batch costs is not known yet";
    if (watched) {
      for (int i = 0; i < 5; ++i) EXPECT_LE(next_run(), 2U) << "no tile gets far ahead";
      b.now += seconds(11);
    }
    EXPECT_GT(next_run(), 8U) << "nobody looks, and long units cost less";
    b.tell(FrameWatched{JobId{77}, 1});  // of a job that is over
  }
}

TEST(Preference, AWorkerStaysWithTheSceneThatItHas) {
  SchedulerOptions options;
  options.unit_time = milliseconds(1);  // a batch
  Bench b(options);
  for (const WorkerId w : {kAnna, kBert}) b.join(w);
  b.add(plan_of("eve"), {}, JobId{1});
  b.add(plan_of("fay"), {}, JobId{2});
  for (const uint64_t j : {1, 2}) b.tell(FrameOpened{JobId{j}, 1});
  for (int round = 0; round < 10; ++round) {
    // In the first round each owner gets one; later Eve, who has nothing then, is next in line.
    const Lease first = b.ask(round == 0 ? kAnna : kBert);
    const Lease second = b.ask(round == 0 ? kBert : kAnna);
    EXPECT_EQ((first.worker == kAnna ? first : second).job, JobId{1});
    EXPECT_EQ((first.worker == kBert ? first : second).job, JobId{2});
    b.now += seconds(1);
    b.deliver_durably(first);
    b.deliver_durably(second);
  }
}

TEST(Preference, AfterItsTimeAWorkerTakesWhatIsNextInLine) {
  SchedulerOptions options;
  options.affinity_time = seconds(20);
  options.unit_time = milliseconds(1);  // a batch
  Bench b(options);
  b.join(kAnna);
  b.add(plan_of("eve"), {}, JobId{1});
  b.add(plan_of("eve"), {}, JobId{2});
  for (const uint64_t j : {1, 2}) b.tell(FrameOpened{JobId{j}, 1});
  b.tell(JobPaused{JobId{1}});
  b.deliver_durably(b.ask(kAnna));
  b.tell(JobResumed{JobId{1}});
  for (int second = 1; second <= 40; ++second) {
    b.now += seconds(1);
    const Lease lease = b.ask(kAnna);
    EXPECT_EQ(lease.job, second < 20 ? JobId{2} : JobId{1}) << "after " << second << " s";
    b.deliver_durably(lease);
  }
  b.join(kBert);
  EXPECT_EQ(b.ask(kBert).job, JobId{1}) << "who has no scene takes the older job";
}

TEST(Preference, AffinityLeavesOwnersTheirShares) {
  SchedulerOptions options;
  options.affinity_time = seconds(1'000'000);
  options.unit_time = milliseconds(1);  // a batch
  Bench b(options);
  b.join(kAnna);
  b.add(plan_of("eve", 400), {}, JobId{1});
  b.tell(FrameOpened{JobId{1}, 1});
  b.deliver_durably(b.ask(kAnna));
  b.add(plan_of("fay", 400), {}, JobId{2});
  b.tell(FrameOpened{JobId{2}, 1});
  std::map<JobId, int> got;
  for (int i = 0; i < 100; ++i) {
    ++got[b.ask(kAnna).job];
    EXPECT_LE(got[JobId{1}], got[JobId{2}] + got[JobId{2}] / 4 + 3) << "nothing is delivered";
  }
  EXPECT_EQ(got[JobId{1}], 50);
}

TEST(Preference, OwnersAreForgottenWithTheirLastJob) {
  Bench b;
  b.join(kAnna);
  for (uint64_t j = 1; j <= 3; ++j) {
    b.add(plan_of("eve"), {}, JobId{j});
    b.tell(FrameOpened{JobId{j}, 1});
  }
  b.ask(kAnna);
  // The audit after each step finds an owner without jobs.
  b.tell(JobReprioritised{JobId{1}, 5});
  EXPECT_EQ(b.ask(kAnna).job, JobId{1});
  b.tell(JobReprioritised{JobId{1}, 0});
  for (uint64_t j = 1; j <= 3; ++j) b.tell(JobCancelled{JobId{j}});
  b.add(plan_of("eve"), {}, JobId{4});
  b.tell(FrameOpened{JobId{4}, 1});
  EXPECT_EQ(b.ask(kAnna).job, JobId{4});
}

TEST(Preference, AffinityNeverOverridesPriority) {
  Bench b;
  b.join(kAnna);
  b.add(plan_of("eve"), {}, JobId{1});
  b.tell(FrameOpened{JobId{1}, 1});
  b.deliver_durably(b.ask(kAnna));
  b.add(plan_of("fay", 100, 1), {}, JobId{2});
  b.tell(FrameOpened{JobId{2}, 1});
  EXPECT_EQ(b.ask(kAnna).job, JobId{2});
}

TEST(Preference, AWorkerThatFailsWhatOthersCanRenderIsQuarantined) {
  SchedulerOptions options;
  options.max_failures = 3;
  Bench b(options);
  b.begin(plan_of("eve", 100));
  for (int i = 0; i < 3; ++i) {
    const Lease failed = b.ask(kAnna);
    b.tell(UnitFailed{kAnna, failed.lease, kJob, failed.units[0], "bad memory"});
    EXPECT_TRUE(b.all<Quarantine>().empty()) << "it may be the unit";
    const Lease good = b.ask(kBert);
    EXPECT_EQ(good.units, failed.units);
    b.deliver(good);
  }
  const auto out = b.only<Quarantine>();
  EXPECT_EQ(out.worker, kAnna);
  EXPECT_THAT(out.reason, testing::HasSubstr("bad memory"));
  b.tell(WorkRequested{kAnna, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.tell(WorkerBarred{kAnna, false});
  EXPECT_EQ(b.only<Lease>().worker, kAnna) << "released";
}

TEST(Preference, AReleasedWorkerThatIsToLeaveGetsUnitsOnlyWhenItComesAgain) {
  SchedulerOptions options;
  options.max_failures = 1;
  Bench b(options);
  b.begin(plan_of("eve", 100));
  const Lease failed = b.ask(kAnna);
  b.tell(UnitFailed{kAnna, failed.lease, kJob, failed.units[0], "bad memory"});
  b.deliver(b.ask(kBert));
  ASSERT_EQ(b.only<Quarantine>().worker, kAnna);
  b.tell(WorkerBarred{kAnna, true, true});
  b.tell(WorkRequested{kAnna, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.tell(WorkerLost{kAnna});
  b.join(kAnna);
  EXPECT_EQ(b.ask(kAnna).worker, kAnna) << "its quarantine is over";
}

TEST(Preference, AForgottenWorkerLeavesNothingBehind) {
  SchedulerOptions options;
  options.max_failures = 2;
  Bench b(options);
  b.begin(plan_of("eve", 100));
  const auto failure = [&] {
    const Lease failed = b.ask(kAnna);
    b.tell(UnitFailed{kAnna, failed.lease, kJob, failed.units[0], "bad memory"});
    b.deliver(b.ask(kBert));
  };
  failure();
  b.tell(WorkerForgotten{kAnna});
  b.join(kAnna);
  failure();
  EXPECT_TRUE(b.all<Quarantine>().empty()) << "a failure of another life";
  failure();
  EXPECT_EQ(b.only<Quarantine>().worker, kAnna);
  b.tell(WorkerForgotten{kAnna});
  b.join(kAnna);
  EXPECT_EQ(b.ask(kAnna).worker, kAnna);
}

TEST(Preference, AUnitOfItsOwnEndsAWorkersStrikes) {
  SchedulerOptions options;
  options.max_failures = 3;
  Bench b(options);
  b.begin(plan_of("eve", 100));
  for (int i = 0; i < 6; ++i) {
    const Lease failed = b.ask(kAnna);
    b.tell(UnitFailed{kAnna, failed.lease, kJob, failed.units[0], "now and then"});
    b.deliver(b.ask(kBert));
    EXPECT_TRUE(b.all<Quarantine>().empty());
    if (i % 2 == 1) b.deliver(b.ask(kAnna));
  }
}

TEST(Preference, ABrokenJobPutsNoWorkerIntoQuarantine) {
  Bench b;
  std::vector<int32_t> frames;
  for (int32_t f = 1; f <= 20; ++f) frames.push_back(f);
  JobPlan plan = small_plan(frames, 1);
  plan.frames_in_flight = 1;
  b.join(kAnna);
  b.join(kBert);
  b.add(plan);
  for (const int32_t f : frames) {
    b.tell(FrameOpened{kJob, f});
    for (int i = 0; i < 3; ++i) {
      const WorkerId worker = i % 2 == 0 ? kAnna : kBert;
      const Lease lease = b.ask(worker);
      b.tell(UnitFailed{worker, lease.lease, kJob, lease.units[0], "no such texture"});
      EXPECT_TRUE(b.all<Quarantine>().empty());
    }
    b.tell(Persisted{b.only<Persist>().id});
    b.only<FrameFailed>();
  }
}

}  // namespace
}  // namespace hyades::coordinator
