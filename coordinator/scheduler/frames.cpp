// Frames: opened, finished, begun again, over.
#include <algorithm>
#include <memory>
#include <utility>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {

void Scheduler::on(const FrameOpened& e) {
  JobState* job = find_job(e.job);
  FrameSlot* slot = job ? job->slot(e.frame) : nullptr;
  if (slot == nullptr || slot->phase != FramePhase::opening) return;
  slot->phase = FramePhase::rendering;
  if (slot->doubted) return restart_frame(*job, *slot);
  void_doubted(*job, *slot);  // what it has from before a restart
  update_ready(*job);
  complete_if_so(*job, *slot);  // a frame without pixels
}

void Scheduler::on(const FrameRefused& e) {
  JobState* job = find_job(e.job);
  FrameSlot* slot = job ? job->slot(e.frame) : nullptr;
  if (slot == nullptr || slot->phase != FramePhase::opening) return;
  fail_frame(*job, *slot, e.reason);
}

void Scheduler::on(const FinishDone& e) {
  JobState* job = find_job(e.job);
  FrameSlot* slot = job ? job->slot(e.frame) : nullptr;
  if (slot == nullptr || slot->phase != FramePhase::finishing) return;
  if (job->begins_again(*slot)) return restart_frame(*job, *slot);
  if (!slot->books->settled()) return reopen_frame(*job, *slot);
  if (slot->doubted) return restart_frame(*job, *slot);
  slot->phase = FramePhase::closing;
  persist(FrameFinishedRecord{job->id, slot->frame}, {});
}

void Scheduler::on(const FinishFailed& e) {
  JobState* job = find_job(e.job);
  FrameSlot* slot = job ? job->slot(e.frame) : nullptr;
  if (slot == nullptr || slot->phase != FramePhase::finishing) return;
  if (job->begins_again(*slot)) return restart_frame(*job, *slot);
  if (!slot->books->settled()) return reopen_frame(*job, *slot);
  if (++slot->finish_attempts < job->plan.max_attempts) {
    say(FinishFrame{job->id, slot->frame, slot->books->unconfirmed()});
  } else {
    fail_frame(*job, *slot, e.reason);
  }
}

/// Opens frames while there is less than half a frame left to lease, or too little for all threads,
/// or those that are open have workers enough: the next scene is there before the last unit of this
/// one is gone, and not much earlier.
void Scheduler::open_frames(JobState& job) {
  if (job.paused) return;
  const uint64_t frame_total = uint64_t{job.grid.size()} * job.plan.batches;
  const uint64_t enough = std::max(frame_total / 2, 2 * threads_);
  while (job.in_flight.size() < std::max(job.plan.frames_in_flight, 1U)) {
    uint64_t free = 0;
    bool room = false;
    for (const uint32_t i : job.in_flight) {
      const FrameSlot& slot = job.slots[i];
      if (slot.phase == FramePhase::opening || slot.phase == FramePhase::rendering) {
        free += slot.books->free();
        room = room || has_room({&job, i});
      }
    }
    if (room && free > enough && job.plan.order == FrameOrder::sequential) return;
    while (job.next_slot < job.slots.size() &&
           job.slots[job.next_slot].phase != FramePhase::waiting) {
      ++job.next_slot;
    }
    if (job.next_slot == job.slots.size()) return;
    const auto index = static_cast<uint32_t>(job.next_slot);
    FrameSlot& slot = job.slots[index];
    slot.phase = FramePhase::opening;
    --job.waiting;
    if (!slot.books) {
      slot.books = std::make_unique<FrameState>(job.grid.order(), job.plan.batches);
    }
    job.in_flight.push_back(index);
    say(OpenFrame{job.id, slot.frame});
  }
}

void Scheduler::complete_if_so(JobState& job, FrameSlot& slot) {
  if (slot.phase == FramePhase::rendering && slot.books->complete()) finish(job, slot);
}

void Scheduler::finish(JobState& job, FrameSlot& slot) {
  // Late films may have overtaken units that are still out.
  take_back_frame(job, slot);
  slot.phase = FramePhase::finishing;
  say(FinishFrame{job.id, slot.frame, slot.books->unconfirmed()});
}

