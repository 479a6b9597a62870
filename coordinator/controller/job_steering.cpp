#include "coordinator/controller/job_steering.h"

#include <chrono>
#include <cstdlib>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/frame_finisher.h"
#include "coordinator/controller/job_queries.h"
#include "coordinator/controller/not_found.h"
#include "coordinator/controller/video_maker.h"
#include "core/base/wall_clock.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr int kMostPriority = 1'000'000;

}  // namespace

grpc::Status check_priority(int priority) {
  if (std::abs(int64_t{priority}) <= kMostPriority) return grpc::Status::OK;
  return {grpc::StatusCode::INVALID_ARGUMENT, "priority: expected -1000000 to 1000000"};
}

void JobSteering::pause(uint64_t id, const std::string& by, JobReply then) {
  set_paused(id, true, by, std::move(then));
}

void JobSteering::resume(uint64_t id, const std::string& by, JobReply then) {
  set_paused(id, false, by, std::move(then));
}

/// Notes in the job's log what somebody has done.
void JobSteering::note(ActiveJob& active, const std::string& what, const std::string& by) {
  jobs_.note(active, v1::LOG_LEVEL_INFO, std::nullopt, {}, by.empty() ? what : what + " by " + by);
}

void JobSteering::note_watched(uint64_t id, int32_t frame) {
  Turn turn(dispatcher_);
  const ActiveJob* active = jobs_.find(id);
  if (active != nullptr && !active->ending) turn.tell(FrameWatched{active->id, frame});
}

void JobSteering::set_paused(uint64_t id, bool paused, const std::string& by, JobReply then) {
  change(id, std::move(then), [&](ActiveJob& active, Turn& turn) HYADES_REQUIRES(state_lock) {
    const StoredState wanted = paused ? StoredState::paused : StoredState::running;
    if (active.stored.state == wanted) return;
    active.stored.state = wanted;
    note(active, paused ? "paused" : "resumed", by);
    turn.tell(paused ? Event(JobPaused{active.id}) : Event(JobResumed{active.id}));
  });
}

void JobSteering::set_priority(uint64_t id, int priority, const std::string& by, JobReply then) {
  if (const grpc::Status sane = check_priority(priority); !sane.ok()) return then(sane, {});
  change(id, std::move(then), [&](ActiveJob& active, Turn& turn) HYADES_REQUIRES(state_lock) {
    if (active.stored.priority == priority) return;
    active.stored.priority = priority;
    note(active, fmt::format("priority changed to {}", priority), by);
    turn.tell(JobReprioritised{active.id, priority});
  });
}

/// Changes an open job; `then` is called once that is stored.
void JobSteering::change(uint64_t id, JobReply then,
                         const std::function<void(ActiveJob&, Turn&)>& what) {
  bool open = false;
  {
    Turn turn(dispatcher_);
    ActiveJob* active = jobs_.find(id);
    open = active != nullptr && !active->ending;
    if (open) {
      what(*active, turn);
      records_.when_stored(id, then);
      records_.store(*active);
    }
  }
  if (context_.stop) records_.answer_late({});
  if (!open) then(why_not_open(*context_.store, id), {});
}

void JobSteering::cancel(uint64_t id, const std::string& by, JobReply then) {
  bool open = false;
  {
    Turn turn(dispatcher_);
    ActiveJob* active = jobs_.find(id);
    open = active != nullptr;
    if (open) {
      // The end is stored by the job's tasks; to answer is to promise.
      records_.when_stored(id, then);
      if (!active->ending) note(*active, "cancelled", by);
      finisher_.cancel(active->id);
      if (active->making_videos) {
        videos_.cancel(*active);
      } else {
        turn.tell(JobCancelled{active->id});
      }
    }
  }
  if (context_.stop) records_.answer_late({});
  if (open) return;
  v1::Job now;
  const grpc::Status status = cancel_waiting(id, now);
  then(status, now);
}

/// A job that waits to be recovered ends without; any other is why_not_open().
grpc::Status JobSteering::cancel_waiting(uint64_t id, v1::Job& now) {
  const auto waits = [&] {
    const StateLock lock(context_.mutex);
    return jobs_.waiting().contains(id) && jobs_.find(id) == nullptr &&
           !jobs_.recovering().contains(id);
  };
  if (!waits()) return why_not_open(*context_.store, id);
  // Nobody begins to recover it meanwhile.
  const auto one = context_.wait_for_submissions();
  auto stored = context_.store->summary(id);
  if (!stored) return farm::unavailable(stored.error());
  if (!one || !waits() || !*stored || has_ended((*stored)->state)) {
    return being_recovered(id);
  }
  (*stored)->state = StoredState::cancelled;
  (*stored)->ended_ms = core::wall_ms();
  (*stored)->reason.clear();
  if (const core::Status done = context_.store->update_job(**stored); !done)
    return farm::unavailable(done.error());
  now = queries_.describe(**stored);
  const StateLock lock(context_.mutex);
  jobs_.no_longer_waits(id);
  return grpc::Status::OK;
}

grpc::Status being_recovered(uint64_t id) {
  return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                           fmt::format("job {} is just being opened again", id),
                           std::chrono::seconds(1));
}

grpc::Status why_not_open(JobStore& store, uint64_t id) {
  const auto stored = store.job(id);
  if (const grpc::Status there = job_is_there(id, stored); !there.ok()) return there;
  if (has_ended((*stored)->state)) {
    return {grpc::StatusCode::FAILED_PRECONDITION, fmt::format("job {} has ended", id)};
  }
  const std::string& reason = (*stored)->reason;
  if (reason.empty()) return being_recovered(id);
  // That was tried, and may not come to pass for days: whoever asks is told why, and waits for none
  // of it.
  return {grpc::StatusCode::FAILED_PRECONDITION, fmt::format("job {} {}", id, reason)};
}

}  // namespace hyades::coordinator
