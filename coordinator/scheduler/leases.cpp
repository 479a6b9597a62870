#include "coordinator/scheduler/leases.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace hyades::coordinator {

Assignment& Leases::assign(FrameSlot& slot, const Extent& extent, WorkerId worker) {
  Assignment& assignment = slot.ledger->assign(extent, {worker, id_of(next_)}, next_assignment_++);
  assignment.since = step_.now;
  return assignment;
}

void Leases::copy(Assignment& assignment, WorkerId worker) const {
  assignment.holders.push_back({worker, id_of(next_)});
}

Leases::Entry* Leases::find(const LeaseId& id) {
  if (id.incarnation != options_.incarnation) return nullptr;
  const auto it = leases_.find(id.number);
  return it == leases_.end() ? nullptr : &it->second;
}

bool Leases::is_of(const LeaseId& id, WorkerId worker) const {
  const auto found = leases_.find(id.number);
  return id.incarnation == options_.incarnation && found != leases_.end() &&
         found->second.worker == worker;
}

bool Leases::holds(WorkerId worker, const LeaseId& lease, JobId id, const core::Unit& unit) const {
  if (!is_of(lease, worker) || leases_.find(lease.number)->second.job != id) return false;
  const auto [job, slot] = jobs_.find_frame({id, unit.frame});
  if (slot == nullptr || !slot->ledger) return false;
  const auto extent = job->extent_of(unit);
  return extent && slot->ledger->find_covering(*extent, lease) != nullptr;
}

TimePoint Leases::since(const UnitInHand& held) const {
  const auto [job, slot] = jobs_.find_frame({held.job, held.unit.frame});
  return slot->ledger->find_covering(*job->extent_of(held.unit), held.lease)->since;
}

std::vector<UnitInHand> Leases::units_of(WorkerId worker, const LeaseId& lease) const {
  std::vector<UnitInHand> units;
  const auto found = leases_.find(lease.number);
  if (lease.incarnation != options_.incarnation || found == leases_.end() ||
      found->second.worker != worker) {
    return units;
  }
  const ScheduledJob& job = *jobs_.find(found->second.job);
  for (const Extent& extent : found->second.units) {
    units.push_back({lease, job.id, job.unit_of(job.slots[found->second.slot], extent)});
  }
  return units;
}

void Leases::grant(WorkerId id, Worker& worker, const FramePlace& place, std::vector<Extent> units,
                   bool adopted) {
  ScheduledJob& job = *place.job;
  const LeaseId lease = id_of(next_++);
  const TimePoint deadline = step_.now + options_.lease_time;
  Lease action{id, lease, job.id, {}, deadline, adopted};
  for (const Extent& e : units) action.units.push_back(job.unit_of(place.frame(), e));
  step_.say(std::move(action));
  films_.take(job, place.frame());
  jobs_.count_running(job, static_cast<int64_t>(units.size()));
  worker.units += static_cast<uint32_t>(units.size());
  leases_.emplace(lease.number, Entry{id, job.id, place.slot, std::move(units), deadline});
  worker.leases.insert(lease.number);
  ++job.workers[id];
  deadlines_.emplace(deadline, lease.number);
}

void Leases::renew(WorkerId worker, const LeaseId& id) {
  Entry* lease = find(id);
  if (lease != nullptr && lease->worker == worker)
    lease->deadline = step_.now + options_.lease_time;
}

void Leases::release_all(const Worker& worker, bool revoke) {
  const std::set<uint64_t> numbers = worker.leases;
  for (const uint64_t number : numbers) release(number, revoke);
}

void Leases::end_assignment(const ScheduledJob& job, FrameSlot& slot, const Extent& extent,
                            const LeaseId& delivered) {
  for (const Holder& holder : slot.ledger->end_assignment(extent)) {
    drop_unit(holder.lease, extent);
    if (holder.lease == delivered) continue;
    step_.say(Revoke{holder.worker, holder.lease, job.id, job.unit_of(slot, extent)});
  }
}

std::optional<TimePoint> Leases::next_deadline() const {
  if (deadlines_.empty()) return std::nullopt;
  return deadlines_.top().first;
}

void Leases::expire() {
  while (!deadlines_.empty() && deadlines_.top().first <= step_.now) {
    const uint64_t number = deadlines_.top().second;
    deadlines_.pop();
    const auto it = leases_.find(number);
    if (it == leases_.end()) continue;
    if (it->second.deadline > step_.now) {
      deadlines_.emplace(it->second.deadline, number);
    } else {
      release(number, true, true);
    }
  }
}

