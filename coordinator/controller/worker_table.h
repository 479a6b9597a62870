#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/speed.h"
#include "coordinator/controller/worker_link.h"
#include "hyades/v1/farm.pb.h"

namespace hyades::coordinator {

/// How far a lease was when the worker last told, and for how long that is so.
struct LeaseProgress {
  v1::LeaseProgress::Stage stage = v1::LeaseProgress::STAGE_UNSPECIFIED;
  uint64_t samples_done = 0;
  Duration still{0};
};

/// What is known of a worker, from its first stream until it is forgotten.
struct WorkerSession {
  WorkerId id HYADES_GUARDED_BY(state_lock){};
  v1::Hello hello HYADES_GUARDED_BY(state_lock);          ///< without what is in hand
  std::string owner HYADES_GUARDED_BY(state_lock);        ///< WorkerPass::owner
  std::string joined_with HYADES_GUARDED_BY(state_lock);  ///< WorkerPass::joined_with
  /// Null while there is no stream.
  std::shared_ptr<WorkerLink> link HYADES_GUARDED_BY(state_lock);
  std::set<JobId> spec_sent HYADES_GUARDED_BY(state_lock);  ///< jobs that this stream knows
  v1::WorkerState state HYADES_GUARDED_BY(state_lock) = v1::WORKER_STATE_ACTIVE;
  std::string reason HYADES_GUARDED_BY(state_lock);  ///< of its state
  TimePoint heard HYADES_GUARDED_BY(state_lock);     ///< when anything last came
  TimePoint beat HYADES_GUARDED_BY(state_lock);      ///< when a heartbeat last came
  /// As the last heartbeat told.
  std::map<LeaseId, LeaseProgress> progress HYADES_GUARDED_BY(state_lock);
  /// Since when another process has asked for the same id, while this one is here.
  std::optional<TimePoint> duplicate_since HYADES_GUARDED_BY(state_lock);
  std::optional<TimePoint> lost_at HYADES_GUARDED_BY(state_lock);  ///< its stream has ended
  /// Why the process is to leave, if somebody wants that.
  std::optional<std::string> drained HYADES_GUARDED_BY(state_lock);
  bool leaving HYADES_GUARDED_BY(state_lock) = false;  ///< the process has said that it leaves
  bool joined HYADES_GUARDED_BY(state_lock) = false;   ///< the scheduler knows it
  /// Units that it asked for during adoption, granted when that is over.
  uint32_t deferred_request HYADES_GUARDED_BY(state_lock) = 0;
  // What Worker (farm.proto) tells of it.
  uint64_t units_done HYADES_GUARDED_BY(state_lock) = 0;
  uint64_t units_failed HYADES_GUARDED_BY(state_lock) = 0;
  uint32_t bad_films HYADES_GUARDED_BY(state_lock) = 0;  ///< one after the other
  uint64_t samples_done HYADES_GUARDED_BY(state_lock) = 0;
  uint64_t memory HYADES_GUARDED_BY(state_lock) = 0;
  uint64_t cache HYADES_GUARDED_BY(state_lock) = 0;
  uint64_t cache_limit HYADES_GUARDED_BY(state_lock) = 0;
  uint64_t cache_hits HYADES_GUARDED_BY(state_lock) = 0;
  uint64_t cache_misses HYADES_GUARDED_BY(state_lock) = 0;
  Speed speed HYADES_GUARDED_BY(state_lock);
  int64_t joined_ms HYADES_GUARDED_BY(state_lock) = 0;
  int64_t heard_ms HYADES_GUARDED_BY(state_lock) = 0;

  /// The class in which it renders jobs that need `job`.
  const std::string& class_for(const JobNeeds& job) const HYADES_REQUIRES(state_lock) {
    return job.render_class == core::RenderClass::portable ? hello.portable_class()
                                                           : hello.worker_class();
  }
  /// Whether it is there, neither drained nor in quarantine.
  bool may_take_units() const HYADES_REQUIRES(state_lock) {
    return joined && state == v1::WORKER_STATE_ACTIVE;
  }
};

/// The sessions of all workers, those that are gone for a while too, and who is in quarantine.
class WorkerTable {
 public:
  using Sessions = std::map<WorkerId, WorkerSession>;

