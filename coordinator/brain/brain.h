#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <unordered_set>
#include <vector>

#include "coordinator/brain/job_desk.h"
#include "coordinator/brain/worker_link.h"
#include "coordinator/scheduler/scheduler.h"
#include "coordinator/state/job_store.h"
#include "coordinator/store/disk_room.h"
#include "farm/content_store.h"
#include "hyades/v1/farm.pb.h"
#include "hyades/v1/jobs.pb.h"
#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {

/// Half of the machine's memory, in bytes; all there can be where that is not known.
uint64_t default_film_memory();

struct BrainOptions {
  std::string folder;                            ///< where all state lies; made if it is missing
  std::string finisher;                          ///< the program hyades-film
  Duration unit_time = std::chrono::seconds(5);  ///< of one thread for one unit
  Duration lease_time = std::chrono::seconds(30);
  Duration copy_after = std::chrono::seconds(10);
  /// A frame whose class of workers has been gone for this long begins again with another.
  Duration class_patience = std::chrono::minutes(5);
  /// A worker whose stream has ended is lost if it has not come again after this.
  Duration reconnect_time = std::chrono::seconds(3);
  DiskLimits disk;
  /// Files that no job needs any more stay for so long after they were last used.
  Duration asset_grace = std::chrono::hours(1);
  /// After a restart no new units are leased for this long, so that workers can say what they hold;
  /// longer, up to four times this, while those who hold something still come. By default the
  /// longest wait of a worker (farm/backoff.h), and what connecting takes.
  Duration adoption_time = std::chrono::seconds(5);
  /// A lease whose rendering makes no progress is not renewed any more after this; where the worker
  /// loads or waits, after six times this.
  Duration stall_time = std::chrono::minutes(10);
  /// Bytes that the film of a frame may take in memory; jobs of larger ones are refused.
  uint64_t film_memory = default_film_memory();
  /// A job's film log is rewritten when it has grown by this much.
  uint64_t compact_bytes = LocalLog{}.compact_bytes;
};

/// The coordinator without its network: the scheduler, and everything that happens because of it.
///
/// One lock guards the scheduler and all books; every event is handled and its messages are queued
/// under it, so that what workers are told has one order. Nothing slow happens under it: films are
/// decoded before (by the thread that received them), made durable and merged by each job's
/// FilmKeeper, finished by a process; what touches the disk is done by the chores' thread.
/// Thread-safe.
class Brain {
 public:
  /// Opens the folder and takes up all jobs that have not ended. An error where another process has
  /// it, or it was written by a newer version. A job whose files are gone fails alone.
  static core::Result<std::unique_ptr<Brain>> open(const BrainOptions& options);

  /// Stops at once: all that was promised is durable.
  ~Brain();
  /// Ends all workers' streams, and starts nothing more. Before the server ends.
  void stop();
  Brain(const Brain&) = delete;
  Brain& operator=(const Brain&) = delete;

  // Workers (brain_attach.cpp, brain_work.cpp, brain_heartbeat.cpp).

  /// A worker's stream begins; `link` gets the Welcome. An older stream of the same worker is
  /// closed, unless it is another process' that still speaks: ALREADY_EXISTS then. INVALID_ARGUMENT
  /// for a Hello that makes no sense.
  grpc::Status attach(const v1::Hello& hello, const std::shared_ptr<WorkerLink>& link,
                      WorkerId& worker);
  /// What came on the stream; what comes on one that is not the worker's newest is ignored.
  void receive(WorkerId worker, const WorkerLink* link, const v1::WorkerMessage& message);
  /// The stream has ended.
  void detach(WorkerId worker, const WorkerLink* link);

  // Jobs (brain_jobs.cpp, brain_queries.cpp). Errors as docs/wire.md has them.

  grpc::Status submit(const v1::SubmitRequest& request, v1::SubmitResponse& response);
  grpc::Status list(const v1::ListJobsRequest& request, v1::ListJobsResponse& response);
  /// The job, and its frames above `after` as far as they fit.
  grpc::Status get(uint64_t job, std::optional<int32_t> after, v1::GetJobResponse& response);
  grpc::Status pause(uint64_t job, v1::Job& now);
  grpc::Status resume(uint64_t job, v1::Job& now);
  grpc::Status cancel(uint64_t job, v1::Job& now);
  grpc::Status retry(uint64_t job, v1::Job& now);
  grpc::Status set_priority(uint64_t job, int priority, v1::Job& now);
  grpc::Status remove(uint64_t job);
  grpc::Status explain(uint64_t job, v1::ExplainResponse& response);
  using FilmTaker = std::function<void(const grpc::Status&, const core::FilmInfo&,
                                       std::shared_ptr<const core::Film>)>;
  /// A copy of the frame's film as it is now, or, where films are kept, was in the end; given to
  /// `then`, perhaps by another thread.
  grpc::Status film(uint64_t job, int32_t frame, FilmTaker then);
  /// How far somebody has been told of a job's changes; at first of nothing.
  struct ToldOf {
    uint64_t version = 0;          ///< of the job: of all changes up to this one
    uint64_t next_version = 0;     ///< while they do not fit into one event, and
    std::optional<int32_t> after;  ///< the last frame that did
    bool over = false;             ///< what is told is how the job has ended
  };
  /// What has changed since, as far as it fits. `ended`: there will be no other changes.
  grpc::Status changes(uint64_t job, ToldOf& told, v1::WatchEvent& event, bool& ended);
  /// Calls `poke` (quickly, by another thread) whenever the job has changed, until unwatch.
  uint64_t watch(uint64_t job, std::function<void()> poke);
  void unwatch(uint64_t number);

