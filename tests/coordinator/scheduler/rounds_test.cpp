// Tiles that get more batches until they are found to have enough.
#include <vector>

#include "tests/coordinator/scheduler/conflicts_testing.h"

namespace hyades::coordinator {
namespace {

/// Two tiles of at most six batches, judged after two and after three.
JobPlan judged_plan() {
  JobPlan plan = small_plan({1}, 6);
  plan.rounds = {2, 3};
  return plan;
}

class Rounds : public testing::Test {
 protected:
  void SetUp() override { b.begin(judged_plan()); }

  /// Renders units until nothing is to be had, and returns what somebody is asked.
  std::vector<JudgeTile> render_all(WorkerId worker = kAnna) {
    std::vector<JudgeTile> asked;
    for (;;) {
      b.tell(WorkRequested{worker, 1});
      const auto leases = b.all<Lease>();
      if (leases.empty()) return asked;
      b.deliver_durably(leases.front());
      for (const JudgeTile& judge : b.all<JudgeTile>()) asked.push_back(judge);
    }
  }
  void answer(const JudgeTile& judge, bool enough) {
    b.tell(TileJudged{judge.job, judge.frame, judge.tile, judge.serial, enough});
  }

  SchedulerBench b;
};

TEST_F(Rounds, ATileIsJudgedByAllThatIsPlannedOfItAndMerged) {
  const auto asked = render_all();
  ASSERT_EQ(asked.size(), 2U);
  EXPECT_EQ(asked[0].batches, 2U);
  EXPECT_NE(asked[0].tile, asked[1].tile);
  EXPECT_TRUE(b.all<FinishFrame>().empty());
}

TEST_F(Rounds, ATileThatNeedsMoreGetsTheNextRoundAtOnce) {
  const auto asked = render_all();
  answer(asked[0], false);
  const Lease lease = b.only<Lease>();  // Anna's wish stood
  EXPECT_EQ(lease.units[0].tile, asked[0].tile);
  EXPECT_EQ(lease.units[0].batches, (core::BatchRange{2, 1}));
  b.deliver_durably(lease);
  EXPECT_EQ(b.only<JudgeTile>().batches, 3U);
}

TEST_F(Rounds, AFrameIsFinishedWithWhatItsTilesNeed) {
  const auto asked = render_all();
  answer(asked[0], true);
  answer(asked[1], false);
  b.deliver_durably(b.only<Lease>());
  answer(b.only<JudgeTile>(), false);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(b.all<FinishFrame>().empty());
    b.deliver_durably(b.ask(kAnna));
    EXPECT_TRUE(b.all<JudgeTile>().empty()) << "it gets all batches that there are";
  }
  EXPECT_EQ(b.only<FinishFrame>().volume, 32U * 32 * (2 + 6));
}

TEST_F(Rounds, OnlyTheAnswerToTheLastQuestionCounts) {
  const auto asked = render_all();
  JudgeTile other = asked[0];
  other.serial += 100;
  answer(other, false);
  EXPECT_TRUE(b.all<Lease>().empty());
  answer(asked[0], false);
  const Lease lease = b.only<Lease>();
  answer(asked[0], true);  // again
  b.deliver_durably(lease);
  EXPECT_EQ(b.only<JudgeTile>().batches, 3U);
}

TEST_F(Rounds, AfterARestartATileThatHasItsRoundIsJudgedAgain) {
  const core::PixelRect left{0, 0, 32, 32};
  const core::PixelRect right{32, 0, 64, 32};
  SchedulerBench again;
  again.join(kAnna);
  RestoredJob restored;
  restored.accepted = {{{1, left, {0, 2}}, digest(1), "class"},
                       {{1, right, {0, 1}}, digest(1), "class"}};
  again.add(judged_plan(), restored);
  again.tell(FrameOpened{kJob, 1});
  EXPECT_EQ(again.only<JudgeTile>().tile, left);
  EXPECT_EQ(again.ask(kAnna).units[0], (core::Unit{1, right, {1, 1}}));
}

TEST_F(Rounds, AfterARestartWhatIsThereTellsWhatWasDecided) {
  const core::PixelRect left{0, 0, 32, 32};
  SchedulerBench again;
  again.join(kAnna);
  RestoredJob restored;
  // A batch of the last round: the tile was found to need it, twice.
  restored.accepted = {{{1, left, {0, 3}}, digest(1), "class"},
                       {{1, left, {4, 1}}, digest(1), "class"}};
  again.add(judged_plan(), restored);
  again.tell(FrameOpened{kJob, 1});
  EXPECT_TRUE(again.all<JudgeTile>().empty());
  std::vector<core::Unit> units;
  for (int i = 0; i < 4; ++i) {
    const Lease lease = again.ask(kAnna);
    if (lease.units[0].tile == left) units.push_back(lease.units[0]);
  }
  EXPECT_EQ(units, (std::vector<core::Unit>{{1, left, {3, 1}}, {1, left, {5, 1}}}));
}

TEST_F(Rounds, WhatAWorkerHasOfARoundIsNoProofThatItIsNeeded) {
  const core::PixelRect left{0, 0, 32, 32};
  SchedulerBench again;
  RestoredJob restored;
  restored.accepted = {{{1, left, {0, 2}}, digest(1), "class"}};
  again.add(judged_plan(), restored);
  again.join(kAnna);
  again.tell(FrameOpened{kJob, 1});
  const auto judge = again.only<JudgeTile>();
  const ResultArrived late{kAnna, {0, 7}, kJob, {1, left, {2, 1}}, digest(1), {}};
  again.tell(late);
  EXPECT_EQ(again.only<Reject>().reason, RejectReason::not_now) << "it may be needed";
  again.tell(TileJudged{kJob, 1, left, judge.serial, true});
  again.tell(late);
  EXPECT_EQ(again.only<Reject>().reason, RejectReason::unknown);
}

TEST_F(Rounds, TheNextFrameIsOpenedByWhatIsPlanned) {
  JobPlan plan = judged_plan();
  plan.frames = {1, 2, 3};
  plan.batches = 1000;
  plan.region = {0, 0, 32 * 40, 32};
  SchedulerBench other;
  other.join(kAnna);
  other.add(plan);
  EXPECT_EQ(other.all<OpenFrame>().size(), 1U);
  other.tell(FrameOpened{kJob, 1});
  EXPECT_TRUE(other.all<OpenFrame>().empty()) << "there is all of a first round to do";
}

/// A frame of one tile, judged after two batches and after four, that has its first round, of which
/// Bert has rendered the first batch wrongly.
class VoidedRounds : public testing::Test {
 protected:
  void SetUp() override {
    b.join(kBert);
    JobPlan plan = small_plan({1}, 8);
    plan.region = {0, 0, 32, 32};
    plan.rounds = {2, 4};
    b.add(plan);
    b.tell(FrameOpened{kJob, 1});
    bert_ = b.ask(kBert);
    ASSERT_EQ(bert_.units[0].batches, (core::BatchRange{0, 1}));
    b.deliver(bert_, 0, 2);  // wrong
    b.tell(Persisted{b.only<Persist>().id});
    b.join(kAnna);
    b.deliver_durably(b.ask(kAnna));
    judge_ = b.only<JudgeTile>();
  }
  /// Anna and Cora render what Bert has rendered, and agree.
  void find_bert_out() {
    for (const WorkerId worker : {kAnna, kCora}) {
      b.join(worker);
      Lease same = bert_;
      same.worker = worker;
      b.deliver(same, 0, 1);
      make_durable();
    }
  }
  void make_durable() {
    for (std::vector<Persist> left = b.all<Persist>(); !left.empty(); left = b.all<Persist>()) {
      for (const Persist& persist : left) {
        b.tell(Persisted{persist.id});
        if (!b.all<TileVoided>().empty()) voided_ = b.only<TileVoided>();
      }
    }
  }

