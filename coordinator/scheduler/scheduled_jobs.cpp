#include "coordinator/scheduler/scheduled_jobs.h"

#include <algorithm>

#include "coordinator/scheduler/scheduled_workers.h"

namespace hyades::coordinator {
namespace {

ScheduledJobs::ShareOrder order_of(const FairShare& share) {
  return {-share.priority, share.running, share.served, share.serial};
}

}  // namespace

bool Needs::are_met(const Worker& worker) const {
  return worker.class_in(render_class) != ClassId{} &&
         (memory == 0 || worker.memory == 0 || worker.memory >= memory) &&
         std::includes(worker.tags.begin(), worker.tags.end(), tags.begin(), tags.end());
}

ScheduledJob* ScheduledJobs::find(JobId id) const {
  const auto it = jobs_.find(id);
  return it == jobs_.end() ? nullptr : it->second.get();
}

FoundFrame ScheduledJobs::find_frame(const FrameId& id) const {
  ScheduledJob* job = find(id.job);
  FrameSlot* slot = job ? job->slot(id.frame) : nullptr;
  return slot ? FoundFrame{job, slot} : FoundFrame{};
}

ScheduledJob& ScheduledJobs::add(JobId id, const JobPlan& plan, const Needs& needs,
                                 const std::function<uint64_t(const Needs&)>& count) {
  ScheduledJob& job = *jobs_.emplace(id, std::make_unique<ScheduledJob>()).first->second;
  job.id = id;
  job.serial = next_serial_++;
  job.plan = plan;
  const auto [group, fresh] = needs_.try_emplace(needs);
  job.group = &group->second;
  job.group->jobs.emplace(id, &job);
  if (fresh) {
    job.group->serial = next_group_++;
    job.group->needs = needs;
    job.group->workers = count(needs);
  }
  join_share(job);
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
  leave_share(job);
  job.group->jobs.erase(job.id);
  if (job.group->jobs.empty()) needs_.erase(Needs(job.group->needs));
  records_.forget(job.id);
  jobs_.erase(job.id);
}

void ScheduledJobs::end_if_over(ScheduledJob& job) {
  if (job.bring_back_from) return;
  if (job.frames_done + job.frames_failed == job.slots.size()) end(job, false);
}

void ScheduledJobs::reprioritise(ScheduledJob& job, int priority) {
  const auto running = static_cast<int64_t>(job.running);
  list_ready(job, false);
  count_running(job, -running);
  leave_share(job);
  job.plan.priority = priority;
  step_.work_appeared = true;
  join_share(job);
  count_running(job, running);
  update_offer(job);
}

void ScheduledJobs::join_share(ScheduledJob& job) {
  const auto [at, fresh] = shares_.try_emplace({job.plan.priority, job.plan.owner});
  job.share = &at->second;
  if (fresh) {
    job.share->priority = job.plan.priority;
    job.share->serial = job.serial;
  }
  ++job.share->jobs;
}

void ScheduledJobs::leave_share(ScheduledJob& job) {
  if (--job.share->jobs == 0) shares_.erase({job.plan.priority, job.plan.owner});
  job.share = nullptr;
}

void ScheduledJobs::count_running(ScheduledJob& job, int64_t change) {
  job.running += static_cast<uint64_t>(change);
  FairShare& share = *job.share;
  ready_shares_.erase(order_of(share));
  share.running += static_cast<uint64_t>(change);
  if (change > 0) share.served = ++last_served_;
  if (!share.ready.empty()) ready_shares_.emplace(order_of(share), &share);
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
  list_ready(job, has_work(job));
}

/// What nobody who is there may render stands before no other's.
void ScheduledJobs::count_worker(const Worker& worker, bool one_more) {
  for (auto& [needs, group] : needs_) {
    if (!needs.are_met(worker)) continue;
    group.workers += one_more ? 1 : -1;
    if (group.workers > (one_more ? 1 : 0)) continue;
    for (const auto& [id, job] : group.jobs) list_ready(*job, has_work(*job));
  }
}

void ScheduledJobs::list_ready(ScheduledJob& job, bool ready) {
  if (ready == job.ready) return;
  job.ready = ready;
  FairShare& share = *job.share;
  if (ready) {
    FairShare::Ready& alike = share.ready[job.group->serial];
    alike.group = job.group;
    alike.jobs.emplace(job.serial, &job);
    ready_shares_.emplace(order_of(share), &share);
  } else {
    const auto alike = share.ready.find(job.group->serial);
    alike->second.jobs.erase(job.serial);
    if (alike->second.jobs.empty()) share.ready.erase(alike);
    if (share.ready.empty()) ready_shares_.erase(order_of(share));
  }
}

}  // namespace hyades::coordinator
