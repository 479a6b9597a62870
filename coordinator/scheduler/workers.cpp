// Workers that come, go, wait for work and say that they live.
#include <algorithm>
#include <utility>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {
namespace {

/// More than any worker can use; a wish beyond it is a mistake or malice.
constexpr uint32_t kMaxWanted = 1U << 16;
/// How often the waiting workers are offered copies.
constexpr Duration kCopyRound = std::chrono::milliseconds(250);

}  // namespace

void Scheduler::on(const WorkerJoined& e) {
  on(WorkerLost{e.worker});
  Worker& worker = workers_[e.worker];
  worker.threads = e.threads;
  worker.worker_class = intern_class(e.worker_class);
  worker.tags = intern_tags(e.tags);
  worker.memory = e.memory;
  worker.in_turn = now_;
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
  remember_scene(worker, {held.job, held.unit.frame}, false);
  settle(worker, Scene{held.job, held.unit.frame});
  update_ready(*job);
}

void Scheduler::on(const WorkRequested& e) {
  Worker* worker = find_worker(e.worker);
  if (worker == nullptr) return;
  worker->wanted = std::min(kMaxWanted, worker->wanted + std::min(e.units, kMaxWanted));
  if (may_lease()) serve(e.worker, *worker, true);
  set_waiting(e.worker, *worker);
}

void Scheduler::on(const LeasingHeld& e) {
  leasing_held_ = e.held;
  work_appeared_ = true;
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
  if (!e.barred) {
    quarantined_.erase(e.worker);
    strikes_.erase(e.worker);
  }
  Worker* worker = find_worker(e.worker);
  if (worker == nullptr || worker->barred == e.barred) return;
  worker->barred = e.barred;
  if (e.barred) settle(*worker, std::nullopt);
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
  settle(*worker, std::nullopt);
  if (!worker->barred) count_class(worker->worker_class, -1);
  workers_.erase(e.worker);
  // A unit that failed with others may now be theirs to try again.
  work_appeared_ = true;
}

void Scheduler::on(const WorkerForgotten& e) {
  on(WorkerLost{e.worker});
  quarantined_.erase(e.worker);
  strikes_.erase(e.worker);
}

void Scheduler::on(const Tick&) {
  expire_leases();
  retry_persisting();
  restart_orphans();
  if (now_ >= storage_blocked_until_) work_appeared_ = true;
  turned_away_ = false;
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
  if (!may_lease()) return;
  if (film_refused_ && !any_film_in_work()) serve_those_without_film();
  const bool copies = options_.copy_after > Duration{0} && now_ >= next_copy_round_;
  if (copies) next_copy_round_ = now_ + kCopyRound;
  if (!copies && !work_appeared_) return;
  work_appeared_ = false;
  for (auto it = waiting_.begin(); it != waiting_.end();) {
    const bool due =
        copies && !copy_candidates_.empty() && first_copy(copy_candidates_.front()) <= now_;
    if (ready_shares_.empty() && !due) return;
    const WorkerId id = it->second;
    Worker& worker = *find_worker(id);
    ++it;
    serve(id, worker, due);
    set_waiting(id, worker);
  }
}

}  // namespace hyades::coordinator
