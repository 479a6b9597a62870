#include "coordinator/controller/worker_sessions.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/controller/to_wire.h"
#include "coordinator/meters/meters.h"
#include "core/base/printable.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/base/wall_clock.h"
#include "farm/log.h"
#include "farm/tags.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostWorkers = 20'000;
constexpr int kMostInHand = 20'000;                            ///< units that a worker brings along
constexpr uint32_t kMostThreads = 4096;                        ///< of one worker
constexpr int kHeartbeats = 6;                                 ///< of a worker, in one lease_time
constexpr Duration kLateBeatMargin = std::chrono::seconds(1);  ///< that a heartbeat may be late by

uint64_t milliseconds(Duration d) {
  return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(d).count());
}

/// What makes a Hello useless, or nothing.
std::string complaint(const v1::Hello& hello) {
  if (hello.protocol() < farm::kOldestProtocol) {
    return fmt::format(
        "the worker speaks protocol {}, this coordinator {} to {}: update the worker",
        hello.protocol(), farm::kOldestProtocol, farm::kProtocol);
  }
  if (hello.worker_id().size() < 16 || hello.worker_id().size() > 64) {
    return "worker_id has to have 16 to 64 characters";
  }
  if (hello.instance().size() < 16 || hello.instance().size() > 64) {
    return "instance has to have 16 to 64 characters";
  }
  if (hello.name().empty() || hello.name().size() > kLongestName ||
      hello.host().size() > kLongestName || hello.build().size() > kLongestName) {
    return "a worker needs a name; names, host and build have at most 200 characters";
  }
  if (!core::is_printable(hello.name()) || !core::is_printable(hello.host()) ||
      !core::is_printable(hello.build())) {
    return "name, host and build: expected one line of printable characters";
  }
  if (const auto tags = farm::check_tags({hello.tags().begin(), hello.tags().end()}); !tags) {
    return tags.error().message;
  }
  if (hello.worker_class().empty() || hello.worker_class().size() > 64) {
    return "a worker needs a class of at most 64 characters";
  }
  if (hello.portable_class().size() > 64) return "a portable class has at most 64 characters";
  if (!core::is_printable(hello.worker_class()) || !core::is_printable(hello.portable_class())) {
    return "class: expected printable characters";
  }
  if (hello.threads() < 1 || hello.threads() > kMostThreads) return "threads: expected 1 to 4096";
  if (hello.in_hand_size() > kMostInHand) {
    return fmt::format("units in hand: at most {}", kMostInHand);
  }
  return {};
}

/// What the scheduler is told of a worker, but for its number. What it says that it has and cannot
/// prove is put into `unproven`.
core::Result<WorkerJoined> joining(const v1::Hello& hello, const LeaseProofs& proofs,
                                   std::vector<v1::LeasedUnit>& unproven) {
  WorkerJoined joined;
  joined.threads = hello.threads();
  joined.worker_class = hello.worker_class();
  joined.portable_class = hello.portable_class();
  joined.tags.assign(hello.tags().begin(), hello.tags().end());
  joined.memory = hello.memory_bytes();
  for (const v1::LeasedUnit& held : hello.in_hand()) {
    const auto unit = farm::from_wire(held.unit());
    if (!unit) return unit.error();
    if (!proofs.holds(held.unit().proof(), hello.worker_id(), JobId{held.job()}, *unit)) {
      unproven.push_back(held);
      continue;
    }
    joined.in_hand.push_back({from_wire(held.lease()), JobId{held.job()}, *unit});
  }
  return joined;
}

/// What a session keeps of what a worker says of itself, field by field: a message that is emptied
/// holds on to its memory, and one that is copied keeps what this version does not know.
v1::Hello without_units(const v1::Hello& hello) {
  v1::Hello kept;
  kept.set_protocol(hello.protocol());
  kept.set_worker_id(hello.worker_id());
  kept.set_name(hello.name());
  kept.set_host(hello.host());
  kept.set_worker_class(hello.worker_class());
  kept.set_portable_class(hello.portable_class());
  kept.set_build(hello.build());
  kept.set_threads(hello.threads());
  kept.set_memory_bytes(hello.memory_bytes());
  *kept.mutable_tags() = hello.tags();
  kept.set_instance(hello.instance());
  return kept;
}

void begin_stream(WorkerSession& session, const v1::Hello& hello,
                  const std::shared_ptr<WorkerLink>& link) HYADES_REQUIRES(state_lock) {
  session.hello = without_units(hello);
  session.link = link;
  session.spec_sent.clear();
  session.progress.clear();
  session.lost_at.reset();
  session.leaving = false;
  session.deferred_request = 0;
  session.heard = std::chrono::steady_clock::now();
  session.heard_ms = core::wall_ms();
  if (session.joined_ms == 0) session.joined_ms = session.heard_ms;
}

}  // namespace

