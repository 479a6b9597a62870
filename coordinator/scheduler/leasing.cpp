// Workers and their leases.
#include <algorithm>
#include <utility>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {
namespace {

/// More than any worker can use; a wish beyond it is a mistake or malice.
constexpr uint32_t kMaxWanted = 1U << 16;
/// How many of the oldest units are considered before a worker goes without a copy.
constexpr size_t kCopySearch = 16;
/// How often the waiting workers are offered copies.
constexpr Duration kCopyRound = std::chrono::milliseconds(250);

}  // namespace

void Scheduler::on(const WorkerJoined& e) {
  on(WorkerLost{e.worker});
  Worker& worker = workers_[e.worker];
  worker.threads = e.threads;
  worker.worker_class = intern_class(e.worker_class);
  threads_ += worker.threads;
  worker.barred = quarantined_.contains(e.worker);
  if (!worker.barred) count_class(worker.worker_class, 1);
  for (const UnitInHand& held : e.in_hand) adopt(e.worker, worker, held);
  for (const auto& [id, job] : jobs_) open_frames(*job);
}

void Scheduler::adopt(WorkerId id, Worker& worker, const UnitInHand& held) {
  JobState* job = find_job(held.job);
  FrameSlot* slot = job ? job->slot(held.unit.frame) : nullptr;
  const auto extent = job ? extent_of(*job, held.unit) : std::nullopt;
  if (slot == nullptr || !extent || quarantined_.contains(id) ||
      slot->phase != FramePhase::rendering ||
      (slot->worker_class != 0 && slot->worker_class != worker.worker_class) ||
      !slot->books->all_free(*extent)) {
    say(Revoke{id, held.lease, held.job, held.unit});
    return;
  }
  slot->worker_class = worker.worker_class;
  const auto index = static_cast<uint32_t>(slot - job->slots.data());
  const LeaseId next{options_.incarnation, next_lease_};
  note_copy_candidate(*job, index, slot->books->assign(*extent, {id, next}, next_assignment_++));
  new_lease(id, worker, *job, index, true, {*extent});
  update_ready(*job);
}

void Scheduler::on(const WorkRequested& e) {
  Worker* worker = find_worker(e.worker);
  if (worker == nullptr) return;
  worker->wanted = std::min(kMaxWanted, worker->wanted + std::min(e.units, kMaxWanted));
  if (now_ >= storage_blocked_until_) serve(e.worker, *worker, true);
  set_waiting(e.worker, *worker);
}

void Scheduler::on(const WorkerAlive& e) {
  Worker* worker = find_worker(e.worker);
  if (worker == nullptr) return;
  for (const LeaseId& id : e.leases) {
    LeaseState* lease = find_lease(id);
    if (lease != nullptr && lease->worker == e.worker) lease->deadline = now_ + options_.lease_time;
  }
}

void Scheduler::on(const WorkerBarred& e) {
  if (!e.barred) quarantined_.erase(e.worker);
  Worker* worker = find_worker(e.worker);
  if (worker == nullptr || worker->barred == e.barred) return;
  worker->barred = e.barred;
  count_class(worker->worker_class, e.barred ? -1 : 1);
  work_appeared_ = true;
}

/// One worker of the class more or less that may get units.
void Scheduler::count_class(uint32_t worker_class, int change) {
  class_workers_[worker_class] += static_cast<uint32_t>(change);
  if (change < 0 && class_workers_[worker_class] == 0) class_gone_[worker_class] = now_;
}

void Scheduler::on(const WorkerLost& e) {
  Worker* worker = find_worker(e.worker);
  if (worker == nullptr) return;
  const std::vector<uint64_t> numbers = worker->leases;
  for (const uint64_t number : numbers) release_lease(number, false);
  if (worker->waiting != 0) waiting_.erase(worker->waiting);
  threads_ -= worker->threads;
  if (!worker->barred) count_class(worker->worker_class, -1);
  workers_.erase(e.worker);
  // A unit that failed with others may now be theirs to try again.
  work_appeared_ = true;
}

void Scheduler::on(const Tick&) {
  expire_leases();
  retry_persisting();
  restart_orphans();
  if (now_ >= storage_blocked_until_) work_appeared_ = true;
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
      release_lease(number, true);
    }
  }
}

