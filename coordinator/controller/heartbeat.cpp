// Which leases a heartbeat renews.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/controller/wire_ids.h"
#include "coordinator/meters/meters.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

using Progress = v1::LeaseProgress;

/// What waits, or loads, may take this many times longer than what renders.
constexpr int kUnhurried = 6;
/// That are told of at once.
constexpr size_t kMostStillUnits = 8;

}  // namespace

/// How long a lease is renewed that makes no progress. Workers watch their renderers themselves and
/// are quicker: this is for those that cannot end a renderer, or are broken themselves.
std::optional<Duration> Controller::patience_with(Progress::Stage stage) const {
  switch (stage) {
    case Progress::STAGE_RENDERING:
      return options_.stall_time;
    case Progress::STAGE_LOADING:
    case Progress::STAGE_WAITING:
      return kUnhurried * options_.stall_time;
    default:
      // Films wait for us, and files come as fast as they come: the worker gives up by itself.
      return std::nullopt;
  }
}

/// Renews the leases that are named and make progress. One that does not is taken back: as a
/// failure of the worker with its units where it was at work on one. With the lock.
std::vector<Event> Controller::renew_leases(WorkerSession& session, const v1::Heartbeat& beat) {
  const TimePoint now = std::chrono::steady_clock::now();
  // What nobody has heard in between does not count against a worker: this process may have slept.
  const Duration since = std::min<Duration>(now - session.beat, options_.lease_time);
  session.beat = now;
  std::vector<Event> events;
  WorkerAlive alive{session.id, {}};
  std::map<LeaseId, LeaseProgress> renewed;  // of those that are named
  for (const Progress& told : beat.leases()) {
    const LeaseId lease = lease_from_wire(told.lease());
    const auto old = session.progress.find(lease);
    LeaseProgress progress{told.stage(), told.samples_done(), Duration(0)};
    if (old != session.progress.end() && old->second.stage == progress.stage &&
        old->second.samples_done == progress.samples_done) {
      progress.still = old->second.still + since;
    }
    const auto patience = patience_with(progress.stage);
    if (!patience || progress.still < *patience) {
      alive.leases.push_back(lease);
      renewed[lease] = progress;
      continue;
    }
    for (Event& event : take_back(session, lease, progress)) events.push_back(std::move(event));
  }
  session.progress = std::move(renewed);
  events.emplace_back(std::move(alive));
  return events;
}

std::vector<Event> Controller::take_back(WorkerSession& session, const LeaseId& lease,
                                         const LeaseProgress& progress) {
  std::vector<Event> events;
  const std::string reason =
      fmt::format("no progress in {:.3g} s", std::chrono::duration<double>(progress.still).count());
  for (const UnitInHand& held : scheduler_.units_of(session.id, lease)) {
    if (ActiveJob* active = active_job(held.job)) {
      note(*active, v1::LOG_LEVEL_WARNING, held.unit.frame, session.hello.name(),
           fmt::format("tile {},{} batches {}-{} is taken back: {}", held.unit.tile.x0,
                       held.unit.tile.y0, held.unit.batches.first, held.unit.batches.end() - 1,
                       reason),
           &held.unit);
    }
    meters_->lost("stalled");
    v1::CoordinatorMessage stop;
    v1::LeasedUnit& unit = *stop.mutable_stop()->mutable_unit();
    unit.mutable_lease()->set_incarnation(lease.incarnation);
    unit.mutable_lease()->set_number(lease.number);
    unit.set_job(static_cast<uint64_t>(held.job));
    *unit.mutable_unit() = farm::to_wire(held.unit);
    session.link->send(std::move(stop));
    if (progress.stage == Progress::STAGE_WAITING) {
      events.emplace_back(UnitReturned{session.id, lease, held.job, held.unit});
    } else {
      ++session.units_failed;
      events.emplace_back(UnitFailed{session.id, lease, held.job, held.unit, reason});
    }
  }
  return events;
}

/// Units of the job that get no further, in words; with the lock.
std::vector<std::string> Controller::still_units(JobId job) const {
  std::vector<std::string> words;
  for (const auto& [id, session] : sessions_) {
    for (const auto& [lease, progress] : session.progress) {
      const auto patience = patience_with(progress.stage);
      if (!patience || progress.still < *patience / 4) continue;
      for (const UnitInHand& held : scheduler_.units_of(id, lease)) {
        if (held.job != job || words.size() == kMostStillUnits) continue;
        words.push_back(fmt::format(
            "worker {} has made no progress for {:.3g} s with tile {},{} of frame {}; after {:.3g} "
            "s it is taken from it",
            session.hello.name(), std::chrono::duration<double>(progress.still).count(),
            held.unit.tile.x0, held.unit.tile.y0, held.unit.frame,
            std::chrono::duration<double>(*patience).count()));
      }
    }
  }
  return words;
}

}  // namespace hyades::coordinator
