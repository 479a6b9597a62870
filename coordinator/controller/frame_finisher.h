#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/timeline.h"

namespace hyades::coordinator {

class DiskWatch;
struct FinishTask;

/// Has the outputs of complete frames made, one frame after the other.
class FrameFinisher {
 public:
  FrameFinisher(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs, DiskWatch& disk,
                Timelines& timelines)
      : context_(context),
        dispatcher_(dispatcher),
        jobs_(jobs),
        disk_(disk),
        timelines_(timelines) {}
  /// Waits for the one in work.
  void end() { queue_.end(); }

  /// Has the frame finished, whose film is among those of `active` that are complete. `parts`:
  /// StoredFrame::parts.
  void add(ActiveJob& active, const FinishFrame& asked, std::vector<std::string> parts)
      HYADES_REQUIRES(state_lock);

 private:
  struct Completed;
  bool finish(Completed& completed) HYADES_EXCLUDES(state_lock);
  bool begin(Completed& completed, std::string& spec, StoredFrame& over)
      HYADES_EXCLUDES(state_lock);
  core::Result<FinishTask> task_of(const farm::ReadJob& read, uint64_t job,
                                   const StoredFrame& over) const;
  core::Status make_outputs(const Completed& completed, const FinishTask& task,
                            const StoredFrame& over, bool& written) const;

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  DiskWatch& disk_;
  Timelines& timelines_;
  farm::RetryQueue queue_{1};  ///< by job
};

}  // namespace hyades::coordinator
