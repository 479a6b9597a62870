#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <grpcpp/support/byte_buffer.h>

#include "coordinator/controller/failure_reasons.h"
#include "coordinator/controller/log_buffer.h"
#include "coordinator/controller/speed.h"
#include "coordinator/controller/state_lock.h"
#include "coordinator/film_store/film_store.h"
#include "coordinator/job_store/job_store.h"
#include "coordinator/scheduler/ids.h"
#include "coordinator/scheduler/job_plan.h"
#include "core/film/film_info.h"
#include "core/film/noise.h"
#include "core/job/video.h"
#include "farm/content_store.h"
#include "farm/job_package.h"
#include "hyades/v1/common.pb.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::coordinator {

/// Bytes of the name of a job, owner or worker.
inline constexpr size_t kLongestName = 200;

/// What those who ask are told of a frame of an open job.
struct FrameNote {
  v1::FrameState state = v1::FRAME_STATE_WAITING;
  uint64_t samples_done = 0;      ///< durable
  uint64_t samples_spared = 0;    ///< that its tiles were found not to need
  FailureReasons::Reason reason;  ///< why it failed; null where it has not
  std::string worker_class;       ///< of those who render it; empty: nobody has begun
  uint32_t restarts = 0;          ///< how often it has begun again
  std::optional<double> noise;    ///< of its film when that was last measured, see picture_noise()
  int64_t begun_ms = 0;    ///< when its first unit was leased; 0: before the last start, or never
  uint64_t render_ns = 0;  ///< that threads took for the results which counted, since the start
  uint64_t begun = 0;  ///< StoredFrame::moment of the last frame that was finished then; 0: unknown
  uint64_t version = 0;  ///< of the job when this last changed
};

/// A film that is being made durable: who rendered it, and what that took.
struct FilmUnderWay {
  WorkerId worker{};
  std::string name;        ///< of the worker
  uint32_t thread = 0;     ///< of the worker
  uint64_t render_ns = 0;  ///< nanoseconds that the thread took
  int64_t came_us = 0;     ///< when it arrived: microseconds since 1970, UTC
  TimePoint came;          ///< the same by the steady clock
  bool is_old = false;     ///< the worker had it before the coordinator started
};

/// All that the coordinator has in memory of a job that has not ended. What the state lock does not
/// guard never changes once the job is in the JobTable. Until then nobody else knows it, and
/// whoever makes it needs no lock.
struct ActiveJob {
  ActiveJob(StoredJob stored_, v1::JobSpec spec_)
      : spec(std::move(spec_)), stored(std::move(stored_)) {}

  JobId id{};
  const uint64_t life = next_life();  ///< another one whenever a job is opened, or reopened
  v1::JobSpec spec;                   ///< empty once it is in `brief`
  grpc::ByteBuffer brief;             ///< a CoordinatorMessage, which tells workers of the job
  uint64_t bytes = 0;  ///< that it takes in memory while it is open, but for its frames and films

  // What is asked for all the time of its document; all else of that is in JobDocuments.
  std::vector<int32_t> numbers;    ///< of its frames, in order
  uint32_t samples = 0;            ///< per pixel, at most
  core::NoiseThreshold threshold;  ///< when a tile has enough of them
  std::string tone_map = "srgb";   ///< of its first output for displays
  float exposure = 0;              ///< of that output, in stops
  /// The videos that are made when all frames are done: none where the spec asks for some frames
  /// only.
  std::vector<core::VideoDesc> videos;
  core::VideoFrames video_frames;  ///< what they are made of, but for the folder
  bool leaves_out_videos = false;  ///< the document has some, and the spec not all frames
  JobNeeds needs;                  ///< what it asks of its workers

  core::PixelRect region;
  core::FilmLayout layout;
  uint64_t film_bytes = 0;  ///< that the film of one frame and its FrameLedger take in memory
  uint64_t samples_per_frame = 0;
  Digest key{};  ///< JobBrief.key

  /// Reports to the controller.
  std::unique_ptr<FilmStore::Listener> film_listener HYADES_GUARDED_BY(state_lock);
  /// Null until there is a film. It has locks of its own.
  std::unique_ptr<FilmStore> film_store HYADES_GUARDED_BY(state_lock);
  /// Complete films until their frame is over.
  std::map<int32_t, std::shared_ptr<const core::Film>> complete HYADES_GUARDED_BY(state_lock);
  std::map<RecordId, FilmUnderWay> films_under_way HYADES_GUARDED_BY(state_lock);

  StoredJob stored HYADES_GUARDED_BY(state_lock);
  std::map<int32_t, FrameNote> frames HYADES_GUARDED_BY(state_lock);
  uint64_t samples_done HYADES_GUARDED_BY(state_lock) = 0;
  uint64_t samples_spared HYADES_GUARDED_BY(state_lock) = 0;
  uint64_t version HYADES_GUARDED_BY(state_lock) = 1;  ///< grows with every change
  /// The frames that have changed, by the version of their last change.
  std::map<uint64_t, int32_t> changed HYADES_GUARDED_BY(state_lock);
  /// Frames that may be in work: all that are rendered or finished, and a few others.
  std::set<int32_t> in_work HYADES_GUARDED_BY(state_lock);
  std::set<int32_t> failed HYADES_GUARDED_BY(state_lock);  ///< frames that have failed
  std::set<int32_t> black HYADES_GUARDED_BY(state_lock);   ///< done ones that no light has reached
  FailureReasons reasons HYADES_GUARDED_BY(state_lock);    ///< why these have
  Speed speed HYADES_GUARDED_BY(state_lock);
  /// How long the outputs of a frame lately took to be made [seconds]; 0: not known.
  double finish_seconds HYADES_GUARDED_BY(state_lock) = 0;
  /// When the outputs of the frame that is being finished were begun [wall clock, us]; 0: none is.
  int64_t finishing_since HYADES_GUARDED_BY(state_lock) = 0;
  /// Since when it has been worked on without a pause that is not in stored.busy_ns; none: nobody
  /// works on it.
  TimePoint busy_since HYADES_GUARDED_BY(state_lock);
  /// Why nobody who is there may render it, while it waits; empty: somebody may, or it does not.
  std::string obstacle HYADES_GUARDED_BY(state_lock);
  std::optional<double> noise HYADES_GUARDED_BY(state_lock);  ///< that was measured last
  TimePoint noise_measured HYADES_GUARDED_BY(state_lock);     ///< when that was

