#include "worker/state_machine.h"

#include <gtest/gtest.h>

#include "tests/worker/state_machine_testing.h"

namespace hyades::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Message = v1::WorkerMessage;

TEST(StateMachine, SaysHelloWhenItsClassIsMeasured) {
  WorkerWorld world;
  world.machine->stream_opened(world.now);
  EXPECT_TRUE(world.take_sent().empty());
  world.renderer_up();
  const auto sent = world.take_sent();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].hello().worker_class(), "class");
  EXPECT_EQ(sent[0].hello().want(), 3U);
}

TEST(StateMachine, RendersWhenFilesAreThereAndKeepsTheFilmUntilItIsAcknowledged) {
  WorkerWorld world;
  world.begin();
  const auto unit = WorkerWorld::unit(0);
  world.lease(unit);
  EXPECT_EQ(world.ports.fetched, std::vector<uint64_t>{WorkerWorld::kJob});
  EXPECT_EQ(world.token_of(0), 0U);
  world.machine->files_are_there(WorkerWorld::kJob);
  ASSERT_NE(world.token_of(0), 0U);
  world.take_sent();
  world.film(world.token_of(0));
  const Message result = first(world.take_sent(), &Message::has_result);
  EXPECT_EQ(result.result().unit().batches(), 4U);
  EXPECT_EQ(result.result().want(), 1U) << "a result asks for the next unit";
  EXPECT_FALSE(world.machine->empty());
  EXPECT_EQ(world.ports.released, std::vector<uint64_t>{WorkerWorld::kJob});
  world.acknowledge(unit);
  EXPECT_TRUE(world.machine->empty());
}

TEST(StateMachine, HasNoMoreInWorkThanThreadsAndWhatWaits) {
  WorkerWorld world(2, 1);
  world.begin();
  EXPECT_EQ(first(world.take_sent(), &Message::has_hello).hello().want(), 3U);
  for (const int x : {0, 8, 16}) world.lease(WorkerWorld::unit(x, static_cast<uint64_t>(x) + 1));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.machine->tick(world.now, true);
  EXPECT_FALSE(first(world.take_sent(), &Message::has_request).has_request());
  world.film(world.token_of(8));
  EXPECT_EQ(first(world.take_sent(), &Message::has_result).result().want(), 1U);
}

TEST(StateMachine, AsksForNothingWhileTooManyFilmsWait) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.take_sent();
  world.film(world.token_of(0), 4, 2000);  // more than max_kept_bytes
  EXPECT_EQ(first(world.take_sent(), &Message::has_result).result().want(), 0U);
  world.acknowledge(WorkerWorld::unit(0));
  EXPECT_EQ(first(world.take_sent(), &Message::has_request).request().units(), 1U);
}

TEST(StateMachine, HeartbeatsTellOfTheCache) {
  WorkerWorld world;
  world.begin();
  world.take_sent();
  world.machine->cache_is({100, 1000, 7, 3});
  world.now += std::chrono::seconds(2);
  world.machine->tick(world.now, true);
  const v1::Heartbeat beat = first(world.take_sent(), &Message::has_heartbeat).heartbeat();
  EXPECT_EQ(beat.cache_bytes(), 100U);
  EXPECT_EQ(beat.cache_limit_bytes(), 1000U);
  EXPECT_EQ(beat.cache_hits(), 7U);
  EXPECT_EQ(beat.cache_misses(), 3U);
}

TEST(StateMachine, FilmsSurviveALostStreamAndAreSentAgain) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.lease(WorkerWorld::unit(8, 2));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.film(world.token_of(0));
  world.machine->stream_closed();
  world.take_sent();
  world.machine->stream_opened(world.now);
  const Message hello = first(world.take_sent(), &Message::has_hello);
  EXPECT_EQ(hello.hello().in_hand_size(), 2);
  EXPECT_EQ(hello.hello().want(), 2U);
  world.welcome();
  const Message again = first(world.take_sent(), &Message::has_result);
  ASSERT_TRUE(again.has_result());
  EXPECT_EQ(again.result().unit().tile().x0(), 0);
  world.lease(WorkerWorld::unit(8, 31), true);
  world.film(world.token_of(8));
  EXPECT_EQ(first(world.take_sent(), &Message::has_result).result().lease().number(), 31U)
      << "an adopted unit goes on under its new lease";
}

