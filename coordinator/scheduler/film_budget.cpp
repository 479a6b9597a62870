#include "coordinator/scheduler/film_budget.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace hyades::coordinator {
namespace {

constexpr double kTurn = 60;                 ///< seconds
constexpr double kSetAsidePerSecond = 50e6;  ///< bytes, of a slow disk
/// Who waits for room asks again within so long.
constexpr Duration kStillWaits = std::chrono::seconds(5);

}  // namespace

void FilmBudget::take(const ScheduledJob& job, FrameSlot& slot) {
  slot.leaving = false;
  if (std::exchange(slot.film, true)) return;
  slot.film_since = step_.now;
  bytes_ += job.plan.film_bytes;
  if (largest_ != job.plan.owner) kept_out_.reset();
  if (yielded_ != job.plan.owner) yielded_.reset();
  if ((bytes_of_[job.plan.owner] += job.plan.film_bytes) > limit_ / 2) largest_ = job.plan.owner;
  holders_.emplace(job.id, job.index_of(slot));
}

void FilmBudget::drop(const ScheduledJob& job, FrameSlot& slot) {
  slot.leaving = false;
  if (!std::exchange(slot.film, false)) return;
  if (must_yield(job)) yielded_ = job.plan.owner;
  bytes_ -= job.plan.film_bytes;
  const auto own = bytes_of_.find(job.plan.owner);
  if (own != bytes_of_.end() && (own->second -= job.plan.film_bytes) == 0) bytes_of_.erase(own);
  if (largest_ == job.plan.owner && !most_are_of(job)) {
    largest_.reset();
    kept_out_.reset();
  }
  holders_.erase({job.id, job.index_of(slot)});
  serve_refused();
}

bool FilmBudget::most_are_of(const ScheduledJob& job) const {
  const auto own = bytes_of_.find(job.plan.owner);
  return own != bytes_of_.end() && own->second > limit_ / 2;
}

bool FilmBudget::must_yield(const ScheduledJob& job) const {
  if (!kept_out_ || largest_ != job.plan.owner) return false;
  // Nobody says that he waits no more.
  if (step_.now - refused_other_ > kStillWaits) return false;
  const auto bytes = static_cast<double>(bytes_of_.at(job.plan.owner));
  return seconds(step_.now - *kept_out_) >= kTurn + bytes / kSetAsidePerSecond;
}

bool FilmBudget::has_yielded(const ScheduledJob& job) const {
  return yielded_ == job.plan.owner && step_.now - refused_other_ <= kStillWaits;
}

bool FilmBudget::fits(const ScheduledJob& job, uint64_t limit) const {
  return job.plan.film_bytes <= limit - std::min(bytes_, limit);
}

void FilmBudget::refuse(const ScheduledJob& job) {
  refused_ = true;
  wanted_ = std::max(wanted_, job.plan.film_bytes);
  if (!largest_ || largest_ == job.plan.owner) return;
  refused_other_ = step_.now;
  if (!kept_out_) kept_out_ = step_.now;
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
