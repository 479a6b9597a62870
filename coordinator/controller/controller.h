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

#include "coordinator/controller/active_job.h"
#include "coordinator/controller/asked_video.h"
#include "coordinator/controller/controller_options.h"
#include "coordinator/controller/retry_queue.h"
#include "coordinator/controller/thread_pool.h"
#include "coordinator/controller/timeline.h"
#include "coordinator/controller/worker_link.h"
#include "coordinator/finisher/finish_task.h"
#include "coordinator/scheduler/scheduler.h"
#include "coordinator/state/job_store.h"
#include "coordinator/store/disk_room.h"
#include "core/job/video.h"
#include "farm/content_store.h"
#include "farm/token_term.h"
#include "hyades/v1/farm.pb.h"
#include "hyades/v1/jobs.pb.h"
#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {

class Meters;

/// The coordinator without its network: the scheduler, and everything that happens because of it.
///
/// One lock guards the scheduler and all books; every event is handled and its messages are queued
/// under it, so that what workers are told has one order. Nothing slow happens under it: films are
/// decoded before (by the thread that received them), made durable and merged by each job's
/// FilmStore, finished by a process; what changes in a job's rows is stored by its tasks.
/// Thread-safe.
class Controller {
 public:
  /// Opens the folder and takes up all jobs that have not ended. An error where another process has
  /// it, or it was written by a newer version. A job whose files are gone fails alone.
  /// Jobs are kept in `store`, or, where that is null, in the folder.
  static core::Result<std::unique_ptr<Controller>> open(const ControllerOptions& options,
                                                        std::unique_ptr<JobStore> store = nullptr);

  /// Stops at once: all that was promised is durable.
  ~Controller();
  /// Ends all workers' streams, and starts nothing more. Before the server ends.
  void stop();
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  // Workers (attach.cpp, work.cpp, heartbeat.cpp).

  /// A worker's stream begins; `link` gets the Welcome. An older stream of the same worker is
  /// closed, unless it is another process' that still speaks: ALREADY_EXISTS then. INVALID_ARGUMENT
  /// for a Hello that makes no sense. The Welcome tells `token`, how long that of the worker holds.
  grpc::Status attach(const v1::Hello& hello, const std::shared_ptr<WorkerLink>& link,
                      WorkerId& worker, const farm::TokenTerm& token = {});
  /// What came on the stream; what comes on one that is not the worker's newest is ignored.
  void receive(WorkerId worker, const WorkerLink* link, const v1::WorkerMessage& message);
  /// The stream has ended.
  void detach(WorkerId worker, const WorkerLink* link);

  // Jobs (jobs.cpp, steer.cpp, queries.cpp, explain.cpp). Errors as
  // docs/wire.md has them. What may wait for the disk or the store says so: it is not for threads
  // that others need. All else never does.

  /// JobReply of what somebody asked for: a status, and where that is OK the job as it is now.
  using JobReply = std::function<void(const grpc::Status&, const v1::Job&)>;

