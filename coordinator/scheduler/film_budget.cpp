#include "coordinator/scheduler/film_budget.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace hyades::coordinator {
namespace {

/// Of whoever has half of the room [seconds].
constexpr double kTurn = 60;
constexpr double kSetAsidePerSecond = 50e6;  ///< bytes, of a slow disk
/// Who waits for room is come to again within so long, also where there is one worker, which stays
/// with what it has, and others are before him in line.
constexpr Duration kStillWaits = std::chrono::seconds(120);

}  // namespace

void FilmBudget::take(const ScheduledJob& job, FrameSlot& slot) {
  slot.leaving = false;
  if (std::exchange(slot.film, true)) return;
  slot.film_since = step_.now;
  bytes_ += job.plan.film_bytes;
  bytes_of_[job.plan.owner] += job.plan.film_bytes;
  find_most();
  forget(job.id);
  holders_.emplace(job.id, job.index_of(slot));
}

void FilmBudget::drop(const ScheduledJob& job, FrameSlot& slot) {
  slot.leaving = false;
  if (!std::exchange(slot.film, false)) return;
  if (must_yield(job)) yielded_ = job.plan.owner;
  bytes_ -= job.plan.film_bytes;
  const auto own = bytes_of_.find(job.plan.owner);
  if (own != bytes_of_.end() && (own->second -= job.plan.film_bytes) == 0) bytes_of_.erase(own);
  find_most();
  holders_.erase({job.id, job.index_of(slot)});
  serve_refused();
}

void FilmBudget::forget(JobId job) {
  if (!next_ || next_->job != job) return;
  next_.reset();
  yielded_.reset();
}

void FilmBudget::find_most() {
  most_of_.reset();
  uint64_t most = 0;
  for (const auto& [owner, bytes] : bytes_of_) {
    if (bytes <= most) continue;
    most = bytes;
    most_of_ = owner;
  }
}

uint64_t FilmBudget::bytes_of_most() const { return most_of_ ? bytes_of_.at(*most_of_) : 0; }

/// Not all say when they wait no more: a frame may have failed.
bool FilmBudget::waits() const { return next_ && step_.now - next_->last <= kStillWaits; }

bool FilmBudget::must_yield(const ScheduledJob& job) const {
  if (!waits() || !takes_most(job) || next_->owner == job.plan.owner) return false;
  const auto bytes = static_cast<double>(std::max<uint64_t>(bytes_of_most(), 1));
  const double half = 0.5 * static_cast<double>(limit_);
  return seconds(step_.now - next_->since) >=
         kTurn * std::max(1.0, half / bytes) + bytes / kSetAsidePerSecond;
}

bool FilmBudget::has_yielded(const ScheduledJob& job) const {
  return yielded_ == job.plan.owner && waits();
}

bool FilmBudget::leaves_room(const ScheduledJob& job) const {
  if (!waits() || takes_most(job)) return false;
  const uint64_t others = bytes_ - bytes_of_most();
  return others + next_->film_bytes + job.plan.film_bytes <= limit_;
}

bool FilmBudget::has_place(const ScheduledJob& job) const {
  if (!has_room(job) || has_yielded(job)) return false;
  return !waits() || is_next(job) || leaves_room(job);
}

bool FilmBudget::fits(const ScheduledJob& job, uint64_t limit) const {
  return job.plan.film_bytes <= limit - std::min(bytes_, limit);
}

void FilmBudget::expect(const ScheduledJob& job) {
  if (next_ && next_->job == job.id) next_->last = step_.now;
}

void FilmBudget::refuse(const ScheduledJob& job) {
  refused_ = true;
  wanted_ = std::max(wanted_, job.plan.film_bytes);
  if (takes_most(job)) return;
  if (!waits()) next_ = Next{job.id, job.plan.owner, job.plan.film_bytes, step_.now, step_.now};
  if (next_->job == job.id) next_->last = step_.now;
}

uint64_t FilmBudget::lacking() const {
  const uint64_t room = limit_ - std::min(bytes_, limit_);
  const uint64_t over = bytes_ - std::min(bytes_, limit_);
  return over + wanted_ - std::min(wanted_, room);
}

void FilmBudget::serve_refused() {
  wanted_ = 0;
  if (std::exchange(refused_, false)) step_.work_appeared = true;
}

}  // namespace hyades::coordinator
