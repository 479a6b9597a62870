#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/shared.h"
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
  WorkerId id{};
  v1::Hello hello;                   ///< without what is in hand
  std::shared_ptr<WorkerLink> link;  ///< null while there is no stream
  std::set<JobId> spec_sent;         ///< jobs that this stream knows
  v1::WorkerState state = v1::WORKER_STATE_ACTIVE;
  std::string reason;
  TimePoint heard;
  TimePoint beat;                             ///< the last heartbeat
  std::map<LeaseId, LeaseProgress> progress;  ///< as of then
  std::optional<TimePoint> twin_came;  ///< another process with the same id, while this one is here
  std::optional<TimePoint> lost_at;    ///< its stream has ended
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

/// The sessions of all workers, those that are gone for a while too, and who is in quarantine.
class WorkerTable {
 public:
  using Sessions = std::map<WorkerId, WorkerSession>;

  WorkerTable(Shared& shared, JobTable& jobs) : shared_(shared), jobs_(jobs) {}
  /// Reads who is in quarantine.
  core::Status load() HYADES_EXCLUDES(state_lock);

  const Sessions& all() const HYADES_REQUIRES(state_lock) { return sessions_; }
  Sessions& all() HYADES_REQUIRES(state_lock) { return sessions_; }
  WorkerSession* find(WorkerId worker) HYADES_REQUIRES(state_lock);
  const WorkerSession* find(WorkerId worker) const HYADES_REQUIRES(state_lock);
  /// The worker's session, if `link` is its newest stream.
  WorkerSession* find(WorkerId worker, const WorkerLink* link) HYADES_REQUIRES(state_lock);
  /// By number or by name. Null where `status` says why.
  WorkerSession* find(const std::string& text, grpc::Status& status) HYADES_REQUIRES(state_lock);
  bool knows(const std::string& worker_id) const HYADES_REQUIRES(state_lock) {
    return ids_.contains(worker_id);
  }
  /// The session of the worker that calls itself so; a new one where there is none.
  WorkerSession& open(const std::string& worker_id) HYADES_REQUIRES(state_lock);
  /// Nobody will come under this number any more.
  void forget(WorkerId worker, Turn& turn) HYADES_REQUIRES(state_lock);
  /// What workers call themselves; nothing for those who are not known any more.
  std::vector<std::string> names_of(const std::vector<WorkerId>& workers) const
      HYADES_REQUIRES(state_lock);

  void note_speeds(TimePoint now) HYADES_REQUIRES(state_lock);

  /// Does nothing where the worker has no stream.
  void send(WorkerId worker, v1::CoordinatorMessage message) HYADES_REQUIRES(state_lock);

  /// Why the worker is in quarantine; null where it is not.
  const std::string* quarantine_of(const std::string& worker_id) const HYADES_REQUIRES(state_lock);
  /// The scheduler is told by whoever knows more.
  void set_quarantine(WorkerSession& session, const std::string& reason)
      HYADES_REQUIRES(state_lock);
  void end_quarantine(WorkerSession& session) HYADES_REQUIRES(state_lock);

  /// That the worker has the units no more, and why: a line per job, however many they are.
  void note_losses(const WorkerSession& session, const std::vector<UnitInHand>& units,
                   const std::string& why) HYADES_REQUIRES(state_lock);

 private:
  void store_quarantine(std::function<core::Status()> what);

  Shared& shared_;
  JobTable& jobs_;
  Sessions sessions_ HYADES_GUARDED_BY(state_lock);
  std::map<std::string, WorkerId> ids_
      HYADES_GUARDED_BY(state_lock);  ///< by what they call themselves
  uint64_t next_worker_ HYADES_GUARDED_BY(state_lock) = 1;
  /// By what they call themselves: the reason; as stored.
  std::map<std::string, std::string> quarantines_ HYADES_GUARDED_BY(state_lock);
};

}  // namespace hyades::coordinator