TEST(StateMachine, FilmsMadeWithoutAStreamAreSentLater) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.machine->stream_closed();
  world.take_sent();
  world.film(world.token_of(0));
  EXPECT_TRUE(world.take_sent().empty());
  world.machine->stream_opened(world.now);
  world.welcome();
  EXPECT_TRUE(first(world.take_sent(), &Message::has_result).has_result());
}

TEST(StateMachine, StopsItsUnitsByItselfWhenItsLeasesRanOut) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.lease(WorkerWorld::unit(8, 2));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.film(world.token_of(0));
  world.machine->stream_closed();
  world.now += seconds(9);
  world.machine->tick(world.now, true);
  EXPECT_FALSE(world.stopped(world.token_of(8)));
  world.now += seconds(2);
  world.machine->tick(world.now, true);
  EXPECT_TRUE(world.stopped(world.token_of(8)));
  EXPECT_EQ(world.machine->unacknowledged(), 1U) << "films are kept";
  world.take_sent();
  world.machine->stream_opened(world.now);
  EXPECT_EQ(first(world.take_sent(), &Message::has_hello).hello().in_hand_size(), 1);
}

TEST(StateMachine, ASleeperGivesUpItsUnitsBeforeItListensAgain) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.now += seconds(60);  // SIGSTOP, SIGCONT: the stream still looks alive
  world.lease(WorkerWorld::unit(8, 2));
  EXPECT_TRUE(world.stopped(world.token_of(0)));
  world.film(world.token_of(0));
  EXPECT_EQ(world.machine->unacknowledged(), 0U) << "a late film of a unit that was given up";
}

TEST(StateMachine, HeartbeatsNameEveryLeaseAndRenewThem) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.lease(WorkerWorld::unit(8, 2));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.film(world.token_of(0));
  world.take_sent();
  for (int i = 0; i < 30; ++i) {
    world.now += milliseconds(1000);
    world.machine->tick(world.now, true);
    const Message beat = first(world.take_sent(), &Message::has_heartbeat);
    EXPECT_EQ(beat.heartbeat().leases_size(), 2);
    world.echo(beat.heartbeat().number());
  }
  EXPECT_FALSE(world.stopped(world.token_of(8)));
  for (int i = 0; i < 12; ++i) {
    world.now += milliseconds(1000);
    world.machine->tick(world.now, false);  // nothing leaves this machine
  }
  EXPECT_TRUE(world.stopped(world.token_of(8)));
}

TEST(StateMachine, HeartbeatsThatNobodyAnswersRenewNothing) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  const auto beat = [&] {
    world.now += milliseconds(1000);
    world.machine->tick(world.now, true);
    return first(world.take_sent(), &Message::has_heartbeat).heartbeat().number();
  };
  const uint64_t answered_late = beat();
  for (int i = 0; i < 4; ++i) beat();
  world.echo(answered_late);
  world.echo(answered_late);
  world.echo(99);  // was never sent
  for (int i = 0; i < 6; ++i) beat();
  EXPECT_FALSE(world.stopped(world.token_of(0))) << "10 s after the answered one was sent";
  beat();
  EXPECT_TRUE(world.stopped(world.token_of(0))) << "the network is cut, and nothing says so";

  // It has healed: what comes now is held for a lease's time again.
  world.lease(WorkerWorld::unit(8, 2));
  world.machine->files_are_there(WorkerWorld::kJob);
  for (int i = 0; i < 10; ++i) beat();
  EXPECT_FALSE(world.stopped(world.token_of(8)));
  beat();
  EXPECT_TRUE(world.stopped(world.token_of(8)));
}

