#include "coordinator/scheduler/scheduler.h"

#include <algorithm>
#include <utility>

namespace hyades::coordinator {
namespace {

/// How long a worker waits that came too late for a frame.
constexpr Duration kLookAgain = std::chrono::seconds(1);

}  // namespace

Scheduler::Scheduler(SchedulerOptions options) : options_(options) {
  // Class 0 stands for 'none yet'.
  class_names_.emplace_back();
  class_workers_.push_back(0);
  class_gone_.emplace_back();
}

std::vector<Action> Scheduler::handle(const Event& event, TimePoint now) {
  now_ = std::max(now_, now);
  std::visit([this](const auto& e) { on(e); }, event);
  end_marks();
  dispatch();
  return std::exchange(actions_, {});
}

JobState* Scheduler::find_job(JobId id) {
  const auto it = jobs_.find(id);
  return it == jobs_.end() ? nullptr : it->second.get();
}

Scheduler::Worker* Scheduler::find_worker(WorkerId id) {
  const auto it = workers_.find(id);
  return it == workers_.end() ? nullptr : &it->second;
}

std::optional<Extent> Scheduler::extent_of(const JobState& job, const core::Unit& unit) const {
  const auto tile = job.grid.index_of(unit.tile);
  const uint64_t end = uint64_t{unit.batches.first} + unit.batches.count;
  if (!tile || unit.batches.count == 0 || end > job.plan.batches) return std::nullopt;
  return Extent{*tile, unit.batches};
}

core::Unit Scheduler::unit_of(const JobState& job, const FrameSlot& slot,
                              const Extent& extent) const {
  return {slot.frame, job.grid.tile(extent.tile), extent.batches};
}

uint32_t Scheduler::intern_class(const std::string& name) {
  const auto [it, fresh] =
      class_index_.try_emplace(name, static_cast<uint32_t>(class_names_.size()));
  if (fresh) {
    class_names_.push_back(name);
    class_workers_.push_back(0);
    class_gone_.push_back(now_);
  }
  return it->second;
}

std::vector<uint32_t> Scheduler::intern_tags(const std::vector<std::string>& tags) {
  std::vector<uint32_t> numbers;
  for (const std::string& tag : tags) {
    const auto next = static_cast<uint32_t>(tag_index_.size());
    numbers.push_back(tag_index_.try_emplace(tag, next).first->second);
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// Whether a worker of the class may get units of the job.
bool Scheduler::anybody_for(const JobState& job, uint32_t worker_class) const {
  if (!job.plan.needs.any()) return class_workers_[worker_class] > 0;
  return std::any_of(workers_.begin(), workers_.end(), [&](const auto& entry) {
    return !entry.second.barred && entry.second.worker_class == worker_class &&
           suits(job, entry.second);
  });
}

Scheduler::LeaseState* Scheduler::find_lease(const LeaseId& id) {
  if (id.incarnation != options_.incarnation) return nullptr;
  const auto it = leases_.find(id.number);
  return it == leases_.end() ? nullptr : &it->second;
}

std::optional<TimePoint> Scheduler::next_wake() const {
  std::optional<TimePoint> wake;
  const auto at = [&](TimePoint t) { wake = wake ? std::min(*wake, t) : t; };
  if (!deadlines_.empty()) at(deadlines_.top().first);
  if (now_ < storage_blocked_until_) at(storage_blocked_until_);
  if (turned_away_) at(now_ + kLookAgain);
  if (options_.class_patience > Duration{0} && !jobs_.empty() && threads_ > 0) {
    at(next_orphan_check_);
  }
  if (!leasing_held_ && !waiting_.empty() && !copy_candidates_.empty() &&
      options_.copy_after > Duration{0}) {
    at(std::max(first_copy(copy_candidates_.front()), next_copy_round_));
  }
  return wake;
}

uint32_t Scheduler::leased_units(JobId id) const {
  const auto job = jobs_.find(id);
  return job == jobs_.end() ? 0 : static_cast<uint32_t>(job->second->running);
}

uint32_t Scheduler::disputed_units(JobId id) const {
  const auto job = jobs_.find(id);
  if (job == jobs_.end()) return 0;
  size_t units = 0;
  for (const uint32_t i : job->second->in_flight) {
    const FrameSlot& slot = job->second->slots[i];
    if (slot.books) units += slot.books->disputes();
  }
  return static_cast<uint32_t>(units);
}

uint32_t Scheduler::leased_units(WorkerId id) const {
  const auto worker = workers_.find(id);
  if (worker == workers_.end()) return 0;
  size_t units = 0;
  for (const uint64_t number : worker->second.leases) units += leases_.at(number).units.size();
  return static_cast<uint32_t>(units);
}

std::vector<UnitInHand> Scheduler::units_of(WorkerId worker, const LeaseId& lease) const {
  std::vector<UnitInHand> units;
  const auto found = leases_.find(lease.number);
  if (lease.incarnation != options_.incarnation || found == leases_.end() ||
      found->second.worker != worker) {
    return units;
  }
  const JobState& job = *jobs_.at(found->second.job);
  for (const Extent& extent : found->second.units) {
    units.push_back({lease, job.id, unit_of(job, job.slots[found->second.slot], extent)});
  }
  return units;
}

}  // namespace hyades::coordinator
