// Leases: made, taken back, ended.
#include <algorithm>
#include <utility>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {

/// The lease under the next number over units that are assigned to it already.
void Scheduler::new_lease(WorkerId id, Worker& worker, JobState& job, uint32_t slot, bool adopted,
                          std::vector<Extent> extents) {
  const LeaseId lease{options_.incarnation, next_lease_++};
  const TimePoint deadline = now_ + options_.lease_time;
  Lease action{id, lease, job.id, {}, deadline, adopted};
  for (const Extent& e : extents) action.units.push_back(unit_of(job, job.slots[slot], e));
  say(std::move(action));
  take_film(job, job.slots[slot]);
  set_running(job, static_cast<int64_t>(extents.size()));
  leases_.emplace(lease.number, LeaseState{id, job.id, slot, std::move(extents), deadline});
  worker.leases.push_back(lease.number);
  ++job.workers[id];
  deadlines_.emplace(deadline, lease.number);
}

void Scheduler::expire_leases() {
  while (!deadlines_.empty() && deadlines_.top().first <= now_) {
    const uint64_t number = deadlines_.top().second;
    deadlines_.pop();
    const auto it = leases_.find(number);
    if (it == leases_.end()) continue;
    if (it->second.deadline > now_) {
      deadlines_.emplace(it->second.deadline, number);
    } else {
      release_lease(number, true, true);
    }
  }
}

/// Takes the lease back: what it still held is free again.
void Scheduler::release_lease(uint64_t number, bool revoke, bool expired) {
  const auto it = leases_.find(number);
  const LeaseState lease = std::move(it->second);
  leases_.erase(it);
  std::erase(find_worker(lease.worker)->leases, number);
  JobState& job = *find_job(lease.job);
  FrameSlot& slot = job.slots[lease.slot];
  const LeaseId id{options_.incarnation, number};
  for (const Extent& e : lease.units) {
    slot.books->release(e, id);
    if (revoke) say(Revoke{lease.worker, id, job.id, unit_of(job, slot, e), expired});
  }
  set_running(job, -static_cast<int64_t>(lease.units.size()));
  leave_job(job, lease.worker);
  update_ready(job);
}

/// One lease less.
void Scheduler::leave_job(JobState& job, WorkerId worker) {
  const auto found = job.workers.find(worker);
  if (--found->second > 0) return;
  job.workers.erase(found);
  if (job.plan.max_workers > 0) work_appeared_ = true;
}

/// Whether the worker has what the job asks for, and the job's limit leaves room for it.
bool Scheduler::may_join(const JobState& job, WorkerId id, const Worker& worker) const {
  const bool room = job.plan.max_workers == 0 || job.workers.size() < job.plan.max_workers ||
                    job.workers.contains(id);
  return room && suits(job, worker);
}

/// The unit is no longer out under this lease; its books are the caller's business.
void Scheduler::drop_from_lease(const LeaseId& id, const Extent& e) {
  LeaseState* lease = find_lease(id);
  if (lease == nullptr || std::erase(lease->units, e) == 0) return;
  set_running(*find_job(lease->job), -1);
  if (!lease->units.empty()) return;
  leave_job(*find_job(lease->job), lease->worker);
  std::erase(find_worker(lease->worker)->leases, id.number);
  leases_.erase(id.number);
}

}  // namespace hyades::coordinator
