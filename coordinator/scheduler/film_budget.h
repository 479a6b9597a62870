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
  // Whose films take most keeps out what does not fit beside them. Of the others' jobs that wait
  // for room one is next: it is kept out for a minute, and then has its turn.

  /// Whether the job is next.
  bool is_next(const ScheduledJob& job) const { return waits() && next_->job == job.id; }
  /// Whether a film of the job, which fits now, leaves the room that the next one needs when the
  /// films that take most are gone.
  bool leaves_room(const ScheduledJob& job) const;
  /// Whether a film of the job that waits for room may hold up others: not where its owner's films
  /// take most, or have just made room.
  bool may_hold_up(const ScheduledJob& job) const { return !takes_most(job) && !has_yielded(job); }
  /// Whether the job's owner, whose films take most, has kept the next one out for so long that it
  /// is its turn: a minute where they take half of all room or more, longer the less they take, and
  /// as long again as it takes to set them aside.
  bool must_yield(const ScheduledJob& job) const;
  /// Whether the job's owner has just done so, and the next one has not begun yet.
  bool has_yielded(const ScheduledJob& job) const;
  /// Whether a film of the job that nobody has asked for may come into memory: it fits, and is not
  /// in the way of the next one.
  bool has_place(const ScheduledJob& job) const;
  /// Whether a film of the job fits beside those that are there.
  bool has_room(const ScheduledJob& job) const { return bytes_ == 0 || fits(job, limit_); }
  /// Whether it may begin where none of the others can be set aside.
  bool has_room_in_need(const ScheduledJob& job) const { return fits(job, limit_ + limit_ / 4); }

  /// A film of the job has room, but somebody has to take a unit first: it is next as long as that
  /// is asked for.
  void expect(const ScheduledJob& job);
  /// The job that is next, if there is one.
  std::optional<JobId> next() const { return next_ ? std::optional(next_->job) : std::nullopt; }
  /// The job waits no longer.
  void forget(JobId job);
  /// Some frame of the job gets no units, as its film does not fit.
  void refuse(const ScheduledJob& job);
  /// Whether that has happened since serve_refused().
  bool refused() const { return refused_; }
  /// How many bytes have to go until all fit that were refused, one at a time.
  uint64_t lacking() const;
  /// There is more room, or more may begin: whoever waits for units is served again.
  void serve_refused();

 private:
  /// The job, of another owner than him whose films take most, that gets the next turn.
  struct Next {
    JobId job{};
    std::string owner;
    uint64_t film_bytes = 0;
    TimePoint since;  ///< it is kept out
    TimePoint last;   ///< it was refused, or expected
  };

  bool fits(const ScheduledJob& job, uint64_t limit) const;
  bool takes_most(const ScheduledJob& job) const { return most_of_ == job.plan.owner; }
  uint64_t bytes_of_most() const;
  void find_most();
  bool waits() const;

  const uint64_t limit_;
  Step& step_;
  uint64_t bytes_ = 0;
  std::map<std::string, uint64_t> bytes_of_;  ///< by owner
  std::set<std::pair<JobId, uint32_t>> holders_;
  bool refused_ = false;
  uint64_t wanted_ = 0;                 ///< of the largest film that was refused
  std::optional<std::string> most_of_;  ///< the owner whose films take most
  std::optional<Next> next_;
  std::optional<std::string> yielded_;  ///< the owner who has made room for it
};

}  // namespace hyades::coordinator
