#include "coordinator/scheduler/results.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "core/base/hash.h"
#include "core/base/overloaded.h"

namespace hyades::coordinator {
namespace {

/// Whether the unit is one of those that two witnesses have to render: the same share of all units,
/// and always the same ones, which nobody without the seed can tell.
bool needs_two(const JobPlan& plan, int32_t frame, const Extent& extent) {
  if (plan.redundancy == 0) return false;
  const uint64_t place = core::hash_combine(static_cast<uint32_t>(frame),
                                            (uint64_t{extent.tile} << 32U) | extent.batches.first);
  return core::hash_combine(plan.redundancy_seed, place) % 100 < plan.redundancy;
}

}  // namespace

void Results::on(const ResultArrived& e) {
  const auto [job, slot] = jobs_.find_frame({e.job, e.unit.frame});
  if (slot == nullptr || slot->over()) return reject(e, RejectReason::unknown);
  const auto extent = job->extent_of(e.unit);
  if (!extent) return reject(e, RejectReason::malformed);
  Worker* worker = workers_.find(e.worker);
  if (worker == nullptr || slot->phase == FramePhase::waiting ||
      slot->phase == FramePhase::opening) {
    return reject(e, RejectReason::not_now);
  }
  if (workers_.quarantined(e.worker)) return reject(e, RejectReason::unknown);
  FrameLedger& ledger = *slot->ledger;
  // Its films are about to be void; this one may count then.
  if (ledger.is_suspect(extent->tile) || job->begins_again(*slot)) {
    return reject(e, RejectReason::not_now);
  }
  // Rendered for a coordinator that has ended, which had found the tile to need it. Whether it does
  // is asked again, so that nobody has to be believed.
  if (!ledger.is_planned(*extent)) {
    return reject(
        e, ledger.is_undecided(extent->tile) ? RejectReason::not_now : RejectReason::unknown);
  }
  const HeldRecord* held = ledger.find_held(*extent);
  // After a restart what was merged has no digest any more.
  const bool differs = held && held->digest != Digest{} && held->digest != e.digest;
  const Dispute* known = held ? ledger.find_dispute(*extent) : nullptr;
  if (known && known->differs && job->mark != DisputeMark::open) {
    // Who has heard an answer may forget its film, and that there is a dispute must be known then.
    reject(e, RejectReason::not_now);
  } else if (differs) {
    if (slot->worker_class != worker->class_for(*job)) return reject(e, RejectReason::unknown);
    dispute(*job, *slot, *extent, *held, worker->witness, e);
  } else if (held) {
    answer_again(*job, *slot, *extent, *held, worker->witness, e);
  } else if (ledger.any_held(*extent)) {
    reject(e, RejectReason::overlap);
  } else if (const ClassId own = worker->class_for(*job);
             own == ClassId{} || (slot->worker_class != ClassId{} && slot->worker_class != own)) {
    reject(e, RejectReason::unknown);
  } else if (!slot->film && !films_.has_place(*job)) {
    // It is late: its lease has ended, and the frame's film was set aside.
    films_.refuse(*job);
    reject(e, RejectReason::not_now);
  } else {
    accept(*job, *slot, *extent, *worker, e);
  }
  if (leases_.is_of(e.lease, e.worker)) leases_.end_unit(*job, *slot, *extent, e.lease);
  jobs_.update_offer(*job);
  frames_.open(*job);
}

void Results::reject(const ResultArrived& e, RejectReason reason) {
  step_.say(Reject{e.worker, e.lease, e.job, e.unit, reason});
}

/// The film differs from the one that is held.
void Results::dispute(ScheduledJob& job, FrameSlot& slot, const Extent& extent,
                      const HeldRecord& held, Witness witness, const ResultArrived& e) {
  // What is held may not become durable after all, and the dispute is over then: that the two
  // differ would be forgotten with the film of this one.
  const bool durable = held.pending == RecordId{};
  const bool right = conflicts_.weigh(job, slot, extent, witness, e);
  const bool known = durable && job.mark == DisputeMark::open;
  reject(e, right || !known ? RejectReason::not_now : RejectReason::conflict);
}

/// The film is the one that is held, as far as is known: it is acknowledged when that is durable.
void Results::answer_again(ScheduledJob& job, FrameSlot& slot, const Extent& extent,
                           const HeldRecord& held, Witness witness, const ResultArrived& e) {
  if (held.pending == RecordId{}) {
    step_.say(Acknowledge{e.worker, e.lease, e.job, e.unit});
  } else {
    records_.await(held.pending, {e.worker, e.lease});
  }
  if (held.digest != Digest{}) conflicts_.weigh(job, slot, extent, witness, e);
}

/// The film counts once it is durable. Whoever else renders the unit can stop.
void Results::accept(ScheduledJob& job, FrameSlot& slot, const Extent& extent, Worker& worker,
                     const ResultArrived& e) {
  slot.worker_class = worker.class_for(job);
  workers_.forget_given_back(e.worker);
  worker.delivered = step_.now;
  films_.take(job, slot);
  slot.ledger->hold(extent,
                    {extent.batches, e.digest, e.worker, records_.next_id(), worker.witness});
  if (needs_two(job.plan, slot.frame, extent)) {
    slot.ledger->open_dispute(extent, {e.worker, e.digest, worker.witness});
  }
  leases_.end_assignment(job, slot, extent, e.lease);
  records_.persist(UnitRecord{job.id, {e.unit, e.digest, workers_.name_of(slot.worker_class)}},
                   extent, {{e.worker, e.lease}});
  lifecycle_.forgive_and_blame(job, slot, extent, e.worker);
  learn_cost(job, extent, e.render_time);
  affinity_.learn_load(job, worker, e);
}

void Results::learn_cost(ScheduledJob& job, const Extent& extent, Duration render_time) {
  if (render_time <= Duration{0}) return;
  const double cost = seconds(render_time) / extent.batches.count;
  float& known = job.tile_cost[extent.tile];
  known = static_cast<float>(known > 0 ? 0.5 * (known + cost) : cost);
  const double rate = std::max(0.02, 1.0 / static_cast<double>(++job.costs_known));
  job.mean_cost += rate * (cost - job.mean_cost);
}

void Results::on(const UnitReturned& e) {
  if (!leases_.is_of(e.lease, e.worker)) return;
  const auto [job, slot] = jobs_.find_frame({e.job, e.unit.frame});
  const auto extent = job ? job->extent_of(e.unit) : std::nullopt;
  if (!extent || !leases_.holds(e.worker, e.lease, e.job, e.unit)) return;
  leases_.end_unit(*job, *slot, *extent, e.lease);
  workers_.note_given_back(e.worker, 1);
}

void Results::on(const UnitFailed& e) {
  const auto [job, slot] = jobs_.find_frame({e.job, e.unit.frame});
  const auto extent = job ? job->extent_of(e.unit) : std::nullopt;
  // A failure under a lease that has ended proves nothing that its successor would not show.
  if (!extent || !slot->ledger || !leases_.is_of(e.lease, e.worker)) return;
  const Assignment* assignment = slot->ledger->find_covering(*extent, e.lease);
  if (assignment == nullptr) return;
  const Extent whole = assignment->extent;
  const Worker* worker = workers_.find(e.worker);  // whose lease it is, so that it is there
  slot->ledger->blame(whole, e.worker, worker->witness);
  workers_.failures(e.worker).reason = e.reason;
  leases_.end_unit(*job, *slot, *extent, e.lease);
  if (hopeless(*job, *slot, whole)) frames_.fail_or_leave(*job, *slot, e.worker, e.reason);
}

/// Whether a unit has failed with so many different witnesses that it is the unit's fault; or that
/// often in all, and nobody is there whose witness is another.
bool Results::hopeless(const ScheduledJob& job, const FrameSlot& slot, const Extent& extent) const {
  const FailedUnits& failed = slot.ledger->failed();
  std::vector<Witness> tried = failed.witnesses(extent);
  if (tried.size() >= job.plan.max_attempts) return true;
  if (failed.failures(extent) < job.plan.max_attempts) return false;
  // Those whose films of it are the matter are not asked again.
  if (const Dispute* dispute = slot.ledger->find_dispute(extent)) {
    for (const Opinion& o : dispute->opinions) tried.push_back(o.witness);
  }
  return !workers_.anybody_besides({}, tried, job, slot.worker_class);
}

void Results::on(const Persisted& e) {
  const std::optional<PendingRecord> pending = records_.take(e.record);
  if (!pending) return;
  const auto over = [this](JobId id, int32_t frame, FramePhase phase) {
    const auto [job, slot] = jobs_.find_frame({id, frame});
    frames_.over(*job, *slot, phase);
  };
  std::visit(core::Overloaded{
                 [&](const UnitRecord& unit) { unit_persisted(unit, *pending, e.record); },
                 [&](const FrameFinishedRecord& finished) {
                   over(finished.job, finished.frame, FramePhase::done);
                 },
                 [&](const FrameFailedRecord& failed) {
                   over(failed.job, failed.failed.frame, FramePhase::failed);
                 },
                 [&](const FrameRestartedRecord& again) {
                   const auto [job, slot] = jobs_.find_frame({again.job, again.frame});
                   frames_.restarted(*job, *slot);
                 },
                 [&](const TileVoidedRecord& voided) { conflicts_.persisted(voided); },
                 [&](const DisputeRecord& dispute) { conflicts_.persisted(dispute); },
                 [&](const DivergentWorkerRecord& worker) { conflicts_.persisted(worker); },
             },
             pending->record);
}

void Results::unit_persisted(const UnitRecord& record, const PendingRecord& pending, RecordId id) {
  const core::Unit& unit = record.accepted.unit;
  const auto [job, slot] = jobs_.find_frame({record.job, unit.frame});
  // The job may have ended meanwhile, and the frame or its tile may have begun again.
  const bool counts = slot != nullptr && slot->phase == FramePhase::rendering &&
                      slot->ledger->waits_for(pending.extent, id);
  if (counts) {
    slot->ledger->made_durable(pending.extent);
    step_.say(Merge{id, record.job, unit});
  }
  for (const Holder& waiter : pending.waiters) {
    step_.say(Acknowledge{waiter.worker, waiter.lease, record.job, unit});
  }
  if (!counts) return;
  frames_.judge_if_due(*job, *slot, pending.extent.tile);
  frames_.finish_if_complete(*job, *slot);
}

void Results::on(const PersistFailed& e) {
  const std::optional<PendingRecord> lost = records_.failed(e.record);
  if (!lost) return;
  const auto& record = std::get<UnitRecord>(lost->record);
  const auto [job, slot] = jobs_.find_frame({record.job, record.accepted.unit.frame});
  // Its tile or frame may have begun again, and hold another film of these extents.
  if (slot->phase == FramePhase::rendering && slot->ledger->waits_for(lost->extent, e.record)) {
    slot->ledger->unhold(lost->extent);
    jobs_.update_offer(*job);
  }
  for (const Holder& waiter : lost->waiters) {
    step_.say(Reject{waiter.worker, waiter.lease, record.job, record.accepted.unit,
                     RejectReason::not_now});
  }
}

}  // namespace hyades::coordinator
