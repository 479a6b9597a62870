#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/scheduler/actions.h"
#include "coordinator/scheduler/events.h"
#include "coordinator/scheduler/scheduler_options.h"

namespace hyades::coordinator {

/// Decides who renders what and when: a deterministic state machine. Events and the time go in,
/// actions come out; it has no input or output, no threads and no clock of its own, so that the
/// same code serves the coordinator, a single machine and simulations. Not thread-safe.
class Scheduler {
 public:
  explicit Scheduler(const SchedulerOptions& options);
  ~Scheduler();

  /// What follows from `event` at time `now` (which never goes back). The caller carries the
  /// actions out in order.
  std::vector<Action> handle(const Event& event, TimePoint now);

  /// When a Tick is needed at the latest, if nothing else happens before; nothing where none is.
  std::optional<TimePoint> next_wake() const;

  /// Whether the job has not ended.
  bool knows(JobId job) const;
  /// How many units of the job are out with workers; 0 where the job is not known.
  uint32_t leased_units(JobId job) const;
  /// How many units are out with the worker; 0 where it is not known.
  uint32_t leased_units(WorkerId worker) const;

  /// The units that the worker has under the lease; none where it has no such lease.
  std::vector<UnitInHand> units_of(WorkerId worker, const LeaseId& lease) const;
  /// Whether the lease is the worker's, and units of it are still out.
  bool has_lease(WorkerId worker, const LeaseId& lease) const;
  /// Whether the worker has this unit of the job, or what it is a part of, under this lease.
  bool holds(WorkerId worker, const LeaseId& lease, JobId job, const core::Unit& unit) const;
  /// Since when the unit, which the worker holds, is out.
  TimePoint since(const UnitInHand& held) const;

  /// All units that the worker has, under whatever lease.
  std::vector<UnitInHand> units_of(WorkerId worker) const;
  /// All units of the job that are out, and the worker that has each.
  std::vector<std::pair<WorkerId, UnitInHand>> units_of(JobId job) const;

  /// How many units of the job have been rendered differently by two workers, and wait for another
  /// worker to render them too.
  uint32_t disputed_units(JobId job) const;
  /// How many have been rendered once, and wait for another witness to render them too
  /// (JobPlan::redundancy).
  uint32_t units_to_confirm(JobId job) const;

  /// Bytes of the films of all frames that have begun and are not over.
  uint64_t films() const;
  /// Whether a frame of the job could begin if there were more room for films.
  bool waits_for_film(JobId job) const;

  /// What does not agree in the scheduler's tables, or nothing. Slow; for tests and audits.
  std::string audit() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace hyades::coordinator