/// Takes the lease back: what it still held is free again.
void Scheduler::release_lease(uint64_t number, bool revoke) {
  const auto it = leases_.find(number);
  const LeaseState lease = std::move(it->second);
  leases_.erase(it);
  std::erase(find_worker(lease.worker)->leases, number);
  JobState& job = *find_job(lease.job);
  FrameSlot& slot = job.slots[lease.slot];
  const LeaseId id{options_.incarnation, number};
  for (const Extent& e : lease.units) {
    slot.books->release(e, id);
    if (revoke) say(Revoke{lease.worker, id, job.id, unit_of(job, slot, e)});
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

/// Whether the job's limit leaves room for this worker.
bool Scheduler::may_join(const JobState& job, WorkerId worker) const {
  return job.plan.max_workers == 0 || job.workers.size() < job.plan.max_workers ||
         job.workers.contains(worker);
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

void Scheduler::set_waiting(WorkerId id, Worker& worker) {
  if (worker.wanted > 0 && worker.waiting == 0) {
    worker.waiting = next_waiting_++;
    waiting_.emplace(worker.waiting, id);
  } else if (worker.wanted == 0 && worker.waiting != 0) {
    waiting_.erase(worker.waiting);
    worker.waiting = 0;
  }
}

void Scheduler::serve(WorkerId id, Worker& worker, bool copies) {
  if (worker.barred) return;
  while (worker.wanted > 0 && grant(id, worker)) {
  }
  while (copies && worker.wanted > 0 && grant_copy(id, worker)) {
  }
}

/// Serves those who wait, where something has turned up for them.
void Scheduler::dispatch() {
  if (now_ < storage_blocked_until_) return;
  const bool copies = options_.copy_after > Duration{0} && now_ >= next_copy_round_;
  if (copies) next_copy_round_ = now_ + kCopyRound;
  if (!copies && !work_appeared_) return;
  work_appeared_ = false;
  for (auto it = waiting_.begin(); it != waiting_.end();) {
    const bool due = copies && !copy_candidates_.empty() &&
                     copy_candidates_.front().since + options_.copy_after <= now_;
    if (ready_shares_.empty() && !due) return;
    const WorkerId id = it->second;
    Worker& worker = *find_worker(id);
    ++it;
    serve(id, worker, due);
    set_waiting(id, worker);
  }
}

bool Scheduler::grant(WorkerId id, Worker& worker) {
  for (const auto& [priority, running, index] : ready_shares_) {
    for (const auto& [serial, job] : shares_[index].ready) {
      if (grant_from(*job, id, worker)) return true;
    }
  }
  return false;
}

bool Scheduler::grant_from(JobState& job, WorkerId id, Worker& worker) {
  if (!may_join(job, id)) return false;
  const auto judge = [&](const std::vector<WorkerId>& blamed) {
    return may_try(id, worker, blamed);
  };
  const MayTry allowed = std::ref(judge);
  for (const uint32_t index : job.in_flight) {
    FrameSlot& slot = job.slots[index];
    if (slot.phase != FramePhase::rendering) continue;
    if (slot.worker_class != 0 && slot.worker_class != worker.worker_class) continue;
    if (grant_check(job, index, id, worker, allowed)) return true;
    if (!slot.books->has_work(allowed)) continue;
    std::vector<Extent> extents;
    const LeaseId next{options_.incarnation, next_lease_};
    while (extents.size() < worker.wanted) {
      const auto extent = slot.books->next(
          allowed, [&](uint32_t tile) { return run_length(job, *slot.books, tile); });
      if (!extent) break;
      note_copy_candidate(job, index, slot.books->assign(*extent, {id, next}, next_assignment_++));
      extents.push_back(*extent);
    }
    if (extents.empty()) continue;
    slot.worker_class = worker.worker_class;
    worker.wanted -= static_cast<uint32_t>(extents.size());
    new_lease(id, worker, job, index, false, std::move(extents));
    update_ready(job);
    open_frames(job);
    return true;
  }
  return false;
}

/// Hands out a second copy of one of the oldest units: purity makes it safe, and whichever comes
/// first counts. No unit is copied twice.
bool Scheduler::grant_copy(WorkerId id, Worker& worker) {
  if (options_.copy_after <= Duration{0}) return false;
  while (!copy_candidates_.empty() && !live_copy_candidate(copy_candidates_.front())) {
    copy_candidates_.pop_front();
  }
  for (size_t i = 0; i < std::min(kCopySearch, copy_candidates_.size()); ++i) {
    const CopyCandidate candidate = copy_candidates_[i];
    if (candidate.since + options_.copy_after > now_) return false;
    Assignment* assignment = live_copy_candidate(candidate);
    if (assignment == nullptr || assignment->holders.front().worker == id) continue;
    JobState& job = *find_job(candidate.job);
    if (job.paused || job.slots[candidate.slot].worker_class != worker.worker_class) continue;
    if (!may_join(job, id)) continue;
    assignment->copied = true;
    assignment->holders.push_back({id, {options_.incarnation, next_lease_}});
    --worker.wanted;
    new_lease(id, worker, job, candidate.slot, false, {candidate.extent});
    return true;
  }
  return false;
}

/// The lease under the next number over units that are assigned to it already.
void Scheduler::new_lease(WorkerId id, Worker& worker, JobState& job, uint32_t slot, bool adopted,
                          std::vector<Extent> extents) {
  const LeaseId lease{options_.incarnation, next_lease_++};
  const TimePoint deadline = now_ + options_.lease_time;
  Lease action{id, lease, job.id, {}, deadline, adopted};
  for (const Extent& e : extents) action.units.push_back(unit_of(job, job.slots[slot], e));
  say(std::move(action));
  set_running(job, static_cast<int64_t>(extents.size()));
  leases_.emplace(lease.number, LeaseState{id, job.id, slot, std::move(extents), deadline});
  worker.leases.push_back(lease.number);
  ++job.workers[id];
  deadlines_.emplace(deadline, lease.number);
}

/// As many batches as take one thread options_.unit_time, but not so many that the threads would
/// end far apart.
uint32_t Scheduler::run_length(const JobState& job, const FrameState& books, uint32_t tile) const {
  const double cost = job.tile_cost[tile] > 0 ? job.tile_cost[tile] : job.mean_cost;
  if (cost <= 0) return 1;
  const double seconds = std::chrono::duration<double>(options_.unit_time).count();
  const double by_time = std::clamp(seconds / cost, 1.0, 1e6);
  const uint64_t by_spread = books.free() / (2 * std::max<uint64_t>(threads_, 1));
  return static_cast<uint32_t>(
      std::max<uint64_t>(1, std::min(static_cast<uint64_t>(by_time), by_spread)));
}

/// A unit that has failed goes to somebody who has not failed it yet, if there is anybody.
bool Scheduler::may_try(WorkerId id, const Worker& worker,
                        const std::vector<WorkerId>& blamed) const {
  if (std::find(blamed.begin(), blamed.end(), id) == blamed.end()) return true;
  std::vector<WorkerId> here;
  for (const WorkerId b : blamed) {
    const auto it = workers_.find(b);
    if (it == workers_.end() || it->second.worker_class != worker.worker_class) continue;
    if (std::find(here.begin(), here.end(), b) == here.end()) here.push_back(b);
  }
  return here.size() >= class_workers_[worker.worker_class];
}

void Scheduler::note_copy_candidate(const JobState& job, uint32_t slot,
                                    const Assignment& assignment) {
  if (options_.copy_after <= Duration{0}) return;
  if (copy_candidates_.size() >= copy_candidates_checked_) {
    std::erase_if(copy_candidates_,
                  [&](const CopyCandidate& c) { return !live_copy_candidate(c); });
    copy_candidates_checked_ = std::max<size_t>(64, 2 * copy_candidates_.size());
  }
  copy_candidates_.push_back({now_, assignment.serial, job.id, slot, assignment.extent});
}

/// The assignment that may still be copied, or null.
Assignment* Scheduler::live_copy_candidate(const CopyCandidate& c) {
  JobState* job = find_job(c.job);
  if (job == nullptr || !job->slots[c.slot].books) return nullptr;
  Assignment* assignment = job->slots[c.slot].books->find_assignment(c.extent);
  if (assignment == nullptr || assignment->serial != c.serial || assignment->copied) return nullptr;
  return assignment;
}

}  // namespace hyades::coordinator
