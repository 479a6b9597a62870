#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "coordinator/scheduler/actions.h"
#include "coordinator/scheduler/events.h"
#include "coordinator/scheduler/job_state.h"

namespace hyades::coordinator {

/// How the scheduler behaves towards every job.
struct SchedulerOptions {
  uint64_t incarnation = 1;  ///< greater after every restart
  /// A lease that is not renewed for this long is taken back.
  Duration lease_time = std::chrono::seconds(60);
  /// What rendering one unit shall take one thread: runs of batches are as long as that needs.
  Duration unit_time = std::chrono::milliseconds(500);
  /// Idle workers get a copy of a unit that has been out for this long, and sooner where it should
  /// have taken much less; 0: no copies.
  Duration copy_after = std::chrono::seconds(5);
  /// A frame whose class of workers has been gone for this long begins again with another; 0:
  /// never.
  Duration class_patience{0};
  /// A worker stays with scenes that it has loaded for this long though another job or frame would
  /// be in turn; 0: never.
  Duration affinity_time = std::chrono::seconds(20);
  /// What loading a scene is taken to take until films have shown it; 0: it takes no time (all
  /// workers are threads of one machine), and never shows.
  Duration scene_time = std::chrono::seconds(3);
  /// So many units that a worker has failed one after the other and others then rendered put it
  /// into quarantine.
  uint32_t max_strikes = 5;
  /// Bytes that films of frames in work may take together; a frame begins (gets its first unit)
  /// when its own fits, or nothing else is in work.
  uint64_t film_memory = UINT64_MAX;
  /// Nothing is leased for this long after something could not be made durable.
  Duration storage_retry = std::chrono::seconds(1);
};

/// Who renders what (invariants 3 and 5): a deterministic state machine. Events and a clock in,
/// actions out; no input or output, no threads, no clock of its own. The same machine serves the
/// coordinator, the single machine and the simulator. Not thread-safe.
class Scheduler {
 public:
  explicit Scheduler(SchedulerOptions options);

  /// What follows from `event` at time `now` (which never goes back). The caller carries the
  /// actions out in order.
  std::vector<Action> handle(const Event& event, TimePoint now);

  /// When a Tick is needed at the latest, if nothing else happens before.
  std::optional<TimePoint> next_wake() const;

  /// How many units of the job are out with workers.
  uint32_t leased_units(JobId job) const;
  /// How many units the worker has.
  uint32_t leased_units(WorkerId worker) const;

  /// What the worker has under the lease; nothing where it has no such lease.
  std::vector<UnitInHand> units_of(WorkerId worker, const LeaseId& lease) const;

  /// All that the worker has.
  std::vector<UnitInHand> units_of(WorkerId worker) const;
  /// What is out of the job, and with whom.
  std::vector<std::pair<WorkerId, UnitInHand>> units_of(JobId job) const;

  /// How many units of the job, rendered differently by two workers, wait for one who has not
  /// rendered them.
  uint32_t disputed_units(JobId job) const;

  /// Bytes of the films of all frames that have begun and are not over.
  uint64_t films() const { return films_; }
  /// Whether a frame of the job could begin if there were more room for films.
  bool waits_for_film(JobId job) const;

  /// What is wrong with the books, or nothing. Slow; for tests and audits.
  std::string audit() const;

