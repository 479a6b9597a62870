#pragma once

#include <functional>
#include <map>
#include <memory>
#include <queue>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "coordinator/scheduler/scheduler.h"
#include "core/base/hash.h"
#include "tests/coordinator/scheduler/simulated_types.h"

namespace hyades::coordinator {

/// A small farm in which everything goes wrong: the real scheduler under a simulated network, clock
/// and store, driven by one seed. Messages are delayed, reordered, doubled and dropped; workers die
/// or lose the connection; the coordinator dies and comes back with what its store holds; the store
/// refuses; in half of the worlds it is the real film log with real films (SimulatedDisk), whose
/// disk fills, fails, and forgets what was not synced when the power goes, and films that are not
/// in memory lie on it beside the log (FilmsAside); some workers' films are wrong, others fail all;
/// units and finishing fail; jobs are paused and cancelled; the clock jumps. After a while the
/// faults end, and then every job must end too. Throws a std::string with what went wrong.
class SimulatedWorld {
 public:
  /// Films that left memory, of worlds with the real store.
  struct FilmsAsideSeen {
    uint64_t done = 0;         ///< set aside
    uint64_t at_start = 0;     ///< likewise, when the coordinator started
    uint64_t refused = 0;      ///< by the disk
    uint64_t asked_twice = 0;  ///< before the first answer
    uint64_t fetched = 0;
    uint64_t lost = 0;
    // What came while the film was aside.
    uint64_t results = 0;
    uint64_t voids = 0;  ///< of a tile
    uint64_t compactions = 0;
    uint64_t power_cuts = 0;
    uint64_t kills = 0;  ///< of the coordinator

    void add(const FilmsAsideSeen& other);
  };

  /// `cramped`: there is memory for next to no films, and jobs are paused all the time.
  explicit SimulatedWorld(uint64_t seed, bool cramped = false);

  /// Lives until all jobs have ended.
  void run();

  // What was seen, for the test's own accounts.
  uint64_t restarts = 0;
  uint64_t kills = 0;
  uint64_t frames_done = 0;
  uint64_t frames_failed = 0;
  uint64_t duplicates = 0;
  uint64_t adopted = 0;
  uint64_t copies_revoked = 0;
  uint64_t overlaps = 0;
  uint64_t frames_restarted = 0;
  uint64_t conflicts = 0;
  uint64_t quarantines = 0;
  uint64_t tiles_voided = 0;
  uint64_t frames_reopened = 0;
  uint64_t frames_suspected =
      0;                      ///< finished, with a part of a worker that was found divergent later
  uint64_t left_suspect = 0;  ///< ... after their job had ended
  uint64_t struck_out = 0;    ///< workers in quarantine because they failed unit after unit
  uint64_t frames_wrong = 0;  ///< finished before anybody compared
  uint64_t tiles_judged = 0;
  uint64_t tiles_spared = 0;
  // Of the real store.
  uint64_t films_replayed = 0;
  uint64_t power_cuts = 0;
  uint64_t failed_commits = 0;
  uint64_t refused = 0;  ///< appends
  uint64_t compactions = 0;
  FilmsAsideSeen aside;

