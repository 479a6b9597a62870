// Jobs: added, steered, ended; and whose turn it is among their owners.
#include <algorithm>
#include <memory>
#include <utility>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {

void Scheduler::on(const JobAdded& e) {
  if (jobs_.contains(e.job)) return;
  auto owned = std::make_unique<JobState>();
  JobState& job = *owned;
  job.id = e.job;
  job.serial = next_job_serial_++;
  job.share = share_of(e.plan.priority, e.plan.owner);
  job.plan = e.plan;
  job.tags = intern_tags(e.plan.needs.tags);
  job.grid = TileGrid(e.plan.region, e.plan.tile_size, e.plan.shuffle);
  job.tile_cost.assign(job.grid.size(), 0.0F);
  for (const int32_t frame : e.plan.frames) {
    const auto index = static_cast<uint32_t>(job.slots.size());
    if (job.by_number.emplace(frame, index).second) job.slots.emplace_back().frame = frame;
  }
  jobs_.emplace(e.job, std::move(owned));
  restore(job, e.restored);
  job.waiting = static_cast<uint64_t>(
      std::count_if(job.slots.begin(), job.slots.end(),
                    [](const FrameSlot& slot) { return slot.phase == FramePhase::waiting; }));
  if (e.restored.disputed) {
    // Nobody knows any more who was odd, and what else it did.
    distrust_restored_ = true;
    job.mark = DisputeMark::open;
    marked_.insert(job.id);
  }
  if (distrust_restored_) doubt_films_of(WorkerId{});
  for (uint32_t i = 0; i < job.slots.size(); ++i) {
    FrameSlot& slot = job.slots[i];
    if (slot.phase == FramePhase::waiting && slot.books && slot.books->complete()) {
      --job.waiting;
      job.in_flight.push_back(i);
      finish(job, slot);
    }
  }
  open_frames(job);
  end_job_if_over(job);
}

void Scheduler::restore(JobState& job, const RestoredJob& restored) {
  for (const int32_t frame : restored.finished) {
    if (FrameSlot* slot = job.slot(frame); slot && slot->phase == FramePhase::waiting) {
      slot->phase = FramePhase::done;
      ++job.frames_done;
    }
  }
  for (const FailedFrame& failed : restored.failed) {
    FrameSlot* slot = job.slot(failed.frame);
    if (slot && slot->phase == FramePhase::waiting) {
      slot->phase = FramePhase::failed;
      slot->reason = failed.reason;
      ++job.frames_failed;
    }
  }
  for (const AcceptedUnit& accepted : restored.accepted) {
    FrameSlot* slot = job.slot(accepted.unit.frame);
    const auto extent = extent_of(job, accepted.unit);
    if (slot == nullptr || slot->phase != FramePhase::waiting || !extent) continue;
    if (!slot->books) {
      slot->books = std::make_unique<FrameState>(job.grid.order(), job.plan.batches);
      slot->worker_class = intern_class(accepted.worker_class);
      take_film(job, *slot);
    }
    if (slot->books->any_held(*extent)) continue;
    slot->books->hold(*extent, {extent->batches, accepted.digest, WorkerId{}, RecordId{}});
  }
}

void Scheduler::on(const JobPaused& e) {
  if (JobState* job = find_job(e.job)) {
    job->paused = true;
    update_ready(*job);
  }
}

void Scheduler::on(const JobResumed& e) {
  if (JobState* job = find_job(e.job)) {
    job->paused = false;
    update_ready(*job);
    open_frames(*job);
  }
}

void Scheduler::on(const JobCancelled& e) {
  JobState* job = find_job(e.job);
  if (job == nullptr) return;
  for (const uint32_t i : job->in_flight) take_back_frame(*job, job->slots[i]);
  for (FrameSlot& slot : job->slots) drop_film(*job, slot);
  job->in_flight.clear();
  update_ready(*job);
  say(JobEnded{e.job, job->frames_done, job->frames_failed, true});
  marked_.erase(e.job);
  jobs_.erase(e.job);
}

void Scheduler::on(const JobReprioritised& e) {
  JobState* job = find_job(e.job);
  if (job == nullptr || job->plan.priority == e.priority) return;
  const auto running = static_cast<int64_t>(job->running);
  list_ready(*job, false);
  set_running(*job, -running);
  job->plan.priority = e.priority;
  work_appeared_ = true;
  job->share = share_of(e.priority, job->plan.owner);
  set_running(*job, running);
  update_ready(*job);
}

void Scheduler::on(const FramesDoubted& e) {
  JobState* job = find_job(e.job);
  if (job == nullptr) return;
  for (const int32_t frame : e.frames) {
    FrameSlot* slot = job->slot(frame);
    if (slot == nullptr) continue;
    if (slot->phase == FramePhase::done) {
      --job->frames_done;
      job->in_flight.push_back(static_cast<uint32_t>(slot - job->slots.data()));
      restart_frame(*job, *slot);
    } else if (slot->phase == FramePhase::finishing ||
               (slot->phase == FramePhase::closing && slot->books)) {
      slot->doubted = true;
    }
  }
}

void Scheduler::on(const FramesRetried& e) {
  JobState* job = find_job(e.job);
  if (job == nullptr) return;
  for (uint32_t i = 0; i < job->slots.size(); ++i) {
    FrameSlot& slot = job->slots[i];
    if (slot.phase != FramePhase::failed) continue;
    --job->frames_failed;
    job->in_flight.push_back(i);
    restart_frame(*job, slot);
  }
}

void Scheduler::end_job_if_over(JobState& job) {
  if (job.frames_done + job.frames_failed < job.slots.size()) return;
  update_ready(job);
  say(JobEnded{job.id, job.frames_done, job.frames_failed, false});
  marked_.erase(job.id);
  jobs_.erase(job.id);
}

uint32_t Scheduler::share_of(int priority, const std::string& owner) {
  const auto [it, fresh] =
      share_index_.try_emplace({priority, owner}, static_cast<uint32_t>(shares_.size()));
  if (fresh) shares_.push_back({priority, owner, 0, {}});
  return it->second;
}

void Scheduler::set_running(JobState& job, int64_t change) {
  job.running += static_cast<uint64_t>(change);
  const uint32_t index = job.share;
  Share& share = shares_[index];
  if (!share.ready.empty()) ready_shares_.erase({-share.priority, share.running, index});
  share.running += static_cast<uint64_t>(change);
  if (!share.ready.empty()) ready_shares_.insert({-share.priority, share.running, index});
}

/// Lists the job among those that have work, or takes it off the list. Those who wait are served
/// again only where there is more than before: what was there did not suit them.
void Scheduler::update_ready(JobState& job) {
  uint64_t offer = 0;
  for (const uint32_t i : job.in_flight) {
    const FrameSlot& slot = job.slots[i];
    if (job.paused || slot.phase != FramePhase::rendering) continue;
    offer += slot.books->free() + slot.books->waiting_checks();
  }
  if (offer > job.offer) work_appeared_ = true;
  offered_ += offer - job.offer;
  job.offer = offer;
  list_ready(job, offer > 0);
}

void Scheduler::list_ready(JobState& job, bool ready) {
  if (ready == job.ready) return;
  job.ready = ready;
  Share& share = shares_[job.share];
  if (ready) {
    share.ready.emplace(job.serial, &job);
    if (share.ready.size() == 1) {
      ready_shares_.insert({-share.priority, share.running, job.share});
    }
  } else {
    share.ready.erase(job.serial);
    if (share.ready.empty()) ready_shares_.erase({-share.priority, share.running, job.share});
  }
}

}  // namespace hyades::coordinator
