#pragma once

#include <cstdint>

#include "coordinator/scheduler/scheduled_job.h"
#include "coordinator/scheduler/step.h"

namespace hyades::coordinator {

/// The memory of films: how much those of frames that have begun take.
class FilmBudget {
 public:
  FilmBudget(uint64_t limit, Step& step) : limit_(limit), step_(step) {}

  /// The frame's film is in memory from now on, or will be with the first unit.
  void take(const ScheduledJob& job, FrameSlot& slot);
  void drop(const ScheduledJob& job, FrameSlot& slot);

  uint64_t bytes() const { return bytes_; }
  /// Whether a film of the job fits beside those that are there.
  bool has_room(const ScheduledJob& job) const;

  /// A frame goes without units, as its film does not fit.
  void refuse() { refused_ = true; }
  bool refused() const { return refused_; }
  /// There is more room, or nothing is in work any more: those who were refused are served again.
  void serve_refused();

 private:
  const uint64_t limit_;
  Step& step_;
  uint64_t bytes_ = 0;
  bool refused_ = false;
};

}  // namespace hyades::coordinator
