#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "cli/client/farm_client.h"
#include "cli/display/viewer.h"
#include "core/base/mutex.h"

namespace hyades::cli {

/// Shows the frames of a farm's job in a viewer while workers render them. The coordinator is asked
/// for the films of the first frames in work that have changed, one at a time, at most once a
/// second, and never more than a fifth of the time; for the last one of a finished frame where it
/// keeps that, else for the frame's EXR. A thread of its own does so with a connection of its own:
/// what cannot be had now is left out.
class FilmDisplay {
 public:
  /// `client` gives up at once where it is not answered. `viewer` outlives this.
  FilmDisplay(std::unique_ptr<FarmClient> client, Viewer& viewer, uint64_t job);
  /// Shows what is left, for ten seconds at most and as long as one answer takes.
  ~FilmDisplay();

  /// News of the job.
  void take(const v1::WatchEvent& event) HYADES_EXCLUDES(mutex_);

 private:
  using Clock = std::chrono::steady_clock;
  /// A frame that may be shown.
  struct InWork {
    uint64_t samples = 0;
    uint64_t shown = 0;  ///< samples of the film that the viewer has
  };
  void run() HYADES_EXCLUDES(mutex_);
  std::optional<int32_t> next_frame() const HYADES_REQUIRES(mutex_);
  bool show_film(int32_t frame);
  void show_exr(int32_t frame);
  void show(int32_t frame, const core::Image& picture) HYADES_EXCLUDES(mutex_);

  const std::unique_ptr<FarmClient> client_;
  Viewer& viewer_;
  const uint64_t job_;

  core::Mutex mutex_;
  core::CondVar wake_;
  std::string name_ HYADES_GUARDED_BY(mutex_);
  bool several_ HYADES_GUARDED_BY(mutex_) = false;
  std::map<int32_t, InWork> in_work_ HYADES_GUARDED_BY(mutex_);
  /// The last few that were finished, to be shown as they are now.
  std::deque<int32_t> done_ HYADES_GUARDED_BY(mutex_);
  bool ending_ HYADES_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace hyades::cli
