// Films of all jobs together have so much memory.
#include <numeric>

#include "tests/coordinator/scheduler/scheduler_testing.h"

namespace hyades::coordinator {
namespace {

using Bench = SchedulerBench;

constexpr JobId kOther{2};
constexpr JobId kThird{3};
constexpr WorkerId kChoosy{3};

class FilmRoom : public testing::Test {
 protected:
  static SchedulerOptions with_memory() {
    SchedulerOptions options;
    options.film_memory = 100;
    return options;
  }
  static JobPlan plan(uint64_t film_bytes, int32_t tiles = 1) {
    JobPlan plan = small_plan({1}, 1);
    plan.region = {0, 0, 32 * tiles, 32};
    plan.film_bytes = film_bytes;
    return plan;
  }
  void SetUp() override {
    b.join(kAnna);
    b.join(kBert);
  }
  void add(JobId job, const JobPlan& plan, RestoredJob restored = {}) {
    b.add(plan, std::move(restored), job);
    b.tell(FrameOpened{job, 1});
  }
  void expect_bert_waits() {
    b.tell(WorkRequested{kBert, 1});
    EXPECT_TRUE(b.all<Lease>().empty());
  }
  void expect_bert_gets(JobId job) {
    const Lease lease = b.only<Lease>();
    EXPECT_EQ(lease.worker, kBert);
    EXPECT_EQ(lease.job, job);
  }
  /// A job that is resumed while its film is still being set aside.
  void resume_before_the_film_is_aside() {
    add(kJob, plan(60, 2));
    b.deliver_durably(b.ask(kAnna));
    b.tell(JobPaused{kJob});
    tick();
    b.only<SetAside>();
    b.tell(JobResumed{kJob});
  }
  void tick() {
    b.now += std::chrono::seconds(1);
    b.tell(Tick{});
  }
  Bench b{with_memory()};
};

TEST_F(FilmRoom, AFrameBeginsWhenItsFilmFitsBesideTheOthers) {
  add(kJob, plan(60));
  add(kOther, plan(41));
  const Lease lease = b.ask(kAnna);
  expect_bert_waits();
  EXPECT_TRUE(b.scheduler.waits_for_film(kOther));
  EXPECT_FALSE(b.scheduler.waits_for_film(kJob));
  EXPECT_EQ(b.scheduler.films(), 60U);
  b.deliver_durably(lease);
  EXPECT_TRUE(b.all<Lease>().empty());
  b.tell(FinishDone{kJob, 1});
  EXPECT_TRUE(b.all<Lease>().empty()) << "the finished film is still there";
  b.tell(Persisted{b.only<Persist>().id});
  expect_bert_gets(kOther);
  EXPECT_EQ(b.scheduler.films(), 41U);
}

TEST_F(FilmRoom, FilmsThatFitAreInWorkTogether) {
  add(kJob, plan(60));
  add(kOther, plan(40));
  b.ask(kAnna);
  b.tell(WorkRequested{kBert, 1});
  expect_bert_gets(kOther);
}

TEST_F(FilmRoom, OneFrameIsAlwaysPossible) {
  add(kJob, plan(200));
  EXPECT_EQ(b.ask(kAnna).job, kJob);
}

TEST_F(FilmRoom, FilmsOfPausedJobsAreSetAside) {
  add(kJob, plan(60, 2));
  add(kOther, plan(60));
  const Lease lease = b.ask(kAnna);
  b.tell(JobPaused{kJob});
  expect_bert_waits();  // for what Anna still has
  tick();
  EXPECT_TRUE(b.all<SetAside>().empty());
  b.deliver_durably(lease);
  tick();
  EXPECT_EQ(b.only<SetAside>().frame, 1);
  EXPECT_EQ(b.scheduler.films(), 60U) << "until it is";
  b.tell(FilmSetAside{kJob, 1, true});
  expect_bert_gets(kOther);
  const Lease berts = b.only<Lease>();
  EXPECT_EQ(b.scheduler.films(), 60U);
  // Now it is the other that has to wait.
  b.tell(JobResumed{kJob});
  EXPECT_TRUE(b.scheduler.waits_for_film(kJob));
  b.deliver_durably(berts);
  b.tell(WorkRequested{kAnna, 1});
  b.tell(FinishDone{kOther, 1});
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_EQ(b.only<Lease>().job, kJob);
}

// They may stay so for ever, and all open jobs' are too many for a machine.
TEST_F(FilmRoom, FilmsOfPausedJobsLeaveThoughNobodyWaitsForRoom) {
  add(kJob, plan(60, 2));
  b.deliver_durably(b.ask(kAnna));
  b.tell(JobPaused{kJob});
  ASSERT_TRUE(b.scheduler.next_wake());
  EXPECT_LE(*b.scheduler.next_wake(), b.now);
  tick();
  EXPECT_EQ(b.only<SetAside>().job, kJob);
  b.tell(FilmSetAside{kJob, 1, true});
  EXPECT_EQ(b.scheduler.films(), 0U);
  tick();
  EXPECT_TRUE(b.said.empty());
}

// What a few begin and leave does not grow beyond what there is.
TEST_F(FilmRoom, FilmsThatNobodyWorksAtNeverTakeMoreThanThereIs) {
  JobPlan large = plan(90, 2);
  for (uint64_t job = 1; job <= 20; ++job) {
    large.needs.tags = {std::to_string(job)};  // each has a worker of its own
    b.tell(WorkerJoined{kChoosy, 1, "class", {}, large.needs.tags});
    add(JobId{job}, large);
    b.tell(WorkRequested{kChoosy, 1});
    for (int i = 0; i < 30 && b.all<Lease>().empty(); ++i) {
      tick();
      for (const SetAside& aside : b.all<SetAside>()) {
        b.tell(FilmSetAside{aside.job, aside.frame, true});
      }
    }
    ASSERT_EQ(b.only<Lease>().job, JobId{job});
    EXPECT_LE(b.scheduler.films(), 100U);
    b.deliver_durably(b.only<Lease>());
    if (job % 2 == 0) b.tell(JobPaused{JobId{job}});
    b.tell(WorkerLost{kChoosy});
  }
}

// A film that takes nearly all of the room, of a frame that renders for days.
TEST_F(FilmRoom, WhoeverHasMostOfItLetsOthersHaveTheirTurn) {
  JobPlan large = plan(99, 1000);
  large.owner = "eve";
  JobPlan small = plan(30, 1);
  small.owner = "ann";
  add(kJob, large);
  std::map<WorkerId, Lease> leases = {{kAnna, b.ask(kAnna)}, {kBert, b.ask(kBert)}};
  add(kOther, small);
  EXPECT_TRUE(b.scheduler.waits_for_film(kOther));
  int waited = 0;  // seconds
  std::vector<SetAside> aside;
  while (waited < 200 && aside.empty()) {
    tick();
    ++waited;
    aside = b.all<SetAside>();
    const WorkerId worker = waited % 2 == 0 ? kAnna : kBert;
    const auto lease = leases.extract(worker);
    if (lease.empty()) continue;
    b.deliver_durably(lease.mapped());
    b.tell(WorkRequested{worker, 1});
    for (const Lease& more : b.all<Lease>()) {
      ASSERT_EQ(more.job, kJob);
      leases.emplace(more.worker, more);
    }
  }
  ASSERT_EQ(aside.size(), 1U) << "the small job waits as long as the large one renders";
  EXPECT_GE(waited, 60) << "a large film has its turn too";
  EXPECT_LE(waited, 75);
  b.tell(FilmSetAside{kJob, 1, true});
  const Lease others = b.only<Lease>();
  EXPECT_EQ(others.job, kOther);
  b.deliver_durably(others);
  b.tell(FinishDone{kOther, 1});
  b.tell(Persisted{b.only<Persist>().id});
  EXPECT_EQ(b.ask(kAnna).job, kJob) << "the large one comes back";
}

TEST_F(FilmRoom, JobsWithoutWorkersHoldNobodyUp) {
  JobPlan choosy = plan(60, 2);
  choosy.needs.tags = {"gpu"};
  b.tell(WorkerJoined{kChoosy, 1, "class", {}, {"gpu"}});
  add(kJob, choosy);
  b.deliver_durably(b.ask(kChoosy));
  b.tell(WorkerLost{kChoosy});
  add(kOther, plan(60));
  expect_bert_waits();
  tick();
  EXPECT_TRUE(b.all<SetAside>().empty()) << "it may come back";
  b.now += std::chrono::seconds(10);
  tick();
  EXPECT_EQ(b.only<SetAside>().job, kJob);
  b.tell(FilmSetAside{kJob, 1, true});
  expect_bert_gets(kOther);
}

/// One that waits for somebody else to render it too would else want all the room, once it is
/// aside.
TEST_F(FilmRoom, AFrameThatIsAsideAndThatNobodyMayWorkAtHoldsNobodyUp) {
  b.tell(WorkerLost{kBert});
  JobPlan checked = plan(90);
  checked.redundancy = 100;
  add(kJob, checked);
  b.deliver_durably(b.ask(kAnna));
  JobPlan others = plan(30);
  others.frames = {1, 2};
  add(kOther, others);
  b.tell(FrameOpened{kOther, 2});
  b.tell(WorkRequested{kAnna, 1});
  EXPECT_TRUE(b.all<Lease>().empty());
  for (int i = 0; i < 12 && b.all<SetAside>().empty(); ++i) tick();
  b.tell(FilmSetAside{b.only<SetAside>().job, 1, true});
  EXPECT_EQ(b.only<Lease>().job, kOther);
  EXPECT_EQ(b.ask(kAnna).job, kOther) << "the other frame begins beside it";
}

TEST_F(FilmRoom, WhereFilmsCannotBeSetAsideThereIsALittleMoreRoom) {
  add(kJob, plan(60, 2));
  b.deliver_durably(b.ask(kAnna));
  b.tell(JobPaused{kJob});
  tick();
  b.tell(FilmSetAside{kJob, 1, false});
  add(kOther, plan(66));
  add(kThird, plan(65));
  expect_bert_waits();
  tick();
  EXPECT_TRUE(b.all<Lease>().empty());
  b.tell(JobCancelled{kOther});
  tick();
  expect_bert_gets(kThird);
  EXPECT_EQ(b.scheduler.films(), 125U);
  b.now += std::chrono::seconds(10);
  tick();
  EXPECT_EQ(b.only<SetAside>().job, kJob) << "it is tried again";
}

TEST_F(FilmRoom, AFilmThatIsNeededAgainStays) {
  resume_before_the_film_is_aside();
  EXPECT_EQ(b.ask(kAnna).job, kJob);
  b.tell(FilmSetAside{kJob, 1, true});
  EXPECT_EQ(b.scheduler.films(), 60U);
}

// There may be two questions at a time; each answer says what is.
TEST_F(FilmRoom, AFilmIsAskedForAgainBeforeTheFirstAnswer) {
  resume_before_the_film_is_aside();
  const Lease lease = b.ask(kAnna);
  b.tell(UnitReturned{kAnna, lease.lease, kJob, lease.units[0]});
  b.tell(JobPaused{kJob});
  tick();
  b.only<SetAside>();
  b.tell(FilmSetAside{kJob, 1, true});
  EXPECT_EQ(b.scheduler.films(), 0U);
  b.tell(JobResumed{kJob});
  b.ask(kAnna);
  EXPECT_EQ(b.scheduler.films(), 60U) << "it comes with the unit";
  b.tell(FilmSetAside{kJob, 1, true});
  EXPECT_EQ(b.scheduler.films(), 60U);
}

TEST_F(FilmRoom, FilmsFromBeforeARestartMayBeSetAsideAlready) {
  RestoredJob restored;
  restored.accepted.push_back({{1, {0, 0, 32, 32}, {0, 1}}, digest(1), "class"});
  restored.set_aside = {1};
  add(kJob, plan(60, 2), restored);
  EXPECT_EQ(b.scheduler.films(), 0U);
  EXPECT_EQ(b.ask(kAnna).units.at(0).tile.x0, 32);
  EXPECT_EQ(b.scheduler.films(), 60U);
}

RestoredJob all_of_it_aside() {
  RestoredJob restored;
  restored.accepted.push_back({{1, {0, 0, 32, 32}, {0, 1}}, digest(1), "class"});
  restored.set_aside = {1};
  return restored;
}

// Frames that were complete when the coordinator died, or failed and are retried, came into memory
// all together.
TEST_F(FilmRoom, CompleteFramesFromBeforeARestartAreFinishedWhenTheirFilmsHaveRoom) {
  b.add(plan(60), all_of_it_aside(), kJob);
  EXPECT_EQ(b.only<FinishFrame>().job, kJob);
  for (const JobId job : {kOther, kThird}) {
    b.add(plan(60), all_of_it_aside(), job);
    EXPECT_TRUE(b.all<FinishFrame>().empty());
  }
  EXPECT_EQ(b.scheduler.films(), 60U);
  EXPECT_TRUE(b.scheduler.waits_for_film(kOther));
  EXPECT_FALSE(b.scheduler.waits_for_film(kJob));
  tick();
  EXPECT_TRUE(b.all<FinishFrame>().empty());
  b.tell(JobCancelled{kOther});  // one that waits
  b.tell(JobCancelled{kJob});
  EXPECT_EQ(b.only<FinishFrame>().job, kThird);
  EXPECT_EQ(b.scheduler.films(), 60U);
}

TEST_F(FilmRoom, ACompleteFrameThatWaitsIsNotOvertaken) {
  add(kJob, plan(50));
  b.ask(kAnna);
  b.add(plan(60), all_of_it_aside(), kOther);
  EXPECT_TRUE(b.all<FinishFrame>().empty());
  add(kThird, plan(30));
  expect_bert_waits();
  b.tell(JobCancelled{kJob});
  EXPECT_EQ(b.only<FinishFrame>().job, kOther);
  expect_bert_gets(kThird);
}

TEST_F(FilmRoom, TilesFromBeforeARestartAreJudgedWhenTheirFilmHasRoom) {
  add(kJob, plan(60));
  b.ask(kAnna);
  JobPlan judged = plan(60);
  judged.batches = 4;
  judged.rounds = {1, 2};
  add(kOther, judged, all_of_it_aside());
  EXPECT_TRUE(b.all<JudgeTile>().empty());
  EXPECT_EQ(b.scheduler.films(), 60U);
  b.tell(JobCancelled{kJob});
  EXPECT_EQ(b.only<JudgeTile>().job, kOther);
  EXPECT_EQ(b.scheduler.films(), 60U);
}

TEST_F(FilmRoom, RecordsOfACancelledJobThatNobodyAnswersHoldNobodyUp) {
  add(kJob, plan(90));
  b.deliver(b.ask(kAnna));
  const RecordId film = b.only<Persist>().id;
  add(kOther, plan(60, 2));
  expect_bert_waits();  // for the film on its way to the disk
  // Its store ends before it has begun.
  b.tell(JobCancelled{kJob});
  expect_bert_gets(kOther);
  // Should an answer come after all, nothing follows from it.
  b.tell(PersistFailed{film, "disk full"});
  EXPECT_TRUE(b.said.empty());
  EXPECT_EQ(b.ask(kAnna).job, kOther) << "work is not held back for it";
}

TEST_F(FilmRoom, SmallFilmsDoNotOvertakeForEver) {
  add(kJob, plan(60));
  add(kOther, plan(60));
  add(kThird, plan(10));
  b.ask(kAnna);
  expect_bert_waits();
  b.tell(JobCancelled{kJob});
  expect_bert_gets(kOther);
}

// Who has filled the memory with his own films waits for himself alone.
TEST_F(FilmRoom, WhoHasTakenMostOfTheRoomHoldsUpNobodyElse) {
  JobPlan hog = plan(60);
  hog.owner = "mal";
  JobPlan small = plan(10);
  small.owner = "vic";
  add(kJob, hog);
  const Lease lease = b.ask(kAnna);
  b.deliver_durably(lease);  // now it is being finished
  add(kOther, hog);
  add(kThird, small);
  b.tell(WorkRequested{kBert, 1});
  expect_bert_gets(kThird);
}

// A worker may keep what it has rendered, and deliver it when the frames' films have been set
// aside.
TEST_F(FilmRoom, LateResultsBringFilmsIntoMemoryAsThereIsRoom) {
  for (const JobId job : {kJob, kOther, kThird}) add(job, plan(60, 2), all_of_it_aside());
  const auto deliver_late = [&](JobId job) {
    b.tell(ResultArrived{kAnna, {7}, job, {1, {32, 0, 64, 32}, {0, 1}}, digest(1)});
  };
  deliver_late(kJob);
  EXPECT_EQ(b.all<Persist>().size(), 1U);
  for (const JobId job : {kOther, kThird}) {
    deliver_late(job);
    EXPECT_TRUE(b.all<Persist>().empty());
    EXPECT_EQ(b.only<Reject>().reason, RejectReason::not_now);
    EXPECT_EQ(b.scheduler.films(), 60U);
  }
  b.tell(JobCancelled{kJob});
  deliver_late(kThird);
  EXPECT_EQ(b.all<Persist>().size(), 1U);
  EXPECT_EQ(b.scheduler.films(), 60U);
}

TEST_F(FilmRoom, UnitsInHandBringFilmsIntoMemoryAsThereIsRoom) {
  std::vector<UnitInHand> in_hand;
  for (const JobId job : {kJob, kOther, kThird}) {
    add(job, plan(60, 2), all_of_it_aside());
    in_hand.push_back({{in_hand.size() + 1}, job, {1, {32, 0, 64, 32}, {0, 1}}});
  }
  b.join(kChoosy, in_hand);
  EXPECT_EQ(b.only<Lease>().job, kJob);
  EXPECT_EQ(b.all<Revoke>().size(), 2U);
  EXPECT_EQ(b.scheduler.films(), 60U);
}

/// Three workers that render a unit a second each, and a disk that takes no time.
class CrowdedFilms : public FilmRoom {
 protected:
  void SetUp() override {
    FilmRoom::SetUp();
    b.join(kChoosy);
  }
  static JobPlan of(const std::string& owner, uint64_t film_bytes, int32_t tiles) {
    JobPlan job = plan(film_bytes, tiles);
    job.owner = owner;
    return job;
  }
  void add(JobId job, JobPlan plan) { tell(JobAdded{job, std::move(plan), {}}); }
  /// How many units of each job were leased meanwhile.
  std::map<JobId, int> work(int seconds) {
    units_.clear();
    for (int second = 0; second < seconds; ++second) {
      b.now += std::chrono::seconds(1);
      tell(Tick{});
      for (const Lease& lease : std::exchange(leases_, {})) {
        tell(ResultArrived{lease.worker, lease.lease, lease.job, lease.units.at(0), digest(1),
                           std::chrono::seconds(1)});
        tell(WorkRequested{lease.worker, 1});
      }
      for (const WorkerId worker : std::exchange(idle_, {})) tell(WorkRequested{worker, 1});
      EXPECT_LE(b.scheduler.films(), 100U);
    }
    return units_;
  }

