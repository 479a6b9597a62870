// Events in, actions out.
#include "coordinator/controller/controller.h"

#include <utility>

#include <fmt/format.h>

#include "coordinator/meters/meters.h"
#include "farm/log.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

v1::LeaseId to_wire(const LeaseId& lease) {
  v1::LeaseId wire;
  wire.set_incarnation(lease.incarnation);
  wire.set_number(lease.number);
  return wire;
}

v1::LeasedUnit to_wire(const LeaseId& lease, JobId job, const core::Unit& unit) {
  v1::LeasedUnit wire;
  *wire.mutable_lease() = to_wire(lease);
  wire.set_job(static_cast<uint64_t>(job));
  *wire.mutable_unit() = farm::to_wire(unit);
  return wire;
}

v1::Rejected::Reason to_wire(RejectReason reason) {
  switch (reason) {
    case RejectReason::unknown:
      return v1::Rejected::REASON_UNKNOWN;
    case RejectReason::malformed:
      return v1::Rejected::REASON_MALFORMED;
    case RejectReason::overlap:
      return v1::Rejected::REASON_OVERLAP;
    case RejectReason::conflict:
      return v1::Rejected::REASON_CONFLICT;
    case RejectReason::not_now:
      return v1::Rejected::REASON_NOT_NOW;
  }
  return v1::Rejected::REASON_UNSPECIFIED;
}

const char* name_of(RejectReason reason) {
  switch (reason) {
    case RejectReason::unknown:
      return "unknown";
    case RejectReason::malformed:
      return "malformed";
    case RejectReason::overlap:
      return "overlap";
    case RejectReason::conflict:
      return "conflict";
    case RejectReason::not_now:
      break;
  }
  return "not_now";
}

constexpr uint32_t kRetryAfterMs = 1000;

}  // namespace

int64_t wall_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

int64_t wall_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::vector<Action> Controller::tell(const Event& event, Delivery* delivery) {
  std::vector<Action> later;
  const std::vector<Action> actions = scheduler_.handle(event, std::chrono::steady_clock::now());
  for (const Action& action : actions) act(action, delivery, later);
  note_expired(actions);
  return later;
}

/// Does what can be done under the lock; the rest goes to `later`.
void Controller::act(const Action& action, Delivery* delivery, std::vector<Action>& later) {
  if (const auto* lease = std::get_if<Lease>(&action)) {
    send_lease(*lease);
  } else if (const auto* ack = std::get_if<Acknowledge>(&action)) {
    v1::CoordinatorMessage message;
    *message.mutable_acknowledge()->mutable_unit() = to_wire(ack->lease, ack->job, ack->unit);
    send(ack->worker, std::move(message));
    // Of a film that needs not be stored: it is there already.
    if (delivery != nullptr && !std::exchange(delivery->settled, true)) {
      meters_->result("duplicate");
    }
  } else if (const auto* revoke = std::get_if<Revoke>(&action)) {
    v1::CoordinatorMessage message;
    *message.mutable_stop()->mutable_unit() = to_wire(revoke->lease, revoke->job, revoke->unit);
    send(revoke->worker, std::move(message));
    meters_->lost(revoke->expired ? "expired" : "revoked");
  } else if (const auto* reject = std::get_if<Reject>(&action)) {
    v1::CoordinatorMessage message;
    v1::Rejected& rejected = *message.mutable_rejected();
    *rejected.mutable_unit() = to_wire(reject->lease, reject->job, reject->unit);
    rejected.set_reason(to_wire(reject->reason));
    if (reject->reason == RejectReason::not_now) rejected.set_retry_after_ms(kRetryAfterMs);
    send(reject->worker, std::move(message));
    meters_->result(name_of(reject->reason));
    if (delivery != nullptr) delivery->settled = true;
  } else if (const auto* conflict = std::get_if<Conflict>(&action)) {
    if (ActiveJob* active = active_job(conflict->job)) {
      note(*active, v1::LOG_LEVEL_ERROR, conflict->unit.frame, {},
           fmt::format("workers {} and {} rendered tile {},{} batches {}-{} to different bits",
                       static_cast<uint64_t>(conflict->first),
                       static_cast<uint64_t>(conflict->second), conflict->unit.tile.x0,
                       conflict->unit.tile.y0, conflict->unit.batches.first,
                       conflict->unit.batches.end() - 1),
           &conflict->unit);
    }
  } else if (const auto* odd = std::get_if<Quarantine>(&action)) {
    if (const auto session = sessions_.find(odd->worker); session != sessions_.end()) {
      set_quarantine(session->second, odd->reason);
      note_quarantine(session->second);
    }
  } else if (const auto* sure = std::get_if<Confirmed>(&action)) {
    confirmed(*sure);
  } else if (const auto* record = std::get_if<Persist>(&action)) {
    persist(*record, delivery);
  } else if (const auto* open = std::get_if<OpenFrame>(&action)) {
    // The film takes memory only as units come in.
    for (const Action& next :
         scheduler_.handle(FrameOpened{open->job, open->frame}, std::chrono::steady_clock::now())) {
      act(next, delivery, later);
    }
  } else {
    later.push_back(action);
  }
}

