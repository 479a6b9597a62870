#include "worker/state_machine.h"

#include <gtest/gtest.h>

#include "tests/worker/state_machine_testing.h"

namespace hyades::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Message = v1::WorkerMessage;

/// The child may remove nothing from the cache, and is believed only about its job's files.
TEST(StateMachine, AFileThatTheChildFindsDamagedIsLookedAtIfItIsOneOfItsJob) {
  WorkerWorld world;
  world.begin();
  world.job(WorkerWorld::kJob, {std::string(32, '\x11'), std::string(32, '\x22')});
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.failed(world.token_of(0), {std::string(64, '2'), std::string(64, '3')});
  EXPECT_EQ(world.ports.rechecked, std::vector<std::string>{std::string(64, '2')});
  EXPECT_TRUE(world.machine->empty());
}

TEST(StateMachine, FilesInDoubtAreFetchedBeforeTheNextUnitThoughOthersOfTheJobAreInWork) {
  WorkerWorld world;
  world.begin();
  world.job(WorkerWorld::kJob, {std::string(32, '\x22')});
  world.lease(WorkerWorld::unit(0));
  world.lease(WorkerWorld::unit(8, 2));
  world.machine->files_are_there(WorkerWorld::kJob);
  ASSERT_EQ(world.ports.fetched.size(), 1U);
  world.failed(world.token_of(0), {std::string(64, '2')});
  world.lease(WorkerWorld::unit(16, 3));
  EXPECT_EQ(world.ports.fetched.size(), 2U) << "fetching looks at what was found damaged";
  EXPECT_EQ(world.token_of(16), 0U) << "not before that";
  world.machine->files_are_there(WorkerWorld::kJob);
  EXPECT_NE(world.token_of(16), 0U);
}

TEST(StateMachine, FilmsThatCannotBeStoredNowComeAgain) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.film(world.token_of(0));
  world.take_sent();
  v1::CoordinatorMessage message;
  *message.mutable_rejected()->mutable_unit() = WorkerWorld::unit(0);
  message.mutable_rejected()->set_reason(v1::Rejected::REASON_NOT_NOW);
  message.mutable_rejected()->set_retry_after_ms(500);
  world.machine->coordinator_says(message, world.now);
  world.now += milliseconds(400);
  world.machine->tick(world.now, true);
  EXPECT_FALSE(first(world.take_sent(), &Message::has_result).has_result());
  world.now += milliseconds(200);
  world.machine->tick(world.now, true);
  EXPECT_TRUE(first(world.take_sent(), &Message::has_result).has_result());
  message.mutable_rejected()->set_reason(v1::Rejected::REASON_UNKNOWN);
  world.machine->coordinator_says(message, world.now);
  EXPECT_TRUE(world.machine->empty());
}

TEST(StateMachine, UnitsWhoseFilesCannotBeHadGoBack) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.take_sent();
  world.machine->files_failed(WorkerWorld::kJob, "not there", FilesTrouble::machine, world.now);
  EXPECT_EQ(first(world.take_sent(), &Message::has_returned).returned().reason(), "not there");
  EXPECT_TRUE(world.machine->empty());
  world.now += seconds(10);
  world.machine->tick(world.now, true);
  world.lease(WorkerWorld::unit(0, 2));
  EXPECT_EQ(world.ports.fetched.size(), 2U) << "and are tried again with the next lease";
  world.take_sent();
  world.machine->files_failed(WorkerWorld::kJob, "its name is no SHA-256", FilesTrouble::hopeless,
                              world.now);
  EXPECT_EQ(first(world.take_sent(), &Message::has_failure).failure().reason(),
            "its name is no SHA-256");
}

