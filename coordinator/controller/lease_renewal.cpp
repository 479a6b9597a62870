// Which leases a heartbeat renews.
#include "coordinator/controller/lease_renewal.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/controller/to_wire.h"
#include "coordinator/controller/worker_sessions.h"
#include "coordinator/meters/meters.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

using Progress = v1::LeaseProgress;

/// What waits, or loads, may take this many times longer than what renders.
constexpr int kUnhurried = 6;

}  // namespace

std::optional<Duration> lease_patience(Progress::Stage stage, Duration stall_time) {
  switch (stage) {
    case Progress::STAGE_RENDERING:
      return stall_time;
    case Progress::STAGE_LOADING:
    case Progress::STAGE_WAITING:
      return kUnhurried * stall_time;
    default:
      // Films wait for us, and files come as fast as they come: the worker gives up by itself.
      return std::nullopt;
  }
}

/// Renews the leases that are named and make progress. One that does not is taken back: as a
/// failure of the worker with its units where it was at work on one.
void WorkerSessions::renew_leases(WorkerSession& session, const v1::Heartbeat& beat, Turn& turn) {
  const TimePoint now = std::chrono::steady_clock::now();
  // What nobody has heard in between does not count against a worker: this process may have slept.
  const Duration since = std::min<Duration>(now - session.beat, context_.options.lease_time);
  session.beat = now;
  std::vector<std::pair<LeaseId, LeaseProgress>> stalled;
  WorkerAlive alive{session.id, {}};
  std::map<LeaseId, LeaseProgress> renewed;  // of those that are named
  std::set<LeaseId> named;
  size_t left = entries_heard(session);
  for (const Progress& told : beat.leases()) {
    if (left-- == 0) break;
    const LeaseId lease = from_wire(told.lease());
    // Of what somebody names twice, or invents, nothing is kept or done.
    if (!dispatcher_.scheduler().has_lease(session.id, lease)) continue;
    if (!named.insert(lease).second) continue;
    const auto old = session.progress.find(lease);
    LeaseProgress progress{told.stage(), told.samples_done(), Duration(0)};
    if (old != session.progress.end() && old->second.stage == progress.stage &&
        old->second.samples_done == progress.samples_done) {
      progress.still = old->second.still + since;
    }
    const auto patience = lease_patience(progress.stage, context_.options.stall_time);
    if (!patience || progress.still < *patience) {
      alive.leases.push_back(lease);
      renewed[lease] = progress;
    } else {
      stalled.emplace_back(lease, progress);
    }
  }
  // What each of them holds is asked before the scheduler hears of any.
  std::vector<Event> events;
  for (const auto& [lease, progress] : stalled) take_back(session, lease, progress, events);
  session.progress = std::move(renewed);
  for (const Event& event : events) turn.tell(event);
  turn.tell(alive);
}

void WorkerSessions::take_back(WorkerSession& session, const LeaseId& lease,
                               const LeaseProgress& progress, std::vector<Event>& events) {
  const std::string reason =
      fmt::format("no progress in {:.3g} s", std::chrono::duration<double>(progress.still).count());
  for (const UnitInHand& held : dispatcher_.scheduler().units_of(session.id, lease)) {
    if (ActiveJob* active = jobs_.find(held.job)) {
      jobs_.note(*active, v1::LOG_LEVEL_WARNING, held.unit.frame, session.hello.name(),
                 fmt::format("tile {},{} batches {}-{} is taken back: {}", held.unit.tile.x0,
                             held.unit.tile.y0, held.unit.batches.first,
                             held.unit.batches.end() - 1, reason),
                 &held.unit);
    }
    context_.meters->lost("stalled");
    v1::CoordinatorMessage stop;
    *stop.mutable_stop()->mutable_unit() = to_wire(lease, held.job, held.unit);
    session.link->send(bytes_of(stop));
    if (progress.stage == Progress::STAGE_WAITING) {
      events.emplace_back(UnitReturned{session.id, lease, held.job, held.unit});
    } else {
      ++session.units_failed;
      events.emplace_back(UnitFailed{session.id, lease, held.job, held.unit, reason});
    }
  }
}

}  // namespace hyades::coordinator
