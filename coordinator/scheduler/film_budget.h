#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "coordinator/scheduler/scheduled_job.h"
#include "coordinator/scheduler/step.h"

namespace hyades::coordinator {

/// How much memory the films of all frames take that have begun and are not over [bytes], and how
/// much they may.
class FilmBudget {
 public:
  FilmBudget(uint64_t limit, Step& step) : limit_(limit), step_(step) {}

  /// The frame's film is in memory from now on, or will be with the first unit.
  void take(const ScheduledJob& job, FrameSlot& slot);
  /// The frame's film is gone, if there was one: there is room for another.
  void drop(const ScheduledJob& job, FrameSlot& slot);

  /// What all films take.
  uint64_t bytes() const { return bytes_; }
  /// Whether films of the job's owner take more than half of what all may.
  bool most_are_of(const ScheduledJob& job) const;
  /// Whether a film of the job fits beside those that are there.
  bool has_room(const ScheduledJob& job) const;

  /// Some frame gets no units, as its film does not fit.
  void refuse() { refused_ = true; }
  /// Whether that has happened since serve_refused().
  bool refused() const { return refused_; }
  /// There is more room, or nothing is in work any more: whoever waits for units is served again.
  void serve_refused();

 private:
  const uint64_t limit_;
  Step& step_;
  uint64_t bytes_ = 0;
  std::map<std::string, uint64_t> bytes_of_;  ///< by owner
  bool refused_ = false;
};

}  // namespace hyades::coordinator
