#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/scheduler/ids.h"
#include "coordinator/state/job_store.h"
#include "coordinator/store/film_store.h"
#include "core/film/film_info.h"
#include "farm/content_store.h"
#include "farm/job_package.h"
#include "hyades/v1/common.pb.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::coordinator {

/// A frame of an open job, for those who ask.
struct FrameNote {
  v1::FrameState state = v1::FRAME_STATE_WAITING;
  uint64_t samples_done = 0;  ///< durable
  std::string reason;
  std::string worker_class;
  uint32_t restarts = 0;
  uint64_t begun = 0;  ///< StoredFrame::moment of the last frame that was finished then; 0: unknown
  uint64_t version = 0;  ///< of the job when this last changed
};

/// A film that is being made durable: who rendered it, and what that took.
struct FilmUnderWay {
  WorkerId worker{};
  std::string name;  ///< of the worker
  uint32_t thread = 0;
  uint64_t render_ns = 0;
  int64_t came_us = 0;  ///< since 1970, UTC
  TimePoint came;
};

/// How fast samples become durable, smoothed over some ten seconds.
class Speed {
 public:
  /// `done` in all so far, at `now`.
  void note(uint64_t done, TimePoint now);
  double per_second() const { return rate_; }

 private:
  TimePoint last_;
  uint64_t done_ = 0;
  double rate_ = 0;
};

/// All that the coordinator has in memory of a job that has not ended. Guarded by the controller's
/// lock, except for what never changes, and the film store.
struct ActiveJob {
  ActiveJob(StoredJob stored_, v1::JobSpec spec_)
      : spec(std::move(spec_)), stored(std::move(stored_)) {}

  // Never changes.
  JobId id{};
  v1::JobSpec spec;
  farm::ReadJob read;            ///< the job as its document says, with the spec's samples
  std::vector<int32_t> numbers;  ///< of its frames, in order
  core::PixelRect region;
  core::FilmLayout layout;
  uint64_t film_bytes = 0;  ///< that the film of one frame takes in memory
  uint64_t samples_per_frame = 0;
  Digest key{};  ///< JobBrief.key

  std::unique_ptr<FilmStore::Owner> owner;  ///< reports to the controller
  std::unique_ptr<FilmStore> film_store;    ///< null until there is a film
  /// Complete films until their frame is over.
  std::map<int32_t, std::shared_ptr<const core::Film>> complete;

  StoredJob stored;
  std::map<int32_t, FrameNote> frames;
  uint64_t samples_done = 0;
  uint64_t version = 1;  ///< grows with every change
  Speed speed;
  std::vector<StoredLine> lines;  ///< not stored yet
  uint64_t lines_dropped = 0;     ///< since lines were last taken: too many at once
  bool storing_lines = false;
  TimePoint lines_again;     ///< not before: storing them has failed
  bool storing_row = false;  ///< a task will store what has changed in `stored`
  std::string trouble;       ///< why its films cannot be stored
  std::string row_trouble;   ///< why `stored` cannot be stored
  std::map<RecordId, FilmUnderWay> films_under_way;
  std::set<int32_t> in_work;     ///< frames that may be, for preview_frame()
  uint64_t core_ns_stored = 0;   ///< of `stored`, as the store has it
  TimePoint core_stored;         ///< when that was looked at
  std::set<WorkerId> gave_back;  ///< whose reason for giving units back is in the log
  bool making_videos = false;    ///< all frames are done, and the scheduler has let go of it; its
                                 ///< videos are being made, or wait for their turn
  bool ending = false;           ///< the scheduler has let go of it, and its end is being stored

  FrameNote& touch(int32_t frame);
  void touch() { ++version; }
  /// A line for the job's log; dropped and counted where too many wait for the disk.
  void note(StoredLine line);
  /// The lines that wait, and a last one that tells of those dropped.
  std::vector<StoredLine> take_lines();
  /// Lines that could not be stored come again, before all others; the oldest of them go where too
  /// many wait.
  void put_back(std::vector<StoredLine> taken);
  /// The videos that are made when all frames are done: none where the spec asks for some frames
  /// only.
  const std::vector<core::VideoDesc>& videos() const;
  /// The frame that stands for the job in a list: the first in work of which something is there,
  /// else the last that was finished.
  std::optional<int32_t> preview_frame() const;
  v1::Job describe(uint32_t leased) const;
  v1::Frame describe_frame(int32_t frame, const FrameNote& note) const;
  core::FilmInfo film_info(int32_t frame) const;
};

/// Pixels along the side of a job's tiles, by its crop window and samples per pixel. Every unit
/// costs the farm some milliseconds, and none is larger than a tile with all its samples: 64 where
/// these are few, if the frame is still cut into enough pieces for many threads; else 32. Where
/// films have `splats`: kSplatTile.
int32_t tile_size_of(const core::PixelRect& region, uint32_t samples, bool splats);

int32_t tile_size_of(const ActiveJob& job);

/// A stored job as the wire shows it.
v1::Job describe(const StoredJob& job);

/// Reads what `stored` says out of `files`; an error holds every complaint about the document, or
/// says that the film of a frame takes more than `film_memory` bytes.
core::Result<std::unique_ptr<ActiveJob>> make_active_job(const StoredJob& stored,
                                                         const v1::JobSpec& spec,
                                                         farm::ContentStore& assets,
                                                         uint64_t film_memory);

/// The records of a spec's files; an error where they are not what the wire allows.
core::Result<std::vector<core::AssetRecord>> files_of(const v1::JobSpec& spec);

}  // namespace hyades::coordinator
