// Workers that come and go.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "coordinator/controller/counted.h"
#include "coordinator/controller/wire_ids.h"
#include "core/base/version.h"
#include "farm/log.h"
#include "farm/tags.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostWorkers = 20'000;
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

/// Whether another worker may come; with the lock. Where all sessions are taken, one that is gone
/// is forgotten sooner than others.
bool Controller::has_room_for_worker(std::vector<Action>& later) {
  if (sessions_.size() < kMostWorkers) return true;
  const auto gone = std::find_if(sessions_.begin(), sessions_.end(), [](const auto& session) {
    return session.second.lost_at && !session.second.joined;
  });
  if (gone == sessions_.end()) return false;
  later = forget(gone->first);
  return true;
}

/// Two processes under one id would close each other's stream for ever. The one that was here first
/// keeps the id if it still speaks after another has asked; a silent one is gone (its machine lost
/// its power, say), though nobody has noticed yet. With the lock.
grpc::Status Controller::meet_twin(WorkerSession& session, const v1::Hello& hello) {
  if (!session.link || session.hello.instance() == hello.instance()) return grpc::Status::OK;
  const TimePoint now = std::chrono::steady_clock::now();
  const Duration pause = options_.lease_time / kHeartbeats + kTwinMargin;
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

grpc::Status Controller::attach(const v1::Hello& hello, const std::shared_ptr<WorkerLink>& link,
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
    joined.in_hand.push_back({lease_from_wire(held.lease()), JobId{held.job()}, *unit});
  }
  std::vector<Action> later;
  {
    const std::lock_guard lock(mutex_);
    if (!worker_ids_.contains(hello.worker_id()) && !has_room_for_worker(later)) {
      return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                               fmt::format("there are {} workers already", kMostWorkers),
                               std::chrono::seconds(10));
    }
    const auto [known, fresh] = worker_ids_.try_emplace(hello.worker_id(), WorkerId{next_worker_});
    if (fresh) ++next_worker_;
    worker = known->second;
    WorkerSession& session = sessions_[worker];
    if (grpc::Status met = meet_twin(session, hello); !met.ok()) return met;
    session.twin_came.reset();
    if (session.link) {
      session.link->close({grpc::StatusCode::ABORTED, "the worker has a newer stream"});
    }
    const bool new_process = session.joined && session.hello.instance() != hello.instance();
    session.id = worker;
    session.hello = hello;
    session.hello.clear_in_hand();
    session.link = link;
    session.spec_sent.clear();
    session.progress.clear();
    if (const auto kept = quarantines_.find(hello.worker_id()); kept != quarantines_.end()) {
      session.state = v1::WORKER_STATE_QUARANTINED;
      session.reason = kept->second;
    } else {
      session.state = v1::WORKER_STATE_ACTIVE;
    }
    session.lost_at.reset();
    session.leaving = false;
    session.held_wish = 0;
    session.heard = std::chrono::steady_clock::now();
    session.heard_ms = wall_ms();
    if (session.joined_ms == 0) session.joined_ms = session.heard_ms;

    v1::CoordinatorMessage message;
    v1::Welcome& welcome = *message.mutable_welcome();
    welcome.set_protocol(farm::kProtocol);
    welcome.set_incarnation(incarnation_);
    welcome.set_heartbeat_ms(
        static_cast<uint32_t>(milliseconds(options_.lease_time) / kHeartbeats));
    welcome.set_lease_ms(static_cast<uint32_t>(milliseconds(options_.lease_time)));
    welcome.set_max_message_bytes(farm::kMaxResultBytes);
    welcome.set_version(core::kVersion);
    welcome.set_name(hello.name());
    welcome.set_token_expires_ms(token.expires_ms);
    welcome.set_token_warn_ms(token.warn_ms);
    link->send(std::move(message));

    joined.worker = worker;
    if (new_process) {
      note_losses(session, scheduler_.units_of(worker), "has been started again");
    }
    session.joined = true;
    farm::log_later(farm::LogLevel::info,
                    fmt::format("attends: {}{}", counted(hello.threads(), "thread"),
                                hello.host().empty() ? "" : " on " + hello.host()),
                    {{}, {}, {}, farm::wire_text(hello.name())});
    for (Action& action : tell(joined)) later.push_back(std::move(action));
    if (session.state == v1::WORKER_STATE_QUARANTINED) {
      for (Action& action : tell(WorkerBarred{worker, true})) later.push_back(std::move(action));
    }
    if (!joined.in_hand.empty()) wait_for_more_holders();
    want(session, hello.want(), later);
  }
  carry_out(later);
  return grpc::Status::OK;
}

/// A worker that holds something has come: where so many come that they have to wait for each other
/// the rest is still on its way. With the lock.
void Controller::wait_for_more_holders() {
  const TimePoint now = std::chrono::steady_clock::now();
  if (now >= adopting_until_) return;
  const TimePoint later = std::min(now + options_.adoption_time / 5, adopting_at_most_);
  adopting_until_ = std::max(adopting_until_, later);
}

void Controller::detach(WorkerId worker, const WorkerLink* link) {
  const std::lock_guard lock(mutex_);
  WorkerSession* session = session_of(worker, link);
  if (session == nullptr) return;
  farm::log_later(
      farm::LogLevel::info,
      session->reason.empty() ? "its stream has ended" : "its stream has ended: " + session->reason,
      {{}, {}, {}, session->hello.name()});
  session->link.reset();
  session->lost_at = std::chrono::steady_clock::now();
}

}  // namespace hyades::coordinator