TEST(StateMachine, RestsLongerEachTimeThatFilesCannotBeHad) {
  WorkerWorld world;
  world.begin(1000, 10'000'000);
  const auto fail = [&] {  // how long it asks for nothing
    world.lease(WorkerWorld::unit(0));
    world.machine->files_failed(WorkerWorld::kJob, "the disk is full", FilesTrouble::machine,
                                world.now);
    world.take_sent();
    for (milliseconds rest{0};; rest += milliseconds(100)) {
      if (rest > seconds(200)) return rest;
      world.machine->tick(world.now, true);
      if (first(world.take_sent(), &Message::has_request).has_request()) return rest;
      world.now += milliseconds(100);
    }
  };
  const auto rest = fail();
  EXPECT_GE(rest, seconds(5));
  EXPECT_LE(rest, seconds(11));
  EXPECT_GE(fail(), seconds(10));
  EXPECT_GE(fail(), seconds(20));
  for (int i = 0; i < 5; ++i) EXPECT_LE(fail(), seconds(121));
  EXPECT_EQ(world.ports.notes, std::vector<std::string>{"units go back: the disk is full"})
      << "people are told of what changes";
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  world.film(world.token_of(0));
  world.acknowledge(WorkerWorld::unit(0));
  EXPECT_LE(fail(), seconds(11));
  EXPECT_EQ(world.ports.notes.size(), 2U);
}

TEST(StateMachine, WhatComesDuringARestGoesBackAtOnce) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_failed(WorkerWorld::kJob, "the disk is full", FilesTrouble::machine,
                              world.now);
  world.take_sent();
  world.lease(WorkerWorld::unit(0, 2));
  const auto sent = world.take_sent();
  EXPECT_EQ(first(sent, &Message::has_returned).returned().reason(), "the disk is full");
  EXPECT_FALSE(first(sent, &Message::has_request).has_request());
  EXPECT_EQ(world.ports.fetched.size(), 1U);
  EXPECT_TRUE(world.machine->empty());
}

TEST(StateMachine, AJobWhoseFilesCannotBeHadHoldsUpNobodyElse) {
  constexpr uint64_t kOther = 8;
  WorkerWorld world;
  world.begin(1000, 10'000'000);
  world.job(kOther);
  world.lease(WorkerWorld::unit(0));
  world.take_sent();
  world.machine->files_failed(WorkerWorld::kJob, "too many", FilesTrouble::job, world.now);
  auto sent = world.take_sent();
  EXPECT_EQ(first(sent, &Message::has_returned).returned().reason(), "too many");
  EXPECT_EQ(first(sent, &Message::has_request).request().units(), 1U) << "it does not rest";
  world.lease(WorkerWorld::unit(0, 2));
  sent = world.take_sent();
  EXPECT_FALSE(first(sent, &Message::has_returned).has_returned()) << "it would come again at once";
  EXPECT_EQ(first(sent, &Message::has_request).request().units(), 1U) << "of others";
  EXPECT_EQ(world.ports.fetched.size(), 1U);
  world.lease(WorkerWorld::unit(8, 3, kOther));
  world.machine->files_are_there(kOther);
  EXPECT_NE(world.token_of(8), 0U);
  world.now += seconds(10);
  world.machine->tick(world.now, true);
  EXPECT_EQ(world.ports.fetched.back(), WorkerWorld::kJob) << "and is tried again";
  world.machine->files_are_there(WorkerWorld::kJob);
  EXPECT_NE(world.token_of(0), 0U);
  EXPECT_EQ(world.ports.notes, std::vector<std::string>{"units go back: too many"});
}

TEST(StateMachine, OfAJobThatRestsFewUnitsAreHeld) {
  WorkerWorld world;  // which has room for three
  world.begin(1000, 10'000'000);
  world.lease(WorkerWorld::unit(0));
  world.machine->files_failed(WorkerWorld::kJob, "too many", FilesTrouble::job, world.now);
  for (int i = 1; i <= 3; ++i) world.lease(WorkerWorld::unit(8 * i, 1 + i));
  EXPECT_EQ(world.machine->in_hand(), 3U);
  world.take_sent();
  world.lease(WorkerWorld::unit(40, 9));
  auto sent = world.take_sent();
  EXPECT_EQ(first(sent, &Message::has_returned).returned().reason(), "too many");
  EXPECT_FALSE(first(sent, &Message::has_request).has_request()) << "it would come again at once";
  world.now += milliseconds(1100);
  world.machine->tick(world.now, true);
  EXPECT_EQ(first(world.take_sent(), &Message::has_request).request().units(), 1U);
  world.now += seconds(10);
  world.machine->tick(world.now, true);
  EXPECT_EQ(world.ports.fetched.size(), 2U);
  world.take_sent();
  world.machine->files_failed(WorkerWorld::kJob, "too many", FilesTrouble::job, world.now);
  EXPECT_EQ(first(world.take_sent(), &Message::has_returned).returned().units_size(), 3);
}

