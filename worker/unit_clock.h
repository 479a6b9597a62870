#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace hyades::worker {

/// Times the units that the rendering child has. It notices a child that hangs without dying: a
/// unit of which no sample gets done, a scene whose loading does not end, a child that says nothing
/// at all (it was stopped, or never gets ready) or begins nothing. And it ends units that take too
/// long, however well they get on: a scene may be made to take for ever.
///
/// No clock of its own: it knows what time it is from tick(). Only time in which this process ran
/// counts: while the machine slept, or the person had pressed Ctrl-Z, the child did not get on
/// either.
class UnitClock {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// What is wrong with a child that hangs and has to be killed.
  struct Hang {
    std::set<uint64_t> tokens;  ///< the units that are to blame: those that it hangs in
    std::string reason;         ///< completes "the process that renders ..."
  };

  /// What has to be done because of units that have had their time.
  struct Overdue {
    std::vector<uint64_t> tokens;  ///< they have failed, and are to be stopped; said once each
    /// The child has to be killed: it loads the scene of one of them, in which it cannot be
    /// stopped, or one was to stop and has not answered within kStopping.
    bool stuck = false;
  };

  /// `hang_limit`: how long a unit may be without a new sample. A unit of a job that was seen to
  /// take long from one sample to the next has kSlack times that; the loading of a scene has
  /// kLoading times the limit. `unit_limit`: how long a unit may take from the moment that the
  /// child begins with it, be it with loading its scene. 0: for ever.
  UnitClock(Duration hang_limit, Duration unit_limit)
      : hang_limit_(hang_limit), unit_limit_(unit_limit) {}

  static constexpr int kSlack = 20;
  static constexpr int kLoading = 30;
  /// How long a child may take to stop a unit.
  static constexpr std::chrono::seconds kStopping{10};

  /// A new child, which has to say that it is ready.
  void child_started();
  void child_gone();
  /// The child has said anything, be it Ready.
  void heard();

  /// The child was given a unit of a job.
  void given(uint64_t token, uint64_t job);
  /// The child has begun to load the unit's scene, or (then or later) to render it.
  void begun(uint64_t token, bool loading);
  /// So many samples of it are done.
  void progress(uint64_t token, uint64_t samples);
  /// The child has answered for it: a film, a failure, or it was stopped. Until then a unit that
  /// nobody wants any more is timed too, for it occupies a thread.
  void answered(uint64_t token) { units_.erase(token); }

  /// To be told often what time it is; two ticks are never taken for more than a second apart.
  void tick(TimePoint now);
  /// The units whose time was up at the last tick.
  Overdue overdue();
  /// Whether the child hung at the last tick; said once, and the child counts as gone then.
  std::optional<Hang> hang();

  /// Why an overdue unit has failed: "took longer than 30 min 00 s (--unit-time-limit of ...".
  std::string overdue_reason() const;

 private:
  enum class Phase : uint8_t { queued, loading, rendering };
  /// Times are by time_.
  struct Unit {
    uint64_t job = 0;
    Phase phase = Phase::queued;
    uint64_t samples = 0;
    Duration moved{0};                        ///< when it last got further
    std::optional<Duration> begun{};          ///< when its time began
    std::optional<Duration> overdue_since{};  ///< when it was said to be overdue
  };

  Duration patience_with(const Unit& unit) const;

  const Duration hang_limit_;
  const Duration unit_limit_;
  Duration time_{0};  ///< that has passed since the first tick
  std::optional<TimePoint> ticked_;
  bool awaited_ = false;  ///< a child was started that is not ready yet
  Duration heard_{0};
  Duration busy_{0};                    ///< when the child last was in a unit, or had none
  std::map<uint64_t, Unit> units_;      ///< by token
  std::map<uint64_t, Duration> steps_;  ///< by job: the longest time between samples so far
};

}  // namespace hyades::worker