  /// May wait for the disk, for other submissions up to two seconds.
  grpc::Status submit(const v1::SubmitRequest& request, bool owner_proven,
                      v1::SubmitResponse& response);
  /// May wait for the store; list_open() knows all jobs that have not ended, and says no where
  /// others are asked for.
  grpc::Status list(const v1::ListJobsRequest& request, v1::ListJobsResponse& response);
  bool list_open(const v1::ListJobsRequest& request, v1::ListJobsResponse& response);
  /// The job, and its frames above `after` as far as they fit. May wait for the store; get_open()
  /// answers for jobs that have not ended, and says no for others.
  /// Only frames in state `only`, where one is given.
  grpc::Status get(uint64_t job, std::optional<int32_t> after, v1::GetJobResponse& response,
                   v1::FrameState only = v1::FRAME_STATE_UNSPECIFIED);
  bool get_open(uint64_t job, std::optional<int32_t> after, v1::GetJobResponse& response,
                v1::FrameState only = v1::FRAME_STATE_UNSPECIFIED);
  /// The same of why it does or does not get on.
  grpc::Status explain(uint64_t job, v1::ExplainResponse& response);
  bool explain_open(uint64_t job, v1::ExplainResponse& response);
  /// These four call `then` exactly once, perhaps by another thread and at the latest when the
  /// controller stops: when the change is stored, or after half a second with UNAVAILABLE (it
  /// holds, and will be stored). For a job that is not open they may wait for the store.
  void pause(uint64_t job, JobReply then);
  void resume(uint64_t job, JobReply then);
  void cancel(uint64_t job, JobReply then);
  void set_priority(uint64_t job, int priority, JobReply then);
  /// May wait for the disk, and for submissions up to two seconds.
  grpc::Status retry(uint64_t job, v1::Job& now);
  grpc::Status remove(uint64_t job);
  using FilmTaker = std::function<void(const grpc::Status&, const core::FilmInfo&,
                                       std::shared_ptr<const core::Film>)>;
  /// A copy of the frame's film as it is now, or, where films are kept, was in the end; given to
  /// `then` (which is quick), perhaps by another thread. May wait for the disk.
  grpc::Status film(uint64_t job, int32_t frame, FilmTaker then);
  /// A frame as it is now, and how its job shows it.
  struct FrameNow {
    v1::Frame frame;
    std::string tag;  ///< quoted; another one whenever the frame has changed; of open jobs only
    std::string tone_map = "srgb";  ///< of the job's first output for displays; of open jobs only
    float exposure = 0;             ///< stops; the same
  };
  /// May wait for the store.
  grpc::Status frame_now(uint64_t job, int32_t frame, FrameNow& now);
  /// What was done for the job where and when, as far as it is kept in memory. May wait for the
  /// store.
  grpc::Status timeline(const v1::ListTimelineRequest& request, v1::ListTimelineResponse& response);
  /// Has a video made of the pictures of the job's finished frames, also of a job that has ended or
  /// has none of its own; it is among the outputs once it is there. May wait for the store.
  /// FAILED_PRECONDITION where there is nothing to make it of, RESOURCE_EXHAUSTED where too many
  /// wait already.
  grpc::Status ask_for_video(uint64_t job, const VideoWish& wish, AskedVideo& asked);
  /// Those that were asked for since the coordinator started, the last ones; may wait for the
  /// store.
  grpc::Status asked_videos(uint64_t job, std::vector<AskedVideo>& videos);
  /// Whether a file is there only until the open job's video is made of it.
  bool is_for_video(uint64_t job, const std::string& path) const;
  /// How far somebody has been told of a job's changes; at first of nothing.
  struct ChangeCursor {
    uint64_t version = 0;          ///< of the job: of all changes up to this one
    uint64_t next_version = 0;     ///< while they do not fit into one event, and
    std::optional<int32_t> after;  ///< the last frame that did
    bool over = false;             ///< what is told is how the job has ended
  };
  /// What has changed since, as far as it fits. `ended`: there will be no other changes. May wait
  /// for the store; changes_of_open() answers for jobs that have not ended, and says no for others.
  grpc::Status changes(uint64_t job, ChangeCursor& cursor, v1::WatchEvent& event, bool& ended);
  bool changes_of_open(uint64_t job, ChangeCursor& cursor, v1::WatchEvent& event);
  /// Calls `poke` (quickly, by another thread) whenever the job has changed, until unwatch.
  uint64_t watch(uint64_t job, std::function<void()> poke);
  void unwatch(uint64_t number);

  // The disk (disk.cpp).

  /// Whether `bytes` more may be stored, or (0) something new may begin: OK, or RESOURCE_EXHAUSTED
  /// with the reason. May wait for the disk.
  grpc::Status admit(uint64_t bytes);
  /// Even what was begun has to wait.
  bool disk_is_full() const { return disk_full_; }

  // Farm (farm.cpp).

  void info(v1::InfoResponse& response);
  /// What info() tells as the address of gRPC.
  void listens_at(const std::string& address);
  /// How strangers may listen or act, for info(); empty: they may not.
  void set_unguarded(const std::string& how);
  /// As many as fit.
  void workers(const v1::WorkersRequest& request, v1::WorkersResponse& response);
  grpc::Status drain_worker(const v1::WorkerRequest& request, v1::Worker& now);
  grpc::Status quarantine_worker(const v1::WorkerRequest& request, v1::Worker& now);
  grpc::Status release_worker(const v1::WorkerRequest& request, v1::Worker& now);

