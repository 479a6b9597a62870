#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/requested_video.h"
#include "coordinator/controller/tasks_in_work.h"
#include "coordinator/controller/timeline.h"
#include "coordinator/finisher/video_task.h"
#include "farm/retry_queue.h"

namespace hyades::coordinator {

class DiskWatch;
class JobRecords;

/// Makes videos of finished frames beside all else, as that takes minutes: a job's own before it
/// ends, and those that somebody asks for. Of each owner one after the other; owners take turns by
/// the time that theirs take. Thread-safe.
class VideoMaker {
 public:
  VideoMaker(ControllerContext& context, JobTable& jobs, JobRecords& records, DiskWatch& disk,
             Timelines& timelines)
      : context_(context), jobs_(jobs), records_(records), disk_(disk), timelines_(timelines) {}
  /// Breaks off the videos in work.
  void stop() HYADES_EXCLUDES(state_lock);
  /// Waits for what is in work; to be called after stop().
  void end() { queue_.end(); }

  /// Has a video made of the pictures of the job's finished frames, also of a job that has ended or
  /// has none of its own; it is among the outputs once it is there. May wait for the store.
  /// FAILED_PRECONDITION where there is nothing to make it of, RESOURCE_EXHAUSTED where too many
  /// wait already.
  grpc::Status ask(uint64_t job, const VideoRequest& request, RequestedVideo& asked)
      HYADES_EXCLUDES(state_lock);
  /// The job's videos that were asked for since the coordinator started, the last ones. NOT_FOUND.
  /// May wait for the store.
  grpc::Status asked(uint64_t job, std::vector<RequestedVideo>& videos) HYADES_EXCLUDES(state_lock);

  /// Makes the videos of a job whose frames are all done; then it ends.
  void begin(ActiveJob& active) HYADES_REQUIRES(state_lock);
  /// The job, whose videos are being made or wait, ends without them.
  void cancel(ActiveJob& active) HYADES_REQUIRES(state_lock);
  /// Nobody wants the videos that were asked for of the job, which is deleted.
  void forget(uint64_t job) HYADES_EXCLUDES(state_lock);
  /// Whether a video of the job's own is in work.
  bool is_making(JobId job) const HYADES_REQUIRES(state_lock) {
    return in_work_.contains(static_cast<uint64_t>(job));
  }

 private:
  void add(const ActiveJob& active) HYADES_REQUIRES(state_lock);
  bool make_of_job(JobId job, uint64_t life) HYADES_EXCLUDES(state_lock);
  core::Result<bool> make_one(uint64_t id, const std::vector<core::VideoDesc>& videos,
                              const core::VideoFrames& frames, const std::atomic<bool>& stop);
  core::Status make(uint64_t id, const std::string& scratch, const VideoTask& task,
                    const std::vector<std::string>& gone, const std::atomic<bool>& stop);
  void make_asked(uint64_t number) HYADES_EXCLUDES(state_lock);
  void asked_is_over(const RequestedVideo& video, const core::Status& done)
      HYADES_EXCLUDES(state_lock);

  ControllerContext& context_;
  JobTable& jobs_;
  JobRecords& records_;
  DiskWatch& disk_;
  Timelines& timelines_;
  TasksInWork in_work_{context_};  ///< by the keys of their tasks
  /// The oldest first; those that are over too.
  std::deque<RequestedVideo> asked_ HYADES_GUARDED_BY(state_lock);
  uint64_t next_asked_ HYADES_GUARDED_BY(state_lock) = 1;
  /// By job, and by what was asked for. So many owners' videos are made at once.
  farm::RetryQueue queue_{4};
};

}  // namespace hyades::coordinator
