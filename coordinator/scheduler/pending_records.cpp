#include "coordinator/scheduler/pending_records.h"

#include <utility>
#include <variant>

#include <fmt/format.h>

namespace hyades::coordinator {
namespace {

/// Whose record it is; nothing where it concerns all jobs.
std::optional<JobId> job_of(const Record& record) {
  if (std::holds_alternative<DivergentWorkerRecord>(record)) return std::nullopt;
  return std::visit([](const auto& one) { return one.job; }, record);
}

}  // namespace

void PendingRecords::persist(Record record, const Extent& extent, std::vector<Holder> waiters) {
  const RecordId id{next_++};
  step_.say(Persist{id, record});
  pending_.emplace(id, PendingRecord{std::move(record), extent, std::move(waiters)});
}

std::optional<PendingRecord> PendingRecords::take(RecordId id) {
  auto found = pending_.extract(id);
  if (found.empty()) found = films_of_ended_.extract(id);
  if (found.empty()) return std::nullopt;
  return std::move(found.mapped());
}

std::optional<PendingRecord> PendingRecords::failed(RecordId id) {
  films_of_ended_.erase(id);
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

void PendingRecords::forget(JobId job) {
  for (auto next = pending_.begin(); next != pending_.end();) {
    const auto at = next++;
    if (job_of(at->second.record) != job) continue;
    auto gone = pending_.extract(at);
    if (!gone.mapped().waiters.empty()) films_of_ended_.insert(std::move(gone));
  }
  std::erase_if(to_retry_, [this](RecordId id) { return !pending_.contains(id); });
}

std::string PendingRecords::audit(const std::function<bool(JobId)>& open) const {
  for (const auto& [id, pending] : pending_) {
    const std::optional<JobId> job = job_of(pending.record);
    if (job && !open(*job)) {
      return fmt::format("record {} is of a job that has ended", static_cast<uint64_t>(id));
    }
  }
  return {};
}

}  // namespace hyades::coordinator
