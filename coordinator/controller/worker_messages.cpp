// What workers say, and what they are told.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "coordinator/controller/disk_watch.h"
#include "coordinator/controller/result_check.h"
#include "coordinator/controller/to_wire.h"
#include "coordinator/controller/worker_sessions.h"
#include "coordinator/meters/meters.h"
#include "core/base/wall_clock.h"
#include "core/film/film_codec.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

constexpr int kMostNotes = 8;
constexpr uint32_t kCrowdedRetryMs = 500;
constexpr uint32_t kFullRetryMs = 2000;
/// Nanoseconds that a unit counts for at most, so that no worker makes a job more expensive.
constexpr uint64_t kLongestRendering = 7ULL * 24 * 3600 * 1'000'000'000;
/// What a film may take that is unpacked while others are; of larger ones it is one at a time.
constexpr uint64_t kLargeFilm = uint64_t{64} << 20U;
constexpr uint32_t kMostBadFilms = 20;

ResultRefusal too_many_wait() {
  return {v1::Rejected::REASON_NOT_NOW, "more films wait to be unpacked than may", kCrowdedRetryMs};
}

v1::LeasedUnit named_unit(const v1::UnitResult& result) {
  v1::LeasedUnit named;
  *named.mutable_lease() = result.lease();
  named.set_job(result.job());
  return named;
}

}  // namespace

void WorkerSessions::receive(WorkerId worker, const WorkerLink* link, v1::WorkerMessage message) {
  if (message.has_result()) return on_result(worker, link, std::move(*message.mutable_result()));
  Turn turn(dispatcher_);
  WorkerSession* session = workers_.find(worker, link);
  if (session == nullptr) return;
  session->heard = std::chrono::steady_clock::now();
  session->heard_ms = core::wall_ms();
  using Message = v1::WorkerMessage;
  switch (message.message_case()) {
    case Message::kRequest:
      return want(*session, message.request().units(), turn);
    case Message::kHeartbeat:
      return on_heartbeat(*session, message.heartbeat(), turn);
    case Message::kFailure:
      return on_failure(*session, message.failure(), turn);
    case Message::kReturned:
      return on_returned(*session, message.returned(), turn);
    case Message::kLeaving:
      return on_leaving(*session, message.leaving(), turn);
    case Message::kResult:  // above: its film is merged without the lock
    case Message::kHello:   // heard before there is a session
    case Message::MESSAGE_NOT_SET:
      return;
  }
}

void WorkerSessions::on_heartbeat(WorkerSession& session, const v1::Heartbeat& beat, Turn& turn) {
  session.memory = beat.memory_bytes();
  session.cache = beat.cache_bytes();
  session.cache_limit = beat.cache_limit_bytes();
  session.cache_hits = beat.cache_hits();
  session.cache_misses = beat.cache_misses();
  renew_leases(session, beat, turn);
  v1::CoordinatorMessage echo;
  echo.mutable_echo()->set_number(beat.number());
  session.link->send(bytes_of(echo));
}

/// Whether the worker has the unit that it speaks of. Who has not could fill the logs of whatever
/// job with what he invents.
bool WorkerSessions::has(const WorkerSession& session, const v1::LeasedUnit& named,
                         const core::Unit& unit) const {
  return dispatcher_.scheduler().holds(session.id, from_wire(named.lease()), JobId{named.job()},
                                       unit);
}

/// Nanoseconds that a thread of the worker may say it took for the unit: no more than the unit has
/// been out, and where it is the worker's no more, than the worker has been here.
uint64_t WorkerSessions::longest_rendering(const WorkerSession& session,
                                           const v1::UnitResult& result,
                                           const core::Unit& unit) const {
  using std::chrono::nanoseconds;
  const Scheduler& scheduler = dispatcher_.scheduler();
  const UnitInHand held{from_wire(result.lease()), JobId{result.job()}, unit};
  nanoseconds most = std::chrono::milliseconds(core::wall_ms() - session.joined_ms);
  if (scheduler.holds(session.id, held.lease, held.job, unit)) {
    most = std::chrono::steady_clock::now() - scheduler.since(held);
  }
  return std::min(static_cast<uint64_t>(std::max<int64_t>(most.count(), 0)), kLongestRendering);
}

