#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/shared.h"
#include "coordinator/controller/timeline.h"

namespace hyades::coordinator {

class DiskWatch;

/// Has the outputs of complete frames made, one frame after the other.
class FrameFinisher {
 public:
  FrameFinisher(Shared& shared, Dispatcher& dispatcher, JobTable& jobs, DiskWatch& disk,
                Timelines& timelines)
      : shared_(shared), dispatcher_(dispatcher), jobs_(jobs), disk_(disk), timelines_(timelines) {}
  /// Waits for the one in work.
  void end() { queue_.end(); }

  /// The frame's film is among those of `active` that are complete. `parts`: StoredFrame::parts.
  void add(ActiveJob& active, int32_t frame, std::vector<std::string> parts)
      HYADES_REQUIRES(state_lock);

 private:
  struct Completed;
  bool finish(Completed& completed) HYADES_EXCLUDES(state_lock);

  Shared& shared_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  DiskWatch& disk_;
  Timelines& timelines_;
  RetryQueue queue_{1};  ///< by job
};

}  // namespace hyades::coordinator
