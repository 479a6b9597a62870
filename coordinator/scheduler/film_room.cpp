// Films in memory: which frames may begin.
#include <algorithm>
#include <utility>

#include "coordinator/scheduler/scheduler.h"

namespace hyades::coordinator {

/// The frame's film is in memory from now on, or will be with the first unit.
void Scheduler::take_film(const JobState& job, FrameSlot& slot) {
  if (!std::exchange(slot.film, true)) films_ += job.plan.film_bytes;
}

void Scheduler::drop_film(const JobState& job, FrameSlot& slot) {
  if (!std::exchange(slot.film, false)) return;
  films_ -= job.plan.film_bytes;
  serve_those_without_film();
}

/// Whether the frame has a film, or it fits beside those of other frames; or nothing gets on with
/// those any more, so that they hold nobody up for ever: their jobs are paused, or have no workers.
bool Scheduler::film_fits(const JobState& job, const FrameSlot& slot) const {
  const uint64_t room = options_.film_memory - std::min(films_, options_.film_memory);
  if (slot.film || job.plan.film_bytes <= room || !any_film_in_work()) return true;
  film_refused_ = true;
  return false;
}

/// Whether a unit is out, a film is on its way to the disk, or a frame is being finished: there
/// will be room, or something else will be out.
bool Scheduler::any_film_in_work() const {
  if (!leases_.empty() || !pending_.empty()) return true;
  return std::any_of(jobs_.begin(), jobs_.end(), [](const auto& entry) {
    const JobState& job = *entry.second;
    return std::any_of(job.in_flight.begin(), job.in_flight.end(), [&](uint32_t i) {
      const FrameSlot& slot = job.slots[i];
      return slot.film && (slot.over() || slot.phase == FramePhase::finishing);
    });
  });
}

/// There is more room, or nothing is in work any more.
void Scheduler::serve_those_without_film() {
  if (std::exchange(film_refused_, false)) work_appeared_ = true;
}

bool Scheduler::waits_for_film(JobId id) const {
  const auto found = jobs_.find(id);
  if (found == jobs_.end() || found->second->paused) return false;
  const JobState& job = *found->second;
  return std::any_of(job.in_flight.begin(), job.in_flight.end(), [&](uint32_t i) {
    const FrameSlot& slot = job.slots[i];
    return slot.phase == FramePhase::rendering && !film_fits(job, slot);
  });
}

}  // namespace hyades::coordinator
