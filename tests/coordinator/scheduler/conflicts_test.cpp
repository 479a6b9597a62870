// Two renderings of one unit that differ.
#include <algorithm>
#include <chrono>
#include <variant>
#include <vector>

#include "tests/coordinator/scheduler/conflicts_testing.h"

namespace hyades::coordinator {
namespace {

using Bench = SchedulerBench;

TEST_F(Conflicts, AThirdWorkerIsAskedAndNeitherOfTheTwo) {
  EXPECT_EQ(b.scheduler.disputed_units(kJob), 1U);
  // They get the other tile, and then nothing: it waits.
  const Lease other = b.ask(kAnna);
  EXPECT_NE(other.units[0], anna_.units[0]);
  b.tell(WorkRequested{kBert, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  deliver_durably(other, 1);
  EXPECT_TRUE(b.all<FinishFrame>().empty());
  b.join(kCora);
  EXPECT_EQ(b.ask(kCora).units[0], anna_.units[0]);
}

TEST_F(Conflicts, AThirdWorkerThatFailedOnceIsAskedAgainWhereThereIsNoOther) {
  deliver_durably(b.ask(kAnna), 1);
  b.join(kCora);
  const Lease check = b.ask(kCora);
  b.tell(UnitFailed{kCora, check.lease, kJob, check.units[0], "bad luck"});
  EXPECT_EQ(b.ask(kCora).units, check.units) << "Anna and Bert have said what they think";
}

TEST_F(Conflicts, ThatTheOnlyThirdWorkerCannotRenderFailTheFrame) {
  b.join(kCora);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(b.all<Persist>().empty());
    const Lease check = b.ask(kCora);
    b.tell(UnitFailed{kCora, check.lease, kJob, check.units.at(0), "no memory"});
  }
  EXPECT_EQ(std::get<FrameFailedRecord>(b.only<Persist>().record).failed.reason, "no memory");
}

TEST_F(Conflicts, TheSecondWasWrong) {
  deliver_durably(b.ask(kAnna), 1);
  b.join(kCora);
  b.deliver(b.ask(kCora), 0, 1);
  EXPECT_EQ(b.only<Quarantine>().worker, kBert);
  EXPECT_EQ(b.only<Acknowledge>().worker, kCora);
  EXPECT_EQ(b.all<FinishFrame>().size(), 1U);
  EXPECT_EQ(std::get<DivergentWorkerRecord>(b.only<Persist>().record).worker, kBert);
  const auto sure = b.all<Confirmed>();
  ASSERT_EQ(sure.size(), 2U);
  EXPECT_EQ(sure[0].worker, kAnna);
  EXPECT_EQ(sure[1].worker, kCora);
  divergence_is_stored();
  EXPECT_FALSE(std::get<DisputeRecord>(b.only<Persist>().record).open) << "all is well";
}

TEST_F(Conflicts, TheFirstWasWrongAndAllItDidIsRenderedAgain) {
  const Lease other = b.ask(kAnna);
  deliver_durably(other, 1);
  b.join(kCora);
  const Lease check = b.ask(kCora);
  b.deliver(check, 0, 2);
  EXPECT_EQ(b.only<Quarantine>().worker, kAnna);
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now);
  const auto voids = b.all<Persist>();
  ASSERT_EQ(voids.size(), 3U);
  EXPECT_EQ(std::get<DivergentWorkerRecord>(voids[2].record).worker, kAnna);
  EXPECT_EQ(std::get<TileVoidedRecord>(voids[0].record).tile, anna_.units[0].tile);
  EXPECT_EQ(std::get<TileVoidedRecord>(voids[1].record).tile, other.units[0].tile);
  b.deliver(by(kBert), 0, 2);  // too early
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now);
  b.tell(Persisted{voids[0].id});
  EXPECT_EQ(b.only<TileVoided>().tile, anna_.units[0].tile);
  b.tell(Persisted{voids[1].id});
  deliver_durably(check, 2);  // sent again, it counts
  EXPECT_EQ(b.all<Merge>().size(), 1U);
  const Lease again = b.ask(kBert);
  EXPECT_EQ(again.units[0], other.units[0]);
  deliver_durably(again, 2);
  EXPECT_EQ(b.all<FinishFrame>().size(), 1U);
}

TEST_F(Conflicts, WhatAnotherAgreedOnIsKept) {
  const Lease other = b.ask(kAnna);
  deliver_durably(other, 1);
  Lease same = other;
  same.worker = kBert;
  b.deliver(same, 0, 1);
  b.join(kCora);
  b.deliver(b.ask(kCora), 0, 2);
  EXPECT_EQ(b.all<Persist>().size(), 2U);
  EXPECT_EQ(std::get<TileVoidedRecord>(b.all<Persist>().at(0).record).tile, anna_.units[0].tile);
}

TEST_F(Conflicts, AQuarantinedWorkerIsNotBelievedAndGetsNothing) {
  const Lease other = b.ask(kBert);
  b.join(kCora);
  b.tell(WorkRequested{kBert, 1});
  b.deliver(b.ask(kCora), 0, 1);
  EXPECT_EQ(b.only<Revoke>().lease, other.lease);
  b.deliver(other, 0, 2);
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::unknown);
  b.join(kBert);
  b.tell(WorkRequested{kBert, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.tell(WorkerBarred{kBert, false});
  EXPECT_EQ(b.all<Lease>().size(), 1U);
}

TEST_F(Conflicts, WhereThreeDifferAFourthDecides) {
  b.join(kCora);
  b.join(kDora);
  b.deliver(b.ask(kCora), 0, 3);
  EXPECT_TRUE(b.all<Quarantine>().empty());
  b.deliver(b.ask(kDora), 0, 2);
  const auto divergent = b.all<Quarantine>();
  ASSERT_EQ(divergent.size(), 2U);
  EXPECT_EQ(divergent[0].worker, kAnna);
  EXPECT_EQ(divergent[1].worker, kCora);
}

TEST_F(Conflicts, FiveDifferentAnswersFailTheFrameAndBlameNobody) {
  uint8_t bits = 3;
  for (const WorkerId worker : {kCora, kDora, kEmil}) {
    b.join(worker);
    b.deliver(b.ask(worker), 0, bits++);
    EXPECT_TRUE(b.all<Quarantine>().empty());
  }
  const auto failed = std::get<FrameFailedRecord>(b.only<Persist>().record);
  EXPECT_EQ(failed.failed.reason, "5 workers rendered tile 0,0 batches 0-0 to 5 different films");
}

TEST_F(Conflicts, ThatShowWhileTheOutputsAreMadeAreStillDecided) {
  b.join(kCora);
  b.deliver(b.ask(kCora), 0, 1);
  divergence_is_stored();
  b.tell(Persisted{b.only<Persist>().id});
  const Lease last = b.ask(kAnna);
  deliver_durably(last, 1);
  ASSERT_EQ(b.all<FinishFrame>().size(), 1U);
  Lease late = last;
  late.worker = kCora;
  b.deliver(late, 0, 2);
  EXPECT_EQ(b.all<Conflict>().size(), 1U);
  b.tell(Persisted{b.only<Persist>().id});
  b.tell(FinishDone{kJob, 1});
  EXPECT_EQ(b.all<FrameReopened>().size(), 1U);
  EXPECT_TRUE(b.all<Persist>().empty());
  b.join(kDora);
  b.deliver(b.ask(kDora), 0, 1);
  EXPECT_EQ(b.only<Quarantine>().worker, kCora);
  EXPECT_EQ(b.all<FinishFrame>().size(), 1U);
}

TEST_F(Conflicts, NobodyIsAnsweredBeforeTheLogKnowsOfTheDispute) {
  b.join(kCora);
  const Lease other = b.ask(kAnna);
  deliver_durably(other, 1);
  b.deliver(b.ask(kCora), 0, 1);
  divergence_is_stored();
  b.tell(Persisted{b.only<Persist>().id});  // that it is over
  Lease late = other;
  late.worker = kCora;
  EXPECT_EQ(b.all<FinishFrame>().size(), 0U);
  b.deliver(late, 0, 2);
  const Persist mark = b.only<Persist>();
  EXPECT_TRUE(std::get<DisputeRecord>(mark.record).open);
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now);
  b.join(kDora);
  late.worker = kDora;
  b.deliver(late, 0, 1);  // it would decide
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now);
  EXPECT_TRUE(b.all<Quarantine>().empty());
  b.tell(PersistFailed{mark.id, "disk full"});
  b.now = *b.scheduler.next_wake();
  b.tell(Tick{});
  EXPECT_EQ(b.only<Persist>().id, mark.id);
  b.tell(Persisted{mark.id});
  b.deliver(late, 0, 1);
  EXPECT_EQ(b.only<Quarantine>().worker, kCora);
}

