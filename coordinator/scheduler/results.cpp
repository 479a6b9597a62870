// Films that arrive, and what has become durable.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/scheduler/scheduler.h"
#include "core/base/overloaded.h"

namespace hyades::coordinator {

void Scheduler::on(const ResultArrived& e) {
  const auto reject = [&](RejectReason reason) {
    say(Reject{e.worker, e.lease, e.job, e.unit, reason});
  };
  JobState* job = find_job(e.job);
  FrameSlot* slot = job ? job->slot(e.unit.frame) : nullptr;
  if (slot == nullptr || slot->over()) return reject(RejectReason::unknown);
  const auto extent = extent_of(*job, e.unit);
  if (!extent) return reject(RejectReason::malformed);
  Worker* worker = find_worker(e.worker);
  if (worker == nullptr || slot->phase == FramePhase::waiting ||
      slot->phase == FramePhase::opening) {
    return reject(RejectReason::not_now);
  }
  if (quarantined_.contains(e.worker)) return reject(RejectReason::unknown);
  FrameState& books = *slot->books;
  // Its films are about to be void; this one may count then.
  if (books.in_doubt(extent->tile) || job->begins_again(*slot)) {
    return reject(RejectReason::not_now);
  }
  const HeldRecord* held = books.find_held(*extent);
  if (const Dispute* dispute = held ? books.find_dispute(*extent) : nullptr;
      dispute != nullptr && job->mark != DisputeMark::open) {
    // Who has heard an answer may forget its film, and that there is a dispute must be known then.
    reject(RejectReason::not_now);
  } else if (held != nullptr) {
    // After a restart what was merged has no digest any more.
    if (held->digest != Digest{} && held->digest != e.digest) {
      if (slot->worker_class != worker->worker_class) return reject(RejectReason::unknown);
      // What is held may not become durable after all, and the dispute is over then: that the two
      // differ would be forgotten with the film of this one.
      const bool durable = held->pending == RecordId{};
      const bool right = weigh(*job, *slot, *extent, e);
      const bool known = durable && job->mark == DisputeMark::open;
      reject(right || !known ? RejectReason::not_now : RejectReason::conflict);
    } else {
      if (held->pending == RecordId{}) {
        say(Acknowledge{e.worker, e.lease, e.job, e.unit});
      } else {
        pending_.at(held->pending).waiters.push_back({e.worker, e.lease});
      }
      if (held->digest != Digest{}) weigh(*job, *slot, *extent, e);
    }
  } else if (books.any_held(*extent)) {
    reject(RejectReason::overlap);
  } else if (slot->worker_class != 0 && slot->worker_class != worker->worker_class) {
    reject(RejectReason::unknown);
  } else {
    slot->worker_class = worker->worker_class;
    accept(*job, *slot, *extent, e);
    forgive_and_blame(*job, *slot, *extent, e.worker);
    learn_cost(*job, *extent, e.render_time);
    learn_load(*job, *worker, e);
  }
  end_unit(*job, *slot, *extent, e.lease);
  update_ready(*job);
  open_frames(*job);
}

/// The film counts once it is durable. Whoever else renders the unit can stop.
void Scheduler::accept(JobState& job, FrameSlot& slot, const Extent& extent,
                       const ResultArrived& e) {
  take_film(job, slot);
  slot.books->hold(extent, {extent.batches, e.digest, e.worker, RecordId{next_record_}});
  for (const Holder& holder : slot.books->end_assignment(extent)) {
    drop_from_lease(holder.lease, extent);
    if (holder.lease != e.lease) say(Revoke{holder.worker, holder.lease, job.id, e.unit});
  }
  persist(UnitRecord{job.id, {e.unit, e.digest, class_names_[slot.worker_class]}},
          {{}, extent, {{e.worker, e.lease}}});
}

/// The lease no longer holds the unit that `part` is of, if it did.
void Scheduler::end_unit(JobState& job, FrameSlot& slot, const Extent& part, const LeaseId& lease) {
  if (!slot.books) return;
  const Assignment* assignment = slot.books->find_covering(part, lease);
  if (assignment == nullptr) return;
  const Extent whole = assignment->extent;
  slot.books->release(whole, lease);
  drop_from_lease(lease, whole);
  update_ready(job);
}

/// A unit is rendered: its worker can, and those who failed it cannot blame the unit. Units that
/// nobody can render are nobody's fault, so that a broken job puts no worker into quarantine.
void Scheduler::forgive_and_blame(JobState& job, FrameSlot& slot, const Extent& extent,
                                  WorkerId worker) {
  strikes_.erase(worker);
  const FrameState::Failures failures = slot.books->take_blame(extent);
  for (const WorkerId failed : failures.workers) {
    if (failed == worker) continue;
    Strikes& strikes = strikes_[failed];
    strikes.reason = failures.reason;
    if (++strikes.count < options_.max_strikes) continue;
    const std::string why =
        fmt::format("failed {} units in a row that others could render, the last of job {}: {}",
                    strikes.count, static_cast<uint64_t>(job.id), strikes.reason);
    strikes_.erase(failed);
    quarantine(failed, why);
  }
}

void Scheduler::learn_cost(JobState& job, const Extent& extent, Duration render_time) {
  if (render_time <= Duration{0}) return;
  const double cost = std::chrono::duration<double>(render_time).count() / extent.batches.count;
  float& known = job.tile_cost[extent.tile];
  known = static_cast<float>(known > 0 ? 0.5 * (known + cost) : cost);
  const double rate = std::max(0.02, 1.0 / static_cast<double>(++job.costs_known));
  job.mean_cost += rate * (cost - job.mean_cost);
}

void Scheduler::on(const UnitReturned& e) {
  JobState* job = find_job(e.job);
  FrameSlot* slot = job ? job->slot(e.unit.frame) : nullptr;
  const auto extent = job ? extent_of(*job, e.unit) : std::nullopt;
  if (slot != nullptr && extent) end_unit(*job, *slot, *extent, e.lease);
}

void Scheduler::on(const UnitFailed& e) {
  JobState* job = find_job(e.job);
  FrameSlot* slot = job ? job->slot(e.unit.frame) : nullptr;
  const auto extent = job ? extent_of(*job, e.unit) : std::nullopt;
  // A failure under a lease that has ended proves nothing that its successor would not show.
  if (slot == nullptr || !slot->books || !extent) return;
  const Assignment* assignment = slot->books->find_covering(*extent, e.lease);
  if (assignment == nullptr) return;
  const Extent whole = assignment->extent;
  slot->books->blame(whole, e.worker, e.reason);
  end_unit(*job, *slot, *extent, e.lease);
  if (hopeless(*job, *slot, whole)) fail_frame(*job, *slot, e.reason);
}

/// Whether a unit has failed with so many different workers that it is the unit's fault; or that
/// often in all, and nobody is there who has not tried.
bool Scheduler::hopeless(const JobState& job, const FrameSlot& slot, const Extent& extent) {
  std::vector<WorkerId> tried = slot.books->blamed(extent);
  const size_t failures = tried.size();
  std::sort(tried.begin(), tried.end());
  tried.erase(std::unique(tried.begin(), tried.end()), tried.end());
  if (tried.size() >= job.plan.max_attempts) return true;
  if (failures < job.plan.max_attempts) return false;
  // Those whose films of it are the matter are not asked again.
  if (const Dispute* dispute = slot.books->find_dispute(extent)) {
    for (const Opinion& o : dispute->opinions) tried.push_back(o.worker);
  }
  return !anybody_besides(tried, job, slot.worker_class);
}

void Scheduler::persist(Record record, Pending pending) {
  const RecordId id{next_record_++};
  say(Persist{id, record});
  pending.record = std::move(record);
  pending_.emplace(id, std::move(pending));
}

void Scheduler::on(const Persisted& e) {
  const auto it = pending_.find(e.record);
  if (it == pending_.end()) return;
  const Pending pending = std::move(it->second);
  pending_.erase(it);
  const auto frame_over = [this](JobId id, int32_t frame, FramePhase phase) {
    if (JobState* job = find_job(id)) this->frame_over(*job, *job->slot(frame), phase);
  };
  std::visit(core::Overloaded{
                 [&](const UnitRecord& unit) { unit_persisted(unit, pending, e.record); },
                 [&](const FrameFinishedRecord& finished) {
                   frame_over(finished.job, finished.frame, FramePhase::done);
                 },
                 [&](const FrameFailedRecord& failed) {
                   frame_over(failed.job, failed.failed.frame, FramePhase::failed);
                 },
                 [&](const FrameRestartedRecord& again) {
                   JobState* job = find_job(again.job);
                   if (job != nullptr) frame_restarted(*job, *job->slot(again.frame));
                 },
                 [&](const TileVoidedRecord& voided) { tile_voided(voided); },
                 [&](const DisputeRecord& dispute) {
                   if (JobState* job = find_job(dispute.job)) dispute_marked(*job, dispute.open);
                 },
                 [&](const WorkerOddRecord&) { --odd_records_; },
             },
             pending.record);
}

void Scheduler::unit_persisted(const UnitRecord& record, const Pending& pending, RecordId id) {
  const core::Unit& unit = record.accepted.unit;
  JobState* job = find_job(record.job);
  FrameSlot* slot = job ? job->slot(unit.frame) : nullptr;
  const bool counts = slot != nullptr && slot->phase == FramePhase::rendering &&
                      slot->books->waits_for(pending.extent, id);
  if (counts) {
    slot->books->made_durable(pending.extent);
    say(Merge{id, record.job, unit});
  }
  for (const Waiter& waiter : pending.waiters) {
    say(Acknowledge{waiter.worker, waiter.lease, record.job, unit});
  }
  if (counts) complete_if_so(*job, *slot);
}

void Scheduler::on(const PersistFailed& e) {
  const auto it = pending_.find(e.record);
  if (it == pending_.end()) return;
  storage_blocked_until_ = now_ + options_.storage_retry;
  if (!std::holds_alternative<UnitRecord>(it->second.record)) {
    to_persist_again_.push_back(e.record);
    return;
  }
  const Pending pending = std::move(it->second);
  pending_.erase(it);
  const auto& record = std::get<UnitRecord>(pending.record);
  JobState* job = find_job(record.job);
  FrameSlot* slot = job ? job->slot(record.accepted.unit.frame) : nullptr;
  // Its tile or frame may have begun again, and hold another film of these extents.
  if (slot != nullptr && slot->phase == FramePhase::rendering &&
      slot->books->waits_for(pending.extent, e.record)) {
    slot->books->unhold(pending.extent);
    update_ready(*job);
  }
  for (const Waiter& waiter : pending.waiters) {
    say(Reject{waiter.worker, waiter.lease, record.job, record.accepted.unit,
               RejectReason::not_now});
  }
}

void Scheduler::retry_persisting() {
  if (now_ < storage_blocked_until_) return;
  for (const RecordId id : std::exchange(to_persist_again_, {})) {
    const Record& record = pending_.at(id).record;
    if (still_wanted(record)) {
      say(Persist{id, record});
    } else {
      pending_.erase(id);
    }
  }
}

}  // namespace hyades::coordinator
