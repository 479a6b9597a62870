#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <grpcpp/support/status.h>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/timeline.h"
#include "core/image/image.h"

namespace hyades::coordinator {

class DiskWatch;

/// Bytes of frames in an answer: answers to those who read slowly, or never, lie in memory.
inline constexpr size_t kMostFrameBytes = size_t{64} << 10U;

/// How far a reader has heard of a job's changes; at first of nothing.
struct ChangeCursor {
  uint64_t version =
      0;  ///< heard of all changes up to this version of the job; 0: not of all frames
  uint64_t first_version = 0;           ///< of the job when the first frame was told
  std::optional<int32_t> after;         ///< the last frame that was told
  bool over = false;                    ///< what is told is how the job has ended
  uint64_t life = 0;                    ///< ActiveJob::life: in another one all is told again
  size_t page_bytes = kMostFrameBytes;  ///< of frames that are told at once
};

/// A frame as it is now, and how its job shows it.
struct FrameNow {
  v1::Frame frame;
  /// Quoted; another one whenever the frame has changed, or its job begun anew; of open jobs only.
  std::string tag;
  std::string tone_map = "srgb";  ///< of the job's first output for displays; of open jobs only
  float exposure = 0;             ///< of that output, in stops; of open jobs only
};

/// What clients want to know of jobs. What may wait for the disk or the store says so: it is not
/// for threads that others need; all else never does. Errors as docs/wire.md has them. Thread-safe.
class JobQueries {
 public:
  JobQueries(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs,
             const DiskWatch& disk, const Timelines& timelines)
      : context_(context),
        dispatcher_(dispatcher),
        jobs_(jobs),
        disk_(disk),
        timelines_(timelines) {}

  /// Jobs, the newest first, as many as are asked for. May wait for the store.
  grpc::Status list(const v1::ListJobsRequest& request, v1::ListJobsResponse& response)
      HYADES_EXCLUDES(state_lock);
  /// list() without waiting, of jobs that have not ended; false where others are asked for.
  bool list_open(const v1::ListJobsRequest& request, v1::ListJobsResponse& response)
      HYADES_EXCLUDES(state_lock);
  /// The job, and its frames above `after` as far as they fit into `most_bytes`; only those in
  /// state `only`, where one is given. NOT_FOUND. May wait for the store.
  grpc::Status get(uint64_t job, std::optional<int32_t> after, v1::GetJobResponse& response,
                   v1::FrameState only = v1::FRAME_STATE_UNSPECIFIED,
                   size_t most_bytes = kMostFrameBytes) HYADES_EXCLUDES(state_lock);
  /// get() without waiting; false where the job has ended or is none.
  bool get_open(uint64_t job, std::optional<int32_t> after, v1::GetJobResponse& response,
                v1::FrameState only = v1::FRAME_STATE_UNSPECIFIED,
                size_t most_bytes = kMostFrameBytes) HYADES_EXCLUDES(state_lock);
  /// What has changed of the job since `cursor`, which goes on, as far as it fits. `ended`: there
  /// will be no other changes. NOT_FOUND. May wait for the store.
  grpc::Status changes(uint64_t job, ChangeCursor& cursor, v1::WatchEvent& event, bool& ended)
      HYADES_EXCLUDES(state_lock);
  /// changes() without waiting; false where the job has ended or is none.
  bool changes_of_open(uint64_t job, ChangeCursor& cursor, v1::WatchEvent& event)
      HYADES_EXCLUDES(state_lock);
  /// The frame as it is now. NOT_FOUND where there is no such job, or it has no such frame. May
  /// wait for the store.
  grpc::Status frame_now(uint64_t job, int32_t frame, FrameNow& now) HYADES_EXCLUDES(state_lock);
  /// Takes a film: a status, and where that is OK the film with what it is of.
  using FilmTaker = std::function<void(const grpc::Status&, const core::FilmInfo&,
                                       std::shared_ptr<const core::Film>)>;
  /// A copy of the frame's film as it is now, or, where films are kept, was in the end; given to
  /// `then` (which is quick), perhaps by another thread. May wait for the disk. RESOURCE_EXHAUSTED
  /// where there is no room for one (FilmCopies), FAILED_PRECONDITION where there never is.
  /// `asker`: for whom the job's document is read where it has to be.
  grpc::Status film(uint64_t job, int32_t frame, const std::string& asker, FilmTaker then)
      HYADES_EXCLUDES(state_lock);
  /// Reads a finished picture of the job. `room`: among copies of films, and has to be kept as long
  /// as the picture. DATA_LOSS where the file is damaged; else as of film().
  grpc::Status picture(uint64_t job, const StoredOutput& output, core::Image& image,
                       std::shared_ptr<const void>& room);
  /// film() without what it is of, for which the job's document may have to be read.
  grpc::Status film_alone(uint64_t job, int32_t frame, FilmTaker then) HYADES_EXCLUDES(state_lock);
  /// What was done for the job where and when, as far as it is kept in memory. May wait for the
  /// store.
  grpc::Status timeline(const v1::ListTimelineRequest& request, v1::ListTimelineResponse& response);
  /// Whether a file is there only until the open job's video is made of it.
  bool is_for_video(uint64_t job, const std::string& path) const HYADES_EXCLUDES(state_lock);

  /// The job as the wire shows it, with what it has cost.
  v1::Job describe(const ActiveJob& active) const HYADES_REQUIRES(state_lock);
  v1::Job describe(const StoredJob& job) const;

 private:
  void count_cost(v1::Job& job) const;
  grpc::Status copy_film(uint64_t job, int32_t frame, std::optional<core::FilmInfo> info,
                         FilmTaker then) HYADES_EXCLUDES(state_lock);
  grpc::Status give_kept_film(uint64_t job, int32_t frame, const FilmTaker& then);
  grpc::Status kept_film(uint64_t job, int32_t frame, core::FilmInfo& info,
                         std::shared_ptr<const core::Film>& film);

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  const DiskWatch& disk_;
  const Timelines& timelines_;
};

}  // namespace hyades::coordinator