void WorkerSessions::on_failure(WorkerSession& session, const v1::UnitFailure& failure,
                                Turn& turn) {
  const auto unit = farm::from_wire(failure.unit().unit());
  const LeaseId lease = from_wire(failure.unit().lease());
  if (unit && has(session, failure.unit(), *unit)) {
    const JobId job{failure.unit().job()};
    ++session.units_failed;
    context_.meters->lost("failed");
    if (ActiveJob* active = jobs_.find(job)) {
      jobs_.note(*active, v1::LOG_LEVEL_WARNING, unit->frame, session.hello.name(),
                 fmt::format("tile {},{} batches {}-{} failed: {}", unit->tile.x0, unit->tile.y0,
                             unit->batches.first, unit->batches.end() - 1,
                             farm::wire_text(failure.reason())),
                 &*unit);
    }
    turn.tell(UnitFailed{session.id, lease, job, *unit, farm::wire_text(failure.reason())});
  }
  want(session, failure.want(), turn);
}

/// How many units or leases a message may name: no more than the worker has, and some that were
/// taken from it meanwhile. Each is looked up under the lock; of further ones nothing is heard.
size_t WorkerSessions::entries_heard(const WorkerSession& session) const {
  constexpr size_t kTakenMeanwhile = 64;
  return dispatcher_.scheduler().leased_units(session.id) + 4 * size_t{session.hello.threads()} +
         kTakenMeanwhile;
}

void WorkerSessions::on_returned(WorkerSession& session, const v1::UnitsReturned& message,
                                 Turn& turn) {
  size_t left = entries_heard(session);
  for (const v1::LeasedUnit& returned : message.units()) {
    if (left-- == 0) break;
    const auto unit = farm::from_wire(returned.unit());
    if (!unit || !has(session, returned, *unit)) continue;
    const JobId job{returned.job()};
    context_.meters->lost("returned");
    // Why a worker that stays gives units back, in the job's log: once, for it may go on so.
    ActiveJob* active = session.leaving || message.reason().empty() ? nullptr : jobs_.find(job);
    if (active != nullptr && active->gave_back.insert(session.id).second) {
      jobs_.note(*active, v1::LOG_LEVEL_WARNING, {}, session.hello.name(),
                 "gives units back: " + farm::wire_text(message.reason()));
    }
    turn.tell(UnitReturned{session.id, from_wire(returned.lease()), job, *unit});
  }
}

void WorkerSessions::on_leaving(WorkerSession& session, const v1::Leaving& leaving, Turn& turn) {
  session.deferred_request = 0;
  session.reason = farm::wire_text(leaving.reason());
  if (!std::exchange(session.leaving, true)) {
    // In the logs of the jobs that it has units of; whether they go to others is told later.
    std::set<JobId> jobs;
    for (const UnitInHand& held : dispatcher_.scheduler().units_of(session.id)) {
      jobs.insert(held.job);
    }
    for (const JobId job : jobs) {
      if (ActiveJob* active = jobs_.find(job)) {
        jobs_.note(*active, v1::LOG_LEVEL_INFO, {}, session.hello.name(),
                   "is leaving: " + session.reason);
      }
    }
  }
  if (session.state == v1::WORKER_STATE_ACTIVE) session.state = v1::WORKER_STATE_DRAINING;
  turn.tell(WorkerBarred{session.id, true});
}

struct WorkerSessions::PendingResult {
  WorkerId worker{};
  std::shared_ptr<WorkerLink> link;
  v1::UnitResult result;
  ExpectedFilm expected;
  TimePoint came;
  std::string owner;                                ///< who has let the worker in
  std::optional<farm::ByteBudget::Share> packed{};  ///< until it is unpacked
};

/// Decides by what is known without unpacking the film, and has it unpacked.
void WorkerSessions::on_result(WorkerId worker, const WorkerLink* link, v1::UnitResult result) {
  context_.meters->film_bytes(result.film().size());
  const auto pending = std::make_shared<PendingResult>();
  pending->worker = worker;
  pending->came = std::chrono::steady_clock::now();
  std::optional<ExpectedFilm> expected;
  {
    const StateLock lock(context_.mutex);
    WorkerSession* session = workers_.find(worker, link);
    if (session == nullptr) return;
    session->heard = pending->came;
    session->heard_ms = core::wall_ms();
    pending->link = session->link;
    pending->owner = session->joined_with.empty() ? session->owner : session->joined_with;
    if (const ActiveJob* active = jobs_.find(result.job())) {
      expected = {active->layout, active->region, active->key, session->hello.worker_id(),
                  session->class_for(active->needs)};
    }
  }
  std::optional<ResultRefusal> refusal = check_claim(result, expected, context_.proofs);
  const bool large = core::memory_to_decode(std::as_bytes(std::span(result.film()))) > kLargeFilm;
  if (expected) pending->expected = std::move(*expected);
  pending->result = std::move(result);
  if (!refusal) refusal = have_unpacked(pending, large ? large_unpackers_ : unpackers_);
  if (!refusal) return;
  Turn turn(dispatcher_);
  WorkerSession* session = workers_.find(worker, link);
  if (session == nullptr) return;
  reject(*session, pending->result, *refusal, turn);
  want(*session, pending->result.want(), turn);
}