  LogBuffer log HYADES_GUARDED_BY(state_lock);
  /// A task will store what has changed in `stored`.
  bool storing_row HYADES_GUARDED_BY(state_lock) = false;
  std::string trouble HYADES_GUARDED_BY(state_lock);      ///< why its films cannot be stored
  std::string row_trouble HYADES_GUARDED_BY(state_lock);  ///< why `stored` cannot be stored
  /// stored.core_ns and stored.busy_ns as the store has them, and when that was looked at.
  uint64_t core_ns_stored HYADES_GUARDED_BY(state_lock) = 0;
  uint64_t busy_ns_stored HYADES_GUARDED_BY(state_lock) = 0;
  TimePoint account_stored HYADES_GUARDED_BY(state_lock);
  /// Workers whose reason for giving units back is in the log.
  std::set<WorkerId> gave_back HYADES_GUARDED_BY(state_lock);
  /// All frames are done, and the scheduler has let go of it; its videos are being made, or wait
  /// for their turn.
  bool making_videos HYADES_GUARDED_BY(state_lock) = false;
  /// The scheduler has let go of it, and its end is being stored.
  bool ending HYADES_GUARDED_BY(state_lock) = false;

  /// The frame, which changes now.
  FrameNote& touch(int32_t frame) HYADES_REQUIRES(state_lock);
  /// Counts the time in which somebody has worked on it; from `now` on somebody does, or not.
  void set_busy(bool busy, TimePoint now) HYADES_REQUIRES(state_lock);
  /// Notes that the store has the job's account as it is in `row`.
  void account_is_stored(const StoredJob& row) HYADES_REQUIRES(state_lock);
  /// Whether the store lacks something of the job's account.
  bool account_has_grown() const HYADES_REQUIRES(state_lock);
  /// Whether anybody does something for it, where `leased` of its units are with workers.
  bool is_worked_on(uint32_t leased) const HYADES_REQUIRES(state_lock);
  /// How many of its frames are rendered, and have their outputs made or wait for that.
  uint32_t frames_finishing() const HYADES_REQUIRES(state_lock);
  /// The outputs of one of its frames took so long to be made.
  void note_finish(double seconds) HYADES_REQUIRES(state_lock);
  /// Whether it runs, and has something left to be rendered of which nobody has any, and no frame
  /// that is being finished.
  bool is_waiting(uint32_t leased) const HYADES_REQUIRES(state_lock);
  /// Something else of the job changes now.
  void touch() HYADES_REQUIRES(state_lock) { ++version; }
  /// Adds a line to the job's log; it is dropped and counted where too many wait for the disk.
  void note(StoredLine line) HYADES_REQUIRES(state_lock);
  /// The frame that stands for the job in a list: the first in work of which something is there,
  /// else the last that was finished.
  std::optional<int32_t> preview_frame() const HYADES_REQUIRES(state_lock);
  /// The job as the wire shows it; `leased`: its units that workers have.
  v1::Job describe(uint32_t leased) const HYADES_REQUIRES(state_lock);
  /// A frame of it as the wire shows it.
  v1::Frame describe_frame(int32_t frame, const FrameNote& note) const HYADES_REQUIRES(state_lock);

 private:
  static uint64_t next_life();
};

/// Pixels along the side of a job's tiles, by its crop window and samples per pixel. Every unit
/// costs the farm some milliseconds, and none is larger than a tile with all its samples: 64 where
/// these are few, if the frame is still cut into enough pieces for many threads; else 32, as where
/// tiles are judged (`adaptive`), and as on a single machine. Where films have `splats`:
/// kSplatTile.
int32_t tile_size_of(const core::PixelRect& region, uint32_t samples, bool splats, bool adaptive);

/// Pixels along the side of the tiles of this job.
int32_t tile_size_of(const ActiveJob& job);

/// Parses StoredJob::options.
v1::Job options_of(const StoredJob& job);
/// What the job asks of its workers, by its options.
JobNeeds needs_of(const v1::Job& options);

/// A stored job as the wire shows it.
v1::Job describe(const StoredJob& job);

/// The job, whose document is `read`; the files that that names are among `assets`. An error says
/// what a farm does not do of it, or that the film of a frame takes more than `film_memory` bytes.
core::Result<std::unique_ptr<ActiveJob>> make_active_job(
    const StoredJob& stored, const v1::JobSpec& spec, const farm::ReadJob& read,
    farm::ContentStore& assets, uint64_t film_memory) HYADES_EXCLUDES(state_lock);

/// Bytes that a job of this spec takes in memory while it is open, but for its frames, films and
/// videos.
uint64_t memory_of(const StoredJob& job);

/// The records of a spec's files; an error where the spec is not as the wire allows.
core::Result<std::vector<core::AssetRecord>> files_of(const v1::JobSpec& spec);

}  // namespace hyades::coordinator
