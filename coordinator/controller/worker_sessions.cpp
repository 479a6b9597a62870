#include "coordinator/controller/worker_sessions.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/counted.h"
#include "coordinator/controller/to_wire.h"
#include "coordinator/controller/wall_clock.h"
#include "coordinator/meters/meters.h"
#include "core/base/version.h"
#include "farm/log.h"
#include "farm/tags.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostWorkers = 20'000;
/// That one worker may have.
constexpr uint32_t kMostThreads = 4096;
/// In the time that a lease lasts.
constexpr int kHeartbeats = 6;
/// By which a heartbeat may be late.
constexpr Duration kTwinMargin = std::chrono::seconds(1);

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
  if (hello.name().empty() || hello.name().size() > 200 || hello.host().size() > 200 ||
      hello.build().size() > 200) {
    return "a worker needs a name; names, host and build have at most 200 characters";
  }
  if (const auto tags = farm::check_tags({hello.tags().begin(), hello.tags().end()}); !tags) {
    return tags.error().message;
  }
  if (hello.worker_class().empty() || hello.worker_class().size() > 64) {
    return "a worker needs a class of at most 64 characters";
  }
  if (hello.threads() < 1 || hello.threads() > kMostThreads) return "threads: expected 1 to 4096";
  return {};
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

/// Two processes under one id would close each other's stream for ever. The one that was here first
/// keeps the id if it still speaks after another has asked; a silent one is gone (its machine lost
/// its power, say), though nobody has noticed yet.
grpc::Status WorkerSessions::meet_twin(WorkerSession& session, const v1::Hello& hello) {
  if (!session.link || session.hello.instance() == hello.instance()) return grpc::Status::OK;
  const TimePoint now = std::chrono::steady_clock::now();
  const Duration pause = shared_.options.lease_time / kHeartbeats + kTwinMargin;
  if (!session.twin_came || now - *session.twin_came > 4 * pause) session.twin_came = now;
  if (session.heard > *session.twin_came) {
    return {grpc::StatusCode::ALREADY_EXISTS,
            fmt::format("a worker called {} on {} works under this id: take a new one",
                        session.hello.name(), session.hello.host())};
  }
  if (now - *session.twin_came >= pause) return grpc::Status::OK;
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                           "a worker with this id is here: it may have gone without a sign",
                           std::chrono::duration_cast<std::chrono::milliseconds>(pause));
}

grpc::Status WorkerSessions::attach(const v1::Hello& hello, const std::shared_ptr<WorkerLink>& link,
                                    WorkerId& worker, const farm::TokenTerm& token) {
  if (const std::string wrong = complaint(hello); !wrong.empty()) {
    return {hello.protocol() < farm::kOldestProtocol ? grpc::StatusCode::FAILED_PRECONDITION
                                                     : grpc::StatusCode::INVALID_ARGUMENT,
            wrong};
  }
  WorkerJoined joined;
  joined.threads = hello.threads();
  joined.worker_class = hello.worker_class();
  joined.tags.assign(hello.tags().begin(), hello.tags().end());
  joined.memory = hello.memory_bytes();
  for (const v1::LeasedUnit& held : hello.in_hand()) {
    const auto unit = farm::from_wire(held.unit());
    if (!unit) return {grpc::StatusCode::INVALID_ARGUMENT, unit.error().message};
    joined.in_hand.push_back({from_wire(held.lease()), JobId{held.job()}, *unit});
  }
  Turn turn(dispatcher_);
  if (!workers_.knows(hello.worker_id()) && !has_room(turn)) {
    return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                             fmt::format("there are {} workers already", kMostWorkers),
                             std::chrono::seconds(10));
  }
  WorkerSession& session = workers_.open(hello.worker_id());
  worker = session.id;
  if (grpc::Status met = meet_twin(session, hello); !met.ok()) return met;
  session.twin_came.reset();
  if (session.link) {
    session.link->close({grpc::StatusCode::ABORTED, "the worker has a newer stream"});
  }
  const bool new_process = session.joined && session.hello.instance() != hello.instance();
  session.hello = hello;
  session.hello.clear_in_hand();
  session.link = link;
  session.spec_sent.clear();
  session.progress.clear();
  if (const std::string* why = workers_.quarantine_of(hello.worker_id())) {
    session.state = v1::WORKER_STATE_QUARANTINED;
    session.reason = *why;
  } else {
    session.state = v1::WORKER_STATE_ACTIVE;
  }
  session.lost_at.reset();
  session.leaving = false;
  session.held_wish = 0;
  session.heard = std::chrono::steady_clock::now();
  session.heard_ms = wall_ms();
  if (session.joined_ms == 0) session.joined_ms = session.heard_ms;
  link->send(welcome(hello, token));

  joined.worker = worker;
  if (new_process) {
    workers_.note_losses(session, dispatcher_.scheduler().units_of(worker),
                         "has been started again");
  }
  session.joined = true;
  farm::log_later(farm::LogLevel::info,
                  fmt::format("attends: {}{}", counted(hello.threads(), "thread"),
                              hello.host().empty() ? "" : " on " + hello.host()),
                  {{}, {}, {}, farm::wire_text(hello.name())});
  turn.tell(joined);
  if (session.state == v1::WORKER_STATE_QUARANTINED) turn.tell(WorkerBarred{worker, true});
  if (!joined.in_hand.empty()) wait_for_more_holders();
  want(session, hello.want(), turn);
  return grpc::Status::OK;
}

