#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/scheduler/frame_ledger.h"
#include "coordinator/scheduler/scheduler_options.h"
#include "coordinator/scheduler/step.h"

namespace hyades::coordinator {

/// A record that is being made durable.
struct PendingRecord {
  Record record;
  Extent extent;                ///< of a unit record
  std::vector<Holder> waiters;  ///< who waits for its acknowledgement
};

/// What was said to be made durable and is not yet, of jobs that have not ended; and divergent
/// workers, who concern all jobs.
class PendingRecords {
 public:
  PendingRecords(const SchedulerOptions& options, Step& step) : options_(options), step_(step) {}

  /// The number that persist() gives the next record.
  RecordId next_id() const { return RecordId{next_}; }
  /// Says Persist, and remembers the record until it is answered. `extent` and `waiters`: of a unit
  /// record.
  void persist(Record record, const Extent& extent = {}, std::vector<Holder> waiters = {});
  /// One more worker waits for the acknowledgement of this unit record, which is pending.
  void await(RecordId id, const Holder& waiter) { pending_.at(id).waiters.push_back(waiter); }
  bool empty() const { return pending_.empty(); }

  /// The record is durable: hands it over; nothing where it is not known.
  std::optional<PendingRecord> take(RecordId id);
  /// The record could not be made durable, and nothing is leased for a while. A unit's is handed
  /// over, as its film is lost; others are tried again. Nothing follows where it is not known.
  std::optional<PendingRecord> failed(RecordId id);
  /// Says those again that are `still_wanted`, when it is time.
  void retry(const std::function<bool(const Record&)>& still_wanted);
  /// The job has ended: nobody waits for its records any more, whether they are ever answered or
  /// not. Only who delivered a film hears of it still, should it become durable.
  void forget(JobId job);
  /// Something could not be made durable: nothing is leased before this.
  TimePoint blocked_until() const { return blocked_until_; }
  std::optional<TimePoint> next_wake() const {
    return step_.now < blocked_until_ ? std::optional(blocked_until_) : std::nullopt;
  }

  /// Which record belongs to a job that is not `open`, in words, or nothing.
  std::string audit(const std::function<bool(JobId)>& open) const;

 private:
  const SchedulerOptions& options_;
  Step& step_;
  std::map<RecordId, PendingRecord> pending_;
  std::map<RecordId, PendingRecord> films_of_ended_;  ///< unit records of jobs that have ended
  uint64_t next_ = 1;
  std::vector<RecordId> to_retry_;
  TimePoint blocked_until_;
};

}  // namespace hyades::coordinator