/// Takes the lease back: what it still held is free again.
void Leases::release(uint64_t number, bool revoke, bool expired) {
  const auto it = leases_.find(number);
  const Entry lease = std::move(it->second);
  leases_.erase(it);
  Worker& worker = *workers_.find(lease.worker);
  worker.leases.erase(number);
  worker.units -= static_cast<uint32_t>(lease.units.size());
  ScheduledJob& job = *jobs_.find(lease.job);
  FrameSlot& slot = job.slots[lease.slot];
  const LeaseId id = id_of(number);
  for (const Extent& e : lease.units) {
    slot.ledger->release(e, id);
    if (revoke) step_.say(Revoke{lease.worker, id, job.id, job.unit_of(slot, e), expired});
  }
  jobs_.count_running(job, -static_cast<int64_t>(lease.units.size()));
  leave_job(job, lease.worker);
  jobs_.update_offer(job);
}

/// One lease less.
void Leases::leave_job(ScheduledJob& job, WorkerId worker) {
  const auto found = job.workers.find(worker);
  if (--found->second > 0) return;
  job.workers.erase(found);
  if (job.plan.max_workers > 0) step_.work_appeared = true;
}

/// The unit is no longer out under this lease; the ledger is the caller's business.
void Leases::drop_unit(const LeaseId& id, const Extent& e) {
  Entry* lease = find(id);
  if (lease == nullptr || std::erase(lease->units, e) == 0) return;
  jobs_.count_running(*jobs_.find(lease->job), -1);
  Worker& worker = *workers_.find(lease->worker);
  --worker.units;
  if (!lease->units.empty()) return;
  leave_job(*jobs_.find(lease->job), lease->worker);
  worker.leases.erase(id.number);
  leases_.erase(id.number);
}

void Leases::end_unit(ScheduledJob& job, FrameSlot& slot, const Extent& part,
                      const LeaseId& lease) {
  if (!slot.ledger) return;
  const Assignment* assignment = slot.ledger->find_covering(part, lease);
  if (assignment == nullptr) return;
  const Extent whole = assignment->extent;
  slot.ledger->release(whole, lease);
  drop_unit(lease, whole);
  jobs_.update_offer(job);
}

void Leases::take_back(ScheduledJob& job, FrameSlot& slot) {
  if (!slot.ledger || !slot.ledger->any_assigned()) return;
  const uint32_t index = job.index_of(slot);
  std::vector<uint64_t> numbers;
  for (const auto& [number, lease] : leases_) {
    if (lease.job == job.id && lease.slot == index) numbers.push_back(number);
  }
  std::sort(numbers.begin(), numbers.end());
  for (const uint64_t number : numbers) release(number, true);
}

std::vector<UnitInHand> Leases::units_of(WorkerId worker) const {
  std::vector<UnitInHand> units;
  const Worker* found = std::as_const(workers_).find(worker);
  if (found == nullptr) return units;
  for (const uint64_t number : found->leases) {
    for (const UnitInHand& unit : units_of(worker, id_of(number))) units.push_back(unit);
  }
  return units;
}

std::vector<std::pair<WorkerId, UnitInHand>> Leases::units_of(JobId id) const {
  std::vector<std::pair<WorkerId, UnitInHand>> units;
  const ScheduledJob* job = jobs_.find(id);
  if (job == nullptr) return units;
  for (const auto& [worker, leases] : job->workers) {
    for (const UnitInHand& unit : units_of(worker)) {
      if (unit.job == id) units.emplace_back(worker, unit);
    }
  }
  return units;
}

std::string Leases::audit(std::map<std::pair<JobId, uint32_t>, size_t>& out) const {
  for (const auto& [number, lease] : leases_) {
    if (lease.units.empty()) return fmt::format("lease {} holds nothing", number);
    const Worker* worker = std::as_const(workers_).find(lease.worker);
    if (worker == nullptr || !worker->leases.contains(number)) {
      return fmt::format("lease {} is not on its worker's list", number);
    }
    const ScheduledJob* job = jobs_.find(lease.job);
    if (job == nullptr) return fmt::format("lease {} belongs to no job", number);
    const FrameSlot& slot = job->slots[lease.slot];
    if (!slot.ledger) return fmt::format("lease {} belongs to a frame that is over", number);
    for (const Extent& e : lease.units) {
      const Assignment* a = slot.ledger->find_assignment(e);
      if (a == nullptr) return fmt::format("lease {} holds a unit that nobody is assigned", number);
      out[{lease.job, lease.slot}] += 1;
    }
  }
  return {};
}

}  // namespace hyades::coordinator