 private:
  using Scene = std::pair<JobId, int32_t>;  ///< a job's frame
  struct Loading {
    Scene scene;
    TimePoint since;
    bool alone = false;  ///< the worker had nothing else to do
  };
  struct Worker {
    uint32_t threads = 1;
    uint32_t worker_class = 0;
    std::vector<uint32_t> tags;      ///< interned, sorted
    uint64_t memory = 0;             ///< 0: no limit
    std::vector<Scene> scenes;       ///< that it should have in memory, the latest last
    std::optional<Scene> home;       ///< what it renders: one of the frame's crew
    std::optional<Scene> next;       ///< ... and will render then; it has a unit of it already
    std::optional<Loading> loading;  ///< what it last began with, until the first film
    TimePoint in_turn;               ///< when it last got what was in turn
    uint32_t wanted = 0;             ///< units it asked for and did not get yet
    uint64_t waiting = 0;            ///< its key in waiting_, or 0
    bool barred = false;             ///< gets nothing
    std::vector<uint64_t> leases;
  };
  /// A frame to get units of.
  struct Place {
    JobState* job = nullptr;
    uint32_t slot = 0;
    Scene scene() const { return {job->id, job->slots[slot].frame}; }
  };
  /// What a worker could not render and others could, without a unit of its own between.
  struct Strikes {
    uint32_t count = 0;
    std::string reason;  ///< of the last
  };
  struct LeaseState {
    WorkerId worker{};
    JobId job{};
    uint32_t slot = 0;
    std::vector<Extent> units;  ///< still out
    TimePoint deadline;
  };
  struct Waiter {
    WorkerId worker{};
    LeaseId lease;
  };
  struct Pending {
    Record record;
    Extent extent;                ///< of a unit record
    std::vector<Waiter> waiters;  ///< who waits for its acknowledgement
  };
  /// All jobs of one owner at one priority.
  struct Share {
    int priority = 0;
    std::string owner;
    uint64_t running = 0;                 ///< leased units
    std::map<uint64_t, JobState*> ready;  ///< jobs that have work, by serial
  };
  struct CopyCandidate {
    TimePoint since;
    uint64_t serial = 0;
    JobId job{};
    uint32_t slot = 0;
    Extent extent;
  };
  /// Highest priority first, then who has least, then by age.
  using ShareOrder = std::tuple<int, uint64_t, uint32_t>;

  // jobs.cpp: jobs, and owners' turns.
  void on(const JobAdded& e);
  void on(const JobPaused& e);
  void on(const JobResumed& e);
  void on(const JobCancelled& e);
  void on(const JobReprioritised& e);
  void on(const FramesRetried& e);
  void on(const FramesDoubted& e);
  void restore(JobState& job, const RestoredJob& restored);
  void end_job_if_over(JobState& job);
  uint32_t share_of(int priority, const std::string& owner);
  void set_running(JobState& job, int64_t change);
  void update_ready(JobState& job);
  void list_ready(JobState& job, bool ready);

  // frames.cpp: frames.
  void on(const FrameOpened& e);
  void on(const FrameRefused& e);
  void on(const FinishDone& e);
  void on(const FinishFailed& e);
  void open_frames(JobState& job);
  void complete_if_so(JobState& job, FrameSlot& slot);
  void finish(JobState& job, FrameSlot& slot);
  void fail_frame(JobState& job, FrameSlot& slot, std::string reason);
  void take_back_frame(JobState& job, FrameSlot& slot);
  void restart_frame(JobState& job, FrameSlot& slot);
  void restart_waiting(JobState& job, uint32_t slot);
  void frame_restarted(JobState& job, FrameSlot& slot);
  void restart_orphans();
  void frame_over(JobState& job, FrameSlot& slot, FramePhase phase);

  // workers.cpp: workers that come and go.
  void on(const WorkerJoined& e);
  void on(const WorkRequested& e);
  void on(const LeasingHeld& e);
  void on(const WorkerAlive& e);
  void on(const WorkerBarred& e);
  void on(const WorkerLost& e);
  void on(const WorkerForgotten& e);
  void on(const Tick& e);
  void adopt(WorkerId id, Worker& worker, const UnitInHand& held);
  void count_class(uint32_t worker_class, int change);
  void set_waiting(WorkerId id, Worker& worker);
  void serve(WorkerId id, Worker& worker, bool copies);
  void dispatch();

  // granting.cpp: which unit a worker gets.
  bool grant(WorkerId id, Worker& worker);
  static bool suits(const JobState& job, const Worker& worker);
  bool has_work_for(const JobState& job, const FrameSlot& slot, WorkerId id,
                    const Worker& worker) const;
  std::optional<Place> in_turn(WorkerId id, const Worker& worker, bool fresh);
  std::optional<uint32_t> find_pass(const JobState& job, WorkerId id, const Worker& worker,
                                    bool begun) const;
  bool grant_from(const Place& place, WorkerId id, Worker& worker, bool ahead);
  static double batch_seconds(const JobState& job, uint32_t tile);
  uint32_t run_length_of(const JobState& job, const FrameState& books, uint32_t tile) const;
  bool may_try(const JobState& job, WorkerId id, const Worker& worker,
               const std::vector<WorkerId>& blamed) const;
  bool anybody_besides(const std::vector<WorkerId>& tried, const JobState& job,
                       uint32_t worker_class) const;

