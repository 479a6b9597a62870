#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
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

/// What was said to be made durable and is not yet.
class PendingRecords {
 public:
  PendingRecords(const SchedulerOptions& options, Step& step) : options_(options), step_(step) {}

  /// Of the next record.
  RecordId next_id() const { return RecordId{next_}; }
  void persist(Record record, const Extent& extent = {}, std::vector<Holder> waiters = {});
  /// Another one waits for it.
  void await(RecordId id, const Holder& waiter) { pending_.at(id).waiters.push_back(waiter); }
  bool empty() const { return pending_.empty(); }

  /// The record is durable; nothing where it is not known.
  std::optional<PendingRecord> take(RecordId id);
  /// The record could not be made durable, and nothing is leased for a while. A unit's is handed
  /// back: its film is lost. Others are tried again.
  std::optional<PendingRecord> failed(RecordId id);
  /// Says those again that are `still_wanted`, when it is time.
  void retry(const std::function<bool(const Record&)>& still_wanted);
  /// Something could not be made durable: nothing is leased before this.
  TimePoint blocked_until() const { return blocked_until_; }
  std::optional<TimePoint> next_wake() const {
    return step_.now < blocked_until_ ? std::optional(blocked_until_) : std::nullopt;
  }

 private:
  const SchedulerOptions& options_;
  Step& step_;
  std::map<RecordId, PendingRecord> pending_;
  uint64_t next_ = 1;
  std::vector<RecordId> to_retry_;
  TimePoint blocked_until_;
};

}  // namespace hyades::coordinator
