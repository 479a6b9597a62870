#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/film_store/film_log.h"
#include "coordinator/film_store/film_records.h"
#include "coordinator/film_store/log_files.h"
#include "core/base/result.h"
#include "core/film/film.h"

namespace hyades::coordinator {

/// Films of frames that are not in memory. Those of an earlier run stay where they are in the log;
/// others get a file of their own, for this run alone and never synced: the log holds their units
/// as well.
class FilmsAside {
 public:
  /// `folder`: where files go, of one log alone; `region`: of every frame.
  FilmsAside(LogFiles& files, std::string folder, const core::PixelRect& region)
      : files_(files), folder_(std::move(folder)), region_(region) {}

  /// Removes what an earlier run has left.
  core::Status remove_left();
  /// Writes the frame's film, which is not there yet, tile by tile, as `key` and `worker_class` of
  /// write_film(). On an error nothing is there.
  core::Status put(int32_t frame, const core::Film& film, int32_t tile_size, const FrameKey& key,
                   const std::string& worker_class);
  /// The frame's film is there, as `records` of `log` (LogContents::places).
  void leave(const FilmLog& log, int32_t frame, std::vector<RecordPlace> records);
  /// The log was compacted: the frame's records stand elsewhere now.
  void move(int32_t frame, std::vector<RecordPlace> records);
  /// What became of the frame's film, which is there: a record that comes after its own.
  void add(int32_t frame, std::vector<std::byte> record);
  /// Whether the frame's film is there.
  bool contains(int32_t frame) const { return frames_.contains(frame); }
  /// A copy of the frame's film, which stays; null where it holds nothing.
  core::Result<std::shared_ptr<core::Film>> read(int32_t frame) const;
  /// Whether what read() could not read is damaged, and so lost.
  bool is_damaged() const { return damaged_; }
  /// Gives the records of the frame's film, which stays, to `take`, one at a time.
  core::Status copy(int32_t frame, const FilmLog::Sink& take) const;
  /// The frame's film goes, if it is there.
  void remove(int32_t frame);
  void remove_all();
  /// What is known of a film that is there.
  struct Put {
    uint64_t bytes = 0;               ///< of its file
    bool too_large = false;           ///< for a record of the log, it may be
    std::vector<RecordPlace> places;  ///< in the log; none: it has a file
    /// What was added since it was put or moved there.
    std::vector<std::vector<std::byte>> added;
  };
  /// The frames whose films are there.
  const std::map<int32_t, Put>& frames() const { return frames_; }

 private:
  std::string path(int32_t frame) const;
  core::Status copy_log(const Put& put, const FilmLog::Sink& take) const;
  core::Status copy_file(int32_t frame, const Put& put, const FilmLog::Sink& take) const;

  LogFiles& files_;
  const std::string folder_;
  const core::PixelRect region_;
  std::map<int32_t, Put> frames_;
  const FilmLog* log_ = nullptr;  ///< where films have places
  mutable bool damaged_ = false;
};

}  // namespace hyades::coordinator