std::optional<ResultRefusal> WorkerSessions::have_unpacked(
    const std::shared_ptr<PendingResult>& pending, farm::ThreadPool& pool) {
  const StateLock lock(context_.mutex);
  if (auto later = not_now(pending->result)) return later;
  pending->packed.emplace(packed_, farm::ByteBudget::Owner{pending->owner});
  if (pending->packed->try_hold(pending->result.film().size()) &&
      pool.submit([this, pending] { unpack(pending); }, pending->owner)) {
    return std::nullopt;
  }
  pending->packed.reset();
  return too_many_wait();
}

void WorkerSessions::unpack(const std::shared_ptr<PendingResult>& pending) {
  const v1::UnitResult& result = pending->result;
  std::variant<Delivery, ResultRefusal> checked = check_result(result, pending->expected);
  pending->packed.reset();
  Turn turn(dispatcher_);
  WorkerSession* session = workers_.find(pending->worker, pending->link.get());
  if (session == nullptr) return;
  std::optional<ResultRefusal> refusal;
  if (auto* delivery = std::get_if<Delivery>(&checked)) {
    delivery->rendered.came = pending->came;
    refusal = deliver(*session, result, *delivery, turn);
  } else {
    refusal = std::get<ResultRefusal>(std::move(checked));
  }
  if (refusal) reject(*session, result, *refusal, turn);
  want(*session, result.want(), turn);
}

/// Who sends one film that is none after the other is cut off, and has to come again.
void WorkerSessions::reject(WorkerSession& session, const v1::UnitResult& result,
                            const ResultRefusal& refusal, Turn& turn) {
  refuse(session, result, refusal, turn);
  const bool bad = refusal.reason == v1::Rejected::REASON_DAMAGED ||
                   refusal.reason == v1::Rejected::REASON_MALFORMED;
  if (!bad) return;
  if (++session.bad_films < kMostBadFilms) return;
  session.bad_films = 0;
  if (session.link) {
    session.link->close({grpc::StatusCode::INVALID_ARGUMENT, "film after film that is none"});
  }
}

/// Why no film of the job is taken at the moment.
std::optional<ResultRefusal> WorkerSessions::not_now(const v1::UnitResult& result) {
  using Rejected = v1::Rejected;
  if (disk_.level() == DiskLevel::full) {
    return ResultRefusal{Rejected::REASON_NOT_NOW, "the coordinator's disk is full", kFullRetryMs};
  }
  const ActiveJob* active = jobs_.find(result.job());
  if (active != nullptr && active->film_store && active->film_store->crowded()) {
    return ResultRefusal{Rejected::REASON_NOT_NOW, "more films wait for the disk than may",
                         kCrowdedRetryMs};
  }
  return std::nullopt;
}

/// The scheduler hears of the film, unless it cannot be taken now.
std::optional<ResultRefusal> WorkerSessions::deliver(WorkerSession& session,
                                                     const v1::UnitResult& result,
                                                     Delivery& delivery, Turn& turn) {
  using Rejected = v1::Rejected;
  ActiveJob* active = jobs_.find(result.job());
  if (session.state == v1::WORKER_STATE_QUARANTINED) {
    return ResultRefusal{Rejected::REASON_UNKNOWN, "the worker is quarantined"};
  }
  const core::Unit& unit = delivery.unit.unit;
  if (auto later = not_now(result)) return later;
  delivery.rendered.worker = session.id;
  delivery.rendered.name = session.hello.name();
  delivery.rendered.thread = result.thread();
  delivery.rendered.render_ns =
      std::min(result.render_ns(), longest_rendering(session, result, unit));
  delivery.rendered.came_us = core::wall_us();
  delivery.rendered.is_old = result.lease().incarnation() != context_.incarnation;
  // What a worker notes counts once, with a film of a unit that it has.
  const v1::LeasedUnit named = named_unit(result);
  const int notes = has(session, named, unit) ? std::min(result.notes_size(), kMostNotes) : 0;
  for (int i = 0; active != nullptr && i < notes; ++i) {
    jobs_.note(*active, v1::LOG_LEVEL_WARNING, unit.frame, session.hello.name(),
               farm::wire_text(result.notes(i)), &unit);
  }
  session.bad_films = 0;
  const Duration took{static_cast<int64_t>(delivery.rendered.render_ns)};
  const Digest digest = delivery.unit.digest;
  turn.tell(
      ResultArrived{session.id, from_wire(result.lease()), JobId{result.job()}, unit, digest, took},
      &delivery);
  if (!delivery.settled) context_.meters->result("waits");
  return std::nullopt;
}