  // The disk (brain_disk.cpp).

  /// Whether `bytes` more may be stored, or (0) something new may begin: OK, or RESOURCE_EXHAUSTED
  /// with the reason.
  grpc::Status admit(uint64_t bytes);
  /// Even what was begun has to wait.
  bool disk_is_full() const { return disk_full_; }

  // Farm (brain_farm.cpp).

  void info(v1::InfoResponse& response);
  void workers(v1::WorkersResponse& response);
  grpc::Status drain_worker(const v1::WorkerRequest& request, v1::Worker& now);
  grpc::Status quarantine_worker(const v1::WorkerRequest& request, v1::Worker& now);
  grpc::Status release_worker(const v1::WorkerRequest& request, v1::Worker& now);

  farm::ContentStore& assets() { return *assets_; }
  JobStore& store() { return *store_; }
  std::string output_folder(uint64_t job) const;
  std::string films_folder(uint64_t job) const;

 private:
  /// How far a lease was when the worker last told, and for how long that is so.
  struct Pulse {
    v1::LeaseProgress::Stage stage = v1::LeaseProgress::STAGE_UNSPECIFIED;
    uint64_t samples_done = 0;
    Duration still{0};
  };
  struct Seat {
    WorkerId id{};
    v1::Hello hello;  ///< without what is in hand
    std::shared_ptr<WorkerLink> link;
    std::set<JobId> briefed;  ///< jobs that this stream knows
    v1::WorkerState state = v1::WORKER_STATE_ACTIVE;
    std::string reason;
    TimePoint heard;
    TimePoint beat;                   ///< the last heartbeat
    std::map<LeaseId, Pulse> pulses;  ///< as of then
    std::optional<TimePoint>
        twin_came;                     ///< another process with the same id, while this one is here
    std::optional<TimePoint> lost_at;  ///< its stream has ended
    bool leaving = false;
    bool joined = false;     ///< the scheduler knows it
    uint32_t held_wish = 0;  ///< until adoption is over
    uint64_t units_done = 0;
    uint64_t units_failed = 0;
    uint64_t samples_done = 0;
    uint64_t memory = 0;
    int64_t joined_ms = 0;
    int64_t heard_ms = 0;
  };
  struct Completed {
    JobId job{};
    int32_t frame = 0;
    std::shared_ptr<const core::Film> film;
  };
  struct Watch {
    uint64_t job = 0;
    uint64_t version = 0;
    std::function<void()> poke;
  };
  /// A result on its way through the scheduler.
  struct Delivery {
    core::Film film;
    std::vector<std::byte> record;
    AcceptedUnit unit;
  };
  class KeeperOwner;

  Brain(BrainOptions options, std::unique_ptr<JobStore> store,
        std::unique_ptr<farm::ContentStore> assets, uint64_t incarnation);
  bool has_room_for(const JobDesk& job) const;
  bool is_here(const v1::JobFile& file);
  grpc::Status files_are_here(const v1::JobSpec& spec);
  grpc::Status set_paused(uint64_t id, bool paused, v1::Job& now);
  grpc::Status change(uint64_t id, v1::Job& now,
                      const std::function<void(JobDesk&, std::vector<Action>&)>& what);
  core::Status take_up_jobs();
  core::Status take_up(uint64_t id);
  core::Result<std::set<int32_t>> frames_without_outputs(uint64_t id) const;
  core::Status start(std::unique_ptr<JobDesk> desk, RestoredJob restored);
  std::unique_ptr<FilmKeeper> make_keeper(JobDesk& desk, bool resume);
  core::Status ensure_keeper(JobDesk& desk);
  void restore_films(JobDesk& desk, const LogContents& contents, RestoredJob& restored);

  // brain.cpp: events in, actions out; with the lock.
  std::vector<Action> tell(const Event& event, Delivery* delivery = nullptr);
  void act(const Action& action, Delivery* delivery, std::vector<Action>& later);
  void send_lease(const Lease& lease);
  void send(WorkerId worker, v1::CoordinatorMessage message);
  void persist(const Persist& persist, Delivery* delivery, std::vector<Action>& later);
  // Without the lock.
  void carry_out(const std::vector<Action>& actions);
  void merged(JobId job, const Merge& merge);
  void finish_frame(const FinishFrame& finish);
  void frame_done(JobId job, int32_t frame);
  void frame_failed(JobId job, int32_t frame, const std::string& reason);
  void frame_restarted(JobId job, int32_t frame);
  void job_ended(const JobEnded& ended);
  void tile_voided(const TileVoided& voided);
  void frame_reopened(JobId job, int32_t frame);

