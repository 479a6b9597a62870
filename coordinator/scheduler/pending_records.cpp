#include "coordinator/scheduler/pending_records.h"

#include <utility>
#include <variant>

namespace hyades::coordinator {

void PendingRecords::persist(Record record, const Extent& extent, std::vector<Holder> waiters) {
  const RecordId id{next_++};
  step_.say(Persist{id, record});
  pending_.emplace(id, PendingRecord{std::move(record), extent, std::move(waiters)});
}

std::optional<PendingRecord> PendingRecords::take(RecordId id) {
  auto found = pending_.extract(id);
  if (found.empty()) return std::nullopt;
  return std::move(found.mapped());
}

std::optional<PendingRecord> PendingRecords::failed(RecordId id) {
  const auto it = pending_.find(id);
  if (it == pending_.end()) return std::nullopt;
  blocked_until_ = step_.now + options_.storage_retry;
  if (std::holds_alternative<UnitRecord>(it->second.record)) return take(id);
  to_retry_.push_back(id);
  return std::nullopt;
}

void PendingRecords::retry(const std::function<bool(const Record&)>& still_wanted) {
  if (step_.now < blocked_until_) return;
  for (const RecordId id : std::exchange(to_retry_, {})) {
    const Record& record = pending_.at(id).record;
    if (still_wanted(record)) {
      step_.say(Persist{id, record});
    } else {
      pending_.erase(id);
    }
  }
}

}  // namespace hyades::coordinator
