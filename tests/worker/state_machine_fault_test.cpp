#include "worker/state_machine.h"

#include <gtest/gtest.h>

#include "tests/worker/state_machine_testing.h"

namespace hyades::worker {
namespace {

using std::chrono::seconds;
using Message = v1::WorkerMessage;

TEST(StateMachine, TheUnitThatKillsItsProcessAloneHasFailed) {
  WorkerWorld world(3, 1);
  world.begin();
  for (const int x : {0, 8, 16, 24})
    world.lease(WorkerWorld::unit(x, static_cast<uint64_t>(x) + 1));
  world.machine->files_are_there(WorkerWorld::kJob);
  for (const int x : {0, 8}) world.started(world.token_of(x));
  world.take_sent();
  world.machine->renderer_died("crashed with signal 11");
  EXPECT_FALSE(first(world.take_sent(), &Message::has_failure).has_failure())
      << "nobody knows yet which of the two it was";
  world.ports.told.clear();
  world.renderer_up();
  EXPECT_NE(world.token_of(0), 0U);
  EXPECT_EQ(world.token_of(8), 0U) << "one suspect at a time";
  EXPECT_EQ(world.token_of(16), 0U) << "and nothing beside it";
  world.film(world.token_of(0));
  EXPECT_NE(world.token_of(8), 0U);
  EXPECT_EQ(world.token_of(16), 0U);
  world.started(world.token_of(8));
  world.machine->renderer_died("crashed with signal 11");
  const Message failure = first(world.take_sent(), &Message::has_failure);
  EXPECT_EQ(failure.failure().unit().unit().tile().x0(), 8);
  EXPECT_NE(failure.failure().reason().find("signal 11"), std::string::npos);
  world.renderer_up();
  EXPECT_NE(world.token_of(16), 0U);
  EXPECT_NE(world.token_of(24), 0U);
}

TEST(StateMachine, AFilmThatIsMoreThanItsUnitEndsTheChildAndBlamesWhatItHadBegun) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.started(world.token_of(0));
  world.take_sent();
  world.film(world.token_of(0), 5);
  ASSERT_EQ(world.ports.kills.size(), 1U);
  const auto sent = world.take_sent();
  EXPECT_FALSE(first(sent, &Message::has_result).has_result());
  EXPECT_NE(first(sent, &Message::has_failure).failure().reason().find("more batches"),
            std::string::npos);
  world.machine->renderer_died("sent a film of more batches");
  world.renderer_up();
  EXPECT_TRUE(world.machine->empty());
}

TEST(StateMachine, UnitsThatNobodyGaveTheChildTakeNoTime) {
  WorkerWorld world;
  world.begin(1000, 10'000'000);
  for (uint64_t token = 1000; token < 1100; ++token) world.started(token, true);
  for (int minute = 0; minute < 40; ++minute) {
    world.now += std::chrono::minutes(1);
    world.machine->tick(world.now, false);
  }
  EXPECT_TRUE(world.ports.kills.empty());
}

TEST(StateMachine, OneUnitInWorkNeedsNoSecondTrial) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.started(world.token_of(0));
  world.take_sent();
  world.machine->renderer_died("ran out of memory");
  EXPECT_TRUE(first(world.take_sent(), &Message::has_failure).has_failure());
  EXPECT_TRUE(world.machine->empty());
}

TEST(StateMachine, AHungUnitFailsAndThoseBesideItAreNotToBlame) {
  WorkerWorld world(3, 1);
  world.begin(1000, 1'000'000);
  for (const int x : {0, 8, 16}) world.lease(WorkerWorld::unit(x, static_cast<uint64_t>(x) + 1));
  world.machine->files_are_there(WorkerWorld::kJob);
  for (const int x : {0, 8}) world.started(world.token_of(x));
  world.take_sent();
  const auto pass = [&](int time) {  // seconds, in which unit 0 gets on and unit 8 does not
    for (int i = 0; i < time; ++i) {
      world.now += seconds(1);
      world.progress({{world.token_of(0), 16 * world.now.time_since_epoch().count()},
                      {world.token_of(8), 32}});
      world.machine->tick(world.now, false);
      world.echo(1);
    }
  };
  pass(60);
  EXPECT_TRUE(world.ports.kills.empty());
  pass(2);
  ASSERT_EQ(world.ports.kills.size(), 1U);
  EXPECT_EQ(world.ports.kills[0], "had no sample done in 60 s and was killed");
  const Message failure = first(world.take_sent(), &Message::has_failure);
  EXPECT_EQ(failure.failure().unit().unit().tile().x0(), 8);
  EXPECT_EQ(failure.failure().reason(),
            "the process that rendered it had no sample done in 60 s and was killed");
  world.machine->renderer_died("had no sample done in 60 s and was killed");  // it is really dead
  EXPECT_FALSE(first(world.take_sent(), &Message::has_failure).has_failure());
  world.ports.told.clear();
  world.renderer_up();
  EXPECT_NE(world.token_of(0), 0U);
  EXPECT_NE(world.token_of(16), 0U) << "nobody is a suspect: all are rendered beside each other";
}