TEST(ConflictsWithAFilm, ThatIsNeverStoredAreNotForgotten) {
  Bench b;
  b.begin(small_plan({1}, 1));
  const Lease annas = b.ask(kAnna);
  Lease berts = annas;
  berts.worker = kBert;
  b.deliver(annas, 0, 1);
  const Persist film = b.only<Persist>();
  b.deliver(berts, 0, 2);
  b.tell(Persisted{b.only<Persist>().id});  // that there is a dispute
  b.deliver(berts, 0, 2);
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now) << "Bert's may be the only one left";
  b.tell(PersistFailed{film.id, "disk full"});
  EXPECT_EQ(b.scheduler.disputed_units(kJob), 0U);
  b.now += std::chrono::minutes(1);
  b.join(kBert);
  b.deliver(berts, 0, 2);
  b.tell(Persisted{b.only<Persist>().id});
  b.join(kAnna);
  b.deliver(annas, 0, 1);
  EXPECT_EQ(b.all<Conflict>().size(), 1U);
  EXPECT_EQ(b.scheduler.disputed_units(kJob), 1U);
}

TEST_F(Conflicts, TheDisputeIsOverWhenAllThatFollowsIsDurable) {
  const Lease other = b.ask(kAnna);
  deliver_durably(other, 1);
  b.join(kCora);
  b.deliver(b.ask(kCora), 0, 2);  // Anna was wrong
  const auto voids = b.all<Persist>();
  ASSERT_EQ(voids.size(), 3U);
  b.tell(Persisted{voids[0].id});
  EXPECT_TRUE(b.all<Persist>().empty());
  b.tell(Persisted{voids[1].id});
  EXPECT_TRUE(b.all<Persist>().empty()) << "nobody would know of Anna after a restart";
  b.tell(Persisted{voids[2].id});
  EXPECT_FALSE(std::get<DisputeRecord>(b.only<Persist>().record).open);
}

