// What workers say: wishes, films, failures.
#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/controller/wire_ids.h"
#include "coordinator/meters/meters.h"
#include "core/film/film_codec.h"
#include "core/film/id_codec.h"
#include "core/film/splat_codec.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

constexpr int kMostNotes = 8;
constexpr uint32_t kCrowdedRetryMs = 500;
constexpr uint32_t kFullRetryMs = 2000;
/// Of a decoded film, besides its pixels.
constexpr uint64_t kFilmOverhead = uint64_t{1} << 20U;
/// What a unit can have taken: no worker makes a job more expensive than that.
constexpr uint64_t kLongestRendering = 7ULL * 24 * 3600 * 1'000'000'000;  // ns

/// Of results that the scheduler is not told of.
const char* verdict_of(v1::Rejected::Reason reason) {
  switch (reason) {
    case v1::Rejected::REASON_DAMAGED:
      return "damaged";
    case v1::Rejected::REASON_MALFORMED:
      return "malformed";
    case v1::Rejected::REASON_NOT_NOW:
      return "not_now";
    default:
      return "unknown";
  }
}

}  // namespace

/// The worker's session, if `link` is its newest stream.
Controller::WorkerSession* Controller::session_of(WorkerId worker, const WorkerLink* link) {
  const auto session = sessions_.find(worker);
  return session == sessions_.end() || session->second.link.get() != link ? nullptr
                                                                          : &session->second;
}

/// Why a worker that stays gives units back, in the job's log: once, for it may go on so.
void Controller::note_return(const WorkerSession& session, JobId job, const std::string& reason) {
  ActiveJob* active = session.leaving || reason.empty() ? nullptr : active_job(job);
  if (active == nullptr || !active->gave_back.insert(session.id).second) return;
  note(*active, v1::LOG_LEVEL_WARNING, {}, session.hello.name(),
       "gives units back: " + farm::wire_text(reason));
}

void Controller::want(WorkerSession& session, uint32_t units, std::vector<Action>& later) {
  if (units == 0 || session.leaving) return;
  if (std::chrono::steady_clock::now() < adopting_until_) {
    session.held_wish = std::min(session.held_wish + std::min(units, kMostThreads), kMostThreads);
    return;
  }
  for (Action& action : tell(WorkRequested{session.id, units})) later.push_back(std::move(action));
}

