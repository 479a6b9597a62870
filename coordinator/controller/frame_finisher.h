#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/tasks_in_work.h"
#include "coordinator/controller/timeline.h"

namespace hyades::coordinator {

class DiskWatch;
struct FinishTask;

/// Has the outputs of complete frames made: of each owner one frame after the other, and owners
/// take turns by the time that theirs take.
class FrameFinisher {
 public:
  FrameFinisher(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs, DiskWatch& disk,
                Timelines& timelines)
      : context_(context),
        dispatcher_(dispatcher),
        jobs_(jobs),
        disk_(disk),
        timelines_(timelines) {}
  /// Breaks off those in work.
  void stop() HYADES_EXCLUDES(state_lock);
  /// Waits for those in work; to be called after stop().
  void end() { queue_.end(); }

  /// Has the frame finished, whose film is among those of `active` that are complete. `parts`:
  /// StoredFrame::parts.
  void add(ActiveJob& active, const FinishFrame& asked, std::vector<std::string> parts)
      HYADES_REQUIRES(state_lock);
  /// Breaks off the frame of the job in work: nobody wants its outputs.
  void cancel(JobId job) HYADES_REQUIRES(state_lock);

 private:
  struct Completed;
  bool finish(Completed& completed) HYADES_EXCLUDES(state_lock);
  std::shared_ptr<const core::Film> begin(Completed& completed, std::string& spec,
                                          std::string& owner, StoredFrame& over)
      HYADES_EXCLUDES(state_lock);
  core::Result<FinishTask> task_of(const farm::ReadJob& read, uint64_t job,
                                   const StoredFrame& over) const;
  core::Status make_outputs(const Completed& completed, const core::Film& film,
                            const FinishTask& task, const StoredFrame& over,
                            const std::atomic<bool>& stop, bool& written) const;

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  DiskWatch& disk_;
  Timelines& timelines_;
  TasksInWork in_work_{context_};  ///< by job
  /// By job. So many owners' frames are finished at once: each takes the memory of its film anew.
  farm::RetryQueue queue_{4};
};

}  // namespace hyades::coordinator