  // Keepers' threads.
  void persisted(JobId job, RecordId record);
  void not_persisted(JobId job, RecordId record, const std::string& reason);
  void storage_failed(JobId job, const std::string& reason);

  // Messages of workers.
  bool has_seat();
  grpc::Status meet_twin(Seat& seat, const v1::Hello& hello);
  std::optional<Duration> patience_with(v1::LeaseProgress::Stage stage) const;
  std::vector<Event> feel_pulses(Seat& seat, const v1::Heartbeat& beat);
  std::vector<Event> take_back(Seat& seat, const LeaseId& lease, const Pulse& pulse);
  std::vector<std::string> still_units(JobId job) const;
  void wait_for_more_holders();
  void on_result(WorkerId worker, const WorkerLink* link, const v1::UnitResult& result);
  void want(Seat& seat, uint32_t units, std::vector<Action>& later);
  void reject(WorkerId worker, const WorkerLink* link, const v1::UnitResult& result,
              v1::Rejected::Reason reason, const std::string& text, uint32_t retry_after_ms);
  Seat* seat_of(WorkerId worker, const WorkerLink* link);

  // Threads.
  void clock_loop();
  void finish_loop();
  void chores_loop();
  void sweep_loop();
  void disk_loop();
  void chore(std::function<void()> what);  // with the lock
  std::vector<Action> mind_workers(TimePoint now);
  void mind_jobs(TimePoint now);

  void mind_disk();
  bool disk_is_short_for(const core::Film& film);

  // What nobody needs any more (brain_sweep.cpp); without the lock.
  void sweep_folders();
  core::Status sweep_assets(Duration grace);
  core::Status spare_needed(std::unordered_set<std::string>& names, uint64_t& after);

  // Small things; with the lock.
  JobDesk* desk_of(JobId job);
  JobDesk* desk_of(uint64_t job) { return desk_of(JobId{job}); }
  void note(JobDesk& desk, v1::LogLevel level, std::optional<int32_t> frame,
            const std::string& worker, const std::string& text);
  v1::Job describe(const JobDesk& desk) const;
  v1::Worker describe(const Seat& seat) const;
  std::string unmet_needs(const StoredJob& job) const;
  grpc::Status not_open(uint64_t job);
  grpc::Status kept_film(uint64_t job, int32_t frame, const FilmTaker& then);
  grpc::Status steer_worker(const v1::WorkerRequest& request, v1::Worker& now,
                            const std::function<std::vector<Action>(Seat&)>& what);
  Seat* find_worker(const std::string& text, grpc::Status& status);
  void set_quarantine(Seat& seat, const std::string& reason);
  void end_quarantine(Seat& seat);
  void store_quarantine(std::function<core::Status()> what);
  void store_patiently(const std::function<core::Status()>& what);
  uint64_t samples_of(const JobDesk& desk, const core::PixelRect& tile,
                      const core::BatchRange& batches) const;

  const BrainOptions options_;
  const std::unique_ptr<JobStore> store_;
  const std::unique_ptr<farm::ContentStore> assets_;
  const uint64_t incarnation_;
  const int64_t started_ms_;
  std::atomic<bool> stop_{false};

  mutable std::mutex mutex_;
  TimePoint adopting_until_;
  TimePoint adopting_at_most_;  ///< until then
  Scheduler scheduler_;
  std::map<JobId, std::unique_ptr<JobDesk>> desks_;
  std::map<WorkerId, Seat> seats_;
  std::map<std::string, WorkerId> worker_ids_;  ///< by what they call themselves
  uint64_t next_worker_ = 1;
  std::map<std::string, std::string> quarantines_;  ///< by worker_id: the reason; as stored
  std::map<uint64_t, Watch> watches_;
  uint64_t next_watch_ = 1;

  DiskRoom disk_;
  uint64_t disk_free_ = UINT64_MAX;  ///< bytes, when it was last measured
  uint64_t walked_used_ = 0;         ///< bytes of the folder, when it was last walked through
  uint64_t walked_free_ = 0;         ///< bytes of the disk at that time
  TimePoint room_made_;              ///< when keepers were last asked for room
  std::atomic<bool> disk_full_{false};
  std::condition_variable disk_wake_;

  std::condition_variable clock_wake_;
  std::deque<Completed> to_finish_;
  std::condition_variable finish_wake_;
  std::deque<std::function<void()>> chores_;
  std::condition_variable chores_wake_;
  bool chores_end_ = false;
  std::timed_mutex submit_mutex_;  ///< one submission at a time
  std::condition_variable sweep_wake_;
  std::atomic<uint64_t> asset_changes_{0};  ///< jobs that have gone
  uint64_t swept_changes_ = UINT64_MAX;     ///< of the sweeper: when it last left nothing to remove
  std::vector<std::thread> threads_;
};

/// Milliseconds since 1970, UTC.
int64_t wall_ms();

}  // namespace hyades::coordinator
