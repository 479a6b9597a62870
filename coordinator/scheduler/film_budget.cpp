#include "coordinator/scheduler/film_budget.h"

#include <algorithm>
#include <utility>

namespace hyades::coordinator {

void FilmBudget::take(const ScheduledJob& job, FrameSlot& slot) {
  slot.leaving = false;
  if (std::exchange(slot.film, true)) return;
  slot.film_since = step_.now;
  bytes_ += job.plan.film_bytes;
  bytes_of_[job.plan.owner] += job.plan.film_bytes;
  holders_.emplace(job.id, job.index_of(slot));
}

void FilmBudget::drop(const ScheduledJob& job, FrameSlot& slot) {
  slot.leaving = false;
  if (!std::exchange(slot.film, false)) return;
  bytes_ -= job.plan.film_bytes;
  const auto own = bytes_of_.find(job.plan.owner);
  if (own != bytes_of_.end() && (own->second -= job.plan.film_bytes) == 0) bytes_of_.erase(own);
  holders_.erase({job.id, job.index_of(slot)});
  serve_refused();
}

bool FilmBudget::most_are_of(const ScheduledJob& job) const {
  const auto own = bytes_of_.find(job.plan.owner);
  return own != bytes_of_.end() && own->second > limit_ / 2;
}

bool FilmBudget::fits(const ScheduledJob& job, uint64_t limit) const {
  return job.plan.film_bytes <= limit - std::min(bytes_, limit);
}

void FilmBudget::refuse(const ScheduledJob& job) {
  refused_ = true;
  wanted_ = std::max(wanted_, job.plan.film_bytes);
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