void Scheduler::fail_frame(JobState& job, FrameSlot& slot, std::string reason) {
  slot.phase = FramePhase::closing;
  slot.reason = std::move(reason);
  take_back_frame(job, slot);
  slot.books.reset();
  update_ready(job);
  persist(FrameFailedRecord{job.id, {slot.frame, slot.reason}}, {});
}

/// What is on its way to the disk of this frame's films is durable before the record, and void.
void Scheduler::restart_frame(JobState& job, FrameSlot& slot) {
  slot.phase = FramePhase::restarting;
  slot.doubted = false;
  take_back_frame(job, slot);
  slot.books.reset();
  update_ready(job);
  persist(FrameRestartedRecord{job.id, slot.frame}, {});
}

/// The same for a frame that has films from before a restart and was not opened since.
void Scheduler::restart_waiting(JobState& job, uint32_t slot) {
  --job.waiting;
  job.in_flight.push_back(slot);
  restart_frame(job, job.slots[slot]);
}

void Scheduler::frame_restarted(JobState& job, FrameSlot& slot) {
  const auto index = static_cast<uint32_t>(&slot - job.slots.data());
  slot.phase = FramePhase::waiting;
  drop_film(job, slot);
  ++job.waiting;
  slot.worker_class = 0;
  slot.orphaned.reset();
  slot.finish_attempts = 0;
  slot.reason.clear();
  std::erase(job.in_flight, index);
  job.next_slot = std::min<size_t>(job.next_slot, index);
  say(FrameRestarted{job.id, slot.frame});
  open_frames(job);
}

/// Frames whose class has been gone for too long begin again, if there is somebody to render them.
void Scheduler::restart_orphans() {
  if (options_.class_patience <= Duration{0} || now_ < next_orphan_check_) return;
  next_orphan_check_ = now_ + options_.class_patience / 4;
  if (threads_ == 0) return;
  for (const auto& [id, job] : jobs_) {
    if (job->paused) continue;
    const std::vector<uint32_t> in_flight = job->in_flight;
    for (const uint32_t i : in_flight) {
      FrameSlot& slot = job->slots[i];
      const uint32_t c = slot.worker_class;
      if (slot.phase != FramePhase::rendering || c == 0) continue;
      if (class_workers_[c] > 0 && anybody_for(*job, c)) {
        slot.orphaned.reset();
        continue;
      }
      if (!slot.orphaned) slot.orphaned = class_workers_[c] > 0 ? now_ : class_gone_[c];
      if (now_ < *slot.orphaned + options_.class_patience || slot.books->all_held()) continue;
      restart_frame(*job, slot);
    }
  }
}

void Scheduler::take_back_frame(JobState& job, FrameSlot& slot) {
  if (!slot.books || !slot.books->any_assigned()) return;
  const auto index = static_cast<uint32_t>(&slot - job.slots.data());
  std::vector<uint64_t> numbers;
  for (const auto& [number, lease] : leases_) {
    if (lease.job == job.id && lease.slot == index) numbers.push_back(number);
  }
  std::sort(numbers.begin(), numbers.end());
  for (const uint64_t number : numbers) release_lease(number, true);
}

void Scheduler::frame_over(JobState& job, FrameSlot& slot, FramePhase phase) {
  // While that was stored a worker that had a part in it was found odd.
  if (phase == FramePhase::done && (slot.doubted || !slot.books->settled())) {
    return restart_frame(job, slot);
  }
  slot.phase = phase;
  drop_film(job, slot);
  slot.books.reset();
  std::erase(job.in_flight, static_cast<uint32_t>(&slot - job.slots.data()));
  if (phase == FramePhase::done) {
    ++job.frames_done;
    say(FrameDone{job.id, slot.frame});
  } else {
    ++job.frames_failed;
    say(FrameFailed{job.id, slot.frame, slot.reason});
  }
  open_frames(job);
  end_job_if_over(job);
}

}  // namespace hyades::coordinator
