#include "coordinator/scheduler/worker_lifecycle.h"

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>

#include <fmt/format.h>

namespace hyades::coordinator {
namespace {

/// Job, frame, tile and first batch.
using PlaceOfUnit = std::tuple<JobId, int32_t, int32_t, int32_t, uint32_t>;

PlaceOfUnit place_of(const UnitInHand& held) {
  const core::Unit& unit = held.unit;
  return {held.job, unit.frame, unit.tile.x0, unit.tile.y0, unit.batches.first};
}

}  // namespace

void WorkerLifecycle::on(const WorkerJoined& e) {
  // Who comes anew with what it had has had it since then; what it had and does not bring it has
  // given back.
  std::map<PlaceOfUnit, TimePoint> had;
  for (const UnitInHand& unit : leases_.units_of(e.worker)) {
    had[place_of(unit)] = leases_.since(unit);
  }
  on(WorkerLost{e.worker});
  Worker& worker = workers_.add(e);
  jobs_.count_worker(worker, true);
  for (const UnitInHand& held : e.in_hand) {
    const auto before = had.extract(place_of(held));
    adopt(e.worker, worker, held, before ? before.mapped() : step_.now);
  }
  workers_.note_given_back(e.worker, static_cast<uint32_t>(had.size()));
  for (const auto& [id, job] : jobs_.all()) frames_.open(*job);
}

void WorkerLifecycle::adopt(WorkerId id, Worker& worker, const UnitInHand& held, TimePoint since) {
  const auto [job, slot] = jobs_.find_frame({held.job, held.unit.frame});
  const auto extent = job ? job->extent_of(held.unit) : std::nullopt;
  if (slot == nullptr || !extent || workers_.quarantined(id) ||
      slot->phase != FramePhase::rendering || !workers_.may_render(*job, *slot, worker) ||
      !slot->ledger->may_assign(*extent, worker.witness) ||
      (!slot->film && !films_.has_place(*job))) {
    step_.say(Revoke{id, held.lease, held.job, held.unit});
    return;
  }
  slot->worker_class = worker.class_for(*job);
  const FramePlace place{job, job->index_of(*slot)};
  Assignment& assignment = leases_.assign(*slot, *extent, id);
  assignment.since = since;
  copies_.note(place, assignment, slot->worker_class);
  leases_.grant(id, worker, place, {*extent}, true);
  Affinity::remember_scene(worker, place.id(), false);
  affinity_.settle(worker, place.id());
  jobs_.update_offer(*job);
}

void WorkerLifecycle::on(const WorkerAlive& e) {
  if (workers_.find(e.worker) == nullptr) return;
  for (const LeaseId& id : e.leases) leases_.renew(e.worker, id);
}

void WorkerLifecycle::on(const WorkerBarred& e) {
  if (!e.barred || e.pardoned) workers_.pardon(e.worker);
  Worker* worker = workers_.find(e.worker);
  if (worker == nullptr || worker->barred == e.barred) return;
  workers_.bar(e.worker, *worker, e.barred);
  if (e.barred) affinity_.settle(*worker, std::nullopt);
  step_.work_appeared = true;
}

void WorkerLifecycle::on(const WorkerLost& e) {
  Worker* worker = workers_.find(e.worker);
  if (worker == nullptr) return;
  leases_.release_all(*worker, false);
  affinity_.settle(*worker, std::nullopt);
  jobs_.count_worker(*worker, false);
  workers_.remove(e.worker);
  // A unit that failed with others may now be theirs to try again.
  step_.work_appeared = true;
}

void WorkerLifecycle::on(const WorkerForgotten& e) {
  on(WorkerLost{e.worker});
  workers_.forget_given_back(e.worker);
  workers_.pardon(e.worker);
}

bool WorkerLifecycle::quarantine(WorkerId id, const std::string& reason) {
  if (!workers_.quarantine(id)) return false;
  step_.say(Quarantine{id, reason});
  if (Worker* worker = workers_.find(id)) {
    leases_.release_all(*worker, true);
    affinity_.settle(*worker, std::nullopt);
    workers_.bar(id, *worker, true);
  }
  // A unit that failed with others may now be theirs to try again.
  step_.work_appeared = true;
  return true;
}

void WorkerLifecycle::forgive_and_blame(const ScheduledJob& job, FrameSlot& slot,
                                        const Extent& extent, WorkerId worker) {
  workers_.forget_failures(worker);
  for (const WorkerId failed : slot.ledger->take_blame(extent)) {
    if (failed == worker) continue;
    ScheduledWorkers::Failures& in_a_row = workers_.failures(failed);
    if (++in_a_row.count < options_.max_failures) continue;
    const std::string why =
        fmt::format("failed {} units in a row that others could render, the last of job {}: {}",
                    in_a_row.count, static_cast<uint64_t>(job.id), in_a_row.reason);
    workers_.forget_failures(failed);
    quarantine(failed, why);
  }
}

}  // namespace hyades::coordinator
