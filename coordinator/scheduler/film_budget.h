#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "coordinator/scheduler/scheduled_job.h"
#include "coordinator/scheduler/step.h"

namespace hyades::coordinator {

/// How much memory the films of all frames take that have begun, are not over and not set aside
/// [bytes], and how much they may.
class FilmBudget {
 public:
  FilmBudget(uint64_t limit, Step& step) : limit_(limit), step_(step) {}

  /// The frame's film is in memory from now on, or will be with the first unit.
  void take(const ScheduledJob& job, FrameSlot& slot);
  /// The frame's film is gone from memory, if there was one: there is room for another.
  void drop(const ScheduledJob& job, FrameSlot& slot);

  /// What all films take.
  uint64_t bytes() const { return bytes_; }
  /// The frames whose films these are, by job and slot.
  const std::set<std::pair<JobId, uint32_t>>& holders() const { return holders_; }
  /// Whether films of the job's owner take more than half of what all may.
  bool most_are_of(const ScheduledJob& job) const;
  /// Whether the job's owner, who has more than half, has kept films of others out for so long that
  /// it is their turn: a minute, and as long again as it takes to set the own ones aside.
  bool must_yield(const ScheduledJob& job) const;
  /// Whether the job's owner has just done so, and those others have not begun yet.
  bool has_yielded(const ScheduledJob& job) const;
  /// Whether a film of the job fits beside those that are there.
  bool has_room(const ScheduledJob& job) const { return bytes_ == 0 || fits(job, limit_); }
  /// Whether it may begin where none of the others can be set aside.
  bool has_room_in_need(const ScheduledJob& job) const { return fits(job, limit_ + limit_ / 4); }

  /// Some frame of the job gets no units, as its film does not fit.
  void refuse(const ScheduledJob& job);
  /// Whether that has happened since serve_refused().
  bool refused() const { return refused_; }
  /// How many bytes have to go until all fit that were refused, one at a time.
  uint64_t lacking() const;
  /// There is more room, or more may begin: whoever waits for units is served again.
  void serve_refused();

 private:
  bool fits(const ScheduledJob& job, uint64_t limit) const;

  const uint64_t limit_;
  Step& step_;
  uint64_t bytes_ = 0;
  std::map<std::string, uint64_t> bytes_of_;  ///< by owner
  std::set<std::pair<JobId, uint32_t>> holders_;
  bool refused_ = false;
  uint64_t wanted_ = 0;                 ///< of the largest film that was refused
  std::optional<std::string> largest_;  ///< the owner who has more than half
  std::optional<TimePoint> kept_out_;   ///< since when no film of others has had room beside his
  TimePoint refused_other_;             ///< when that was so for the last time
  std::optional<std::string> yielded_;  ///< the owner who has made room for others
};

}  // namespace hyades::coordinator