v1::CoordinatorMessage WorkerSessions::welcome(const v1::Hello& hello,
                                               const farm::TokenTerm& token) const {
  v1::CoordinatorMessage message;
  v1::Welcome& welcome = *message.mutable_welcome();
  welcome.set_protocol(farm::kProtocol);
  welcome.set_incarnation(shared_.incarnation);
  welcome.set_heartbeat_ms(
      static_cast<uint32_t>(milliseconds(shared_.options.lease_time) / kHeartbeats));
  welcome.set_lease_ms(static_cast<uint32_t>(milliseconds(shared_.options.lease_time)));
  welcome.set_max_message_bytes(farm::kMaxResultBytes);
  welcome.set_version(core::kVersion);
  welcome.set_name(hello.name());
  welcome.set_token_expires_ms(token.expires_ms);
  welcome.set_token_warn_ms(token.warn_ms);
  return message;
}

void WorkerSessions::begin_adoption() {
  const TimePoint now = std::chrono::steady_clock::now();
  adopting_until_ = now + shared_.options.adoption_time;
  adopting_at_most_ = now + 4 * shared_.options.adoption_time;
}

bool WorkerSessions::is_adopting() const {
  return std::chrono::steady_clock::now() < adopting_until_;
}

/// A worker that holds something has come: where so many come that they have to wait for each other
/// the rest is still on its way.
void WorkerSessions::wait_for_more_holders() {
  if (!is_adopting()) return;
  const TimePoint later = std::min(
      std::chrono::steady_clock::now() + shared_.options.adoption_time / 5, adopting_at_most_);
  adopting_until_ = std::max(adopting_until_, later);
}

void WorkerSessions::want(WorkerSession& session, uint32_t units, Turn& turn) {
  if (units == 0 || session.leaving) return;
  if (is_adopting()) {
    session.held_wish = std::min(session.held_wish + std::min(units, kMostThreads), kMostThreads);
    return;
  }
  turn.tell(WorkRequested{session.id, units});
}

void WorkerSessions::detach(WorkerId worker, const WorkerLink* link) {
  const StateLock lock(shared_.mutex);
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
  const StateLock lock(shared_.mutex);
  for (auto& [id, session] : workers_.all()) {
    if (session.link) session.link->close(why);
  }
}

void WorkerSessions::look_after(Turn& turn) {
  const TimePoint now = std::chrono::steady_clock::now();
  for (auto it = workers_.all().begin(); it != workers_.all().end();) {
    WorkerSession& session = it->second;
    if (session.link && now - session.heard > shared_.options.lease_time) {
      session.link->close({grpc::StatusCode::DEADLINE_EXCEEDED, "not heard of for too long"});
      session.link.reset();
      session.lost_at = now;
    }
    if (session.lost_at && session.joined &&
        (session.leaving || now - *session.lost_at > shared_.options.reconnect_time)) {
      session.joined = false;
      if (session.state != v1::WORKER_STATE_QUARANTINED) session.state = v1::WORKER_STATE_GONE;
      workers_.note_losses(session, dispatcher_.scheduler().units_of(session.id),
                           session.leaving ? "has left" : "is lost");
      if (!session.leaving) shared_.meters->worker_lost();
      turn.tell(WorkerLost{session.id});
    }
    if (session.held_wish > 0 && session.joined && now >= adopting_until_) {
      turn.tell(WorkRequested{session.id, std::exchange(session.held_wish, 0)});
    }
    const WorkerId id = it->first;
    ++it;
    if (session.lost_at && now - *session.lost_at > shared_.options.forget_time) {
      workers_.forget(id, turn);
    }
  }
}

}  // namespace hyades::coordinator
