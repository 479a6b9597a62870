#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <grpcpp/support/status.h>

#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_records.h"

namespace hyades::coordinator {

class FrameFinisher;
class JobQueries;
class VideoMaker;

/// OK, or INVALID_ARGUMENT for a priority that no job may have.
grpc::Status check_priority(int priority);

/// Why a job that is not in memory is not open: NOT_FOUND, FAILED_PRECONDITION for one that has
/// ended or could not be recovered yet, UNAVAILABLE for one that is being recovered.
grpc::Status why_not_open(JobStore& store, uint64_t job);
/// UNAVAILABLE, as somebody is just recovering the job.
grpc::Status being_recovered(uint64_t job);

/// What clients want of open jobs. Each function calls `then` exactly once, perhaps by another
/// thread and at the latest when the controller stops: when the change is stored, or after half a
/// second with UNAVAILABLE (it holds, and will be stored). For a job that is not open they may wait
/// for the store. `by`, whose wish it is, goes into the job's log; empty: nobody in particular's.
/// Thread-safe.
class JobSteering {
 public:
  JobSteering(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs,
              const JobQueries& queries, JobRecords& records, FrameFinisher& finisher,
              VideoMaker& videos)
      : context_(context),
        dispatcher_(dispatcher),
        jobs_(jobs),
        queries_(queries),
        records_(records),
        finisher_(finisher),
        videos_(videos) {}

  /// The job's units are leased no more until it is resumed.
  void pause(uint64_t job, const std::string& by, JobReply then) HYADES_EXCLUDES(state_lock);
  /// Ends a pause.
  void resume(uint64_t job, const std::string& by, JobReply then) HYADES_EXCLUDES(state_lock);
  /// The job ends as it is; one that waits to be recovered, too.
  void cancel(uint64_t job, const std::string& by, JobReply then) HYADES_EXCLUDES(state_lock);
  /// Somebody looks at the picture of a frame in work: for some seconds all of it is refined
  /// together. Nobody is answered.
  void note_watched(uint64_t job, int32_t frame) HYADES_EXCLUDES(state_lock);
  /// INVALID_ARGUMENT as check_priority() has it.
  void set_priority(uint64_t job, int priority, const std::string& by, JobReply then)
      HYADES_EXCLUDES(state_lock);

 private:
  void set_paused(uint64_t job, bool paused, const std::string& by, JobReply then)
      HYADES_EXCLUDES(state_lock);
  void note(ActiveJob& active, const std::string& what, const std::string& by)
      HYADES_REQUIRES(state_lock);
  void change(uint64_t job, JobReply then, const std::function<void(ActiveJob&, Turn&)>& what)
      HYADES_EXCLUDES(state_lock);
  grpc::Status cancel_waiting(uint64_t job, v1::Job& now) HYADES_EXCLUDES(state_lock);

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  const JobQueries& queries_;
  JobRecords& records_;
  FrameFinisher& finisher_;
  VideoMaker& videos_;
};

}  // namespace hyades::coordinator
