#include "coordinator/scheduler/scheduled_jobs.h"

namespace hyades::coordinator {

ScheduledJob* ScheduledJobs::find(JobId id) const {
  const auto it = jobs_.find(id);
  return it == jobs_.end() ? nullptr : it->second.get();
}

FrameSlot* ScheduledJobs::find_frame(const FrameId& id) const {
  ScheduledJob* job = find(id.job);
  return job == nullptr ? nullptr : job->slot(id.frame);
}

ScheduledJob& ScheduledJobs::add(JobId id, const JobPlan& plan) {
  ScheduledJob& job = *jobs_.emplace(id, std::make_unique<ScheduledJob>()).first->second;
  job.id = id;
  job.serial = next_serial_++;
  job.share = share_of(plan.priority, plan.owner);
  job.plan = plan;
  job.grid = TileGrid(plan.region, plan.tile_size, plan.shuffle);
  job.tile_cost.assign(job.grid.size(), 0.0F);
  for (const int32_t frame : plan.frames) {
    const auto index = static_cast<uint32_t>(job.slots.size());
    if (job.by_number.emplace(frame, index).second) job.slots.emplace_back().frame = frame;
  }
  return job;
}

void ScheduledJobs::end(ScheduledJob& job, bool cancelled) {
  update_offer(job);
  step_.say(JobEnded{job.id, job.frames_done, job.frames_failed, cancelled});
  jobs_.erase(job.id);
}

void ScheduledJobs::end_if_over(ScheduledJob& job) {
  if (job.frames_done + job.frames_failed == job.slots.size()) end(job, false);
}

void ScheduledJobs::reprioritise(ScheduledJob& job, int priority) {
  const auto running = static_cast<int64_t>(job.running);
  list_ready(job, false);
  count_running(job, -running);
  job.plan.priority = priority;
  step_.work_appeared = true;
  job.share = share_of(priority, job.plan.owner);
  count_running(job, running);
  update_offer(job);
}

uint32_t ScheduledJobs::share_of(int priority, const std::string& owner) {
  const auto [it, fresh] =
      share_index_.try_emplace({priority, owner}, static_cast<uint32_t>(shares_.size()));
  if (fresh) shares_.push_back({priority, owner, 0, {}});
  return it->second;
}

void ScheduledJobs::count_running(ScheduledJob& job, int64_t change) {
  job.running += static_cast<uint64_t>(change);
  const uint32_t index = job.share;
  FairShare& share = shares_[index];
  if (!share.ready.empty()) ready_shares_.erase({-share.priority, share.running, index});
  share.running += static_cast<uint64_t>(change);
  if (!share.ready.empty()) ready_shares_.insert({-share.priority, share.running, index});
}

/// Those who wait are served again only where there is more than before: what was there did not
/// suit them.
void ScheduledJobs::update_offer(ScheduledJob& job) {
  uint64_t offer = 0;
  for (const uint32_t i : job.in_flight) {
    const FrameSlot& slot = job.slots[i];
    if (job.paused || slot.phase != FramePhase::rendering) continue;
    offer += slot.ledger->free() + slot.ledger->waiting_checks();
  }
  if (offer > job.offer) step_.work_appeared = true;
  offered_ += offer - job.offer;
  job.offer = offer;
  list_ready(job, offer > 0);
}

void ScheduledJobs::list_ready(ScheduledJob& job, bool ready) {
  if (ready == job.ready) return;
  job.ready = ready;
  FairShare& share = shares_[job.share];
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
