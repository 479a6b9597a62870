// What clients want of open jobs: a change that is stored before it is answered.
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "coordinator/brain/brain.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr int kMostPriority = 1'000'000;
constexpr std::chrono::seconds kPatience{2};

}  // namespace

grpc::Status Brain::check_priority(int priority) {
  if (std::abs(int64_t{priority}) <= kMostPriority) return grpc::Status::OK;
  return {grpc::StatusCode::INVALID_ARGUMENT, "priority: expected -1000000 to 1000000"};
}

void Brain::pause(uint64_t id, Told then) { set_paused(id, true, std::move(then)); }

void Brain::resume(uint64_t id, Told then) { set_paused(id, false, std::move(then)); }

void Brain::set_paused(uint64_t id, bool paused, Told then) {
  change(id, std::move(then), [&](JobDesk& desk, std::vector<Action>& later) {
    const StoredState wanted = paused ? StoredState::paused : StoredState::running;
    if (desk.stored.state == wanted) return;
    desk.stored.state = wanted;
    note(desk, v1::LOG_LEVEL_INFO, std::nullopt, {}, paused ? "paused" : "resumed");
    later = paused ? tell(JobPaused{desk.id}) : tell(JobResumed{desk.id});
  });
}

void Brain::set_priority(uint64_t id, int priority, Told then) {
  if (const grpc::Status sane = check_priority(priority); !sane.ok()) return then(sane, {});
  change(id, std::move(then), [&](JobDesk& desk, std::vector<Action>& later) {
    if (desk.stored.priority == priority) return;
    desk.stored.priority = priority;
    note(desk, v1::LOG_LEVEL_INFO, std::nullopt, {}, fmt::format("priority {}", priority));
    later = tell(JobReprioritised{desk.id, priority});
  });
}

/// Changes an open job; `then` is told once that is stored.
void Brain::change(uint64_t id, Told then,
                   const std::function<void(JobDesk&, std::vector<Action>&)>& what) {
  std::vector<Action> later;
  bool open = false;
  {
    const std::lock_guard lock(mutex_);
    JobDesk* desk = desk_of(id);
    open = desk != nullptr && !desk->ending;
    if (open) {
      what(*desk, later);
      when_stored(id, then);
      store_row(*desk);
    }
  }
  carry_out(later);
  if (stop_) mind_waiters({});
  if (!open) then(not_open(id), {});
}

void Brain::cancel(uint64_t id, Told then) {
  std::vector<Action> later;
  bool open = false;
  {
    const std::lock_guard lock(mutex_);
    JobDesk* desk = desk_of(id);
    open = desk != nullptr;
    if (open) {
      // The end is stored by the job's chores; to answer is to promise.
      when_stored(id, then);
      if (desk->filming) {
        cancel_filming(*desk);
      } else {
        later = tell(JobCancelled{desk->id});
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
grpc::Status Brain::cancel_waiting(uint64_t id, v1::Job& now) {
  const auto waits = [&] {
    const std::lock_guard lock(mutex_);
    return waiting_jobs_.contains(id) && desk_of(id) == nullptr;
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
grpc::Status Brain::not_open(uint64_t id) {
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
