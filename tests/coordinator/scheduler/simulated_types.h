#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>

#include "coordinator/scheduler/job_plan.h"
#include "tests/coordinator/scheduler/simulated_disk.h"

namespace hyades::coordinator {

/// Something that will happen at a time; what is earlier, or was planned earlier, comes first.
struct Happening {
  TimePoint when;
  uint64_t serial;
  std::function<void()> what;
  bool operator<(const Happening& o) const {
    return when != o.when ? when > o.when : serial > o.serial;
  }
};

/// The portable class of all workers.
inline const std::string kPortable = "portable";

/// A unit in a worker's hands.
struct UnitHeld {
  JobId job{};
  core::Unit unit;
  LeaseId lease;
  bool rendered = false;
};

struct SimWorker {
  std::string name;
  int threads = 1;
  double slowness = 1;
  bool connected = false;
  uint64_t session = 0;
  uint64_t life = 0;  ///< what was begun in an earlier life is lost
  int asked = 0;
  bool corrupt = false;  ///< its films are wrong
  bool broken = false;   ///< it fails whatever it is given
  std::vector<std::string> tags;
  uint64_t memory = 0;
  /// The coordinator (by generation) that found it out; 0: none.
  uint64_t quarantined_by = 0;
  bool known_divergent = false;       ///< ... and that is durable
  std::map<uint64_t, UnitHeld> held;  ///< by order of arrival
};

/// Names a unit within its job: frame, corner of the tile, batches.
using UnitName = std::tuple<int32_t, int32_t, int32_t, uint32_t, uint32_t>;

/// Corner of a tile and the batch, within a frame.
using PlaceOfBatch = std::tuple<int32_t, int32_t, uint32_t>;

/// A batch that has been merged.
struct SimBatch {
  uint64_t value = 0;
  uint8_t corrupted_by = 0;  ///< number of the worker, or 0
  uint64_t generation = 0;   ///< of the coordinator that took it; 0: an earlier one
};

/// What the merger holds of a frame, and what shall go wrong with it.
struct SimFrame {
  std::map<PlaceOfBatch, SimBatch> batches;  ///< that have been merged
  uint64_t sum = 0;
  core::Film film;         ///< the real one, where the store is
  bool in_memory = false;  ///< there is a real one; it may be aside otherwise
  bool lost = false;       ///< it was aside and could not be read again
  std::string digest;      ///< of the film that is aside
  int asked_aside = 0;     ///< SetAside was said so often and is not answered
  std::string worker_class;
  bool poisoned = false;
  bool refused = false;
  bool unfinishable = false;
  int bad_luck = 2;  ///< failures that may still happen by chance
  bool over = false;
};

/// What the job store has of a finished frame.
struct SimRow {
  std::vector<WorkerId> unconfirmed;  ///< as FinishFrame said
  std::set<uint8_t> corrupted_by;     ///< whose wrong films its outputs show
  bool suspect = false;
};

struct SimJob {
  JobPlan plan;
  std::map<int32_t, SimRow> rows;
  RestoredJob stored;  ///< what the store holds
  std::set<UnitName> stored_units;
  /// What is stored of these is not what another worker has rendered, and has been told so.
  std::vector<core::Unit> disagreed;
  // Where the store is the real one.
  std::unique_ptr<SimulatedDisk> disk;
  std::deque<std::pair<uint64_t, Persist>> appended;  ///< numbers in the log; nobody has heard yet
  uint64_t settled = 0;                               ///< number of the last that somebody has
  uint64_t heard = 0;                                 ///< of the last that is known to be durable
  bool committing = false;                            ///< a group is about to be stored
  std::deque<std::function<void()>> calls;            ///< what its film store is told to do
  bool telling = false;                               ///< which waits until somebody hears it
  std::map<int32_t, SimFrame> frames;
  bool ended = false;
  bool paused = false;
  bool cancelled = false;

  /// Whether the tile has enough with so many batches, where tiles are judged: a pure function of
  /// what is there. Wrong films give wrong answers.
  bool is_enough(int32_t frame, const core::PixelRect& tile, uint32_t batches,
                 bool wrong = false) const {
    const uint64_t place = core::hash_combine(static_cast<uint32_t>(tile.x0), uint32_t(tile.y0));
    const uint64_t h = core::hash_combine(place, core::hash_combine(uint32_t(frame), batches));
    return (h % 3 == 0) != wrong;
  }
  /// How many batches the tile ends with.
  uint32_t batches_of(int32_t frame, const core::PixelRect& tile) const {
    for (const uint32_t round : plan.rounds) {
      if (is_enough(frame, tile, round)) return round;
    }
    return plan.batches;
  }
};

}  // namespace hyades::coordinator