/// Whether another worker may come. Where all places are taken, one that is gone is forgotten
/// sooner than others.
bool WorkerSessions::has_room(Turn& turn) {
  if (workers_.all().size() < kMostWorkers) return true;
  for (const auto& [id, session] : workers_.all()) {
    if (!session.lost_at || session.joined) continue;
    workers_.forget(id, turn);
    return true;
  }
  return false;
}

/// Whether who shows this may be the worker that it says it is. Whoever knows the id of another's
/// could else take what the farm knows of it; a process that has been here may come with a token of
/// another name, as that is how tokens are changed.
grpc::Status WorkerSessions::may_join(const v1::Hello& hello, const WorkerPass& pass) const {
  const WorkerSession* session = workers_.session_of(hello.worker_id());
  if (session != nullptr && !session->owner.empty() && session->owner != pass.owner &&
      session->hello.instance() != hello.instance()) {
    return {grpc::StatusCode::ALREADY_EXISTS,
            "a worker that has joined with the token of somebody else has this id: take a new one"};
  }
  const bool counted = session != nullptr && session->joined_with == pass.joined_with;
  if (pass.joined_with.empty() || counted ||
      workers_.joined_by(pass.joined_with) < size_t{pass.machines}) {
    return grpc::Status::OK;
  }
  return farm::retry_later(
      grpc::StatusCode::RESOURCE_EXHAUSTED,
      fmt::format("{} workers have joined with the token {}, as many as may: ask an admin for "
                  "another ('hyades token create --role worker --machines N')",
                  pass.machines, pass.joined_with),
      std::chrono::seconds(10));
}

/// Two processes under one id would close each other's stream for ever. The one that was here first
/// keeps the id if it still speaks after another has asked; a silent one is gone (its machine lost
/// its power, say), though nobody has noticed yet.
grpc::Status WorkerSessions::resolve_duplicate_id(WorkerSession& session, const v1::Hello& hello) {
  if (!session.link || session.hello.instance() == hello.instance()) return grpc::Status::OK;
  const TimePoint now = std::chrono::steady_clock::now();
  const Duration pause = context_.options.lease_time / kHeartbeats + kLateBeatMargin;
  if (!session.duplicate_since || now - *session.duplicate_since > 4 * pause)
    session.duplicate_since = now;
  if (session.heard > *session.duplicate_since) {
    return {grpc::StatusCode::ALREADY_EXISTS,
            fmt::format("a worker called {} on {} works under this id: take a new one",
                        session.hello.name(), session.hello.host())};
  }
  if (now - *session.duplicate_since >= pause) return grpc::Status::OK;
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                           "a worker with this id is here: it may have gone without a sign",
                           std::chrono::duration_cast<std::chrono::milliseconds>(pause));
}

grpc::Status WorkerSessions::attach(const v1::Hello& hello, const std::shared_ptr<WorkerLink>& link,
                                    WorkerId& worker, const WorkerPass& pass) {
  if (const std::string wrong = complaint(hello); !wrong.empty()) {
    return {hello.protocol() < farm::kOldestProtocol ? grpc::StatusCode::FAILED_PRECONDITION
                                                     : grpc::StatusCode::INVALID_ARGUMENT,
            wrong};
  }
  std::vector<v1::LeasedUnit> unproven;
  auto joined = joining(hello, context_.proofs, unproven);
  if (!joined) return {grpc::StatusCode::INVALID_ARGUMENT, joined.error().message};
  Turn turn(dispatcher_);
  if (grpc::Status may = may_join(hello, pass); !may.ok()) return may;
  if (workers_.session_of(hello.worker_id()) == nullptr && !has_room(turn)) {
    return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                             fmt::format("there are {} workers already", kMostWorkers),
                             std::chrono::seconds(10));
  }
  WorkerSession& session = workers_.open(hello.worker_id());
  worker = session.id;
  if (grpc::Status met = resolve_duplicate_id(session, hello); !met.ok()) return met;
  session.duplicate_since.reset();
  if (session.link) {
    session.link->close({grpc::StatusCode::ABORTED, "the worker has a newer stream"});
  }
  const bool same_process = session.hello.instance() == hello.instance();
  const bool new_process = session.joined && !same_process;
  if (!same_process) session.drained.reset();
  begin_stream(session, hello, link);
  session.owner = pass.owner;
  workers_.set_joined_with(session, pass.joined_with);
  if (const std::string* why = workers_.quarantine_of(hello.worker_id())) {
    session.state = v1::WORKER_STATE_QUARANTINED;
    session.reason = *why;
  } else {
    session.state = v1::WORKER_STATE_ACTIVE;
    session.reason = session.drained.value_or("");  // not why an earlier process has left
  }
  link->send(bytes_of(welcome(hello, pass)));
  for (v1::LeasedUnit& unit : unproven) {
    v1::CoordinatorMessage stop;
    *stop.mutable_stop()->mutable_unit() = std::move(unit);
    link->send(bytes_of(stop));
  }

  joined->worker = worker;
  joined->credential = pass.credential;
  joined->origin = pass.origin;
  if (new_process) {
    workers_.note_losses(session, dispatcher_.scheduler().units_of(worker),
                         "has been started again");
  }
  session.joined = true;
  farm::log_later(farm::LogLevel::info,
                  fmt::format("attends: {}{}", core::counted(hello.threads(), "thread"),
                              hello.host().empty() ? "" : " on " + hello.host()),
                  {{}, {}, {}, farm::wire_text(hello.name())});
  turn.tell(*joined);
  if (session.state == v1::WORKER_STATE_QUARANTINED) turn.tell(WorkerBarred{worker, true});
  if (session.drained) workers_.send_drain(session, turn);
  if (!joined->in_hand.empty()) wait_for_more_holders();
  want(session, hello.want(), turn);
  return grpc::Status::OK;
}