void Controller::persist(const Persist& persist, Delivery* delivery) {
  if (const auto* odd = std::get_if<WorkerOddRecord>(&persist.record)) {
    return keep_divergent(persist.id, *odd);
  }
  const auto job = std::visit([](const auto& record) { return record.job; }, persist.record);
  ActiveJob* active = active_job(job);
  if (active == nullptr) return;
  if (const auto* unit = std::get_if<UnitRecord>(&persist.record)) {
    delivery->settled = true;
    active->films_under_way[persist.id] = std::move(delivery->rendered);
    film_store_of(*active).keep_delivered(persist.id, unit->accepted, std::move(delivery->film),
                                          std::move(delivery->record));
  } else if (const auto* done = std::get_if<FrameFinishedRecord>(&persist.record)) {
    film_store_of(*active).keep_finished(persist.id, done->frame);
  } else if (const auto* voided = std::get_if<TileVoidedRecord>(&persist.record)) {
    film_store_of(*active).void_tile(persist.id, voided->frame, voided->tile);
  } else if (const auto* dispute = std::get_if<DisputeRecord>(&persist.record)) {
    film_store_of(*active).keep_dispute(persist.id, dispute->open);
  } else if (const auto* again = std::get_if<FrameRestartedRecord>(&persist.record)) {
    background_.add(static_cast<uint64_t>(job), [this, job, id = persist.id, frame = again->frame] {
      const core::Status forgotten = store_->forget_frame(static_cast<uint64_t>(job), frame);
      const std::lock_guard lock(mutex_);
      ActiveJob* still = active_job(job);
      if (still == nullptr || still->ending) return true;
      if (forgotten) film_store_of(*still).begin_again(id, frame);
      return forgotten.ok();
    });
  } else if (const auto* failed = std::get_if<FrameFailedRecord>(&persist.record)) {
    const FrameNote& note = active->frames[failed->failed.frame];
    StoredFrame frame{failed->failed.frame, false, failed->failed.reason, note.worker_class,
                      note.restarts};
    background_.add(static_cast<uint64_t>(job), [this, job, id = persist.id, frame] {
      const core::Status stored = store_->frame_over(static_cast<uint64_t>(job), frame, {});
      const std::lock_guard lock(mutex_);
      ActiveJob* still = active_job(job);
      if (still == nullptr) return true;
      // Where it could not be stored the frame fails again after a restart, if it must.
      if (!stored) still->trouble = stored.error().message;
      film_store_of(*still).keep_failed(id);
      return true;
    });
  }
}

