#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "coordinator/local/local_plan.h"
#include "coordinator/scheduler/job_plan.h"
#include "coordinator/store/film_log.h"
#include "core/film/film.h"

namespace hyades::coordinator {

// The records of a run's film log. docs/film-log.md describes the log, which does not know them.

/// What every log begins with: how the frames are cut. Version 1.
struct CutRecord {
  core::PixelRect region;
  int32_t tile_size = 0;
  uint32_t samples = 0;
  friend bool operator==(const CutRecord&, const CutRecord&) = default;
};

std::vector<std::byte> encode_cut(const CutRecord& cut);
/// A film of some tiles and batches of a frame.
std::vector<std::byte> encode_unit(int32_t frame, const core::Film& film);
std::vector<std::byte> encode_finished(int32_t frame);

/// What a log holds.
struct LogContents {
  bool empty = true;
  CutRecord cut;  ///< tile_size 0: not found
  std::set<int32_t> finished;
  std::map<int32_t, std::shared_ptr<core::Film>> films;  ///< of the other frames, merged
  std::vector<std::string> problems;  ///< damage, in words; costs rendering again
};

/// Reads all of `log`, which has just been opened, merging the films of `frames`; others are
/// skipped. Fails where the log was written for another cut than `region` and `samples`.
core::Result<LogContents> read_log(FilmLog& log, const core::PixelRect& region, uint32_t samples,
                                   const std::set<int32_t>& frames);

/// The units that a film holds: its coverage, cut along the tiles; those of a tile stand together.
std::vector<core::Unit> units_of(int32_t frame, const core::Film& film,
                                 const core::PixelRect& region, int32_t tile_size);

/// The part of a film within one tile, of which `units` are all that it holds.
core::Film cut_film(const core::Film& film, std::span<const core::Unit> units);

}  // namespace hyades::coordinator