TEST(StateMachine, UnitsOfAJobWhoseFilesAWorkerNeverHasFailAtOnce) {
  constexpr uint64_t kOther = 8;
  WorkerWorld world;
  world.begin();
  world.job(kOther);
  world.lease(WorkerWorld::unit(0));
  world.take_sent();
  world.machine->files_failed(WorkerWorld::kJob, "never", FilesTrouble::hopeless, world.now);
  EXPECT_EQ(first(world.take_sent(), &Message::has_failure).failure().reason(), "never");
  world.lease(WorkerWorld::unit(8, 2));
  EXPECT_EQ(first(world.take_sent(), &Message::has_failure).failure().reason(), "never");
  EXPECT_EQ(world.ports.fetched.size(), 1U) << "nobody looks at so many files again";
  EXPECT_TRUE(world.machine->empty());
  world.lease(WorkerWorld::unit(16, 3, kOther));
  EXPECT_EQ(world.ports.fetched.back(), kOther);
  world.job();
  world.lease(WorkerWorld::unit(8, 4));
  EXPECT_EQ(world.ports.fetched.back(), WorkerWorld::kJob) << "it may have other files now";
}

TEST(StateMachine, AJobThatIsOverIsForgotten) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.machine->files_are_there(WorkerWorld::kJob);
  v1::CoordinatorMessage message;
  message.mutable_over()->set_job(WorkerWorld::kJob);
  world.machine->coordinator_says(message, world.now);
  EXPECT_TRUE(world.machine->empty());
  EXPECT_TRUE(world.stopped(world.token_of(0)));
  EXPECT_TRUE(world.ports.told.back().has_forget());
}

TEST(StateMachine, FilesThatComeTooLateAreNotKept) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  v1::CoordinatorMessage message;
  message.mutable_over()->set_job(WorkerWorld::kJob);
  world.machine->coordinator_says(message, world.now);
  world.ports.released.clear();
  world.machine->files_are_there(WorkerWorld::kJob);
  EXPECT_EQ(world.ports.released, std::vector<uint64_t>{WorkerWorld::kJob});
}

TEST(StateMachine, AJobThatWasGivenUpWhileItsFilesCameHasThemFetchedAgain) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.now += seconds(11);  // out of contact for longer than a lease
  world.machine->tick(world.now, true);
  ASSERT_TRUE(world.machine->empty());
  EXPECT_EQ(world.ports.released, std::vector<uint64_t>{WorkerWorld::kJob});
  world.lease(WorkerWorld::unit(0, 2));
  EXPECT_EQ(world.ports.fetched.size(), 2U) << "nobody answers for the first time";
  world.machine->files_are_there(WorkerWorld::kJob);
  EXPECT_NE(world.token_of(0), 0U);
}

/// The answer was on its way when the files were let go of: they may be evicted.
TEST(StateMachine, FilesThatWereLetGoOfSinceTheyCameDoNotCount) {
  WorkerWorld world;
  world.begin();
  world.lease(WorkerWorld::unit(0));
  world.stop(WorkerWorld::unit(0));
  world.lease(WorkerWorld::unit(8, 2));
  world.ports.files_are_kept = false;
  world.machine->files_are_there(WorkerWorld::kJob);
  EXPECT_EQ(world.token_of(8), 0U);
  world.lease(WorkerWorld::unit(16, 3));
  EXPECT_EQ(world.ports.fetched.size(), 2U) << "the second time is still to be answered";
  world.ports.files_are_kept = true;
  world.machine->files_are_there(WorkerWorld::kJob);
  EXPECT_NE(world.token_of(8), 0U);
  EXPECT_NE(world.token_of(16), 0U);
}

}  // namespace
}  // namespace hyades::worker
