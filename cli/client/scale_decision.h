#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hyades::cli {

/// What is left of a job that counts.
struct ScaleJob {
  std::optional<double> core_seconds;  ///< of one thread; nothing where none of it was rendered yet
  double seconds_left = 0;             ///< until it shall be done; 0 and less: it is late
  uint32_t max_workers = 0;            ///< that may render it at once; 0: any number
};

/// What is there, and what is allowed.
struct ScaleState {
  std::vector<ScaleJob> jobs;     ///< those that run; paused ones do not count
  double threads_per_worker = 1;  ///< at least 1
  uint32_t least = 0;             ///< workers
  uint32_t most = 1;
  double interval = 60;         ///< s until the next decision
  std::optional<double> price;  ///< of a worker and hour; nothing: money does not count
  double money_left = 0;        ///< in the same currency
};

/// How many workers there shall be, and why, for people.
struct ScaleDecision {
  uint32_t wanted = 0;
  std::string why;
};

/// How many workers the work needs, whatever they cost. They start as late as the deadlines allow,
/// and no sooner: for each deadline as many as the work that is due by then takes, no more of each
/// job than may render it at once, and of these numbers the largest. A worker is not worth its
/// start for less than a minute of work; a job that nobody has begun gets one worker, which
/// measures it.
ScaleDecision decide_scale(const ScaleState& state);

/// Follows decisions upwards at once, and downwards only when they were lower for long enough: to
/// the most that was wanted meanwhile.
class ScaleDamper {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;
  explicit ScaleDamper(Duration delay) : delay_(delay) {}
  uint32_t follow(uint32_t wanted, TimePoint now);

 private:
  const Duration delay_;
  std::vector<std::pair<TimePoint, uint32_t>> lately_;
};

/// Decisions that follow each other: what the work needs, sent home late, and never more than what
/// is left of the money pays until the next decision; beyond it there are only the `least`.
class ScalePlan {
 public:
  explicit ScalePlan(ScaleDamper::Duration down_after) : damper_(down_after) {}
  ScaleDecision next(const ScaleState& state, ScaleDamper::TimePoint now);

 private:
  ScaleDamper damper_;
};

}  // namespace hyades::cli