v1::CoordinatorMessage WorkerSessions::welcome(const v1::Hello& hello,
                                               const WorkerPass& pass) const {
  v1::CoordinatorMessage message;
  v1::Welcome& welcome = *message.mutable_welcome();
  welcome.set_protocol(farm::kProtocol);
  welcome.set_incarnation(context_.incarnation);
  welcome.set_heartbeat_ms(
      static_cast<uint32_t>(milliseconds(context_.options.lease_time) / kHeartbeats));
  welcome.set_lease_ms(static_cast<uint32_t>(milliseconds(context_.options.lease_time)));
  welcome.set_max_message_bytes(farm::kMaxResultBytes);
  welcome.set_version(core::kVersion);
  welcome.set_name(hello.name());
  welcome.set_token_expires_ms(pass.term.expires_ms);
  welcome.set_token_warn_ms(pass.term.warn_ms);
  welcome.set_machine_token(pass.machine_token);
  return message;
}

void WorkerSessions::begin_adoption() {
  const TimePoint now = std::chrono::steady_clock::now();
  adopting_until_ = now + context_.options.adoption_time;
  adopting_at_most_ = now + 4 * context_.options.adoption_time;
}

bool WorkerSessions::is_adopting() const {
  return std::chrono::steady_clock::now() < adopting_until_;
}

/// A worker that holds something has come: where so many come that they have to wait for each other
/// the rest is still on its way.
void WorkerSessions::wait_for_more_holders() {
  if (!is_adopting()) return;
  const TimePoint later = std::min(
      std::chrono::steady_clock::now() + context_.options.adoption_time / 5, adopting_at_most_);
  adopting_until_ = std::max(adopting_until_, later);
}

void WorkerSessions::want(WorkerSession& session, uint32_t units, Turn& turn) {
  if (units == 0 || session.leaving) return;
  if (is_adopting()) {
    session.deferred_request =
        std::min(session.deferred_request + std::min(units, kMostThreads), kMostThreads);
    return;
  }
  turn.tell(WorkRequested{session.id, units});
}

void WorkerSessions::detach(WorkerId worker, const WorkerLink* link) {
  const StateLock lock(context_.mutex);
  WorkerSession* session = workers_.find(worker, link);
  if (session == nullptr) return;
  farm::log_later(
      farm::LogLevel::info,
      session->reason.empty() ? "its stream has ended" : "its stream has ended: " + session->reason,
      {{}, {}, {}, session->hello.name()});
  session->link.reset();
  session->lost_at = std::chrono::steady_clock::now();
}

void WorkerSessions::close(const grpc::Status& why) {
  const StateLock lock(context_.mutex);
  for (auto& [id, session] : workers_.all()) {
    if (session.link) session.link->close(why);
  }
}

void WorkerSessions::look_after(Turn& turn) {
  const TimePoint now = std::chrono::steady_clock::now();
  for (auto it = workers_.all().begin(); it != workers_.all().end();) {
    WorkerSession& session = it->second;
    if (session.link && now - session.heard > context_.options.lease_time) {
      session.link->close({grpc::StatusCode::DEADLINE_EXCEEDED, "not heard of for too long"});
      session.link.reset();
      session.lost_at = now;
    }
    if (session.lost_at && session.joined &&
        (session.leaving || now - *session.lost_at > context_.options.reconnect_time)) {
      session.joined = false;
      if (session.state != v1::WORKER_STATE_QUARANTINED) session.state = v1::WORKER_STATE_GONE;
      workers_.note_losses(session, dispatcher_.scheduler().units_of(session.id),
                           session.leaving ? "has left" : "is lost");
      if (!session.leaving) context_.meters->worker_lost();
      turn.tell(WorkerLost{session.id});
    }
    if (session.deferred_request > 0 && session.joined && now >= adopting_until_) {
      turn.tell(WorkRequested{session.id, std::exchange(session.deferred_request, 0)});
    }
    const WorkerId id = it->first;
    ++it;
    if (session.lost_at && now - *session.lost_at > context_.options.forget_time) {
      workers_.forget(id, turn);
    }
  }
}

}  // namespace hyades::coordinator
