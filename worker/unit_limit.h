#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "worker/running_time.h"

namespace hyades::worker {

/// Ends units that take too long, however well they get on: a scene may be made to take for ever.
/// A unit's time begins when the rendering child begins with it, be it with loading its scene, and
/// is counted as RunningTime has it. No clock of its own.
class UnitLimit {
 public:
  using TimePoint = RunningTime::TimePoint;
  using Duration = RunningTime::Duration;

  /// What has to be done because of units that have had their time.
  struct Overdue {
    std::vector<uint64_t> tokens;  ///< they have failed, and are to be stopped; said once each
    /// The child has to be killed: it loads the scene of one of them, in which it cannot be
    /// stopped, or one was to stop and has not answered within kStopping.
    bool stuck = false;
  };

  /// How long a child may take to stop a unit.
  static constexpr std::chrono::seconds kStopping{10};

  /// `limit`: for one unit; 0: none.
  explicit UnitLimit(Duration limit) : limit_(limit) {}

  /// The child has begun to load the unit's scene, or (then or later) to render it.
  void begun(uint64_t token, bool loading);
  /// The child has answered for it.
  void answered(uint64_t token) { tasks_.erase(token); }
  void child_gone() { tasks_.clear(); }

  Overdue tick(TimePoint now);

  /// Why a unit has failed: "took longer than 30 min 00 s (--unit-time-limit of ...".
  std::string reason() const;

 private:
  struct Task {
    Duration begun{0};
    bool loading = false;
    std::optional<Duration> told{};  ///< when it was said to be overdue
  };

  const Duration limit_;
  RunningTime time_;
  std::map<uint64_t, Task> tasks_;  ///< by token
};

}  // namespace hyades::worker
