// Workers that come and go.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/brain/brain.h"
#include "coordinator/brain/counted.h"
#include "coordinator/brain/wire_ids.h"
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

/// Whether another worker may come; with the lock. Where all seats are taken, one that is gone is
/// forgotten sooner than others.
bool Brain::has_seat(std::vector<Action>& later) {
  if (seats_.size() < kMostWorkers) return true;
  const auto gone = std::find_if(seats_.begin(), seats_.end(), [](const auto& seat) {
    return seat.second.lost_at && !seat.second.joined;
  });
  if (gone == seats_.end()) return false;
  later = forget(gone->first);
  return true;
}

/// Two processes under one id would close each other's stream for ever. The one that was here first
/// keeps the id if it still speaks after another has asked; a silent one is gone (its machine lost
/// its power, say), though nobody has noticed yet. With the lock.
grpc::Status Brain::meet_twin(Seat& seat, const v1::Hello& hello) {
  if (!seat.link || seat.hello.instance() == hello.instance()) return grpc::Status::OK;
  const TimePoint now = std::chrono::steady_clock::now();
  const Duration pause = options_.lease_time / kHeartbeats + kTwinMargin;
  if (!seat.twin_came || now - *seat.twin_came > 4 * pause) seat.twin_came = now;
  if (seat.heard > *seat.twin_came) {
    return {grpc::StatusCode::ALREADY_EXISTS,
            fmt::format("a worker called {} on {} works under this id: take a new one",
                        seat.hello.name(), seat.hello.host())};
  }
  if (now - *seat.twin_came >= pause) return grpc::Status::OK;
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                           "a worker with this id is here: it may have gone without a sign",
                           std::chrono::duration_cast<std::chrono::milliseconds>(pause));
}

grpc::Status Brain::attach(const v1::Hello& hello, const std::shared_ptr<WorkerLink>& link,
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
    if (!worker_ids_.contains(hello.worker_id()) && !has_seat(later)) {
      return farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                               fmt::format("there are {} workers already", kMostWorkers),
                               std::chrono::seconds(10));
    }
    const auto [known, fresh] = worker_ids_.try_emplace(hello.worker_id(), WorkerId{next_worker_});
    if (fresh) ++next_worker_;
    worker = known->second;
    Seat& seat = seats_[worker];
    if (grpc::Status met = meet_twin(seat, hello); !met.ok()) return met;
    seat.twin_came.reset();
    if (seat.link) {
      seat.link->close({grpc::StatusCode::ABORTED, "the worker has a newer stream"});
    }
    const bool new_process = seat.joined && seat.hello.instance() != hello.instance();
    seat.id = worker;
    seat.hello = hello;
    seat.hello.clear_in_hand();
    seat.link = link;
    seat.briefed.clear();
    seat.pulses.clear();
    if (const auto kept = quarantines_.find(hello.worker_id()); kept != quarantines_.end()) {
      seat.state = v1::WORKER_STATE_QUARANTINED;
      seat.reason = kept->second;
    } else {
      seat.state = v1::WORKER_STATE_ACTIVE;
    }
    seat.lost_at.reset();
    seat.leaving = false;
    seat.held_wish = 0;
    seat.heard = std::chrono::steady_clock::now();
    seat.heard_ms = wall_ms();
    if (seat.joined_ms == 0) seat.joined_ms = seat.heard_ms;

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
      note_losses(seat, scheduler_.units_of(worker), "has been started again");
    }
    seat.joined = true;
    farm::log_later(farm::LogLevel::info,
                    fmt::format("attends: {}{}", counted(hello.threads(), "thread"),
                                hello.host().empty() ? "" : " on " + hello.host()),
                    {{}, {}, {}, farm::wire_text(hello.name())});
    for (Action& action : tell(joined)) later.push_back(std::move(action));
    if (seat.state == v1::WORKER_STATE_QUARANTINED) {
      for (Action& action : tell(WorkerBarred{worker, true})) later.push_back(std::move(action));
    }
    if (!joined.in_hand.empty()) wait_for_more_holders();
    want(seat, hello.want(), later);
  }
  carry_out(later);
  return grpc::Status::OK;
}

/// A worker that holds something has come: where so many come that they have to wait for each other
/// the rest is still on its way. With the lock.
void Brain::wait_for_more_holders() {
  const TimePoint now = std::chrono::steady_clock::now();
  if (now >= adopting_until_) return;
  const TimePoint later = std::min(now + options_.adoption_time / 5, adopting_at_most_);
  adopting_until_ = std::max(adopting_until_, later);
}

void Brain::detach(WorkerId worker, const WorkerLink* link) {
  const std::lock_guard lock(mutex_);
  Seat* seat = seat_of(worker, link);
  if (seat == nullptr) return;
  farm::log_later(
      farm::LogLevel::info,
      seat->reason.empty() ? "its stream has ended" : "its stream has ended: " + seat->reason,
      {{}, {}, {}, seat->hello.name()});
  seat->link.reset();
  seat->lost_at = std::chrono::steady_clock::now();
}

}  // namespace hyades::coordinator
