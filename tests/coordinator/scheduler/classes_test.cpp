// Classes that may be one worker's invention.
#include <chrono>
#include <string>

#include "tests/coordinator/scheduler/scheduler_testing.h"

namespace hyades::coordinator {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr WorkerId kOdd{7};

/// Anna and Bert are of one class, and Odd is of another that nobody else has.
class Classes : public testing::Test {
 protected:
  Classes() : bench(options()) {}

  static SchedulerOptions options() {
    SchedulerOptions options;
    options.class_patience = minutes(5);
    options.copy_after = Duration{0};
    options.lease_time = hours(100);                   // it says that it is at work
    options.unit_time = std::chrono::milliseconds(1);  // one batch
    return options;
  }
  void join(WorkerId worker, const std::string& worker_class, const std::string& token = {}) {
    bench.tell(WorkerJoined{
        worker, 1, worker_class, {}, {}, 0, std::to_string(static_cast<uint64_t>(worker)), token});
  }
  /// The worker has all of another job, so that it is at work and asks for nothing.
  void keep_busy(WorkerId worker) {
    const JobId job{100 + static_cast<uint64_t>(worker)};
    bench.add(small_plan({1}, 1), {}, job);
    bench.tell(FrameOpened{job, 1});
    EXPECT_EQ(bench.ask(worker, 2).job, job);
  }
  /// Odd begins with frame 1 of the job, while the others do something else.
  Lease odd_begins(JobPlan plan) {
    join(kAnna, "class");
    join(kBert, "class");
    keep_busy(kBert);
    join(kOdd, "odd");
    bench.add(std::move(plan));
    bench.tell(FrameOpened{kJob, 1});
    return bench.ask(kOdd);
  }
  /// Whether frame 1 begins again within that time.
  bool begins_again(Duration time) {
    for (const TimePoint end = bench.now + time; bench.now < end;) {
      bench.now += seconds(15);
      bench.tell(Tick{});
      for (const Persist& persist : bench.all<Persist>()) {
        const auto* again = std::get_if<FrameRestartedRecord>(&persist.record);
        if (again == nullptr || again->job != kJob) continue;
        bench.tell(Persisted{persist.id});
        return true;
      }
    }
    return false;
  }
  /// Odd asks once more and delivers that.
  void odd_delivers() { bench.deliver_durably(bench.ask(kOdd)); }
  /// Anna is at work and Odd, who came by another token, has three tries at a unit of frame 1.
  Persist odd_fails() {
    join(kAnna, "class", "ours");
    keep_busy(kAnna);
    join(kOdd, "odd", "theirs");
    bench.add(small_plan({1}, 64));
    bench.tell(FrameOpened{kJob, 1});
    return fails_three_times(kOdd);
  }
  /// What is persisted of that, and then is durable.
  Persist fails_three_times(WorkerId worker) {
    for (int i = 0; i < 3; ++i) {
      const Lease lease = bench.ask(worker);
      bench.tell(UnitFailed{worker, lease.lease, kJob, lease.units[0], "no such file"});
    }
    Persist persist = bench.only<Persist>();
    bench.tell(Persisted{persist.id});
    return persist;
  }
  /// One that nobody has left.
  void another_job() {
    bench.add(small_plan({1}, 64), {}, JobId{2});
    bench.tell(FrameOpened{JobId{2}, 1});
  }
  bool gets_a_unit(WorkerId worker) {
    bench.tell(WorkRequested{worker, 1});
    for (const Lease& lease : bench.all<Lease>()) {
      if (lease.worker == worker) return true;
    }
    return false;
  }

