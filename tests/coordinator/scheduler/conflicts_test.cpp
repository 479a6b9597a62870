// Two renderings of one unit that differ.
#include "tests/coordinator/scheduler/scheduler_testing.h"

namespace hyades::coordinator {
namespace {

using Bench = SchedulerBench;

constexpr WorkerId kCora{3};
constexpr WorkerId kDora{4};
constexpr WorkerId kEmil{5};

/// A frame of two tiles of which Anna has rendered the first, and Bert the first too, otherwise.
class Conflicts : public testing::Test {
 protected:
  void SetUp() override {
    b.join(kAnna);
    b.join(kBert);
    JobPlan plan = small_plan({1}, 1);
    plan_it(plan);
    b.add(plan);
    b.tell(FrameOpened{kJob, 1});
    anna_ = b.ask(kAnna);
    deliver_durably(anna_, 1);
    b.deliver(by(kBert), 0, 2);
    EXPECT_EQ(b.only<Conflict>().first, kAnna);
    EXPECT_EQ(b.only<Conflict>().second, kBert);
    EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now);
    EXPECT_TRUE(b.all<Quarantine>().empty());
    b.tell(Persisted{b.only<Persist>().id});
    b.deliver(by(kBert), 0, 2);  // again
    EXPECT_TRUE(b.all<Conflict>().empty());
    EXPECT_EQ(b.only<Reject>().reason, RejectReason::conflict);
  }

  virtual void plan_it(JobPlan& /*plan*/) {}

  Lease by(WorkerId worker) const {
    Lease lease = anna_;
    lease.worker = worker;
    return lease;
  }
  void deliver_durably(const Lease& lease, uint8_t bits) {
    b.deliver(lease, 0, bits);
    b.tell(Persisted{b.only<Persist>().id});
  }

  /// What a worker is found odd for has followed, and is durable.
  void odd_is_stored() {
    const Persist odd = b.all<Persist>().back();
    ASSERT_TRUE(std::holds_alternative<WorkerOddRecord>(odd.record));
    b.tell(Persisted{odd.id});
  }

