#pragma once

#include <string>

#include "coordinator/scheduler/frame_lifecycle.h"
#include "coordinator/scheduler/hedged_copies.h"

namespace hyades::coordinator {

/// Workers: come, gone, alive, barred, in quarantine.
class WorkerLifecycle {
 public:
  WorkerLifecycle(const SchedulerOptions& options, Step& step, ScheduledJobs& jobs,
                  ScheduledWorkers& workers, const FilmBudget& films, Leases& leases,
                  const Affinity& affinity, HedgedCopies& copies, FrameLifecycle& frames)
      : options_(options),
        step_(step),
        jobs_(jobs),
        workers_(workers),
        films_(films),
        leases_(leases),
        affinity_(affinity),
        copies_(copies),
        frames_(frames) {}

  void on(const WorkerJoined& e);
  void on(const WorkerAlive& e);
  void on(const WorkerBarred& e);
  void on(const WorkerLost& e);
  void on(const WorkerForgotten& e);

  /// Nothing more for the worker and nothing more from it. False where that is so already.
  bool quarantine(WorkerId id, const std::string& reason);
  /// A unit is rendered: its worker can, and those who failed it cannot blame the unit. Units that
  /// nobody can render are nobody's fault, so that a broken job puts no worker into quarantine.
  void forgive_and_blame(const ScheduledJob& job, FrameSlot& slot, const Extent& extent,
                         WorkerId worker);

 private:
  void adopt(WorkerId id, Worker& worker, const UnitInHand& held, TimePoint since);

  const SchedulerOptions& options_;
  Step& step_;
  ScheduledJobs& jobs_;
  ScheduledWorkers& workers_;
  const FilmBudget& films_;
  Leases& leases_;
  const Affinity& affinity_;
  HedgedCopies& copies_;
  FrameLifecycle& frames_;
};

}  // namespace hyades::coordinator
