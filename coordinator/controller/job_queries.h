#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <grpcpp/support/status.h>

#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/shared.h"
#include "coordinator/controller/timeline.h"

namespace hyades::coordinator {

class DiskWatch;

/// How far somebody has heard of a job's changes; at first of nothing.
struct ChangeCursor {
  uint64_t version = 0;          ///< of the job: of all changes up to this one
  uint64_t next_version = 0;     ///< while they do not fit into one event, and
  std::optional<int32_t> after;  ///< the last frame that did
  bool over = false;             ///< what is told is how the job has ended
};

/// A frame as it is now, and how its job shows it.
struct FrameNow {
  v1::Frame frame;
  std::string tag;  ///< quoted; another one whenever the frame has changed; of open jobs only
  std::string tone_map = "srgb";  ///< of the job's first output for displays; of open jobs only
  float exposure = 0;             ///< stops; the same
};

/// What clients want to know of jobs. What may wait for the disk or the store says so: it is not
/// for threads that others need; all else never does. Errors as docs/wire.md has them. Thread-safe.
class JobQueries {
 public:
  JobQueries(Shared& shared, Dispatcher& dispatcher, JobTable& jobs, const DiskWatch& disk,
             const Timelines& timelines)
      : shared_(shared), dispatcher_(dispatcher), jobs_(jobs), disk_(disk), timelines_(timelines) {}

  /// May wait for the store; list_open() knows all jobs that have not ended, and says no where
  /// others are asked for.
  grpc::Status list(const v1::ListJobsRequest& request, v1::ListJobsResponse& response)
      HYADES_EXCLUDES(state_lock);
  bool list_open(const v1::ListJobsRequest& request, v1::ListJobsResponse& response)
      HYADES_EXCLUDES(state_lock);
  /// The job, and its frames above `after` as far as they fit; only those in state `only`, where
  /// one is given. May wait for the store; get_open() answers for jobs that have not ended, and
  /// says no for others.
  grpc::Status get(uint64_t job, std::optional<int32_t> after, v1::GetJobResponse& response,
                   v1::FrameState only = v1::FRAME_STATE_UNSPECIFIED) HYADES_EXCLUDES(state_lock);
  bool get_open(uint64_t job, std::optional<int32_t> after, v1::GetJobResponse& response,
                v1::FrameState only = v1::FRAME_STATE_UNSPECIFIED) HYADES_EXCLUDES(state_lock);
  /// What has changed since, as far as it fits. `ended`: there will be no other changes. May wait
  /// for the store; changes_of_open() answers for jobs that have not ended, and says no for others.
  grpc::Status changes(uint64_t job, ChangeCursor& cursor, v1::WatchEvent& event, bool& ended)
      HYADES_EXCLUDES(state_lock);
  bool changes_of_open(uint64_t job, ChangeCursor& cursor, v1::WatchEvent& event)
      HYADES_EXCLUDES(state_lock);
  /// May wait for the store.
  grpc::Status frame_now(uint64_t job, int32_t frame, FrameNow& now) HYADES_EXCLUDES(state_lock);
  using FilmTaker = std::function<void(const grpc::Status&, const core::FilmInfo&,
                                       std::shared_ptr<const core::Film>)>;
  /// A copy of the frame's film as it is now, or, where films are kept, was in the end; given to
  /// `then` (which is quick), perhaps by another thread. May wait for the disk.
  grpc::Status film(uint64_t job, int32_t frame, FilmTaker then) HYADES_EXCLUDES(state_lock);
  /// What was done for the job where and when, as far as it is kept in memory. May wait for the
  /// store.
  grpc::Status timeline(const v1::ListTimelineRequest& request, v1::ListTimelineResponse& response);
  /// Whether a file is there only until the open job's video is made of it.
  bool is_for_video(uint64_t job, const std::string& path) const HYADES_EXCLUDES(state_lock);

  /// The job as the wire shows it.
  v1::Job describe(const ActiveJob& active) const HYADES_REQUIRES(state_lock);
  v1::Job describe(const StoredJob& job) const;

 private:
  void count_cost(v1::Job& job) const;
  grpc::Status kept_film(uint64_t job, int32_t frame, const FilmTaker& then);

  Shared& shared_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  const DiskWatch& disk_;
  const Timelines& timelines_;
};

}  // namespace hyades::coordinator