TEST_F(Conflicts, AVoidThatIsNotDurableIsTriedAgain) {
  b.join(kCora);
  b.deliver(b.ask(kCora), 0, 2);
  const Persist first = b.all<Persist>().at(0);
  b.tell(PersistFailed{first.id, "disk full"});
  EXPECT_TRUE(b.all<TileVoided>().empty());
  b.now = *b.scheduler.next_wake();
  b.tell(Tick{});
  EXPECT_EQ(b.only<Persist>().id, first.id);
}

/// All units of a job are to be rendered twice.
class Redundancy : public testing::Test {
 protected:
  void begin(uint32_t percent, int32_t width = 64, uint64_t seed = 7) {
    JobPlan plan = small_plan({1}, 1);
    plan.region = {0, 0, width, 32};
    plan.redundancy = percent;
    plan.redundancy_seed = seed;
    b.begin(plan);
  }
  SchedulerBench b;
};

TEST_F(Redundancy, HasAnotherWitnessRenderTheUnitToo) {
  begin(100);
  const Lease first = b.ask(kAnna);
  b.deliver_durably(first);
  EXPECT_EQ(b.scheduler.units_to_confirm(kJob), 1U);
  EXPECT_EQ(b.scheduler.disputed_units(kJob), 0U);
  EXPECT_NE(b.ask(kAnna).units, first.units) << "not by herself";
  const Lease again = b.ask(kBert);
  EXPECT_EQ(again.units, first.units);
  b.deliver(again);
  EXPECT_EQ(b.all<Confirmed>().size(), 2U);
  EXPECT_EQ(b.all<Acknowledge>().size(), 1U);
  EXPECT_EQ(b.scheduler.units_to_confirm(kJob), 0U);
}

TEST_F(Redundancy, TheFrameWaitsForIt) {
  begin(100);
  const Lease both = b.ask(kAnna, 2);
  b.deliver_durably(both, 0);
  b.deliver_durably(both, 1);
  EXPECT_TRUE(b.all<FinishFrame>().empty());
  EXPECT_EQ(b.scheduler.units_to_confirm(kJob), 2U);
  b.deliver(b.ask(kBert));
  EXPECT_TRUE(b.all<FinishFrame>().empty());
  b.deliver(b.ask(kBert));
  EXPECT_TRUE(b.only<FinishFrame>().unconfirmed.empty()) << "all of it is confirmed";
}

