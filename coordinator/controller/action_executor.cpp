#include "coordinator/controller/action_executor.h"

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "coordinator/controller/divergent_workers.h"
#include "coordinator/controller/frame_progress.h"
#include "coordinator/controller/job_films.h"
#include "coordinator/controller/job_records.h"
#include "coordinator/controller/to_wire.h"
#include "coordinator/controller/video_maker.h"
#include "coordinator/controller/worker_sessions.h"
#include "coordinator/meters/meters.h"
#include "core/base/overloaded.h"

namespace hyades::coordinator {
namespace {

constexpr uint32_t kRetryAfterMs = 1000;

}  // namespace

void ActionExecutor::act(const std::vector<Action>& actions, Turn& turn, Delivery* delivery) {
  for (const Action& action : actions) {
    std::visit(
        core::Overloaded{
            [&](const OpenFrame& open) HYADES_REQUIRES(state_lock) {
              // The film takes memory only as units come in.
              turn.tell(FrameOpened{open.job, open.frame}, delivery);
            },
            [&](const SetAside& aside)
                HYADES_REQUIRES(state_lock) { films_.set_aside(aside, turn); },
            [&](const Lease& lease) HYADES_REQUIRES(state_lock) { sessions_.send_lease(lease); },
            [&](const Revoke& revoke) HYADES_REQUIRES(state_lock) { send(revoke); },
            [&](const Persist& persist)
                HYADES_REQUIRES(state_lock) { films_.persist(persist, delivery); },
            [&](const TileSpared& spared) HYADES_REQUIRES(state_lock) {
              if (ActiveJob* active = jobs_.find(spared.job)) frames_.spare(*active, spared);
            },
            [&](const Acknowledge& taken) HYADES_REQUIRES(state_lock) { send(taken, delivery); },
            [&](const Reject& reject) HYADES_REQUIRES(state_lock) { send(reject, delivery); },
            [&](const Conflict& conflict) HYADES_REQUIRES(state_lock) { note(conflict); },
            [&](const Quarantine& divergent) HYADES_REQUIRES(state_lock) {
              if (WorkerSession* session = workers_.find(divergent.worker)) {
                workers_.set_quarantine(*session, divergent.reason);
              }
            },
            // Before the leases that an open frame brings.
            [&](const FrameRestarted& again) HYADES_REQUIRES(state_lock) {
              if (ActiveJob* active = jobs_.find(again.job)) frames_.restarted(*active, again);
            },
            [&](const Confirmed& sure) HYADES_REQUIRES(state_lock) { divergent_.confirmed(sure); },
            [&](const Merge& merge) { turn.defer(merge); },
            [&](const JudgeTile& judge) HYADES_REQUIRES(state_lock) {
              if (ActiveJob* active = jobs_.find(judge.job)) frames_.judge(*active, judge);
            },
            [&](const TileVoided& voided) { turn.defer(voided); },
            [&](const FrameReopened& reopened) { turn.defer(reopened); },
            [&](const FinishFrame& finish) { turn.defer(finish); },
            [&](const FrameDone& done) { turn.defer(done); },
            [&](const FrameFailed& failed) { turn.defer(failed); },
            [&](const JobEnded& ended) { turn.defer(ended); },
        },
        action);
  }
  note_expired(actions);
}

void ActionExecutor::carry_out(const DeferredAction& action) {
  std::visit(core::Overloaded{
                 [&](const Merge& merge) { frames_.merged(merge); },
                 [&](const TileVoided& voided) { with_job(voided, &FrameProgress::tile_voided); },
                 [&](const FrameReopened& again) { with_job(again, &FrameProgress::reopened); },
                 [&](const FinishFrame& finish) { with_job(finish, &FrameProgress::finish); },
                 [&](const FrameDone& done) { with_job(done, &FrameProgress::done); },
                 [&](const FrameFailed& failed) { with_job(failed, &FrameProgress::failed); },
                 [&](const JobEnded& ended) { end(ended); },
             },
             action);
}

template <class FrameAction>
void ActionExecutor::with_job(const FrameAction& action,
                              void (FrameProgress::*what)(ActiveJob&, const FrameAction&)) {
  const StateLock lock(context_.mutex);
  if (ActiveJob* active = jobs_.find(action.job)) (frames_.*what)(*active, action);
}

void ActionExecutor::send(const Acknowledge& taken, Delivery* delivery) {
  v1::CoordinatorMessage message;
  *message.mutable_acknowledge()->mutable_unit() = to_wire(taken.lease, taken.job, taken.unit);
  workers_.send(taken.worker, message);
  // Of a film that needs not be stored: it is there already.
  if (delivery != nullptr && !std::exchange(delivery->settled, true)) {
    context_.meters->result("duplicate");
  }
}

void ActionExecutor::send(const Revoke& revoke) {
  v1::CoordinatorMessage message;
  *message.mutable_stop()->mutable_unit() = to_wire(revoke.lease, revoke.job, revoke.unit);
  workers_.send(revoke.worker, message);
  context_.meters->lost(revoke.expired ? "expired" : "revoked");
}

void ActionExecutor::send(const Reject& reject, Delivery* delivery) {
  v1::CoordinatorMessage message;
  v1::Rejected& rejected = *message.mutable_rejected();
  *rejected.mutable_unit() = to_wire(reject.lease, reject.job, reject.unit);
  rejected.set_reason(to_wire(reject.reason));
  if (reject.reason == RejectReason::not_now) rejected.set_retry_after_ms(kRetryAfterMs);
  workers_.send(reject.worker, message);
  context_.meters->result(verdict_of(rejected.reason()));
  if (delivery != nullptr) delivery->settled = true;
}

void ActionExecutor::note(const Conflict& conflict) {
  ActiveJob* active = jobs_.find(conflict.job);
  if (active == nullptr) return;
  const core::Unit& unit = conflict.unit;
  jobs_.note(
      *active, v1::LOG_LEVEL_ERROR, unit.frame, {},
      fmt::format("workers {} and {} rendered tile {},{} batches {}-{} to different bits",
                  static_cast<uint64_t>(conflict.first), static_cast<uint64_t>(conflict.second),
                  unit.tile.x0, unit.tile.y0, unit.batches.first, unit.batches.end() - 1),
      &unit);
}

/// Leases that ran out, in the jobs' logs: a line per worker and job.
void ActionExecutor::note_expired(const std::vector<Action>& actions) {
  std::map<WorkerId, std::vector<UnitInHand>> lost;
  for (const Action& action : actions) {
    const auto* revoke = std::get_if<Revoke>(&action);
    if (revoke == nullptr || !revoke->expired) continue;
    lost[revoke->worker].push_back({revoke->lease, revoke->job, revoke->unit});
  }
  for (const auto& [worker, units] : lost) {
    if (const WorkerSession* session = workers_.find(worker)) {
      workers_.note_losses(*session, units, "did not renew its leases in time");
    }
  }
}

/// All frames of the job are over: its videos are made, or it ends.
void ActionExecutor::end(const JobEnded& ended) {
  const StateLock lock(context_.mutex);
  ActiveJob* active = jobs_.find(ended.job);
  if (active == nullptr || active->ending) return;
  sessions_.send_over(ended.job);
  active->stored.frames_done = ended.done;
  active->stored.frames_failed = ended.failed;
  if (active->leaves_out_videos) {
    jobs_.note(*active, v1::LOG_LEVEL_INFO, std::nullopt, {},
               "no video is made of some of the job's frames: 'fetch' brings their pictures, "
               "'hyades video' makes one of them");
  }
  if (!ended.cancelled && ended.failed == 0 && !active->videos.empty()) {
    videos_.begin(*active);
  } else {
    records_.end(*active, ended.cancelled, {});
  }
}

}  // namespace hyades::coordinator