  /// What is counted, here and by those around.
  Meters& meters() { return *meters_; }
  farm::ContentStore& assets() { return *assets_; }
  JobStore& store() { return *store_; }
  std::string output_folder(uint64_t job) const;
  std::string films_folder(uint64_t job) const;

 private:
  /// How far a lease was when the worker last told, and for how long that is so.
  struct LeaseProgress {
    v1::LeaseProgress::Stage stage = v1::LeaseProgress::STAGE_UNSPECIFIED;
    uint64_t samples_done = 0;
    Duration still{0};
  };
  struct WorkerSession {
    WorkerId id{};
    v1::Hello hello;  ///< without what is in hand
    std::shared_ptr<WorkerLink> link;
    std::set<JobId> spec_sent;  ///< jobs that this stream knows
    v1::WorkerState state = v1::WORKER_STATE_ACTIVE;
    std::string reason;
    TimePoint heard;
    TimePoint beat;                             ///< the last heartbeat
    std::map<LeaseId, LeaseProgress> progress;  ///< as of then
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
    uint64_t cache = 0;
    uint64_t cache_limit = 0;
    uint64_t cache_hits = 0;
    uint64_t cache_misses = 0;
    Speed speed;
    int64_t joined_ms = 0;
    int64_t heard_ms = 0;
  };
  struct Completed {
    JobId job{};
    int32_t frame = 0;
    std::shared_ptr<const core::Film> film;
    std::vector<std::string> parts;  ///< StoredFrame::parts
  };
  /// A worker that was found odd, on its way into the store.
  struct DivergentWorker {
    RecordId record{};
    StoredQuarantine worker;
    uint64_t since = 0;
    StoredLine line;
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
    FilmUnderWay rendered;
    bool settled = false;  ///< it is on its way to the disk, or was answered
  };
  class FilmStoreOwner;

  Controller(ControllerOptions options, std::unique_ptr<JobStore> store,
             std::unique_ptr<farm::ContentStore> assets, uint64_t incarnation);
  static grpc::Status check_priority(int priority);
  bool has_room_for(const StoredJob& job) const;
  bool is_here(const v1::JobFile& file);
  grpc::Status files_are_here(const v1::JobSpec& spec);
  void set_paused(uint64_t id, bool paused, JobReply then);
  void change(uint64_t id, JobReply then,
              const std::function<void(ActiveJob&, std::vector<Action>&)>& what);

  // What is stored of jobs, and who waits for it (ends.cpp).
  /// Somebody who is told once a job is stored as it was when he asked.
  struct Waiter {
    uint64_t number = 0;  ///< grows
    uint64_t job = 0;
    TimePoint give_up;
    JobReply then;
  };
  void end_job(ActiveJob& active, bool cancelled, const std::string& why);
  void when_stored(uint64_t job, JobReply then);
  void store_row(ActiveJob& active);
  bool store_row_now(uint64_t id);
  bool store_end(uint64_t id);
  bool store_lines(JobId id);
  std::vector<Waiter> take_waiters(const std::function<bool(const Waiter&)>& which);
  void mind_waiters(TimePoint now);
  core::Status recover_jobs();
  bool recover_later(uint64_t id);
  bool try_to_recover(uint64_t id);
  core::Status give_up(uint64_t id, const core::Error& why);
  core::Status recover(uint64_t id);
  core::Result<std::vector<StoredOutput>> lost_outputs(uint64_t id) const;
  core::Result<std::set<int32_t>> frames_to_repeat(const ActiveJob& active,
                                                   const std::vector<StoredFrame>& frames);
  core::Status start(std::unique_ptr<ActiveJob> active, RestoredJob restored);
  std::unique_ptr<FilmStore> make_film_store(ActiveJob& active, bool resume);
  FilmStore& film_store_of(ActiveJob& active);
  bool open_film_store(JobId job);
  void restore_films(ActiveJob& active, const LogContents& contents, RestoredJob& restored);

  // actions.cpp: events in, actions out; with the lock.
  std::vector<Action> tell(const Event& event, Delivery* delivery = nullptr);
  void act(const Action& action, Delivery* delivery, std::vector<Action>& later);
  void send_lease(const Lease& lease);
  void send(WorkerId worker, v1::CoordinatorMessage message);
  void persist(const Persist& persist, Delivery* delivery);
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

