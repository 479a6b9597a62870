#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "worker/running_time.h"

namespace hyades::worker {

/// Notices a rendering child that hangs without dying: a unit of which no sample gets done, a scene
/// whose loading does not end, a child that says nothing at all (it was stopped, or never gets
/// ready) or begins nothing. No clock of its own: it knows what time it is from tick(), and
/// counts it as RunningTime has it.
class RenderWatch {
 public:
  using TimePoint = RunningTime::TimePoint;
  using Duration = RunningTime::Duration;

  /// What is wrong with the child, which has to be killed.
  struct Hang {
    std::set<uint64_t> tokens;  ///< the units that are to blame: those that it hangs in
    std::string reason;         ///< completes "the process that renders ..."
  };

  /// `limit`: how long a unit may be without a new sample; 0: for ever. A unit of a job that was
  /// seen to take long from one sample to the next has kSlack times that; the loading of a scene
  /// has kLoading times the limit.
  explicit RenderWatch(Duration limit) : limit_(limit) {}

  static constexpr int kSlack = 20;
  static constexpr int kLoading = 30;

  /// A new child, which has to say that it is ready.
  void child_started();
  void child_gone();
  /// The child has said anything, be it Ready.
  void heard();

  /// The child was given a unit of a job.
  void told(uint64_t token, uint64_t job);
  bool knows(uint64_t token) const { return tasks_.contains(token); }
  void loading(uint64_t token);
  void rendering(uint64_t token);
  /// So many samples of it are done.
  void progress(uint64_t token, uint64_t samples);
  /// The child has answered for it: a film, a failure, or it was stopped. Until then a unit that
  /// nobody wants any more is watched too, for it occupies a thread.
  void answered(uint64_t token);

  /// Time passes. What is returned is said once; the child counts as gone then.
  std::optional<Hang> tick(TimePoint now);

 private:
  enum class Phase : uint8_t { queued, loading, rendering };
  struct Task {
    uint64_t job = 0;
    Phase phase = Phase::queued;
    uint64_t samples = 0;
    Duration moved{0};  ///< when it last got further, by clock_
  };

  void begin(uint64_t token, Phase phase);
  Duration patience_with(const Task& task) const;

  const Duration limit_;
  RunningTime clock_;
  bool awaited_ = false;  ///< a child was started that is not ready yet
  Duration heard_{0};
  Duration busy_{0};                    ///< when it last was in a unit, or had none
  std::map<uint64_t, Task> tasks_;      ///< by token
  std::map<uint64_t, Duration> steps_;  ///< by job: the longest time between samples so far
};

}  // namespace hyades::worker
