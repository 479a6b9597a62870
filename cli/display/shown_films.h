#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/display/viewer.h"
#include "coordinator/local/frame_work.h"
#include "core/base/mutex.h"

namespace hyades::cli {

/// The name that a viewer gives to a frame: the job's, and where it has several frames the number:
/// "walk.0007".
std::string picture_name(const std::string& job, int32_t frame, bool several);

/// Shows the films of a run in a viewer while they grow: all their layers, as
/// core::Film::normalised() has them. What is merged is shown at once, as long as that takes next
/// to no time of the thread that merges (2 % of the run's); else with a later one, at last when the
/// frame is complete.
class ShownFilms : public coordinator::FilmAudience {
 public:
  /// `viewer` outlives it. `several`: the job has more than one frame.
  ShownFilms(Viewer& viewer, std::string job, bool several)
      : viewer_(viewer), job_(std::move(job)), several_(several) {}

  void grown(int32_t frame, const core::Film& film, const core::PixelRect& tile) override;
  void complete(int32_t frame, const core::Film& film) override;

 private:
  using Clock = std::chrono::steady_clock;
  /// What of a frame is not shown yet: parts of Viewer::kPart pixels, row by row.
  struct Pending {
    std::vector<bool> parts;
    size_t next = 0;
  };
  Pending& pending_of(int32_t frame, const core::Film& film) HYADES_REQUIRES(mutex_);
  bool may_spend() const HYADES_REQUIRES(mutex_);
  void show(int32_t frame, const core::Film& film, bool all) HYADES_REQUIRES(mutex_);
  void show_part(int32_t frame, const core::Film& film, const core::PixelRect& part);

  Viewer& viewer_;
  const std::string job_;
  const bool several_;
  const Clock::time_point begin_ = Clock::now();

  core::Mutex mutex_;
  /// Of frames that are not complete.
  std::map<int32_t, Pending> pending_ HYADES_GUARDED_BY(mutex_);
  double spent_ HYADES_GUARDED_BY(mutex_) = 0;  ///< [s] of the processor
};

}  // namespace hyades::cli