void WorkerSessions::refuse(WorkerSession& session, const v1::UnitResult& result,
                            const ResultRefusal& refusal, Turn& turn) {
  v1::CoordinatorMessage message;
  v1::Rejected& rejected = *message.mutable_rejected();
  *rejected.mutable_unit()->mutable_lease() = result.lease();
  rejected.mutable_unit()->set_job(result.job());
  *rejected.mutable_unit()->mutable_unit() = result.unit();
  rejected.mutable_unit()->mutable_unit()->clear_proof();  // it may be as long as a film
  rejected.set_reason(refusal.reason);
  rejected.set_text(refusal.text);
  rejected.set_retry_after_ms(refusal.retry_after_ms);
  session.link->send(bytes_of(message));
  context_.meters->result(verdict_of(refusal.reason));
  if (refusal.reason == v1::Rejected::REASON_NOT_NOW) return;
  const auto unit = farm::from_wire(result.unit());
  if (!unit || !has(session, message.rejected().unit(), *unit)) return;
  if (ActiveJob* active = jobs_.find(result.job())) {
    jobs_.note(*active, v1::LOG_LEVEL_WARNING, result.unit().frame(), session.hello.name(),
               "a film was refused: " + refusal.text, &*unit);
  }
  turn.tell(UnitReturned{session.id, from_wire(result.lease()), JobId{result.job()}, *unit});
}

void WorkerSessions::send_lease(const Lease& lease) {
  WorkerSession* session = workers_.find(lease.worker);
  ActiveJob* active = jobs_.find(lease.job);
  if (session == nullptr || active == nullptr) return;
  if (session->spec_sent.insert(lease.job).second) {
    if (session->link) session->link->send(active->brief);
  }
  v1::CoordinatorMessage message;
  v1::Lease& wire = *message.mutable_lease();
  *wire.mutable_lease() = to_wire(lease.lease);
  wire.set_job(static_cast<uint64_t>(lease.job));
  for (const core::Unit& unit : lease.units) {
    v1::Unit& leased = *wire.add_units();
    leased = farm::to_wire(unit);
    leased.set_proof(context_.proofs.make(session->hello.worker_id(), lease.job, unit));
  }
  wire.set_adopted(lease.adopted);
  wire.set_deadline_ms(static_cast<uint64_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(context_.options.lease_time).count()));
  workers_.send(lease.worker, message);
  context_.meters->leased(lease.units.size(), lease.adopted);

  if (active->stored.begun_ms == 0) active->stored.begun_ms = core::wall_ms();
  active->set_busy(true, std::chrono::steady_clock::now());
  const int32_t number = lease.units.front().frame;
  FrameNote& frame = active->touch(number);
  if (frame.state == v1::FRAME_STATE_WAITING) {
    frame.state = v1::FRAME_STATE_RENDERING;
    frame.begun_ms = core::wall_ms();
    frame.begun = jobs_.moment();
    jobs_.note(*active, v1::LOG_LEVEL_INFO, number, session->hello.name(), "begun");
  }
  if (frame.worker_class.empty()) frame.worker_class = session->class_for(active->needs);
}

void WorkerSessions::send_over(JobId job) {
  for (auto& [id, session] : workers_.all()) {
    if (session.spec_sent.erase(job) == 0) continue;
    v1::CoordinatorMessage message;
    message.mutable_over()->set_job(static_cast<uint64_t>(job));
    workers_.send(id, message);
  }
}

}  // namespace hyades::coordinator