  SchedulerBench bench;
};

TEST_F(Classes, NobodyWaitsForAFrameOfOneWorkersClass) {
  JobPlan plan = small_plan({1, 2}, 64);
  plan.frames_in_flight = 1;
  join(kAnna, "class");
  join(kOdd, "odd");
  bench.add(plan);
  bench.tell(FrameOpened{kJob, 1});
  const Lease odd = bench.ask(kOdd);
  ASSERT_EQ(odd.units[0].frame, 1);
  ASSERT_EQ(bench.only<OpenFrame>().frame, 2);
  bench.tell(FrameOpened{kJob, 2});
  EXPECT_EQ(bench.ask(kAnna).units[0].frame, 2);
}

TEST_F(Classes, AFrameThatStandsStillGoesToTheOthers) {
  odd_begins(small_plan({1}, 64));
  EXPECT_FALSE(gets_a_unit(kAnna));
  EXPECT_FALSE(begins_again(minutes(4)));
  EXPECT_TRUE(begins_again(minutes(3)));
  EXPECT_EQ(bench.only<OpenFrame>().frame, 1);
}

TEST_F(Classes, WhoLetsAFrameStandBeginsNoneWhileOthersMay) {
  odd_begins(small_plan({1}, 64));
  ASSERT_TRUE(begins_again(minutes(7)));
  bench.tell(FrameOpened{kJob, 1});
  EXPECT_FALSE(gets_a_unit(kOdd));
  // Whatever it calls its class, and as whom it comes.
  bench.tell(WorkerJoined{WorkerId{8}, 1, "odder", {}, {}, 0, "7"});
  EXPECT_FALSE(gets_a_unit(WorkerId{8}));
  EXPECT_TRUE(gets_a_unit(kAnna));
}

TEST_F(Classes, WhoIsLeftAloneBeginsAgain) {
  odd_begins(small_plan({1}, 64));
  ASSERT_TRUE(begins_again(minutes(7)));
  bench.tell(FrameOpened{kJob, 1});
  ASSERT_FALSE(gets_a_unit(kOdd));
  bench.tell(WorkerLost{kAnna});
  bench.tell(WorkerLost{kBert});
  EXPECT_EQ(bench.only<Lease>().worker, kOdd);
}

TEST_F(Classes, AnHourLaterItBeginsFramesAgain) {
  odd_begins(small_plan({1}, 64));
  ASSERT_TRUE(begins_again(minutes(7)));
  bench.tell(FrameOpened{kJob, 1});
  ASSERT_FALSE(gets_a_unit(kOdd));
  const TimePoint begun = bench.now;
  while (bench.all<Lease>().empty() && bench.now < begun + hours(2)) {
    bench.now += seconds(15);
    bench.tell(Tick{});
  }
  EXPECT_GE(bench.now - begun, minutes(59));
  EXPECT_LE(bench.now - begun, minutes(62));
}

TEST_F(Classes, AFrameThatGetsOnStays) {
  odd_begins(small_plan({1}, 2048));
  for (int i = 0; i < 30; ++i) {
    EXPECT_FALSE(begins_again(minutes(2))) << i;
    for (int unit = 0; unit < 10; ++unit) odd_delivers();
  }
}

TEST_F(Classes, AFrameThatWouldTakeMoreThanADayGoesToTheOthers) {
  odd_begins(small_plan({1}, 2048));  // of two tiles: 14.2 batches in five minutes
  bool again = false;
  for (int i = 0; i < 10 && !again; ++i) {
    odd_delivers();
    again = begins_again(minutes(2));
  }
  EXPECT_TRUE(again);
}

TEST_F(Classes, OfTwoTokensIsNoInvention) {
  odd_begins(small_plan({1}, 64));
  join(WorkerId{8}, "odd");
  EXPECT_FALSE(begins_again(hours(2)));
}

TEST_F(Classes, OneTokenMayBringManyToItsInvention) {
  join(kOdd, "odd", "theirs");
  join(WorkerId{8}, "odd", "theirs");
  bench.add(small_plan({1}, 64));
  bench.tell(FrameOpened{kJob, 1});
  bench.ask(kOdd);
  join(kAnna, "class", "ours");
  keep_busy(kAnna);
  ASSERT_TRUE(begins_again(minutes(7)));
  bench.tell(FrameOpened{kJob, 1});
  join(WorkerId{9}, "odder", "theirs");
  EXPECT_FALSE(gets_a_unit(WorkerId{9})) << "one more of the same";
  EXPECT_TRUE(gets_a_unit(kAnna));
}

TEST_F(Classes, WhoWasThereBeforeIsNotSlowForAnotherOfTheToken) {
  join(kOdd, "odd", "theirs");
  join(WorkerId{8}, "class", "theirs");
  bench.add(small_plan({1}, 64));
  bench.tell(FrameOpened{kJob, 1});
  bench.ask(kOdd);
  join(kAnna, "third", "ours");
  keep_busy(kAnna);
  ASSERT_TRUE(begins_again(minutes(7)));
  another_job();
  EXPECT_TRUE(gets_a_unit(WorkerId{8}));
}

TEST_F(Classes, WhoDeliversIsNotSlowForAnotherOfItsClass) {
  const WorkerId other{8};
  join(kOdd, "odd", "theirs");
  join(other, "odd", "theirs");
  bench.add(small_plan({1}, 2048));
  bench.tell(FrameOpened{kJob, 1});
  bench.ask(kOdd);
  join(kAnna, "class", "theirs");
  keep_busy(kAnna);
  ASSERT_FALSE(begins_again(minutes(2)));
  bench.deliver_durably(bench.ask(other));
  ASSERT_TRUE(begins_again(minutes(7))) << "a film in five minutes is not enough";
  another_job();
  EXPECT_FALSE(gets_a_unit(kOdd));
  EXPECT_TRUE(gets_a_unit(other));
}

TEST_F(Classes, WhoHoldsAUnitAllTheTimeIsSlowThoughItDeliversOthers) {
  odd_begins(small_plan({1}, 2048));
  ASSERT_FALSE(begins_again(minutes(2)));
  odd_delivers();
  ASSERT_TRUE(begins_again(minutes(7)));
  bench.tell(FrameOpened{kJob, 1});
  EXPECT_FALSE(gets_a_unit(kOdd));
}

TEST_F(Classes, AFrameThatFailsUnderAnInventionBeginsAgainWithOthers) {
  ASSERT_TRUE(std::holds_alternative<FrameRestartedRecord>(odd_fails().record));
  bench.tell(FrameOpened{kJob, 1});
  // Whatever it calls its class now, and as whom it comes.
  EXPECT_FALSE(gets_a_unit(kOdd));
  join(WorkerId{8}, "odder", "theirs");
  EXPECT_FALSE(gets_a_unit(WorkerId{8}));
  EXPECT_TRUE(gets_a_unit(kAnna));
}

TEST_F(Classes, AFrameThatFailsForAllOfThemFails) {
  EXPECT_FALSE(std::holds_alternative<FrameFailedRecord>(odd_fails().record));
  bench.tell(FrameOpened{kJob, 1});
  EXPECT_TRUE(std::holds_alternative<FrameFailedRecord>(fails_three_times(kAnna).record));
}

TEST_F(Classes, OneTokenHoldsAFrameOnceWhateverClassesItInvents) {
  for (uint64_t i = 0; i < 12; ++i) join(WorkerId{20 + i}, "c" + std::to_string(i), "theirs");
  bench.add(small_plan({1}, 64));
  bench.tell(FrameOpened{kJob, 1});
  for (uint64_t i = 0; i < 12; ++i) bench.tell(WorkRequested{WorkerId{20 + i}, 1000});
  join(kAnna, "class", "ours");
  bench.tell(WorkRequested{kAnna, 1});
  ASSERT_TRUE(begins_again(minutes(7)));
  bench.tell(FrameOpened{kJob, 1});
  EXPECT_EQ(bench.only<Lease>().worker, kAnna) << "the next of theirs would hold it again";
}

TEST_F(Classes, NobodyGivesWayToWhoWantsNothing) {
  join(kOdd, "odd");
  bench.add(small_plan({1}, 64));
  bench.tell(FrameOpened{kJob, 1});
  bench.ask(kOdd);
  join(kAnna, "class");
  EXPECT_FALSE(begins_again(hours(1)));
}

TEST_F(Classes, WhereAllCameByOneTokenTheMachineAloneIsSlow) {
  join(kOdd, "odd", "ours");
  bench.add(small_plan({1}, 64));
  bench.tell(FrameOpened{kJob, 1});
  bench.ask(kOdd);
  join(kAnna, "class", "ours");
  keep_busy(kAnna);
  ASSERT_TRUE(begins_again(minutes(7)));
  bench.tell(FrameOpened{kJob, 1});
  EXPECT_FALSE(gets_a_unit(kOdd));
  EXPECT_TRUE(gets_a_unit(kAnna));
}

TEST_F(Classes, WhereNobodyElseIsThereAFrameMayTakeItsTime) {
  odd_begins(small_plan({1}, 64));
  bench.tell(WorkerLost{kAnna});
  bench.tell(WorkerLost{kBert});
  EXPECT_FALSE(begins_again(hours(2)));
}

TEST_F(Classes, NobodyIsToBlameWhileNothingIsLeased) {
  odd_begins(small_plan({1}, 64));
  bench.tell(LeasingHeld{true});
  EXPECT_FALSE(begins_again(hours(2)));
}

TEST_F(Classes, WhoDoesSomethingElseIsNotToBlame) {
  const Lease lease = odd_begins(small_plan({1}, 64));
  bench.tell(UnitReturned{kOdd, lease.lease, kJob, lease.units[0]});
  ASSERT_TRUE(begins_again(minutes(7)));
  bench.tell(FrameOpened{kJob, 1});
  EXPECT_TRUE(gets_a_unit(kOdd));
}

}  // namespace
}  // namespace hyades::coordinator