  Bench b;
  Lease anna_;
};

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
  EXPECT_EQ(std::get<WorkerOddRecord>(b.only<Persist>().record).worker, kBert);
  const auto sure = b.all<Confirmed>();
  ASSERT_EQ(sure.size(), 2U);
  EXPECT_EQ(sure[0].worker, kAnna);
  EXPECT_EQ(sure[1].worker, kCora);
  odd_is_stored();
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
  EXPECT_EQ(std::get<WorkerOddRecord>(voids[2].record).worker, kAnna);
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
  const auto odd = b.all<Quarantine>();
  ASSERT_EQ(odd.size(), 2U);
  EXPECT_EQ(odd[0].worker, kAnna);
  EXPECT_EQ(odd[1].worker, kCora);
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
  odd_is_stored();
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
  odd_is_stored();
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

/// A job of two frames; Anna has rendered the first, and its outputs are made.
class DoubtedFrames : public testing::Test {
 protected:
  void SetUp() override {
    b.join(kAnna);
    JobPlan plan = small_plan({1, 2}, 1);
    plan.region = {0, 0, 32, 32};
    plan.frames_in_flight = 1;
    b.add(plan);
    b.tell(FrameOpened{kJob, 1});
    const Lease lease = b.ask(kAnna);
    b.deliver(lease);
    b.tell(Persisted{b.only<Persist>().id});
    EXPECT_EQ(b.only<FinishFrame>().unconfirmed, std::vector<WorkerId>{kAnna});
    b.tell(FinishDone{kJob, 1});
    stored_ = b.only<Persist>().id;
  }
  void doubt() { b.tell(FramesDoubted{kJob, {1, 2, 7}}); }
  void expect_again() {
    const Persist again = b.only<Persist>();
    EXPECT_EQ(std::get<FrameRestartedRecord>(again.record).frame, 1);
    b.tell(Persisted{again.id});
    EXPECT_EQ(b.only<FrameRestarted>().frame, 1);
  }
  Bench b;
  RecordId stored_{};
};

TEST_F(DoubtedFrames, BeginAgain) {
  b.tell(Persisted{stored_});
  EXPECT_EQ(b.only<FrameDone>().frame, 1);
  doubt();
  expect_again();
  b.tell(FrameOpened{kJob, 2});
  b.deliver_durably(b.ask(kAnna));
  b.tell(FinishDone{kJob, 2});
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_TRUE(b.all<JobEnded>().empty());
  b.tell(FrameOpened{kJob, 1});
  b.deliver_durably(b.ask(kAnna));
  b.tell(FinishDone{kJob, 1});
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_EQ(b.only<JobEnded>().done, 2U);
}

TEST_F(DoubtedFrames, BeginAgainWhenTheirEndIsStored) {
  doubt();
  EXPECT_TRUE(b.all<Persist>().empty());
  b.tell(Persisted{stored_});
  EXPECT_TRUE(b.all<FrameDone>().empty());
  expect_again();
}

TEST_F(DoubtedFrames, BeginAgainWhereTheWorkerIsFoundOutWhileTheirEndIsStored) {
  // Its films of frame 2 differ from two others'.
  b.join(kBert);
  b.join(WorkerId{3});
  JobPlan plan = small_plan({5}, 1);
  plan.region = {0, 0, 32, 32};
  b.add(plan, {}, JobId{2});
  b.tell(FrameOpened{JobId{2}, 5});
  Lease lease = b.ask(kAnna);
  b.deliver(lease, 0, 1);
  b.tell(Persisted{b.only<Persist>().id});
  lease.worker = kBert;
  b.deliver(lease, 0, 2);
  b.tell(Persisted{b.only<Persist>().id});
  lease.worker = WorkerId{3};
  b.deliver(lease, 0, 2);
  EXPECT_EQ(b.only<Quarantine>().worker, kAnna);
  b.tell(Persisted{stored_});
  EXPECT_TRUE(b.all<FrameDone>().empty());
  expect_again();
}

/// What a coordinator finds of two jobs, each with a film in its frame 1.
class ConflictsBeforeARestart : public testing::Test {
 protected:
  static RestoredJob with_a_film(bool disputed) {
    RestoredJob restored;
    restored.accepted.push_back({{1, {0, 0, 32, 32}, {0, 1}}, digest(1), "class"});
    restored.disputed = disputed;
    return restored;
  }
  Bench b;
};

TEST_F(ConflictsBeforeARestart, LetNoFilmFromThenCount) {
  b.add(small_plan({1}, 1), with_a_film(false), JobId{2});
  b.tell(FrameOpened{JobId{2}, 1});
  b.add(small_plan({1}, 1), with_a_film(true), JobId{1});
  // The other one's too: who was odd is not known.
  const auto said = b.all<Persist>();
  ASSERT_EQ(said.size(), 3U);
  EXPECT_EQ(std::get<FrameRestartedRecord>(said[0].record).job, JobId{1});
  EXPECT_EQ(std::get<DisputeRecord>(said[1].record).job, JobId{2});
  EXPECT_EQ(std::get<TileVoidedRecord>(said[2].record).job, JobId{2});
  EXPECT_TRUE(b.all<OpenFrame>().empty());
  b.tell(Persisted{said[0].id});
  EXPECT_EQ(b.all<OpenFrame>().size(), 1U);
  b.tell(Persisted{said[1].id});
  EXPECT_TRUE(b.all<Persist>().empty()) << "a film is in doubt still";
  b.tell(Persisted{said[2].id});
  EXPECT_EQ(b.all<Persist>().size(), 2U) << "both disputes are over";
  // A job that is taken up later is no better.
  b.add(small_plan({1}, 1), with_a_film(false), JobId{3});
  EXPECT_EQ(std::get<FrameRestartedRecord>(b.all<Persist>().at(1).record).job, JobId{3});
}

TEST_F(ConflictsBeforeARestart, LetNoCompleteFilmBeFinished) {
  RestoredJob restored = with_a_film(true);
  restored.accepted.push_back({{1, {32, 0, 64, 32}, {0, 1}}, digest(1), "class"});
  b.add(small_plan({1}, 1), restored);
  EXPECT_TRUE(b.all<FinishFrame>().empty());
  EXPECT_EQ(b.all<Persist>().size(), 1U);
}

TEST_F(ConflictsBeforeARestart, AreNotTheOnlyReasonToDoubtWhatNobodyIsKnownToHaveDone) {
  // No dispute was open; but a worker is found odd that may have rendered the film from then.
  b.add(small_plan({1}, 2), with_a_film(false));
  b.tell(FrameOpened{kJob, 1});
  for (const WorkerId worker : {kAnna, kBert, kCora}) b.join(worker);
  Lease lease = b.ask(kAnna);
  b.deliver(lease, 0, 1);
  b.tell(Persisted{b.all<Persist>().at(0).id});
  lease.worker = kBert;
  b.deliver(lease, 0, 2);
  b.tell(Persisted{b.only<Persist>().id});
  lease.worker = kCora;
  b.deliver(lease, 0, 1);
  EXPECT_EQ(b.only<Quarantine>().worker, kBert);
  EXPECT_EQ(std::get<TileVoidedRecord>(b.all<Persist>().at(0).record).tile,
            (core::PixelRect{0, 0, 32, 32}));
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

/// The same of a job whose films cannot be taken apart.
class WholeFrames : public Conflicts {
 protected:
  void plan_it(JobPlan& plan) override { plan.whole_frames = true; }
  void expect_again(const Persist& again) {
    EXPECT_EQ(std::get<FrameRestartedRecord>(again.record).frame, 1);
    b.tell(Persisted{again.id});
    EXPECT_EQ(b.only<FrameRestarted>().frame, 1);
    b.tell(FrameOpened{kJob, 1});
  }
};

TEST_F(WholeFrames, BeginAgainWhereOneOfTheirFilmsIsWrong) {
  const Lease other = b.ask(kAnna);
  deliver_durably(other, 1);
  b.join(kCora);
  const Lease check = b.ask(kCora);
  b.deliver(check, 0, 2);
  EXPECT_EQ(b.only<Quarantine>().worker, kAnna);
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now);
  const auto said = b.all<Persist>();
  ASSERT_EQ(said.size(), 2U);
  EXPECT_EQ(std::get<WorkerOddRecord>(said[1].record).worker, kAnna);
  b.deliver(check, 0, 2);
  EXPECT_EQ(b.only<Reject>().reason, RejectReason::unknown) << "nothing of then counts";
  expect_again(said[0]);
  b.tell(Persisted{said[1].id});
  EXPECT_FALSE(std::get<DisputeRecord>(b.only<Persist>().record).open);
  deliver_durably(b.ask(kBert), 2);
  deliver_durably(b.ask(kCora), 2);
  EXPECT_EQ(b.only<FinishFrame>().unconfirmed, (std::vector<WorkerId>{kBert, kCora}));
}

TEST_F(WholeFrames, TakeBackWhatIsOutWhenTheyBeginAgain) {
  const Lease other = b.ask(kBert);
  b.join(kCora);
  b.deliver(b.ask(kCora), 0, 2);
  EXPECT_EQ(b.only<Revoke>().lease, other.lease);
  expect_again(b.all<Persist>().at(0));
  EXPECT_EQ(b.scheduler.disputed_units(kJob), 0U);
}

TEST_F(WholeFrames, GoOnWhereTheSecondWasWrong) {
  deliver_durably(b.ask(kAnna), 1);
  b.join(kCora);
  b.deliver(b.ask(kCora), 0, 1);
  EXPECT_EQ(b.only<Quarantine>().worker, kBert);
  EXPECT_EQ(b.all<FinishFrame>().size(), 1U);
}

TEST_F(WholeFrames, BeginAgainOnceTheirOutputsAreMade) {
  // Frame 1 is Anna's and Bert's of one mind, but for one film of Anna's of another job.
  b.join(kCora);
  b.deliver(b.ask(kCora), 0, 1);
  EXPECT_EQ(b.only<Quarantine>().worker, kBert);
  odd_is_stored();
  b.tell(Persisted{b.only<Persist>().id});
  deliver_durably(b.ask(kAnna), 1);
  ASSERT_EQ(b.all<FinishFrame>().size(), 1U);
  for (const WorkerId worker : {kDora, kEmil}) b.join(worker);
  JobPlan plan = small_plan({5}, 1);
  plan.region = {0, 0, 32, 32};
  b.add(plan, {}, JobId{2});
  b.tell(FrameOpened{JobId{2}, 5});
  Lease lease = b.ask(kAnna);
  deliver_durably(lease, 1);
  lease.worker = kDora;
  b.deliver(lease, 0, 2);
  const RecordId dispute = b.only<Persist>().id;
  b.tell(Persisted{dispute});
  lease.worker = kEmil;
  b.deliver(lease, 0, 2);
  EXPECT_EQ(b.only<Quarantine>().worker, kAnna);
  for (const Persist& p : b.all<Persist>()) {
    EXPECT_FALSE(std::holds_alternative<FrameRestartedRecord>(p.record)) << "not yet";
    if (!std::holds_alternative<DisputeRecord>(p.record)) continue;
    EXPECT_EQ(std::get<DisputeRecord>(p.record).job, kJob);
  }
  // Even where its outputs could not be made they are not tried again of that film.
  b.tell(FinishFailed{kJob, 1, "no room"});
  EXPECT_TRUE(b.all<FinishFrame>().empty());
  expect_again(b.only<Persist>());
}

TEST_F(ConflictsBeforeARestart, LetWholeFramesBeginAgain) {
  JobPlan plan = small_plan({1}, 1);
  plan.whole_frames = true;
  b.add(plan, with_a_film(false), JobId{2});
  // While it is being opened.
  b.add(small_plan({1}, 1), with_a_film(true), JobId{1});
  EXPECT_EQ(b.all<Persist>().size(), 2U);
  b.tell(FrameOpened{JobId{2}, 1});
  EXPECT_EQ(std::get<FrameRestartedRecord>(b.only<Persist>().record).job, JobId{2});
}

}  // namespace
}  // namespace hyades::coordinator
