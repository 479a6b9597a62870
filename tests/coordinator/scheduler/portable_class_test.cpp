// Jobs of the portable class, which machines of different native classes render together.
#include <chrono>
#include <string>

#include "tests/coordinator/scheduler/scheduler_testing.h"

namespace hyades::coordinator {
namespace {

constexpr WorkerId kOld{9};

class PortableClass : public testing::Test {
 protected:
  PortableClass() : bench(options()) {}

  static SchedulerOptions options() {
    SchedulerOptions options;
    options.class_patience = std::chrono::minutes(5);
    options.lease_time = std::chrono::hours(100);  // they say that they are at work
    return options;
  }
  void join(WorkerId worker, const std::string& native, const std::string& portable) {
    WorkerJoined joined{worker, 1, native, {}};
    joined.credential = std::to_string(static_cast<uint64_t>(worker));
    joined.portable_class = portable;
    bench.tell(joined);
  }
  /// A job whose frame 1 is open.
  void add(core::RenderClass which, RestoredJob restored = {}) {
    JobPlan plan = small_plan({1}, 64);
    plan.needs.render_class = which;
    bench.add(std::move(plan), std::move(restored));
    bench.tell(FrameOpened{kJob, 1});
  }
  bool gets_a_unit(WorkerId worker) {
    bench.tell(WorkRequested{worker, 1});
    return !bench.all<Lease>().empty();
  }

  SchedulerBench bench;
};

TEST_F(PortableClass, JoinsMachinesOfAllMakers) {
  join(kAnna, "amd", "everywhere");
  join(kBert, "intel", "everywhere");
  add(core::RenderClass::portable);
  EXPECT_TRUE(gets_a_unit(kAnna));
  EXPECT_TRUE(gets_a_unit(kBert));
}

TEST_F(PortableClass, NativeJobsStayWithTheirMaker) {
  join(kAnna, "amd", "everywhere");
  join(kBert, "intel", "everywhere");
  add(core::RenderClass::native);
  EXPECT_TRUE(gets_a_unit(kAnna));
  EXPECT_FALSE(gets_a_unit(kBert));
}

TEST_F(PortableClass, OtherPortableClassesAreOthersToo) {
  join(kAnna, "amd", "of one release");
  join(kBert, "amd", "of another");
  add(core::RenderClass::portable);
  EXPECT_TRUE(gets_a_unit(kAnna));
  EXPECT_FALSE(gets_a_unit(kBert));
}

TEST_F(PortableClass, WhoKnowsNoneGetsNothingOfIt) {
  join(kOld, "amd", "");
  add(core::RenderClass::portable);
  EXPECT_FALSE(gets_a_unit(kOld));
  join(kAnna, "amd", "everywhere");
  EXPECT_TRUE(gets_a_unit(kAnna));
}

TEST_F(PortableClass, FilmsAreOfTheClassThatTheJobIsRenderedIn) {
  join(kAnna, "amd", "everywhere");
  add(core::RenderClass::portable);
  bench.deliver(bench.ask(kAnna));
  const auto record = std::get<UnitRecord>(bench.only<Persist>().record);
  EXPECT_EQ(record.accepted.worker_class, "everywhere");
}

TEST_F(PortableClass, ARestartedCoordinatorGoesOnWithIt) {
  join(kBert, "intel", "everywhere");
  RestoredJob restored;
  restored.accepted.push_back({core::Unit{1, {0, 0, 32, 32}, {0, 1}}, digest(1), "everywhere"});
  add(core::RenderClass::portable, std::move(restored));
  EXPECT_TRUE(gets_a_unit(kBert));
}

// A name of one kind says nothing of the other: whoever gives both the same name, or another's,
// gets in nobody's way.
TEST_F(PortableClass, NamesOfTheKindsAreApart) {
  join(kAnna, "amd", "everywhere");
  join(kOld, "odd", "amd");
  add(core::RenderClass::native);
  EXPECT_TRUE(gets_a_unit(kAnna));
  EXPECT_FALSE(gets_a_unit(kOld));
  bench.tell(WorkerLost{kOld});
  join(kOld, "amd", "amd");
  EXPECT_TRUE(gets_a_unit(kOld));
}

TEST_F(PortableClass, NamesThatLookLikeOnesOfTheOtherKindAreApart) {
  join(kAnna, "portable everywhere", "x");
  join(kBert, "native", "everywhere");
  join(kOld, "x", "native everywhere");
  for (const WorkerId worker : {kAnna, kBert, kOld}) bench.tell(WorkerLost{worker});
  join(kBert, "native", "everywhere");
  add(core::RenderClass::portable);
  bench.deliver(bench.ask(kBert));
  const auto record = std::get<UnitRecord>(bench.only<Persist>().record);
  EXPECT_EQ(record.accepted.worker_class, "everywhere");
}

// Who comes back under another program may know no portable class any more.
TEST_F(PortableClass, FilmsOfWhoHasNoneAreRefused) {
  join(kAnna, "amd", "everywhere");
  add(core::RenderClass::portable);
  const Lease lease = bench.ask(kAnna);
  bench.tell(WorkerLost{kAnna});
  WorkerJoined again{kAnna, 1, "amd", {{lease.lease, kJob, lease.units[0]}}};
  again.credential = "1";
  bench.tell(again);
  EXPECT_TRUE(bench.all<Lease>().empty()) << "it may keep a unit of a class that it has not";
  bench.deliver(lease);
  EXPECT_TRUE(bench.all<Persist>().empty());
  EXPECT_EQ(bench.only<Reject>().reason, RejectReason::unknown);
}

TEST_F(PortableClass, NorDoesAFrameThatNobodyHasBegunTakeThem) {
  join(kAnna, "amd", "everywhere");
  add(core::RenderClass::portable);
  const Lease lease = bench.ask(kAnna);
  SchedulerBench restarted(options());
  JobPlan plan = small_plan({1}, 64);
  plan.needs.render_class = core::RenderClass::portable;
  restarted.tell(WorkerJoined{kAnna, 1, "amd", {}});
  restarted.add(plan);
  restarted.tell(FrameOpened{kJob, 1});
  restarted.deliver(lease);
  EXPECT_TRUE(restarted.all<Persist>().empty());
}

// Two classes of one worker are no two classes at work.
TEST_F(PortableClass, WhoIsAloneIsWaitedForInBoth) {
  join(kAnna, "amd", "everywhere");
  add(core::RenderClass::portable);
  EXPECT_TRUE(gets_a_unit(kAnna));
  for (int i = 0; i < 100; ++i) {
    bench.now += std::chrono::seconds(15);
    bench.tell(Tick{});
    for (const Persist& persist : bench.all<Persist>()) {
      EXPECT_FALSE(std::holds_alternative<FrameRestartedRecord>(persist.record));
    }
  }
}

}  // namespace
}  // namespace hyades::coordinator