  SchedulerBench b;
  Lease bert_;
  JudgeTile judge_;
  TileVoided voided_;
};

TEST_F(VoidedRounds, AnAnswerAboutFilmsThatAreVoidDoesNotCount) {
  find_bert_out();
  ASSERT_EQ(voided_.batches.size(), 2U);
  EXPECT_EQ(voided_.spared, 0U);
  b.tell(TileJudged{kJob, 1, judge_.tile, judge_.serial, true});
  EXPECT_TRUE(b.all<TileSpared>().empty());
  EXPECT_TRUE(b.all<FinishFrame>().empty());
  EXPECT_EQ(b.ask(kAnna).units[0].batches.first, 0U) << "it begins at its first round";
}

TEST_F(VoidedRounds, ATileThatHadEnoughIsJudgedAnew) {
  b.tell(TileJudged{kJob, 1, judge_.tile, judge_.serial, true});
  EXPECT_EQ(b.only<TileSpared>().batches, 2U);
  ASSERT_EQ(b.all<FinishFrame>().size(), 1U);
  find_bert_out();  // while the outputs are made
  b.tell(FinishDone{kJob, 1});
  EXPECT_EQ(b.all<FrameReopened>().size(), 1U);
  make_durable();
  EXPECT_EQ(voided_.spared, 6U);
  b.join(kDora);
  b.deliver_durably(b.ask(kDora));
  b.deliver_durably(b.ask(kDora));
  EXPECT_EQ(b.only<JudgeTile>().batches, 2U);
}

TEST_F(VoidedRounds, UnitsThatWrongFilmsHadAskedForAreTakenBack) {
  b.tell(TileJudged{kJob, 1, judge_.tile, judge_.serial, false});
  const Lease second = b.ask(kAnna);
  ASSERT_EQ(second.units[0].batches.first, 2U);
  find_bert_out();
  b.join(kDora);
  std::vector<uint32_t> begun;
  for (int i = 0; i < 2; ++i) {
    const Lease lease = b.ask(kDora);
    begun.push_back(lease.units[0].batches.first);
    b.deliver_durably(lease);
  }
  EXPECT_EQ(begun, (std::vector<uint32_t>{0, 1}));
  EXPECT_EQ(b.only<JudgeTile>().batches, 2U);
}

}  // namespace
}  // namespace hyades::coordinator
