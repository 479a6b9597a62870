#pragma once

#include "coordinator/scheduler/conflicts.h"

namespace hyades::coordinator {

/// Jobs: added, steered, cancelled, and frames of theirs that are wanted again.
class JobLifecycle {
 public:
  JobLifecycle(ScheduledJobs& jobs, ScheduledWorkers& workers, FilmBudget& films, Leases& leases,
               FrameLifecycle& frames, Conflicts& conflicts)
      : jobs_(jobs),
        workers_(workers),
        films_(films),
        leases_(leases),
        frames_(frames),
        conflicts_(conflicts) {}

  void on(const JobAdded& e);
  void on(const JobPaused& e);
  void on(const JobResumed& e);
  void on(const JobCancelled& e);
  void on(const JobReprioritised& e);
  void on(const FramesRetried& e);
  void on(const FramesSuspected& e);

 private:
  void restore(ScheduledJob& job, const RestoredJob& restored);

  ScheduledJobs& jobs_;
  ScheduledWorkers& workers_;
  FilmBudget& films_;
  Leases& leases_;
  FrameLifecycle& frames_;
  Conflicts& conflicts_;
};

}  // namespace hyades::coordinator
