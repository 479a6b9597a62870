// What clients want of open jobs: a change that is stored before it is answered.
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller/controller.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr int kMostPriority = 1'000'000;
constexpr std::chrono::seconds kPatience{2};

}  // namespace

grpc::Status Controller::check_priority(int priority) {
  if (std::abs(int64_t{priority}) <= kMostPriority) return grpc::Status::OK;
  return {grpc::StatusCode::INVALID_ARGUMENT, "priority: expected -1000000 to 1000000"};
}

void Controller::pause(uint64_t id, JobReply then) { set_paused(id, true, std::move(then)); }

void Controller::resume(uint64_t id, JobReply then) { set_paused(id, false, std::move(then)); }

void Controller::set_paused(uint64_t id, bool paused, JobReply then) {
  change(id, std::move(then), [&](ActiveJob& active, std::vector<Action>& later) {
    const StoredState wanted = paused ? StoredState::paused : StoredState::running;
    if (active.stored.state == wanted) return;
    active.stored.state = wanted;
    note(active, v1::LOG_LEVEL_INFO, std::nullopt, {}, paused ? "paused" : "resumed");
    later = paused ? tell(JobPaused{active.id}) : tell(JobResumed{active.id});
  });
}

void Controller::set_priority(uint64_t id, int priority, JobReply then) {
  if (const grpc::Status sane = check_priority(priority); !sane.ok()) return then(sane, {});
  change(id, std::move(then), [&](ActiveJob& active, std::vector<Action>& later) {
    if (active.stored.priority == priority) return;
    active.stored.priority = priority;
    note(active, v1::LOG_LEVEL_INFO, std::nullopt, {}, fmt::format("priority {}", priority));
    later = tell(JobReprioritised{active.id, priority});
  });
}

/// Changes an open job; `then` is told once that is stored.
void Controller::change(uint64_t id, JobReply then,
                        const std::function<void(ActiveJob&, std::vector<Action>&)>& what) {
  std::vector<Action> later;
  bool open = false;
  {
    const std::lock_guard lock(mutex_);
    ActiveJob* active = active_job(id);
    open = active != nullptr && !active->ending;
    if (open) {
      what(*active, later);
      when_stored(id, then);
      store_row(*active);
    }
  }
  carry_out(later);
  if (stop_) mind_waiters({});
  if (!open) then(not_open(id), {});
}

void Controller::cancel(uint64_t id, JobReply then) {
  std::vector<Action> later;
  bool open = false;
  {
    const std::lock_guard lock(mutex_);
    ActiveJob* active = active_job(id);
    open = active != nullptr;
    if (open) {
      // The end is stored by the job's tasks; to answer is to promise.
      when_stored(id, then);
      if (active->making_videos) {
        cancel_videos(*active);
      } else {
        later = tell(JobCancelled{active->id});
      }
    }
  }
  carry_out(later);
  if (stop_) mind_waiters({});
  if (open) return;
  v1::Job now;
  const grpc::Status status = cancel_waiting(id, now);
  then(status, now);
}

/// A job that waits to be taken up ends without; any other is not_open(). Without the lock.
grpc::Status Controller::cancel_waiting(uint64_t id, v1::Job& now) {
  const auto waits = [&] {
    const std::lock_guard lock(mutex_);
    return waiting_jobs_.contains(id) && active_job(id) == nullptr;
  };
  if (!waits()) return not_open(id);
  // Nobody takes it up meanwhile.
  const std::unique_lock one(submit_mutex_, kPatience);
  auto stored = store_->job(id);
  if (!stored) return farm::unavailable(stored.error());
  if (!one || !waits() || !*stored || has_ended((*stored)->state)) {
    return farm::retry_later(grpc::StatusCode::UNAVAILABLE,
                             fmt::format("job {} is just being taken up", id),
                             std::chrono::seconds(1));
  }
  (*stored)->state = StoredState::cancelled;
  (*stored)->ended_ms = wall_ms();
  (*stored)->reason.clear();
  if (const core::Status done = store_->update_job(**stored); !done)
    return farm::unavailable(done.error());
  now = coordinator::describe(**stored);
  const std::lock_guard lock(mutex_);
  waiting_jobs_.erase(id);
  return grpc::Status::OK;
}

/// NOT_FOUND, or FAILED_PRECONDITION for a job that has ended; without the lock.
grpc::Status Controller::not_open(uint64_t id) {
  const auto stored = store_->job(id);
  if (!stored) return farm::unavailable(stored.error());
  if (!*stored) return {grpc::StatusCode::NOT_FOUND, fmt::format("there is no job {}", id)};
  if (!has_ended((*stored)->state)) {
    return farm::retry_later(
        grpc::StatusCode::UNAVAILABLE,
        fmt::format("job {} {}", id,
                    (*stored)->reason.empty() ? "is being taken up" : (*stored)->reason),
        std::chrono::seconds(1));
  }
  return {grpc::StatusCode::FAILED_PRECONDITION, fmt::format("job {} has ended", id)};
}

}  // namespace hyades::coordinator
