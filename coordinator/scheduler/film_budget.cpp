#include "coordinator/scheduler/film_budget.h"

#include <algorithm>
#include <utility>

namespace hyades::coordinator {

void FilmBudget::take(const ScheduledJob& job, FrameSlot& slot) {
  if (std::exchange(slot.film, true)) return;
  bytes_ += job.plan.film_bytes;
  bytes_of_[job.plan.owner] += job.plan.film_bytes;
}

void FilmBudget::drop(const ScheduledJob& job, FrameSlot& slot) {
  if (!std::exchange(slot.film, false)) return;
  bytes_ -= job.plan.film_bytes;
  const auto own = bytes_of_.find(job.plan.owner);
  if (own != bytes_of_.end() && (own->second -= job.plan.film_bytes) == 0) bytes_of_.erase(own);
  serve_refused();
}

bool FilmBudget::most_are_of(const ScheduledJob& job) const {
  const auto own = bytes_of_.find(job.plan.owner);
  return own != bytes_of_.end() && own->second > limit_ / 2;
}

bool FilmBudget::has_room(const ScheduledJob& job) const {
  return job.plan.film_bytes <= limit_ - std::min(bytes_, limit_);
}

void FilmBudget::serve_refused() {
  if (std::exchange(refused_, false)) step_.work_appeared = true;
}

}  // namespace hyades::coordinator