void Controller::receive(WorkerId worker, const WorkerLink* link,
                         const v1::WorkerMessage& message) {
  if (message.has_result()) return on_result(worker, link, message.result());
  std::vector<Action> later;
  const auto say = [&](const Event& event) {
    for (Action& action : tell(event)) later.push_back(std::move(action));
  };
  {
    const std::lock_guard lock(mutex_);
    WorkerSession* session = session_of(worker, link);
    if (session == nullptr) return;
    session->heard = std::chrono::steady_clock::now();
    session->heard_ms = wall_ms();
    if (message.has_request()) {
      want(*session, message.request().units(), later);
    } else if (message.has_heartbeat()) {
      session->memory = message.heartbeat().memory_bytes();
      session->cache = message.heartbeat().cache_bytes();
      session->cache_limit = message.heartbeat().cache_limit_bytes();
      session->cache_hits = message.heartbeat().cache_hits();
      session->cache_misses = message.heartbeat().cache_misses();
      for (const Event& event : renew_leases(*session, message.heartbeat())) say(event);
      v1::CoordinatorMessage echo;
      echo.mutable_echo()->set_number(message.heartbeat().number());
      session->link->send(std::move(echo));
    } else if (message.has_failure()) {
      const v1::UnitFailure& failure = message.failure();
      const auto unit = farm::from_wire(failure.unit().unit());
      if (unit) {
        const JobId job{failure.unit().job()};
        ++session->units_failed;
        meters_->lost("failed");
        if (ActiveJob* active = active_job(job)) {
          note(*active, v1::LOG_LEVEL_WARNING, unit->frame, session->hello.name(),
               fmt::format("tile {},{} batches {}-{} failed: {}", unit->tile.x0, unit->tile.y0,
                           unit->batches.first, unit->batches.end() - 1,
                           farm::wire_text(failure.reason())),
               &*unit);
        }
        say(UnitFailed{worker, lease_from_wire(failure.unit().lease()), job, *unit,
                       farm::wire_text(failure.reason())});
      }
      want(*session, failure.want(), later);
    } else if (message.has_returned()) {
      for (const v1::LeasedUnit& returned : message.returned().units()) {
        const auto unit = farm::from_wire(returned.unit());
        if (!unit) continue;
        meters_->lost("returned");
        note_return(*session, JobId{returned.job()}, message.returned().reason());
        say(UnitReturned{worker, lease_from_wire(returned.lease()), JobId{returned.job()}, *unit});
      }
    } else if (message.has_leaving()) {
      session->held_wish = 0;
      session->reason = farm::wire_text(message.leaving().reason());
      if (!std::exchange(session->leaving, true)) {
        // In the logs of the jobs that it has units of; whether they go to others is told later.
        std::set<JobId> jobs;
        for (const UnitInHand& held : scheduler_.units_of(session->id)) jobs.insert(held.job);
        for (const JobId job : jobs) {
          if (ActiveJob* active = active_job(job)) {
            note(*active, v1::LOG_LEVEL_INFO, {}, session->hello.name(),
                 "is leaving: " + session->reason);
          }
        }
      }
      if (session->state == v1::WORKER_STATE_ACTIVE) session->state = v1::WORKER_STATE_DRAINING;
      say(WorkerBarred{worker, true});
    }
  }
  carry_out(later);
}

void Controller::reject(WorkerId worker, const WorkerLink* link, const v1::UnitResult& result,
                        v1::Rejected::Reason reason, const std::string& text,
                        uint32_t retry_after_ms) {
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    WorkerSession* session = session_of(worker, link);
    if (session == nullptr) return;
    v1::CoordinatorMessage message;
    v1::Rejected& rejected = *message.mutable_rejected();
    *rejected.mutable_unit()->mutable_lease() = result.lease();
    rejected.mutable_unit()->set_job(result.job());
    *rejected.mutable_unit()->mutable_unit() = result.unit();
    rejected.set_reason(reason);
    rejected.set_text(text);
    rejected.set_retry_after_ms(retry_after_ms);
    session->link->send(std::move(message));
    meters_->result(verdict_of(reason));
    if (reason != v1::Rejected::REASON_NOT_NOW) {
      const auto unit = farm::from_wire(result.unit());
      if (ActiveJob* active = active_job(result.job())) {
        note(*active, v1::LOG_LEVEL_WARNING, result.unit().frame(), session->hello.name(),
             "a film was refused: " + text, unit ? &*unit : nullptr);
      }
      if (unit) {
        later =
            tell(UnitReturned{worker, lease_from_wire(result.lease()), JobId{result.job()}, *unit});
      }
    }
    want(*session, result.want(), later);
  }
  carry_out(later);
}