  core::Status find_color_files(FinishTask& task, const std::vector<core::AssetRecord>& files);

  // Videos (videos.cpp).
  void begin_videos(ActiveJob& active);
  void cancel_videos(ActiveJob& active);
  core::Status make_videos(uint64_t id, const std::vector<core::VideoDesc>& videos,
                           const core::VideoFrames& frames);
  void video_loop();
  void make_job_videos(std::unique_lock<std::mutex>& lock, JobId job);
  void make_asked_video(std::unique_lock<std::mutex>& lock);
  core::Status make_video(uint64_t id, const core::VideoDesc& video,
                          const core::VideoFrames& frames);
  core::Status repeat_for_videos(const ActiveJob& active, const std::vector<int32_t>& done,
                                 std::set<int32_t>& repeated);

  // Film stores' threads.
  void persisted(JobId job, RecordId record);
  void not_persisted(JobId job, RecordId record, const std::string& reason);
  void storage_failed(JobId job, const std::string& reason);

  // Workers that are found odd (divergent_workers.cpp).
  std::vector<std::string> names_of(const std::vector<WorkerId>& workers) const;
  void confirmed(const Confirmed& sure);
  bool store_trust();
  void keep_divergent(RecordId record, const WorkerOddRecord& odd);
  bool store_divergent(const DivergentWorker& odd);
  bool doubt_frames(const JobFrames& doubted);

  // Messages of workers.
  bool has_room_for_worker(std::vector<Action>& later);
  grpc::Status meet_twin(WorkerSession& session, const v1::Hello& hello);
  std::optional<Duration> patience_with(v1::LeaseProgress::Stage stage) const;
  std::vector<Event> renew_leases(WorkerSession& session, const v1::Heartbeat& beat);
  std::vector<Event> take_back(WorkerSession& session, const LeaseId& lease,
                               const LeaseProgress& lease_progress);
  std::vector<std::string> still_units(JobId job) const;
  void wait_for_more_holders();
  void note_losses(const WorkerSession& session, const std::vector<UnitInHand>& units,
                   const std::string& why);
  void note_expired(const std::vector<Action>& actions);
  void note_quarantine(const WorkerSession& session);
  void on_result(WorkerId worker, const WorkerLink* link, const v1::UnitResult& result);
  void note_return(const WorkerSession& session, JobId job, const std::string& reason);
  void want(WorkerSession& session, uint32_t units, std::vector<Action>& later);
  void reject(WorkerId worker, const WorkerLink* link, const v1::UnitResult& result,
              v1::Rejected::Reason reason, const std::string& text, uint32_t retry_after_ms);
  WorkerSession* session_of(WorkerId worker, const WorkerLink* link);

  // Threads.
  void clock_loop();
  void finish_loop();
  void sweep_loop();
  void disk_loop();
  void sweep_partials();
  std::vector<Action> mind_workers(TimePoint now);
  void mind_jobs(TimePoint now);
  void tell_watcher(const std::function<void()>& poke);

  void mind_disk();
  bool disk_is_short_for(const core::Film& film);

  // What nobody needs any more (sweep.cpp); without the lock.
  void sweep_folders();
  core::Status sweep_assets(Duration grace);
  core::Status spare_needed(std::unordered_set<std::string>& names, uint64_t& after);