  void tell(const Event& event) {
    for (const Action& said : b.tell(event)) {
      if (const auto* lease = std::get_if<Lease>(&said)) {
        leases_.push_back(*lease);
        ++units_[lease->job];
      } else if (const auto* open = std::get_if<OpenFrame>(&said)) {
        tell(FrameOpened{open->job, open->frame});
      } else if (const auto* persist = std::get_if<Persist>(&said)) {
        tell(Persisted{persist->id});
      } else if (const auto* finish = std::get_if<FinishFrame>(&said)) {
        tell(FinishDone{finish->job, finish->frame});
      } else if (const auto* aside = std::get_if<SetAside>(&said)) {
        tell(FilmSetAside{aside->job, aside->frame, true});
      }
    }
  }

  /// A film waits beside a larger one, while another owner's small frames begin and end.
  std::map<JobId, int> work_beside_small_frames() {
    add(kJob, of("eve", 60, 1000));
    work(1);
    JobPlan small = of("cat", 1, 1);
    small.frames.resize(1000);
    std::iota(small.frames.begin(), small.frames.end(), 1);
    add(kThird, small);
    add(kOther, of("vic", 49, 1000));
    return work(120);
  }

 private:
  std::vector<Lease> leases_;
  std::vector<WorkerId> idle_ = {kAnna, kBert, kChoosy};
  std::map<JobId, int> units_;
};

// Workers stay with a scene for twenty seconds.
TEST_F(CrowdedFilms, AFrameThatWaitsForItsTurnHoldsUpNoneThatLeavesItsRoom) {
  add(kJob, of("eve", 47, 1000));
  work(1);
  add(kOther, of("dan", 73, 1000));
  add(kThird, of("cat", 5, 1000));
  auto units = work(60);
  EXPECT_GT(units[kThird], 20);
  EXPECT_EQ(units[kOther], 0);
  units = work(60);
  EXPECT_GT(units[kOther], 10) << "its turn comes though nobody has more than half";
  EXPECT_GT(units[kThird], 20);
  units = work(300);
  for (const JobId job : {kJob, kOther, kThird}) {
    EXPECT_GT(units[job], 50) << static_cast<uint64_t>(job);
  }
}

TEST_F(CrowdedFilms, WhoWaitsForHisOwnFilmsHoldsUpNobodyElse) {
  add(kJob, of("eve", 47, 1000));
  work(1);
  JobPlan urgent = of("eve", 73, 1000);
  urgent.priority = 10;
  add(kOther, urgent);
  add(kThird, of("cat", 50, 1000));
  EXPECT_GT(work(60)[kThird], 20);
}

TEST_F(CrowdedFilms, SmallFramesPutNobodysTurnOff) {
  const auto units = work_beside_small_frames();
  EXPECT_GT(units.at(kThird), 3);
  EXPECT_TRUE(units.contains(kOther)) << "others' small frames begin and end all the time";
}

// With one worker all owners have nothing out whenever it asks.
TEST_F(CrowdedFilms, OneWorkerGivesEverybodyHisTurn) {
  tell(WorkerLost{kBert});
  tell(WorkerLost{kChoosy});
  const auto units = work_beside_small_frames();
  EXPECT_TRUE(units.contains(kThird));
  EXPECT_TRUE(units.contains(kOther));
}

TEST_F(FilmRoom, FilmsFromBeforeARestartTakeRoom) {
  RestoredJob restored;
  restored.accepted.push_back({{1, {0, 0, 32, 32}, {0, 1}}, digest(1), "class"});
  add(kJob, plan(60, 2), restored);
  add(kOther, plan(60));
  EXPECT_EQ(b.scheduler.films(), 60U);
  EXPECT_EQ(b.ask(kAnna).job, kJob);
  expect_bert_waits();
}

TEST_F(FilmRoom, AFrameThatFailsLeavesItsRoom) {
  JobPlan broken = plan(60);
  broken.max_attempts = 1;
  add(kJob, broken);
  add(kOther, plan(60));
  const Lease lease = b.ask(kAnna);
  expect_bert_waits();
  b.tell(UnitFailed{kAnna, lease.lease, kJob, lease.units[0], "a NaN"});
  EXPECT_TRUE(b.all<Lease>().empty());
  b.tell(Persisted{b.only<Persist>().id});
  expect_bert_gets(kOther);
}

}  // namespace
}  // namespace hyades::coordinator