  // copies.cpp: second copies of units that are late.
  bool grant_copy(WorkerId id, Worker& worker);
  TimePoint first_copy(const CopyCandidate& candidate) const;
  double late_after(const JobState& job, const Extent& extent) const;
  void note_copy_candidate(const JobState& job, uint32_t slot, const Assignment& assignment);
  Assignment* live_copy_candidate(const CopyCandidate& c);

  // scenes.cpp: which scenes workers have, and which frames they go to.
  static bool has_scene(const Worker& worker, const Scene& scene);
  static void remember_scene(Worker& worker, const Scene& scene, bool ahead);
  void settle(Worker& worker, const std::optional<Scene>& scene);
  void come_next(Worker& worker, const std::optional<Scene>& scene);
  FrameSlot* slot_of(const std::optional<Scene>& scene);
  double load_seconds(const JobState& job) const;
  double seconds_left(const Place& place, uint64_t threads) const;
  bool crowded(const Place& place, const Worker& worker) const;
  bool has_room(const Place& place) const;
  bool too_late(const Place& place, const Worker& worker) const;
  bool nearly_leased(const Place& place) const;
  bool still_loads(const Worker& worker) const;
  std::optional<Place> find_loaded(WorkerId id, const Worker& worker, const JobState& first,
                                   bool loads);
  void learn_load(JobState& job, Worker& worker, const ResultArrived& e);

  // film_room.cpp: films in memory.
  void take_film(const JobState& job, FrameSlot& slot);
  void drop_film(const JobState& job, FrameSlot& slot);
  bool film_fits(const JobState& job, const FrameSlot& slot) const;
  bool any_film_in_work() const;
  void serve_those_without_film();

  // leasing.cpp: leases.
  void new_lease(WorkerId id, Worker& worker, JobState& job, uint32_t slot, bool adopted,
                 std::vector<Extent> extents);
  void expire_leases();
  void release_lease(uint64_t number, bool revoke, bool expired = false);
  void drop_from_lease(const LeaseId& id, const Extent& e);
  void leave_job(JobState& job, WorkerId worker);
  bool may_join(const JobState& job, WorkerId id, const Worker& worker) const;

  // results.cpp: films, and what is durable.
  void on(const ResultArrived& e);
  void on(const UnitReturned& e);
  void on(const UnitFailed& e);
  void on(const Persisted& e);
  void on(const PersistFailed& e);
  void unit_persisted(const UnitRecord& record, const Pending& pending, RecordId id);
  void accept(JobState& job, FrameSlot& slot, const Extent& extent, const ResultArrived& e);
  void end_unit(JobState& job, FrameSlot& slot, const Extent& part, const LeaseId& lease);
  bool hopeless(const JobState& job, const FrameSlot& slot, const Extent& extent);
  void forgive_and_blame(JobState& job, FrameSlot& slot, const Extent& extent, WorkerId worker);
  void learn_cost(JobState& job, const Extent& extent, Duration render_time);
  void persist(Record record, Pending pending);
  void retry_persisting();

  // conflicts.cpp: renderings that differ.
  bool weigh(JobState& job, FrameSlot& slot, const Extent& extent, const ResultArrived& e);
  void decide(JobState& job, FrameSlot& slot, const Dispute& dispute, const ResultArrived& e);
  bool grant_check(JobState& job, uint32_t slot, WorkerId id, Worker& worker,
                   const MayTry& may_try);
  void confirm(const JobState& job, const FrameSlot& slot, WorkerId worker);
  bool quarantine(WorkerId id, const std::string& reason);
  void doubt_films_of(WorkerId id);
  void doubt_frame(JobState& job, FrameSlot& slot);
  void void_doubted(JobState& job, FrameSlot& slot);
  void tile_voided(const TileVoidedRecord& record);
  bool still_wanted(const Record& record);
  void mark_disputed(JobState& job);
  void dispute_marked(JobState& job, bool open);
  void end_marks();
  static bool has_dispute(const JobState& job);
  bool any_in_doubt() const;
  void reopen_frame(JobState& job, FrameSlot& slot);

