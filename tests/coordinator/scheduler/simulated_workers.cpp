// Workers, and the network between them and the coordinator.
#include <algorithm>

#include "tests/coordinator/scheduler/simulated_world.h"

namespace hyades::coordinator {

void SimulatedWorld::act(const Lease& a) {
  if (a.adopted) ++adopted;
  const JobNeeds& needs = jobs_.at(a.job).plan.needs;
  const SimWorker& taker = workers_[index_of(a.worker)];
  for (const std::string& tag : needs.tags) {
    if (std::find(taker.tags.begin(), taker.tags.end(), tag) == taker.tags.end()) {
      fail("a unit goes to a worker without its job's tag");
    }
  }
  if (taker.memory != 0 && taker.memory < needs.memory) {
    fail("a unit goes to a worker with too little memory");
  }
  send(a.worker, [this, a](SimWorker& w) {
    if (a.adopted) {
      for (auto& [order, held] : w.held) {
        if (held.job == a.job && held.unit == a.units.front()) held.lease = a.lease;
      }
      return;
    }
    for (const core::Unit& unit : a.units) take(w, {a.job, unit, a.lease, false});
    w.asked = std::max(0, w.asked - static_cast<int>(a.units.size()));
  });
}

void SimulatedWorld::act(const Revoke& a) {
  ++copies_revoked;
  send(a.worker, [this, a](SimWorker& w) { drop(w, a.job, a.unit, a.lease); });
}

void SimulatedWorld::act(const Acknowledge& a) {
  if (!is_stored(a.job, a.unit) && !jobs_.at(a.job).ended) {
    fail("acknowledged before it was durable");
  }
  send(a.worker, [this, a](SimWorker& w) { drop(w, a.job, a.unit, {}); });
}

void SimulatedWorld::act(const Reject& a) {
  if (a.reason == RejectReason::malformed) fail("a good unit is malformed");
  overlaps += a.reason == RejectReason::overlap;
  if (a.reason == RejectReason::not_now) return;
  if (a.reason == RejectReason::conflict) jobs_.at(a.job).disagreed.push_back(a.unit);
  send(a.worker, [this, a](SimWorker& w) { drop(w, a.job, a.unit, {}); });
}

void SimulatedWorld::send_up(size_t i, const Event& event) {
  if (!workers_[i].connected) return;
  const int times = fault() ? number(0, 2) : 1;
  duplicates += times > 1;
  for (int t = 0; t < times; ++t) tell_later(event);
}

void SimulatedWorld::connect(size_t i) {
  SimWorker& w = workers_[i];
  if (!scheduler_ || w.connected) return;
  w.connected = true;
  ++w.session;
  w.asked = 0;
  WorkerJoined hello{id_of(i), static_cast<uint32_t>(w.threads), w.name, {}, w.tags, w.memory};
  hello.portable_class = kPortable;
  for (const auto& [order, held] : w.held) {
    hello.in_hand.push_back({held.lease, held.job, held.unit});
  }
  tell(hello);
  if (w.quarantined_by != 0) tell(WorkerBarred{id_of(i), true});
  ask(i);
  heartbeat(i, w.session);
}

void SimulatedWorld::heartbeat(size_t i, uint64_t session) {
  SimWorker& w = workers_[i];
  if (!w.connected || w.session != session) return;
  WorkerAlive alive{id_of(i), {}};
  for (const auto& [order, held] : w.held) alive.leases.push_back(held.lease);
  send_up(i, alive);
  for (const auto& [order, held] : w.held) {
    if (held.rendered) deliver(i, held);
  }
  w.asked = 0;  // what was asked may be lost
  ask(i);
  after(std::chrono::milliseconds(1500), [this, i, session] { heartbeat(i, session); });
}

void SimulatedWorld::ask(size_t i) {
  SimWorker& w = workers_[i];
  int busy = 0;
  for (const auto& [order, held] : w.held) busy += !held.rendered;
  const int more = 2 * w.threads - busy - w.asked;
  if (more <= 0) return;
  w.asked += more;
  send_up(i, WorkRequested{id_of(i), static_cast<uint32_t>(more)});
}

void SimulatedWorld::take(SimWorker& w, const UnitHeld& unit) {
  const uint64_t order = ++serial_;
  w.held.emplace(order, unit);
  const double work = unit.unit.batches.count * (0.5 + uniform()) * w.slowness * 0.05;
  const auto i = static_cast<size_t>(&w - workers_.data());
  after(std::chrono::duration_cast<Duration>(std::chrono::duration<double>(work)),
        [this, i, order, life = w.life] {
          if (workers_[i].life == life) rendered(i, order);
        });
}

void SimulatedWorld::rendered(size_t i, uint64_t order) {
  SimWorker& w = workers_[i];
  const auto it = w.held.find(order);
  if (it == w.held.end()) return;
  UnitHeld& held = it->second;
  SimFrame& frame = frame_of(held.job, held.unit.frame);
  const bool poisoned = frame.poisoned && held.unit.tile.x0 == jobs_[held.job].plan.region.x0 &&
                        held.unit.tile.y0 == jobs_[held.job].plan.region.y0;
  if (poisoned || w.broken || (frame.bad_luck > 0 && fault())) {
    if (!poisoned && !w.broken) --frame.bad_luck;
    send_up(i, UnitFailed{id_of(i), held.lease, held.job, held.unit, "it hurt"});
    w.held.erase(it);
  } else if (fault() && held.unit.batches.count > 1) {
    // It drains: half of the batches, the rest goes back.
    UnitHeld half = held;
    half.unit.batches.count /= 2;
    half.rendered = true;
    w.held.erase(it);
    deliver(i, half);
    w.held.emplace(order, half);
  } else if (fault()) {
    send_up(i, UnitReturned{id_of(i), held.lease, held.job, held.unit});
    w.held.erase(it);
  } else {
    held.rendered = true;
    deliver(i, held);
  }
  ask(i);
}

void SimulatedWorld::deliver(size_t i, const UnitHeld& held) {
  Digest digest{};
  digest[0] = static_cast<uint8_t>(held.unit.frame);
  if (workers_[i].corrupt) digest[1] = static_cast<uint8_t>(i + 1);
  send_up(i, ResultArrived{id_of(i), held.lease, held.job, held.unit, digest,
                           std::chrono::milliseconds(50) * held.unit.batches.count});
}

void SimulatedWorld::drop(SimWorker& w, JobId job, const core::Unit& unit, const LeaseId& lease) {
  std::erase_if(w.held, [&](const auto& entry) {
    const UnitHeld& held = entry.second;
    return held.job == job && held.unit == unit && (lease == LeaseId{} || held.lease == lease);
  });
}

}  // namespace hyades::coordinator
