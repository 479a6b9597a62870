#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "coordinator/film_store/film_log.h"
#include "coordinator/scheduler/actions.h"
#include "coordinator/scheduler/job_plan.h"
#include "core/base/hash.h"
#include "core/base/rect.h"
#include "core/film/film.h"

namespace hyades::coordinator {

// The records of a film log, of a run on this machine or of a job of a farm. docs/film-log.md
// describes the log, which does not know them.

/// Hash of what decides a frame's pixels: films of different keys are never merged.
using FrameKey = core::Sha256;

/// What the log of every run begins with: how the frames are cut. Where the region differs from run
/// to run (another crop), one stands before the films of each.
struct CutRecord {
  core::PixelRect region;
  int32_t tile_size = 0;
  uint32_t samples = 0;
  friend bool operator==(const CutRecord&, const CutRecord&) = default;
};

/// A frame whose outputs are there.
struct FinishedRecord {
  FrameKey key{};
  core::PixelRect region;
};

// The bytes of each kind of record.

std::vector<std::byte> encode_cut(const CutRecord& cut);
/// A film of some tiles and batches of a frame.
std::vector<std::byte> encode_unit(int32_t frame, const FrameKey& key, const core::Film& film);
/// Adds what a record of one frame (a film, or that a tile of it is void) says to the film that
/// those before it made: `whole`, null before the first, with the frame's region as its window.
core::Status merge_record(std::span<const std::byte> record, const core::PixelRect& region,
                          std::shared_ptr<core::Film>& whole);
/// A film as a worker delivered it: `film` is what film_codec.h packed. Of `unit` frame, digest and
/// class are kept; the film says the rest.
std::vector<std::byte> encode_delivered(const AcceptedUnit& unit, const FrameKey& key,
                                        std::span<const std::byte> film);
std::vector<std::byte> encode(const FrameRestartedRecord& record);
std::vector<std::byte> encode(const TileVoidedRecord& record);
std::vector<std::byte> encode(const DisputeRecord& record);
std::vector<std::byte> encode_finished(int32_t frame, const FinishedRecord& finished);

/// What a log holds.
struct LogContents {
  bool empty = true;
  CutRecord cut;  ///< the last; tile_size 0: not found
  /// Of the frames that were asked for: with this key and region; of others: whatever they have.
  std::map<int32_t, FinishedRecord> finished;
  std::map<int32_t, std::shared_ptr<core::Film>> films;  ///< of the other frames, merged
  /// With LogFilter::places, instead of the films: their records, in order, and those of tiles that
  /// became void.
  std::map<int32_t, std::vector<RecordPlace>> places;
  /// The units of these films, where workers delivered them. A digest is zero where it is not known
  /// any more.
  std::map<int32_t, std::vector<AcceptedUnit>> units;
  bool disputed = false;              ///< some of these films may be wrong
  uint64_t bytes = 0;                 ///< of all records
  bool others = false;                ///< there are films of frames that were not asked for
  bool unfinished = false;            ///< there are films of frames that are not finished
  std::vector<std::string> problems;  ///< damage, in words; costs rendering again
  /// Why the films of these frames have other pixels: another key, or another number of samples.
  /// Empty: they have not. Else the films are not to be used.
  std::string other_picture;
};

/// What is wanted of a log.
struct LogFilter {
  std::set<int32_t> frames;
  core::PixelRect region;
  uint32_t samples = 1;
  std::function<FrameKey(int32_t frame)> key;
  /// How many batches a tile has was decided by all of its pixels: of films of another region only
  /// tiles are taken that are the same there.
  bool judged = false;
  /// Films that workers have delivered are not read: it is told where they stand. Those of another
  /// region are refused.
  bool places = false;
};

/// Reads all of `log`, which has just been opened, merging the films of the frames of `filter`;
/// others are skipped. Of films of another region the tiles are taken that lie within both, where
/// the films have no splats. Fails where the log cannot be read.
core::Result<LogContents> read_log(FilmLog& log, const LogFilter& filter);

/// The units that a film holds: its coverage, cut along the tiles; those of a tile stand together.
std::vector<core::Unit> units_of(int32_t frame, const core::Coverage& coverage,
                                 const core::PixelRect& region, int32_t tile_size);

/// Whether a record of all of the film may become longer than a log takes: one with splats is not
/// cut.
bool may_be_too_large(const core::Film& film);

/// Says what a film holds in records, one for each tile. Splats belong to no tile: with them, and
/// what they belong to, it is one record, so that all of it is lost or nothing. `worker_class`: of
/// those who delivered it; empty: nobody did.
core::Status write_film(int32_t frame, const FrameKey& key, const core::Film& film,
                        const CutRecord& cut, const std::string& worker_class,
                        const FilmLog::Sink& sink);

}  // namespace hyades::coordinator