  // scheduler.cpp: shared.
  JobState* find_job(JobId id);
  Worker* find_worker(WorkerId id);
  std::optional<Extent> extent_of(const JobState& job, const core::Unit& unit) const;
  core::Unit unit_of(const JobState& job, const FrameSlot& slot, const Extent& extent) const;
  uint32_t intern_class(const std::string& name);
  std::vector<uint32_t> intern_tags(const std::vector<std::string>& tags);
  bool anybody_for(const JobState& job, uint32_t worker_class) const;
  LeaseState* find_lease(const LeaseId& id);
  void say(Action action) { actions_.push_back(std::move(action)); }

  const SchedulerOptions options_;
  TimePoint now_;
  std::vector<Action> actions_;

  std::map<JobId, std::unique_ptr<JobState>> jobs_;
  uint64_t next_job_serial_ = 1;
  std::vector<Share> shares_;
  std::map<std::pair<int, std::string>, uint32_t> share_index_;
  std::set<ShareOrder> ready_shares_;

  std::unordered_map<WorkerId, Worker> workers_;  ///< looked up; walked only where order is nothing
  std::set<WorkerId> quarantined_;                ///< by what they did; stays when they go and come
  std::set<JobId> marked_;                        ///< jobs with a mark of a dispute
  uint32_t odd_records_ = 0;                      ///< WorkerOddRecords that are not durable yet
  bool distrust_restored_ = false;                ///< a dispute was open before the restart
  std::map<WorkerId, Strikes> strikes_;           ///< of those that failed last
  std::map<uint64_t, WorkerId> waiting_;          ///< those with a wish, longest waiting first
  uint64_t next_waiting_ = 1;
  bool work_appeared_ = false;           ///< since the waiting were last served
  uint64_t films_ = 0;                   ///< bytes of all films in memory
  mutable bool film_refused_ = false;    ///< somebody went without, as a film did not fit
  bool turned_away_ = false;             ///< somebody, by too_late(): to be looked at again
  double load_seconds_ = -1;             ///< to load a scene, of any job; -1: not known
  uint64_t threads_ = 0;                 ///< of all workers
  uint64_t offered_ = 0;                 ///< JobState::offer of all jobs
  std::vector<uint32_t> class_workers_;  ///< how many of each class may get units
  std::vector<TimePoint> class_gone_;    ///< since when there are none
  TimePoint next_orphan_check_;
  std::map<std::string, uint32_t, std::less<>> class_index_;
  std::vector<std::string> class_names_;
  std::map<std::string, uint32_t, std::less<>> tag_index_;

  std::unordered_map<uint64_t, LeaseState> leases_;  ///< by number; looked up, never walked
  uint64_t next_lease_ = 1;
  uint64_t next_assignment_ = 1;
  /// When to look at which lease; renewed ones are put back when their turn comes.
  std::priority_queue<std::pair<TimePoint, uint64_t>, std::vector<std::pair<TimePoint, uint64_t>>,
                      std::greater<>>
      deadlines_;
  std::deque<CopyCandidate> copy_candidates_;  ///< oldest first
  size_t copy_candidates_checked_ = 64;        ///< length at which stale ones are swept out
  TimePoint next_copy_round_;                  ///< when the waiting are offered copies again

  std::map<RecordId, Pending> pending_;
  uint64_t next_record_ = 1;
  std::vector<RecordId> to_persist_again_;
  bool may_lease() const { return !leasing_held_ && now_ >= storage_blocked_until_; }
  TimePoint storage_blocked_until_;
  bool leasing_held_ = false;
};

}  // namespace hyades::coordinator