TEST_F(Redundancy, WhoIsLateWithItHoldsUpNobody) {
  begin(100, 32);
  b.deliver_durably(b.ask(kAnna));
  const Lease late = b.ask(kBert);
  const WorkerId cora{3};
  b.join(cora);
  b.tell(WorkRequested{kAnna, 1});
  b.tell(WorkRequested{cora, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.now += std::chrono::seconds(6);
  b.tell(Tick{});
  const Lease copy = b.only<Lease>();
  EXPECT_EQ(copy.worker, cora) << "not Anna, who was heard";
  EXPECT_EQ(copy.units, late.units);
  b.deliver(copy);
  EXPECT_EQ(b.only<Revoke>().lease, late.lease);
  EXPECT_EQ(b.all<FinishFrame>().size(), 1U);
}

TEST_F(Redundancy, WhoComesAgainGoesOnWithIt) {
  begin(100, 32);
  const Lease first = b.ask(kAnna);
  b.deliver_durably(first);
  const Lease check = b.ask(kBert);
  b.join(kAnna, {{first.lease, kJob, first.units[0]}});
  EXPECT_EQ(b.all<Revoke>().size(), 1U) << "she was heard";
  b.join(kBert, {{check.lease, kJob, check.units[0]}});
  const Lease adopted = b.only<Lease>();
  EXPECT_TRUE(adopted.adopted);
  b.deliver(adopted);
  EXPECT_EQ(b.all<FinishFrame>().size(), 1U);
}

TEST_F(Redundancy, WhoDiffersIsFoundOutByAThird) {
  begin(100);
  const WorkerId cora{3};
  b.join(cora);
  const Lease first = b.ask(kAnna);
  b.deliver_durably(first);
  const Lease second = b.ask(kBert);
  b.deliver(second, 0, 2);
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now)
      << "until it is durable that they differ";
  EXPECT_TRUE(std::holds_alternative<DisputeRecord>(b.only<Persist>().record));
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_EQ(b.scheduler.disputed_units(kJob), 1U);
  EXPECT_EQ(b.scheduler.units_to_confirm(kJob), 0U);
  const Lease third = b.ask(cora);
  EXPECT_EQ(third.units, first.units);
  b.deliver(third);
  EXPECT_EQ(b.only<Quarantine>().worker, kBert);
}

TEST_F(Redundancy, IsOfTheShareThatWasAskedForAndOfUnitsThatTheSeedChooses) {
  const auto twice = [](uint64_t seed) {
    SchedulerBench b;
    JobPlan plan = small_plan({1}, 1);
    plan.region = {0, 0, 32 * 1000, 32};
    plan.redundancy = 25;
    plan.redundancy_seed = seed;
    b.begin(plan);
    std::vector<bool> chosen;
    for (int i = 0; i < 1000; ++i) {
      b.deliver_durably(b.ask(kAnna));
      chosen.push_back(b.scheduler.units_to_confirm(kJob) > 0);
      if (chosen.back()) b.deliver(b.ask(kBert));
    }
    return chosen;
  };
  const std::vector<bool> one = twice(7);
  // 250 of 1000 with a deviation of 13.7: five of them.
  EXPECT_NEAR(std::count(one.begin(), one.end(), true), 250, 69);
  EXPECT_NE(twice(8), one);
  EXPECT_EQ(twice(7), one);
}

TEST_F(Redundancy, NobodyGoesFarAheadOfThoseWhoCheck) {
  begin(100, 32 * 100);
  const auto none_left = [&] {
    b.tell(WorkRequested{kAnna, 1});
    return b.all<Lease>().empty();
  };
  for (int i = 0; i < 64; ++i) b.deliver_durably(b.ask(kAnna));
  EXPECT_TRUE(none_left());
  b.deliver(b.ask(kBert));
  EXPECT_EQ(b.all<Lease>().size(), 1U) << "Anna still waits for a unit";
}

TEST_F(Redundancy, WithoutItNobodyIsAskedAgain) {
  begin(0);
  b.deliver_durably(b.ask(kAnna));
  b.deliver_durably(b.ask(kBert));
  EXPECT_EQ(b.all<FinishFrame>().size(), 1U);
}

/// One that contradicts itself is no check: what it gave is in doubt over a restart.
TEST_F(Redundancy, AWorkerThatContradictsItselfIsADispute) {
  begin(0);
  const Lease first = b.ask(kAnna);
  b.deliver_durably(first);
  b.deliver(first, 0, 2);
  EXPECT_EQ(b.scheduler.disputed_units(kJob), 1U);
  EXPECT_EQ(b.scheduler.units_to_confirm(kJob), 0U);
  EXPECT_TRUE(std::holds_alternative<DisputeRecord>(b.only<Persist>().record));
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_TRUE(b.all<Persist>().empty()) << "it is open";
}

/// Anna has a credential of her own, and rendered one of two tiles. Bert, Cora and more are let in
/// by one credential: whoever has that may call himself what he likes.
class OneCredential : public testing::Test {
 protected:
  void SetUp() override {
    b.join_by("anna's", kAnna);
    for (const WorkerId worker : {kBert, kCora, kDora, kEmil}) b.join_by("shared", worker);
    b.add(small_plan({1}, 1));
    b.tell(FrameOpened{kJob, 1});
    unit_ = b.ask(kAnna);
    deliver_durably(kAnna, 1);
  }
  void deliver(WorkerId worker, uint8_t bits) {
    Lease lease = unit_;
    lease.worker = worker;
    b.deliver(lease, 0, bits);
  }
  void deliver_durably(WorkerId worker, uint8_t bits) {
    deliver(worker, bits);
    b.tell(Persisted{b.only<Persist>().id});
  }
  SchedulerBench b;
  Lease unit_;
};

TEST_F(OneCredential, IsOneWitnessWhateverItsWorkersAreCalled) {
  deliver_durably(kBert, 2);
  deliver(kCora, 2);
  deliver(kDora, 2);
  EXPECT_TRUE(b.all<Quarantine>().empty());
  EXPECT_NE(b.ask(kEmil).units, unit_.units) << "who is no other witness is not asked either";
  const WorkerId frida{6};
  b.join_by("frida's", frida);
  EXPECT_EQ(b.ask(frida).units, unit_.units);
  deliver(frida, 1);
  const auto liars = b.all<Quarantine>();
  ASSERT_EQ(liars.size(), 3U);
  EXPECT_EQ(liars[0].worker, kBert);
  EXPECT_EQ(liars[1].worker, kCora);
  EXPECT_EQ(liars[2].worker, kDora);
}

TEST_F(OneCredential, OverrulesNoneOfItsOwnButByAnother) {
  deliver_durably(kBert, 2);
  deliver(kCora, 1);  // who is honest, and agrees with Anna
  EXPECT_EQ(b.only<Quarantine>().worker, kBert);
}

TEST_F(OneCredential, ConfirmsNothingOfItsOwn) {
  const Lease first = b.ask(kBert);
  b.deliver_durably(first);
  Lease again = first;
  again.worker = kCora;
  b.deliver(again);
  EXPECT_TRUE(b.all<Confirmed>().empty());
  again.worker = kAnna;
  b.deliver(again);
  EXPECT_EQ(b.all<Confirmed>().size(), 2U);
}

TEST_F(OneCredential, ThatAnswersInManyWaysFailsNoFrame) {
  deliver_durably(kBert, 2);
  deliver(kCora, 3);
  deliver(kDora, 4);
  deliver(kEmil, 5);
  EXPECT_TRUE(b.all<Persist>().empty());
  EXPECT_TRUE(b.all<Quarantine>().empty());
}

TEST_F(OneCredential, FailsNoFrameWhileAnotherMayTry) {
  const std::vector<core::Unit> other = b.ask(kBert).units;
  const auto fail = [&](const Lease& lease) {
    EXPECT_EQ(lease.units, other);
    b.tell(UnitFailed{lease.worker, lease.lease, kJob, lease.units.at(0), "it is evil"});
    EXPECT_TRUE(b.all<Persist>().empty());
  };
  b.tell(WorkerBarred{kAnna, true});
  b.tell(WorkerLost{kBert});
  for (const WorkerId worker : {kCora, kDora}) fail(b.ask(worker));
  b.tell(WorkerBarred{kAnna, false});
  fail(b.ask(kEmil));
  EXPECT_EQ(b.ask(kAnna).units, other);
}

}  // namespace
}  // namespace hyades::coordinator
