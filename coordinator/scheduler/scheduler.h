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

/// Who renders what (invariants 3 and 5): a deterministic state machine. Events and a clock in,
/// actions out; no input or output, no threads, no clock of its own. The same machine serves the
/// coordinator, the single machine and the simulator. Not thread-safe.
class Scheduler {
 public:
  explicit Scheduler(const SchedulerOptions& options);
  ~Scheduler();

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