void Controller::send(WorkerId worker, v1::CoordinatorMessage message) {
  const auto session = sessions_.find(worker);
  if (session != sessions_.end() && session->second.link)
    session->second.link->send(std::move(message));
}

void Controller::send_lease(const Lease& lease) {
  const auto found = sessions_.find(lease.worker);
  ActiveJob* active = active_job(lease.job);
  if (found == sessions_.end() || active == nullptr) return;
  WorkerSession& session = found->second;
  if (session.spec_sent.insert(lease.job).second) {
    v1::CoordinatorMessage message;
    v1::JobBrief& brief = *message.mutable_job();
    brief.set_job(static_cast<uint64_t>(lease.job));
    *brief.mutable_spec() = active->spec;
    brief.set_key(farm::to_wire(active->key));
    send(lease.worker, std::move(message));
  }
  v1::CoordinatorMessage message;
  v1::Lease& wire = *message.mutable_lease();
  *wire.mutable_lease() = to_wire(lease.lease);
  wire.set_job(static_cast<uint64_t>(lease.job));
  for (const core::Unit& unit : lease.units) *wire.add_units() = farm::to_wire(unit);
  wire.set_adopted(lease.adopted);
  wire.set_deadline_ms(static_cast<uint64_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(options_.lease_time).count()));
  send(lease.worker, std::move(message));
  meters_->leased(lease.units.size(), lease.adopted);

  const int32_t number = lease.units.front().frame;
  FrameNote& frame = active->touch(number);
  if (frame.state == v1::FRAME_STATE_WAITING) {
    frame.state = v1::FRAME_STATE_RENDERING;
    frame.begun = moment_;
    note(*active, v1::LOG_LEVEL_INFO, number, session.hello.name(), "begun");
  }
  if (frame.worker_class.empty()) frame.worker_class = session.hello.worker_class();
}

void Controller::carry_out(const std::vector<Action>& actions) {
  for (const Action& action : actions) {
    if (const auto* merge = std::get_if<Merge>(&action)) {
      merged(merge->job, *merge);
    } else if (const auto* finish = std::get_if<FinishFrame>(&action)) {
      finish_frame(*finish);
    } else if (const auto* done = std::get_if<FrameDone>(&action)) {
      frame_done(done->job, done->frame);
    } else if (const auto* failed = std::get_if<FrameFailed>(&action)) {
      frame_failed(failed->job, failed->frame, failed->reason);
    } else if (const auto* again = std::get_if<FrameRestarted>(&action)) {
      frame_restarted(again->job, again->frame);
    } else if (const auto* voided = std::get_if<TileVoided>(&action)) {
      tile_voided(*voided);
    } else if (const auto* reopened = std::get_if<FrameReopened>(&action)) {
      frame_reopened(reopened->job, reopened->frame);
    } else if (const auto* ended = std::get_if<JobEnded>(&action)) {
      job_ended(*ended);
    }
  }
}

ActiveJob* Controller::active_job(JobId job) {
  const auto found = jobs_.find(job);
  return found == jobs_.end() ? nullptr : found->second.get();
}

void Controller::note(ActiveJob& active, v1::LogLevel level, std::optional<int32_t> frame,
                      const std::string& worker, const std::string& text, const core::Unit* unit) {
  active.note({wall_ms(), level, frame, worker, farm::wire_text(text)});
  // Of frames there are many: that they begin and end is for those who look for something.
  const farm::LogLevel said = level == v1::LOG_LEVEL_ERROR     ? farm::LogLevel::error
                              : level == v1::LOG_LEVEL_WARNING ? farm::LogLevel::warning
                              : frame                          ? farm::LogLevel::debug
                                                               : farm::LogLevel::info;
  if (!farm::logs(said)) return;
  farm::log_later(said, farm::wire_text(text),
                  {static_cast<uint64_t>(active.id), frame,
                   unit == nullptr ? std::string() : farm::unit_field(*unit), worker});
}

}  // namespace hyades::coordinator
