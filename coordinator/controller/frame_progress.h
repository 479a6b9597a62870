#pragma once

#include <cstdint>

#include "coordinator/controller/timeline.h"
#include "coordinator/controller/worker_table.h"

namespace hyades::coordinator {

class FrameFinisher;

/// What becomes of frames, as their jobs show it. Its functions are for the scheduler's actions of
/// these names; those about films are called by the job's film store's thread, where the films are.
class FrameProgress {
 public:
  FrameProgress(Shared& shared, JobTable& jobs, WorkerTable& workers, FrameFinisher& finisher,
                Timelines& timelines)
      : shared_(shared),
        jobs_(jobs),
        workers_(workers),
        finisher_(finisher),
        timelines_(timelines) {}

  void merged(const Merge& merge) HYADES_EXCLUDES(state_lock);
  void tile_voided(const TileVoided& voided) HYADES_EXCLUDES(state_lock);
  void finish(const FinishFrame& finish) HYADES_EXCLUDES(state_lock);
  void done(const FrameDone& action) HYADES_EXCLUDES(state_lock);
  void failed(const FrameFailed& action) HYADES_EXCLUDES(state_lock);
  void restarted(const FrameRestarted& action) HYADES_EXCLUDES(state_lock);
  void reopened(const FrameReopened& action) HYADES_EXCLUDES(state_lock);

 private:
  void count_film(ActiveJob& active, const Merge& merge, int64_t begun_us)
      HYADES_REQUIRES(state_lock);

  Shared& shared_;
  JobTable& jobs_;
  WorkerTable& workers_;
  FrameFinisher& finisher_;
  Timelines& timelines_;
};

}  // namespace hyades::coordinator
