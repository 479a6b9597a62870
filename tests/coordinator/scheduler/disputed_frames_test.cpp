// Frames that conflicts make suspect, and what a restart finds of them.
#include "tests/coordinator/scheduler/conflicts_testing.h"

namespace hyades::coordinator {
namespace {

using Bench = SchedulerBench;

/// A job of two frames; Anna has rendered the first, and its outputs are made.
class SuspectFrames : public testing::Test {
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
  void suspect() { b.tell(FramesSuspected{kJob, {1, 2, 7}}); }
  void expect_again() {
    const Persist again = b.only<Persist>();
    EXPECT_EQ(std::get<FrameRestartedRecord>(again.record).frame, 1);
    b.tell(Persisted{again.id});
    EXPECT_EQ(b.only<FrameRestarted>().frame, 1);
  }
  Bench b;
  RecordId stored_{};
};

TEST_F(SuspectFrames, BeginAgain) {
  b.tell(Persisted{stored_});
  EXPECT_EQ(b.only<FrameDone>().frame, 1);
  suspect();
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

TEST_F(SuspectFrames, BeginAgainWhenTheirEndIsStored) {
  suspect();
  EXPECT_TRUE(b.all<Persist>().empty());
  b.tell(Persisted{stored_});
  EXPECT_TRUE(b.all<FrameDone>().empty());
  expect_again();
}

TEST_F(SuspectFrames, BeginAgainWhereTheWorkerIsFoundOutWhileTheirEndIsStored) {
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
  // The other one's too: who was divergent is not known.
  const auto said = b.all<Persist>();
  ASSERT_EQ(said.size(), 3U);
  EXPECT_EQ(std::get<FrameRestartedRecord>(said[0].record).job, JobId{1});
  EXPECT_EQ(std::get<DisputeRecord>(said[1].record).job, JobId{2});
  EXPECT_EQ(std::get<TileVoidedRecord>(said[2].record).job, JobId{2});
  EXPECT_TRUE(b.all<OpenFrame>().empty());
  b.tell(Persisted{said[0].id});
  EXPECT_EQ(b.all<OpenFrame>().size(), 1U);
  b.tell(Persisted{said[1].id});
  EXPECT_TRUE(b.all<Persist>().empty()) << "a film is suspect still";
  b.tell(Persisted{said[2].id});
  EXPECT_EQ(b.all<Persist>().size(), 2U) << "both disputes are over";
  // A job that is recovered later is no better.
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
  // No dispute was open; but a worker is found divergent that may have rendered the film from then.
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
  EXPECT_EQ(std::get<DivergentWorkerRecord>(said[1].record).worker, kAnna);
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
  divergence_is_stored();
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