TEST(StateMachine, HeartbeatsTellHowFarALeaseIs) {
  WorkerWorld world(1, 4);
  world.begin();
  world.lease(WorkerWorld::unit(0, 1));
  world.lease(WorkerWorld::unit(8, 2));
  world.lease(WorkerWorld::unit(16, 3));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.job(8);
  world.lease(WorkerWorld::unit(24, 4, 8));  // its files are still being fetched
  world.film(world.token_of(0));
  world.started(world.token_of(8));
  world.started(world.token_of(16), true);
  world.progress({{world.token_of(8), 48}});
  world.take_sent();
  const auto stages = [&] {
    world.now += seconds(1);
    world.machine->tick(world.now, true);
    std::map<uint64_t, v1::LeaseProgress::Stage> all;
    const Message beat = first(world.take_sent(), &Message::has_heartbeat);
    for (const auto& lease : beat.heartbeat().leases()) all[lease.lease().number()] = lease.stage();
    return all;
  };
  auto all = stages();
  EXPECT_EQ(all[1], v1::LeaseProgress::STAGE_FILM);
  EXPECT_EQ(all[2], v1::LeaseProgress::STAGE_RENDERING);
  EXPECT_EQ(all[3], v1::LeaseProgress::STAGE_LOADING);
  EXPECT_EQ(all[4], v1::LeaseProgress::STAGE_FETCHING);
  world.machine->renderer_died("crashed with signal 11");
  all = stages();
  EXPECT_EQ(all[2], v1::LeaseProgress::STAGE_WAITING);
  EXPECT_EQ(all[3], v1::LeaseProgress::STAGE_WAITING);
}

TEST(StateMachine, LeavingHandsOverWholeBatchesAndGivesBackTheRest) {
  WorkerWorld world(1, 2);
  world.begin();
  for (const int x : {0, 8}) world.lease(WorkerWorld::unit(x, static_cast<uint64_t>(x) + 1));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.job(8);
  world.lease(WorkerWorld::unit(16, 17, 8));  // its files are still being fetched
  world.take_sent();
  world.machine->leave("SIGTERM", true);
  auto sent = world.take_sent();
  EXPECT_EQ(first(sent, &Message::has_leaving).leaving().reason(), "SIGTERM");
  EXPECT_EQ(first(sent, &Message::has_returned).returned().units(0).job(), 8U);
  EXPECT_TRUE(world.ports.told.back().has_hand_over());
  world.film(world.token_of(0), 2);
  world.returned(world.token_of(8));
  sent = world.take_sent();
  const Message result = first(sent, &Message::has_result);
  EXPECT_EQ(result.result().unit().batches(), 2U);
  EXPECT_EQ(result.result().want(), 0U);
  EXPECT_EQ(first(sent, &Message::has_returned).returned().units(0).unit().tile().x0(), 8);
  EXPECT_EQ(world.machine->unacknowledged(), 1U);
  world.acknowledge(WorkerWorld::unit(0, 1, WorkerWorld::kJob, 2));
  EXPECT_TRUE(world.machine->empty());
}

TEST(StateMachine, DrainedItFinishesWhatIsLeasedAndTakesNoMore) {
  WorkerWorld world(1, 1);
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  v1::CoordinatorMessage drain;
  drain.mutable_drain()->set_reason("maintenance");
  world.machine->coordinator_says(drain, world.now);
  EXPECT_TRUE(world.machine->leaving());
  EXPECT_FALSE(world.machine->empty());
  world.take_sent();
  world.lease(WorkerWorld::unit(8, 2));  // crossed our Leaving
  EXPECT_EQ(first(world.take_sent(), &Message::has_returned).returned().units_size(), 1);
  world.film(world.token_of(0));
  EXPECT_EQ(first(world.take_sent(), &Message::has_result).result().unit().batches(), 4U);
  world.acknowledge(WorkerWorld::unit(0));
  EXPECT_TRUE(world.machine->empty());
}

TEST(StateMachine, StoppedUnitsAreDroppedAndMakeRoom) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.take_sent();
  world.stop(WorkerWorld::unit(0));
  EXPECT_TRUE(world.stopped(world.token_of(0)));
  EXPECT_EQ(first(world.take_sent(), &Message::has_request).request().units(), 1U);
}

}  // namespace
}  // namespace hyades::worker