void Controller::on_result(WorkerId worker, const WorkerLink* link, const v1::UnitResult& result) {
  using Rejected = v1::Rejected;
  meters_->film_bytes(result.film().size());
  const JobId job{result.job()};
  core::FilmLayout layout;
  core::PixelRect region;
  FrameKey key{};
  Delivery delivery;
  const TimePoint came = std::chrono::steady_clock::now();
  {
    const std::lock_guard lock(mutex_);
    WorkerSession* session = session_of(worker, link);
    if (session == nullptr) return;
    session->heard = std::chrono::steady_clock::now();
    session->heard_ms = wall_ms();
    delivery.unit.worker_class = session->hello.worker_class();
    if (const ActiveJob* active = active_job(job)) {
      layout = active->layout;
      region = active->region;
      key = active->key;
    }
  }
  // Without the lock: what depends on the bytes alone.
  const auto unit = farm::from_wire(result.unit());
  const auto digest = farm::digest_from_wire(result.digest());
  if (!unit || !digest) {
    return reject(worker, link, result, Rejected::REASON_MALFORMED,
                  !unit ? unit.error().message : digest.error().message, 0);
  }
  if (layout.channels.empty()) {
    return reject(worker, link, result, Rejected::REASON_UNKNOWN, "there is no such job", 0);
  }
  const auto area = static_cast<uint64_t>(unit->tile.area());
  const std::span<const std::byte> bytes = std::as_bytes(std::span(result.film()));
  uint64_t memory = core::film_memory(layout, unit->tile) + kFilmOverhead;
  if (layout.layers.splats) {
    memory += core::splat_memory(static_cast<uint64_t>(region.area())) * (1 + layout.part_count());
  }
  for (const bool ids : layout.layers.ids)
    memory += ids ? core::id_memory(area * unit->batches.count * core::kBatchSamples) : 0;
  auto film = core::decode_film(bytes, {memory});
  if (!film) {
    return reject(worker, link, result, Rejected::REASON_DAMAGED, film.error().message, 0);
  }
  if (film->layout() != layout || film->window() != unit->tile ||
      film->splats().region() != (layout.layers.splats ? region : core::PixelRect{}) ||
      film->coverage().volume() != area * unit->batches.count ||
      !film->coverage().contains({unit->tile, unit->batches})) {
    return reject(worker, link, result, Rejected::REASON_MALFORMED,
                  "the film is not of the unit that it is said to be of", 0);
  }
  if (film->digest() != core::to_hex(*digest)) {
    return reject(worker, link, result, Rejected::REASON_DAMAGED,
                  "the film is not what its digest says", 0);
  }
  delivery.unit.unit = *unit;
  delivery.unit.digest = *digest;
  delivery.record = encode_delivered(delivery.unit, key, bytes);
  delivery.film = std::move(*film);

  std::vector<Action> later;
  enum class Verdict : uint8_t { taken, crowded, full, quarantined } verdict = Verdict::taken;
  {
    const std::lock_guard lock(mutex_);
    WorkerSession* session = session_of(worker, link);
    if (session == nullptr) return;
    ActiveJob* active = active_job(job);
    if (session->state == v1::WORKER_STATE_QUARANTINED) {
      verdict = Verdict::quarantined;
    } else if (disk_.level() == DiskLevel::full) {
      verdict = Verdict::full;
    } else if (active != nullptr && active->film_store && active->film_store->crowded()) {
      verdict = Verdict::crowded;
    } else {
      delivery.rendered = {session->id,     session->hello.name(),
                           result.thread(), std::min(result.render_ns(), kLongestRendering),
                           wall_us(),       came};
      for (int i = 0; active != nullptr && i < std::min(result.notes_size(), kMostNotes); ++i) {
        note(*active, v1::LOG_LEVEL_WARNING, unit->frame, session->hello.name(),
             farm::wire_text(result.notes(i)), &*unit);
      }
      const Duration took{static_cast<int64_t>(std::min<uint64_t>(result.render_ns(), INT64_MAX))};
      later =
          tell(ResultArrived{worker, lease_from_wire(result.lease()), job, *unit, *digest, took},
               &delivery);
      if (!delivery.settled) meters_->result("waits");
      want(*session, result.want(), later);
    }
  }
  carry_out(later);
  if (verdict == Verdict::crowded) {
    reject(worker, link, result, Rejected::REASON_NOT_NOW, "more films wait for the disk than may",
           kCrowdedRetryMs);
  } else if (verdict == Verdict::full) {
    reject(worker, link, result, Rejected::REASON_NOT_NOW, "the coordinator's disk is full",
           kFullRetryMs);
  } else if (verdict == Verdict::quarantined) {
    reject(worker, link, result, Rejected::REASON_UNKNOWN, "the worker is quarantined", 0);
  }
}

}  // namespace hyades::coordinator