 private:
  [[noreturn]] static void fail(const std::string& what) { throw what; }
  bool chance(double p) { return uniform() < p; }
  bool fault() { return now_ < faults_end_ && chance(fault_rate_); }
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  int number(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
  Duration delay() { return std::chrono::microseconds(number(100, fault() ? 4'000'000 : 50'000)); }
  void after(Duration d, std::function<void()> what) {
    events_.push({now_ + d, ++serial_, std::move(what)});
  }

  // simulated_world.cpp
  void make_job(JobId id);
  void start_coordinator();
  void crash_coordinator(bool power);
  void tell(const Event& event);
  /// Whether the coordinator takes nothing from the worker, because one before it had found it out.
  bool unwelcome(const ResultArrived& result);
  void tell_later(const Event& event);
  void check_audit();
  bool all_ended() const;

  // simulated_store.cpp
  static uint64_t value_of(int32_t frame, const core::PixelRect& tile, uint32_t batch);
  static UnitName name(const core::Unit& u) {
    return {u.frame, u.tile.x0, u.tile.y0, u.batches.first, u.batches.count};
  }
  SimFrame& frame_of(JobId job, int32_t frame) { return jobs_.at(job).frames.at(frame); }
  void add_to_film(SimJob& job, const AcceptedUnit& accepted, uint64_t generation);
  void act(const Persist& a);
  static std::pair<JobId, int32_t> frame_of(const Record& record);
  void store_later(const Persist& a);
  void stored(const Persist& a, bool refused);
  /// Whether a film of the tile is still on its way to the disk, or was said to be and nobody knows
  /// yet that it has arrived.
  bool stores_unit_of(const TileVoidedRecord& voided) const;
  void store(const Record& record);
  void store(const UnitRecord& unit);
  void store(const FrameFinishedRecord& done);
  void store(const FrameFailedRecord& failed);
  void store(const FrameRestartedRecord& again);
  void store(const TileVoidedRecord& voided);
  void store(const DisputeRecord& dispute);
  void store(const DivergentWorkerRecord& divergent);
  bool is_stored(JobId job, const core::Unit& unit) {
    return jobs_.at(job).stored_units.contains(name(unit));
  }
  void act(const Merge& a);
  void act(const JudgeTile& a);
  void act(const TileSpared&) { ++tiles_spared; }
  void act(const FrameRestarted& a);
  void act(const TileVoided& a);

  // simulated_log.cpp: the same with the real film log.
  void take_up(SimJob& job);
  void append(SimJob& job, const Persist& a);
  void commit_soon(SimJob& job, Duration delay);
  void commit(SimJob& job);
  void settle(SimJob& job, uint64_t durable);
  void compact(SimJob& job);
  void disks_fill();
  void check_disks();

  // simulated_frames.cpp
  /// The film that the frame must have in the end.
  static core::Film oracle_of(const SimJob& job, int32_t number);
  void act(const OpenFrame& a);
  void act(const FinishFrame& a);
  void act(const FrameDone& a);
  void act(const FrameFailed& a);
  void act(const JobEnded& a);
  void act(const Conflict&);
  void act(const Quarantine& a);
  void act(const Confirmed&) {}
  void act(const FrameReopened& a);
  void check_rows();

  // simulated_aside.cpp
  void act(const SetAside& a);
  void set_aside(SimJob& job, const SetAside& a, bool refuse);
  /// The job's film store does this after all that it was told to do before.
  void call(SimJob& job, std::function<void()> what);
  /// It does what it was told, until it has to tell something itself.
  void run_calls(SimJob& job);
  /// The frame's film is in memory, if there is one. Whether it could be had.
  bool fetch(SimJob& job, int32_t number);
  /// The frame's film is gone.
  static void forget_film(SimJob& job, SimFrame& frame, int32_t number);
  void tell_of_lost_films();
  void set_aside_at_start(SimJob& job);
  void check_room();

  // simulated_workers.cpp
  // The scheduler's number 0 is nobody's.
  static WorkerId id_of(size_t i) { return WorkerId{i + 1}; }
  static size_t index_of(WorkerId id) { return static_cast<size_t>(id) - 1; }
  template <class Do>
  void send(WorkerId id, Do what) {
    const size_t i = index_of(id);
    const int times = fault() ? number(0, 2) : 1;
    for (int t = 0; t < times; ++t) {
      after(delay(), [this, i, what, s = workers_[i].session] {
        SimWorker& w = workers_[i];
        if (w.session != s || !w.connected) return;
        what(w);
        ask(i);
      });
    }
  }
  void act(const Lease& a);
  void act(const Revoke& a);
  void act(const Acknowledge& a);
  void act(const Reject& a);
  void send_up(size_t i, const Event& event);
  void connect(size_t i);
  void heartbeat(size_t i, uint64_t session);
  void ask(size_t i);
  void take(SimWorker& w, const UnitHeld& unit);
  void rendered(size_t i, uint64_t order);
  void deliver(size_t i, const UnitHeld& held);
  static void drop(SimWorker& w, JobId job, const core::Unit& unit, const LeaseId& lease);

  // simulated_nature.cpp
  /// Deaths, cuts, and people at the controls.
  void nature();

  std::mt19937_64 random_;
  SchedulerOptions options_;
  double fault_rate_ = 0;
  TimePoint faults_end_;
  TimePoint now_;
  uint64_t serial_ = 0;
  uint64_t generation_ = 0;  ///< of coordinators
  bool corrupt_ = false;     ///< some workers' films are wrong
  bool broken_ = false;      ///< one worker fails everything
  bool choosy_ = false;      ///< jobs do not go to every worker
  bool real_store_ = false;  ///< the film log and films are the real ones
  bool cramped_ = false;     ///< few films have room in memory
  bool woken_ = false;       ///< a Tick is on its way
  bool restoring_ = false;   ///< not all jobs are known yet, nor what is said of them
  std::priority_queue<Happening> events_;
  std::unique_ptr<Scheduler> scheduler_;
  std::vector<SimWorker> workers_;
  std::map<JobId, SimJob> jobs_;
  std::map<std::pair<JobId, int32_t>, int> storing_;  ///< records on their way to the disk
  std::map<RecordId, AcceptedUnit> records_;          ///< of this coordinator
  std::set<std::pair<JobId, RecordId>> unsettled_;    ///< films on their way to the disk
  std::vector<std::pair<JobId, int32_t>> lost_;  ///< frames whose films are, before that is told
};

}  // namespace hyades::coordinator
