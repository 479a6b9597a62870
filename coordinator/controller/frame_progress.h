#pragma once

#include <cstdint>
#include <memory>

#include "coordinator/controller/timeline.h"
#include "coordinator/controller/worker_table.h"

namespace hyades::coordinator {

class FrameFinisher;

/// What becomes of frames, as their jobs show it: a function for each of the scheduler's actions
/// about frames.
class FrameProgress {
 public:
  FrameProgress(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs,
                WorkerTable& workers, FrameFinisher& finisher, Timelines& timelines)
      : context_(context),
        dispatcher_(dispatcher),
        jobs_(jobs),
        workers_(workers),
        finisher_(finisher),
        timelines_(timelines) {}

  /// Merges a film that is durable into its frame's. On the film store's thread, where the films
  /// are.
  void merged(const Merge& merge) HYADES_EXCLUDES(state_lock);
  /// Has the film store's thread judge whether the tile has samples enough, once it has merged what
  /// was handed over before; the scheduler hears of it.
  void judge(ActiveJob& active, const JudgeTile& judge) HYADES_REQUIRES(state_lock);
  /// The tile needs no more batches than it has.
  void spare(ActiveJob& active, const TileSpared& spared) HYADES_REQUIRES(state_lock);
  /// The film store has taken the tile out of its frame's film.
  void tile_voided(ActiveJob& active, const TileVoided& voided) HYADES_REQUIRES(state_lock);
  /// Hands the frame to the finisher once its film has all that was delivered.
  void finish(ActiveJob& active, const FinishFrame& finish) HYADES_REQUIRES(state_lock);
  /// The frame's outputs are made and stored. On the film store's thread.
  void done(ActiveJob& active, const FrameDone& action) HYADES_REQUIRES(state_lock);
  /// The frame has failed for good, which is stored. On the film store's thread.
  void failed(ActiveJob& active, const FrameFailed& action) HYADES_REQUIRES(state_lock);
  /// The frame is rendered again from its beginning.
  void restarted(ActiveJob& active, const FrameRestarted& action) HYADES_REQUIRES(state_lock);
  /// What the finisher has made is of a suspect film: the frame is not done.
  void reopened(ActiveJob& active, const FrameReopened& action) HYADES_REQUIRES(state_lock);

 private:
  void measure_noise(JobId job, int32_t frame) HYADES_EXCLUDES(state_lock);
  std::shared_ptr<const core::Film> film_of(JobId job, int32_t frame) const
      HYADES_EXCLUDES(state_lock);
  void count_film(ActiveJob& active, const Merge& merge, int64_t begun_us)
      HYADES_REQUIRES(state_lock);
  void hand_over(ActiveJob& active, const FinishFrame& finish) HYADES_REQUIRES(state_lock);

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  WorkerTable& workers_;
  FrameFinisher& finisher_;
  Timelines& timelines_;
};

}  // namespace hyades::coordinator
