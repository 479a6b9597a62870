#pragma once

#include <cstddef>
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

/// Which worker has which units until when. Keeps the frames' ledgers, the jobs' counts and the
/// workers' lists of leases in step with that.
class Leases {
 public:
  Leases(const SchedulerOptions& options, Step& step, ScheduledJobs& jobs,
         ScheduledWorkers& workers, FilmBudget& films)
      : options_(options), step_(step), jobs_(jobs), workers_(workers), films_(films) {}

  /// Assigns a free unit to the worker, as a part of the next lease that is granted.
  Assignment& assign(FrameSlot& slot, const Extent& extent, WorkerId worker);
  /// Assigns a unit that somebody has to another worker, too, as a part of the next lease that is
  /// granted.
  void copy(Assignment& assignment, WorkerId worker) const;
  /// Grants the lease for which these units, all of one frame, were assigned or copied. `adopted`:
  /// the worker has them already, from an earlier lease.
  void grant(WorkerId id, Worker& worker, const FramePlace& place, std::vector<Extent> units,
             bool adopted = false);

  /// The lease lasts another lease_time from now, if it is this worker's.
  void renew(WorkerId worker, const LeaseId& id);
  /// Takes back the leases whose deadline has passed.
  void expire();
  /// Takes back all that the worker has; with `revoke` it is told so.
  void release_all(const Worker& worker, bool revoke);
  /// Takes back all units of the frame that are out.
  void take_back(ScheduledJob& job, FrameSlot& slot);
  /// The lease no longer holds the unit that `part` belongs to, if it did.
  void end_unit(ScheduledJob& job, FrameSlot& slot, const Extent& part, const LeaseId& lease);
  /// The unit has been delivered under a lease: whoever else renders it can stop.
  void end_assignment(const ScheduledJob& job, FrameSlot& slot, const Extent& extent,
                      const LeaseId& delivered);

  /// Whether the lease is the worker's: numbers are easily guessed.
  bool is_of(const LeaseId& lease, WorkerId worker) const;
  /// Whether the worker has this unit of the job, or what it is a part of, under this lease.
  bool holds(WorkerId worker, const LeaseId& lease, JobId job, const core::Unit& unit) const;
  /// Since when it has a unit that is out.
  TimePoint since(const UnitInHand& held) const;
  /// Whether no unit is out.
  bool empty() const { return leases_.empty(); }
  /// When expire() may have something to do next.
  std::optional<TimePoint> next_deadline() const;
  /// The units that the worker has under this lease; none where it has no such lease.
  std::vector<UnitInHand> units_of(WorkerId worker, const LeaseId& lease) const;
  /// All units that the worker has.
  std::vector<UnitInHand> units_of(WorkerId worker) const;
  /// All units of the job that are out, and the worker that has each.
  std::vector<std::pair<WorkerId, UnitInHand>> units_of(JobId job) const;

  /// What of the leases does not agree with workers, jobs and ledgers, in words, or nothing. Adds
  /// up in `out` how many units are out of each frame, by job and slot.
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
  /// When to look at which lease; one that was renewed meanwhile is put back.
  std::priority_queue<std::pair<TimePoint, uint64_t>, std::vector<std::pair<TimePoint, uint64_t>>,
                      std::greater<>>
      deadlines_;
};

}  // namespace hyades::coordinator