  // Small things; with the lock.
  ActiveJob* active_job(JobId job);
  ActiveJob* active_job(uint64_t job) { return active_job(JobId{job}); }
  void note(ActiveJob& active, v1::LogLevel level, std::optional<int32_t> frame,
            const std::string& worker, const std::string& text, const core::Unit* unit = nullptr);
  v1::Job describe(const ActiveJob& active) const;
  v1::Job describe(const StoredJob& job) const;
  void count_cost(v1::Job& job) const;
  void count_film(ActiveJob& active, const Merge& merge, int64_t begun_us);
  v1::Worker describe(const WorkerSession& session) const;
  std::vector<v1::WorkInHand> work_of(WorkerId worker) const;
  std::string unmet_needs(const StoredJob& job) const;
  std::vector<std::string> barred_workers() const;
  std::vector<std::string> where_units_are(JobId job) const;
  std::vector<Action> forget(WorkerId worker);
  grpc::Status not_open(uint64_t job);
  grpc::Status cancel_waiting(uint64_t job, v1::Job& now);
  grpc::Status wait_until_away(uint64_t job);
  grpc::Status kept_film(uint64_t job, int32_t frame, const FilmTaker& then);
  grpc::Status steer_worker(const v1::WorkerRequest& request, v1::Worker& now,
                            const std::function<std::vector<Action>(WorkerSession&)>& what);
  WorkerSession* find_worker(const std::string& text, grpc::Status& status);
  void set_quarantine(WorkerSession& session, const std::string& reason);
  void end_quarantine(WorkerSession& session);
  void store_quarantine(std::function<core::Status()> what);
  uint64_t samples_of(const ActiveJob& active, const core::PixelRect& tile,
                      const core::BatchRange& batches) const;

  const ControllerOptions options_;
  const std::unique_ptr<JobStore> store_;
  const std::unique_ptr<farm::ContentStore> assets_;
  const uint64_t incarnation_;
  const int64_t started_ms_;
  const std::unique_ptr<Meters> meters_;
  std::atomic<bool> stop_{false};

  mutable std::mutex mutex_;
  TimePoint adopting_until_;
  TimePoint adopting_at_most_;  ///< until then
  Scheduler scheduler_;
  std::map<JobId, std::unique_ptr<ActiveJob>> jobs_;
  Timelines timelines_;
  std::map<WorkerId, WorkerSession> sessions_;
  std::map<std::string, WorkerId> worker_ids_;  ///< by what they call themselves
  uint64_t next_worker_ = 1;
  std::map<std::string, std::string> quarantines_;  ///< by worker_id: the reason; as stored
  uint64_t moment_;                                 ///< of the last frame that was finished
  /// By worker_id: when (moment_) another agreed with it, ascending.
  std::map<std::string, std::vector<uint64_t>> trust_;
  std::set<std::string> trust_to_store_;
  bool storing_trust_ = false;
  std::map<uint64_t, Watch> watches_;
  uint64_t next_watch_ = 1;
  std::string grpc_address_;

  std::string unguarded_;

  DiskRoom disk_;
  uint64_t disk_free_ = UINT64_MAX;  ///< bytes, when it was last measured
  uint64_t walked_used_ = 0;         ///< bytes of the folder, when it was last walked through
  uint64_t walked_free_ = 0;         ///< bytes of the disk at that time
  TimePoint room_made_;              ///< when film stores were last asked for room
  std::atomic<bool> disk_full_{false};
  std::condition_variable disk_wake_;

  std::map<uint64_t, StoredJob> waiting_jobs_;  ///< open, but not taken up yet, with the reason
  std::set<uint64_t> leaving_;  ///< jobs whose end is stored, but whose log is still open
  std::condition_variable away_wake_;

  std::condition_variable clock_wake_;
  std::deque<Completed> to_finish_;
  std::condition_variable finish_wake_;
  std::deque<JobId> videos_due_;
  std::deque<AskedVideo> asked_videos_;  ///< the oldest first; those that are over too
  uint64_t next_asked_ = 1;
  std::optional<JobId> making_videos_of_;  ///< whose videos are being made
  std::condition_variable video_wake_;
  std::atomic<bool> video_stop_{false};  ///< ends the video in work
  std::vector<Waiter> waiters_;
  uint64_t next_waiter_ = 1;
  std::timed_mutex submit_mutex_;  ///< one submission at a time
  std::condition_variable sweep_wake_;
  std::atomic<uint64_t> asset_changes_{0};  ///< jobs that have gone
  uint64_t swept_changes_ = UINT64_MAX;     ///< of the sweeper: when it last left nothing to remove
  std::vector<std::thread> threads_;
  RetryQueue background_{2};  ///< by job; begins and ends while all else is there
  ThreadPool pokes_{1, SIZE_MAX};
};

/// Milliseconds since 1970, UTC.
int64_t wall_ms();
/// Microseconds since then.
int64_t wall_us();

}  // namespace hyades::coordinator
