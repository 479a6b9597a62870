#include "coordinator/scheduler/film_budget.h"

#include <algorithm>
#include <utility>

namespace hyades::coordinator {

void FilmBudget::take(const ScheduledJob& job, FrameSlot& slot) {
  if (!std::exchange(slot.film, true)) bytes_ += job.plan.film_bytes;
}

void FilmBudget::drop(const ScheduledJob& job, FrameSlot& slot) {
  if (!std::exchange(slot.film, false)) return;
  bytes_ -= job.plan.film_bytes;
  serve_refused();
}

bool FilmBudget::has_room(const ScheduledJob& job) const {
  return job.plan.film_bytes <= limit_ - std::min(bytes_, limit_);
}

void FilmBudget::serve_refused() {
  if (std::exchange(refused_, false)) step_.work_appeared = true;
}

}  // namespace hyades::coordinator