TEST(StateMachine, AUnitThatHasHadItsTimeFailsAndTheOthersGoOn) {
  WorkerWorld world(2, 1);
  world.begin(1000, 10'000'000);
  for (const int x : {0, 8, 16}) world.lease(WorkerWorld::unit(x, static_cast<uint64_t>(x) + 1));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.started(world.token_of(0), true);  // the time for its scene counts
  const auto pass = [&](int time) {        // seconds, in which all that is in work gets on
    for (int i = 0; i < time; ++i) {
      world.now += seconds(1);
      const uint64_t samples = static_cast<uint64_t>(world.now.time_since_epoch().count());
      world.progress({{world.token_of(0), samples}, {world.token_of(8), samples}});
      world.machine->tick(world.now, false);
    }
  };
  pass(600);
  world.started(world.token_of(0));
  world.started(world.token_of(8));
  pass(1198);
  EXPECT_FALSE(world.stopped(world.token_of(0)));
  world.take_sent();
  pass(3);
  EXPECT_TRUE(world.stopped(world.token_of(0)));
  const Message failure = first(world.take_sent(), &Message::has_failure);
  EXPECT_EQ(failure.failure().unit().unit().tile().x0(), 0);
  EXPECT_EQ(failure.failure().reason(),
            "took longer than 30 min 00 s (--unit-time-limit of the worker)");
  world.returned(world.token_of(0));
  pass(500);
  EXPECT_FALSE(world.stopped(world.token_of(8))) << "each has its own time";
  EXPECT_TRUE(world.ports.kills.empty()) << "those beside it are not disturbed";
  EXPECT_EQ(world.machine->in_hand(), 2U);
}

TEST(StateMachine, AChildThatDoesNotStopAnOverdueUnitIsKilled) {
  WorkerWorld world(2, 1);
  world.begin(1000, 10'000'000);
  for (const int x : {0, 8}) world.lease(WorkerWorld::unit(x, static_cast<uint64_t>(x) + 1));
  world.machine->files_are_there(WorkerWorld::kJob);
  const auto pass = [&](int time) {
    for (int i = 0; i < time; ++i) {
      world.now += seconds(1);
      const uint64_t samples = static_cast<uint64_t>(world.now.time_since_epoch().count());
      world.progress({{world.token_of(0), samples}, {world.token_of(8), samples}});
      world.machine->tick(world.now, false);
    }
  };
  world.started(world.token_of(0));
  pass(1000);
  world.started(world.token_of(8));
  pass(809);
  EXPECT_TRUE(world.stopped(world.token_of(0)));
  EXPECT_TRUE(world.ports.kills.empty());
  world.take_sent();
  pass(3);
  ASSERT_EQ(world.ports.kills.size(), 1U);
  world.ports.told.clear();
  world.renderer_up();
  EXPECT_NE(world.token_of(8), 0U) << "rendered again, and nobody's fault";
  EXPECT_EQ(world.token_of(0), 0U);
  EXPECT_FALSE(first(world.take_sent(), &Message::has_failure).has_failure());
}

TEST(StateMachine, ASceneThatLoadsForLongerThanAUnitMayTakeEndsItsProcess) {
  WorkerWorld world(2, 1);
  world.begin(1000, 10'000'000);
  world.lease(WorkerWorld::unit(0, 1));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.started(world.token_of(0), true);
  world.take_sent();
  for (int i = 0; i < 1801 && world.ports.kills.empty(); ++i) {
    world.now += seconds(1);
    world.progress({});
    world.machine->tick(world.now, false);
  }
  ASSERT_EQ(world.ports.kills.size(), 1U);
  EXPECT_NE(world.ports.kills[0].find("--unit-time-limit"), std::string::npos);
  EXPECT_TRUE(first(world.take_sent(), &Message::has_failure).has_failure());
}

TEST(StateMachine, ASuspectThatWaitsIsNotBlamedForAHangOfAnother) {
  WorkerWorld world(3, 1);
  world.begin();
  for (const int x : {0, 8}) world.lease(WorkerWorld::unit(x, static_cast<uint64_t>(x) + 1));
  world.machine->files_are_there(WorkerWorld::kJob);
  for (const int x : {0, 8}) world.started(world.token_of(x));
  world.machine->renderer_died("crashed with signal 11");
  world.renderer_up();
  world.started(world.token_of(0));
  v1::CoordinatorMessage stop;
  *stop.mutable_stop()->mutable_unit() = WorkerWorld::unit(0);
  world.machine->coordinator_says(stop, world.now);  // and the child does not even stop
  world.take_sent();
  world.machine->renderer_died("crashed with signal 11");
  EXPECT_FALSE(first(world.take_sent(), &Message::has_failure).has_failure());
}

}  // namespace
}  // namespace hyades::worker
