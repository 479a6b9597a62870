#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <queue>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "coordinator/scheduler/film_budget.h"
#include "coordinator/scheduler/scheduled_jobs.h"
#include "coordinator/scheduler/scheduled_workers.h"
#include "coordinator/scheduler/scheduler_options.h"

namespace hyades::coordinator {

/// Who has which units until when. Keeps the frames' ledgers, the jobs' counts and the workers'
/// lists in step with that.
class Leases {
 public:
  Leases(const SchedulerOptions& options, Step& step, ScheduledJobs& jobs,
         ScheduledWorkers& workers, FilmBudget& films)
      : options_(options), step_(step), jobs_(jobs), workers_(workers), films_(films) {}

  /// Assigns a free unit to the worker, for the next lease.
  Assignment& assign(FrameSlot& slot, const Extent& extent, WorkerId worker);
  /// Copies an assigned unit to another worker, for the next lease.
  void copy(Assignment& assignment, WorkerId worker) const;
  /// Grants the lease over units that are assigned to it already.
  void grant(WorkerId id, Worker& worker, const FramePlace& place, std::vector<Extent> units,
             bool adopted = false);

  void renew(WorkerId worker, const LeaseId& id);
  void expire();
  /// Takes back all that the worker has; `revoke`: and tells it.
  void release_all(const Worker& worker, bool revoke);
  /// Takes back what is out of the frame.
  void take_back(ScheduledJob& job, FrameSlot& slot);
  /// The lease no longer holds the unit that `part` is of, if it did.
  void end_unit(ScheduledJob& job, FrameSlot& slot, const Extent& part, const LeaseId& lease);
  /// The unit has been delivered under a lease: whoever else renders it can stop.
  void end_assignment(const ScheduledJob& job, FrameSlot& slot, const Extent& extent,
                      const LeaseId& delivered);

  bool empty() const { return leases_.empty(); }
  std::optional<TimePoint> next_deadline() const;
  uint32_t units_of(const Worker& worker) const;
  std::vector<UnitInHand> units_of(WorkerId worker, const LeaseId& lease) const;
  std::vector<UnitInHand> units_of(WorkerId worker) const;
  std::vector<std::pair<WorkerId, UnitInHand>> units_of(JobId job) const;

  /// What does not agree with workers, jobs and ledgers, or nothing. Counts in `out` what is out of
  /// each frame, by job and slot.
  std::string audit(std::map<std::pair<JobId, uint32_t>, size_t>& out) const;

 private:
  struct Entry {
    WorkerId worker{};
    JobId job{};
    uint32_t slot = 0;
    std::vector<Extent> units;  ///< still out
    TimePoint deadline;
  };

  LeaseId id_of(uint64_t number) const { return {options_.incarnation, number}; }
  Entry* find(const LeaseId& id);
  void release(uint64_t number, bool revoke, bool expired = false);
  void drop_unit(const LeaseId& id, const Extent& e);
  void leave_job(ScheduledJob& job, WorkerId worker);

  const SchedulerOptions& options_;
  Step& step_;
  ScheduledJobs& jobs_;
  ScheduledWorkers& workers_;
  FilmBudget& films_;
  std::unordered_map<uint64_t, Entry> leases_;  ///< by number; walked only where order is nothing
  uint64_t next_ = 1;
  uint64_t next_assignment_ = 1;
  /// When to look at which lease; renewed ones are put back when their turn comes.
  std::priority_queue<std::pair<TimePoint, uint64_t>, std::vector<std::pair<TimePoint, uint64_t>>,
                      std::greater<>>
      deadlines_;
};

}  // namespace hyades::coordinator
