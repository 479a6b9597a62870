#include "coordinator/scheduler/job_lifecycle.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <set>

namespace hyades::coordinator {

void JobLifecycle::on(const JobAdded& e) {
  if (jobs_.find(e.job) != nullptr) return;
  const JobNeeds& needs = e.plan.needs;
  const Needs asked{tag_ids(needs.tags), needs.memory, needs.render_class};
  ScheduledJob& job =
      jobs_.add(e.job, e.plan, asked, [this](const Needs& of) { return workers_.count(of); });
  restore(job, e.restored);
  job.waiting = static_cast<uint64_t>(
      std::count_if(job.slots.begin(), job.slots.end(),
                    [](const FrameSlot& slot) { return slot.phase == FramePhase::waiting; }));
  conflicts_.restored(job, e.restored.disputed);
  for (uint32_t i = 0; i < job.slots.size(); ++i) {
    FrameSlot& slot = job.slots[i];
    if (slot.phase == FramePhase::waiting && slot.ledger && slot.ledger->complete()) {
      --job.waiting;
      job.in_flight.push_back(i);
      frames_.finish(job, slot);
    }
  }
  frames_.open(job);
  jobs_.end_if_over(job);
}

void JobLifecycle::restore(ScheduledJob& job, const RestoredJob& restored) {
  for (const int32_t frame : restored.finished) {
    if (FrameSlot* slot = job.slot(frame); slot && slot->phase == FramePhase::waiting) {
      slot->phase = FramePhase::done;
      ++job.frames_done;
    }
  }
  for (const int32_t frame : restored.failed) {
    FrameSlot* slot = job.slot(frame);
    if (slot && slot->phase == FramePhase::waiting) {
      slot->phase = FramePhase::failed;
      ++job.frames_failed;
    }
  }
  const std::set<int32_t> aside(restored.set_aside.begin(), restored.set_aside.end());
  for (const AcceptedUnit& accepted : restored.accepted) {
    FrameSlot* slot = job.slot(accepted.unit.frame);
    const auto extent = job.extent_of(accepted.unit);
    if (slot == nullptr || slot->phase != FramePhase::waiting || !extent) continue;
    if (!slot->ledger) {
      slot->ledger =
          std::make_unique<FrameLedger>(job.grid.order(), job.plan.batches, job.plan.rounds);
      slot->worker_class = class_id(job.plan.needs.render_class, accepted.worker_class);
      if (!aside.contains(slot->frame)) films_.take(job, *slot);
    }
    if (slot->ledger->any_held(*extent)) continue;
    slot->ledger->plan_for(*extent);
    slot->ledger->hold(*extent, {extent->batches, accepted.digest, WorkerId{}, RecordId{}});
  }
}

void JobLifecycle::on(const JobPaused& e) {
  if (ScheduledJob* job = jobs_.find(e.job)) {
    job->paused = true;
    films_.forget(job->id);
    jobs_.update_offer(*job);
  }
}

void JobLifecycle::on(const JobResumed& e) {
  if (ScheduledJob* job = jobs_.find(e.job)) {
    job->paused = false;
    jobs_.update_offer(*job);
    frames_.open(*job);
  }
}

void JobLifecycle::on(const JobCancelled& e) {
  ScheduledJob* job = jobs_.find(e.job);
  if (job == nullptr) return;
  for (const uint32_t i : job->in_flight) leases_.take_back(*job, job->slots[i]);
  for (FrameSlot& slot : job->slots) films_.drop(*job, slot);
  films_.forget(job->id);
  job->in_flight.clear();
  jobs_.end(*job, true);
}

void JobLifecycle::on(const JobReprioritised& e) {
  ScheduledJob* job = jobs_.find(e.job);
  if (job != nullptr && job->plan.priority != e.priority) jobs_.reprioritise(*job, e.priority);
}

void JobLifecycle::on(const FramesRetried& e) {
  ScheduledJob* job = jobs_.find(e.job);
  if (job == nullptr) return;
  job->bring_back_from = 0;
  frames_.bring_back_failed(*job);
}

void JobLifecycle::on(const FramesSuspected& e) {
  ScheduledJob* job = jobs_.find(e.job);
  if (job == nullptr) return;
  for (const int32_t frame : e.frames) {
    FrameSlot* slot = job->slot(frame);
    if (slot == nullptr) continue;
    if (slot->phase == FramePhase::done) {
      frames_.bring_back(*job, *slot);
    } else if (slot->phase == FramePhase::finishing ||
               (slot->phase == FramePhase::closing && slot->ledger)) {
      slot->suspect = true;
    }
  }
}

}  // namespace hyades::coordinator
