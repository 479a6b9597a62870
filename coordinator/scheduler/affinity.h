#pragma once

#include <cstdint>
#include <optional>

#include "coordinator/scheduler/events.h"
#include "coordinator/scheduler/scheduled_jobs.h"
#include "coordinator/scheduler/scheduled_workers.h"
#include "coordinator/scheduler/scheduler_options.h"

namespace hyades::coordinator {

/// Which scenes workers have in memory, what loading one takes, and whether it pays that one more
/// worker begins with a frame.
class Affinity {
 public:
  Affinity(const SchedulerOptions& options, const Step& step, const ScheduledJobs& jobs)
      : options_(options), step_(step), jobs_(jobs) {}

  /// Whether the worker should have this frame's scene in memory.
  static bool has_scene(const Worker& worker, const FrameId& frame);
  /// The worker will have this frame's scene in memory; it keeps a few. `ahead`: it still renders
  /// another.
  static void remember_scene(Worker& worker, const FrameId& frame, bool ahead);
  /// The worker loads the scene, which it does not have, from now on; `alone`: it has nothing else
  /// to do.
  void begin_loading(Worker& worker, const FrameId& frame, bool alone) const;
  /// The worker renders this frame from now on, or none.
  void settle(Worker& worker, const std::optional<FrameId>& frame) const;
  /// The worker has a unit of this frame, so that its scene is there when it goes there.
  void prefetch(Worker& worker, const std::optional<FrameId>& frame) const;

  /// What it takes to load a scene of the job [s].
  double load_seconds(const ScheduledJob& job) const;
  /// What is left to lease of the frame for each of `threads` [s].
  double seconds_left(const FramePlace& place, uint64_t threads) const;
  /// Whether the frame has workers enough, so that one more had better begin with another.
  bool crowded(const FramePlace& place, const Worker& worker) const;
  /// Whether more workers may begin with the frame, and some more that come meanwhile.
  bool has_room(const FramePlace& place) const;
  /// Whether those who have the frame's scene will have leased all of it before this worker has
  /// loaded it. No where they may not (a unit has failed, or is disputed) or do not come for it.
  bool too_late(const FramePlace& place, const Worker& worker) const;
  /// Whether it is time to load what comes after this frame.
  bool nearly_leased(const FramePlace& place) const;
  /// Whether the worker still loads what it last began with.
  bool still_loads(const Worker& worker) const;
  /// The first film of a scene has come, so that the worker has loaded it. Where it had nothing
  /// else to do, the time that went by and was not spent on rendering is what loading takes.
  void learn_load(ScheduledJob& job, Worker& worker, const ResultArrived& result);

 private:
  FrameSlot* find(const std::optional<FrameId>& frame) const;

  const SchedulerOptions& options_;
  const Step& step_;
  const ScheduledJobs& jobs_;
  double load_seconds_ = -1;  ///< to load a scene, of any job; -1: not known
};

}  // namespace hyades::coordinator
