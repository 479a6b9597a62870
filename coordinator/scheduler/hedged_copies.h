#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "coordinator/scheduler/affinity.h"
#include "coordinator/scheduler/leases.h"

namespace hyades::coordinator {

/// Second copies of units that are late, for workers that have nothing else to do: purity makes it
/// safe, and whichever comes first counts. Where the two that have a unit are of one origin and are
/// late both, one of another origin gets a third.
class HedgedCopies {
 public:
  HedgedCopies(const SchedulerOptions& options, const Step& step, ScheduledJobs& jobs,
               ScheduledWorkers& workers, Leases& leases, Affinity& affinity)
      : options_(options),
        step_(step),
        jobs_(jobs),
        workers_(workers),
        leases_(leases),
        affinity_(affinity) {}

  bool enabled() const { return options_.copy_after > Duration{0}; }
  /// The unit has been leased to a worker of this class: it may be late one day.
  void note(const FramePlace& place, const Assignment& assignment, ClassId worker_class);
  /// Hands out a copy of one of the oldest units that are late.
  bool grant(WorkerId id, Worker& worker);
  /// Whether some unit may be due for a copy, and as much was not looked at in this round as may
  /// be.
  bool due() const { return !late_.empty() && looks_ < kLooks; }
  /// Whether it is time to offer copies to those who wait; begins the next round.
  bool begin_round();
  /// When copies may be offered next; nothing where no unit is out.
  std::optional<TimePoint> next_wake() const;

 private:
  /// A unit that may be late.
  struct Candidate {
    TimePoint since;
    uint64_t serial = 0;
    JobId job{};
    uint32_t slot = 0;
    Extent extent;
  };

  using Candidates = std::deque<Candidate>;

  /// Units that are for the same workers: else late ones that are for others could stand before
  /// those that a worker may copy.
  struct Group {
    ClassId worker_class{};
    JobId job{};
    auto operator<=>(const Group&) const = default;
  };
  struct Units {
    Candidates alone;      ///< that one worker has; oldest first
    Candidates copied;     ///< that were copied; oldest first
    size_t swept_at = 64;  ///< length of `alone` at which stale ones are swept out
    bool empty() const { return alone.empty() && copied.empty(); }
    /// Since when the oldest has been out.
    TimePoint since() const { return alone.empty() ? TimePoint::max() : alone.front().since; }
  };

  /// How many groups are looked at in a round, for all workers together.
  static constexpr size_t kLooks = 20'000;

  void forget_over(Units& units) const;
  std::vector<Units*> for_worker(WorkerId id, const Worker& worker);
  bool grant_of(Units& units, size_t holders, WorkerId id, Worker& worker);
  bool may_copy(const Assignment& assignment, WorkerId id, const Worker& worker) const;
  void may_be_late(const Candidate& candidate);
  TimePoint first_copy(const Candidate& candidate) const;
  double late_after(const ScheduledJob& job, const Extent& extent) const;
  Assignment* find(const Candidate& candidate) const;

  const SchedulerOptions& options_;
  const Step& step_;
  ScheduledJobs& jobs_;
  ScheduledWorkers& workers_;
  Leases& leases_;
  Affinity& affinity_;
  std::map<Group, Units> out_;
  TimePoint next_round_;
  /// Of this round, by class, the groups of which some unit may be late; whoever has waited longest
  /// first.
  std::map<ClassId, std::vector<std::pair<JobId, Units*>>> late_;
  size_t looks_ = 0;                ///< at groups, in this round
  std::optional<TimePoint> first_;  ///< when some unit may be late, at the earliest
};

}  // namespace hyades::coordinator