  WorkerTable(ControllerContext& context, JobTable& jobs) : context_(context), jobs_(jobs) {}
  /// Reads who is in quarantine; an error where the store cannot be read.
  core::Status load() HYADES_EXCLUDES(state_lock);

  const Sessions& all() const HYADES_REQUIRES(state_lock) { return sessions_; }
  Sessions& all() HYADES_REQUIRES(state_lock) { return sessions_; }
  WorkerSession* find(WorkerId worker) HYADES_REQUIRES(state_lock);
  const WorkerSession* find(WorkerId worker) const HYADES_REQUIRES(state_lock);
  /// The worker's session, if `link` is its newest stream.
  WorkerSession* find(WorkerId worker, const WorkerLink* link) HYADES_REQUIRES(state_lock);
  /// The session of a worker by its number or its name. Null where there is none or several have
  /// the name, which `status` says.
  WorkerSession* find(const std::string& text, grpc::Status& status) HYADES_REQUIRES(state_lock);
  /// The session of the worker that calls itself so; null where there is none.
  const WorkerSession* session_of(const std::string& worker_id) const HYADES_REQUIRES(state_lock);
  /// The session of the worker that calls itself so; a new one where there is none.
  WorkerSession& open(const std::string& worker_id) HYADES_REQUIRES(state_lock);
  /// Notes by which token the worker is here; empty: by none.
  void set_joined_with(WorkerSession& session, const std::string& token)
      HYADES_REQUIRES(state_lock);
  /// How many workers that are known are here by the token.
  size_t joined_by(const std::string& token) const HYADES_REQUIRES(state_lock);
  /// Drops the worker's session: nobody will come under this number any more.
  void forget(WorkerId worker, Turn& turn) HYADES_REQUIRES(state_lock);
  /// The ids that workers keep over restarts; nothing for those who are not known any more.
  std::vector<std::string> stable_ids_of(const std::vector<WorkerId>& workers) const
      HYADES_REQUIRES(state_lock);

  /// Updates how fast workers are; to be called from time to time.
  void note_speeds(TimePoint now, const Scheduler& scheduler) HYADES_REQUIRES(state_lock);

  /// Sends a message to the worker; does nothing where it has no stream.
  void send(WorkerId worker, const v1::CoordinatorMessage& message) HYADES_REQUIRES(state_lock);
  /// Asks a worker that somebody has drained to leave, and bars it.
  void send_drain(WorkerSession& session, Turn& turn) HYADES_REQUIRES(state_lock);

  /// Why the worker is in quarantine; null where it is not.
  const std::string* quarantine_of(const std::string& worker_id) const HYADES_REQUIRES(state_lock);
  /// The worker is in quarantine from now on, over restarts too. The scheduler is not told.
  void set_quarantine(WorkerSession& session, const std::string& reason)
      HYADES_REQUIRES(state_lock);
  /// The worker is out of quarantine, and gets units again unless it is to leave.
  void end_quarantine(WorkerSession& session, const std::string& reason, Turn& turn)
      HYADES_REQUIRES(state_lock);

  /// Tells in the jobs' logs that the worker has these units no more, and why: a line per job.
  void note_losses(const WorkerSession& session, const std::vector<UnitInHand>& units,
                   const std::string& why) HYADES_REQUIRES(state_lock);

 private:
  void store_quarantine(std::function<core::Status()> what);

  ControllerContext& context_;
  JobTable& jobs_;
  Sessions sessions_ HYADES_GUARDED_BY(state_lock);
  std::map<std::string, WorkerId> ids_
      HYADES_GUARDED_BY(state_lock);  ///< by what they call themselves
  uint64_t next_worker_ HYADES_GUARDED_BY(state_lock) = 1;
  std::map<std::string, size_t> joined_by_ HYADES_GUARDED_BY(state_lock);  ///< no zeros
  /// The reasons, as stored, by what workers call themselves.
  std::map<std::string, std::string> quarantines_ HYADES_GUARDED_BY(state_lock);
};

}  // namespace hyades::coordinator
