#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "coordinator/scheduler/frame_ledger.h"
#include "coordinator/scheduler/job_plan.h"
#include "coordinator/scheduler/tile_grid.h"

namespace hyades::coordinator {

/// A frame, by its job and number.
struct FrameId {
  JobId job{};
  int32_t frame = 0;
  friend bool operator==(const FrameId&, const FrameId&) = default;
};

/// How far a frame is.
enum class FramePhase : uint8_t {
  waiting,     ///< not opened yet
  opening,     ///< OpenFrame was said
  rendering,   ///< its units are leased
  finishing,   ///< complete; FinishFrame was said, or will be when its film has room
  closing,     ///< finished or failed; waits for that to be durable
  restarting,  ///< begins again; waits for that to be durable
  returning,   ///< had failed and begins again; likewise, but that very many may be at once
  done,
  failed,
};

/// A frame of a job. Its ledger exists from opening (or restoring) until the frame is over.
struct FrameSlot {
  int32_t frame = 0;
  FramePhase phase = FramePhase::waiting;
  bool film = false;         ///< its film is in memory, or will be with its first unit
  TimePoint film_since;      ///< when it came into memory
  bool leaving = false;      ///< SetAside was said of it and not answered
  TimePoint stays_until;     ///< it could not be set aside: not before this
  bool awaits_film = false;  ///< it is to be finished or judged when its film has room
  uint32_t finish_attempts = 0;
  bool suspect = false;    ///< while it is opened or finished, a worker that had a part was found
                           ///< divergent
  ClassId worker_class{};  ///< of those who render it; 0 until the first unit is leased
  uint64_t assigned_threads = 0;     ///< of the workers that render it
  uint64_t prefetching_threads = 0;  ///< of those that load its scene while they render another
  TimePoint last_leased;
  TimePoint watched_until;  ///< somebody looks at its picture
  /// Since when no worker is there that may render it; nothing where one is.
  std::optional<TimePoint> orphaned;
  /// Since when its class is watched, as it may be somebody's invention, and how many of its
  /// batches were durable then; nothing where it is not.
  struct Watch {
    TimePoint since;
    uint64_t durable = 0;
  };
  std::optional<Watch> watch;
  /// How often it began again for that. Each time it gets twice as long, as its units may be long.
  uint32_t stood_still = 0;
  /// Under which classes, that may be inventions, it stood still or failed: others come first.
  struct Left {
    Origin origin{};
    ClassId worker_class{};
    TimePoint until;  ///< others come first
  };
  std::vector<Left> left;
  std::unique_ptr<FrameLedger> ledger;
  std::string reason;  ///< why it fails, until that is durable

  /// Threads of all workers that have units of it.
  uint64_t threads() const { return assigned_threads + prefetching_threads; }
  /// Whether it has been begun with, or begins again, and that it is over is not durable yet.
  bool in_flight() const {
    return phase != FramePhase::waiting && phase != FramePhase::returning &&
           phase != FramePhase::done && phase != FramePhase::failed;
  }
  /// Whether it takes no films any more.
  bool over() const {
    return phase == FramePhase::closing || phase == FramePhase::restarting ||
           phase == FramePhase::returning || phase == FramePhase::done ||
           phase == FramePhase::failed;
  }
};

/// What a job's log says of its films (DisputeRecord).
enum class DisputeMark : uint8_t {
  none,
  opening,  ///< will say that they may be wrong, once that is durable
  open,
  ending,  ///< will say that they are right
};

struct FairShare;
struct ScheduledJob;
struct Worker;

/// What a job asks of workers.
struct Needs {
  std::vector<TagId> tags;  ///< all of them; sorted
  uint64_t memory = 0;      ///< 0: any
  core::RenderClass render_class = core::RenderClass::native;
  auto operator<=>(const Needs&) const = default;

  /// Whether a worker has that; of memory 0: it knows no limit.
  bool are_met(const Worker& worker) const;
};

/// Jobs that ask the same of workers, and how many workers have that.
struct NeedsGroup {
  uint64_t serial = 0;
  Needs needs;
  std::map<JobId, ScheduledJob*> jobs;
  uint64_t workers = 0;
};

/// A job that has not ended: its plan, its frames, and what their rendering has shown so far.
struct ScheduledJob {
  JobId id{};
  uint64_t serial = 0;         ///< order of arrival
  FairShare* share = nullptr;  ///< of its owner at its priority
  JobPlan plan;
  NeedsGroup* group = nullptr;  ///< with those that ask the same of workers
  TileGrid grid;
  std::vector<FrameSlot> slots;                     ///< in the order of plan.frames
  std::unordered_map<int32_t, uint32_t> by_number;  ///< frame number -> slot; never walked
  std::vector<uint32_t> in_flight;                  ///< slots, in order
  size_t next_slot = 0;                             ///< before it nothing waits
  uint64_t waiting = 0;                             ///< frames that do
  uint64_t running = 0;                             ///< leased units
  std::map<WorkerId, uint32_t> workers;             ///< how many leases each has
  bool paused = false;
  bool ready = false;  ///< listed among those that have work for some worker
  uint64_t offer = 0;  ///< free batches and disputed units when it was last looked at

  /// Of failed frames that begin again some at a time: the slot from which on they are looked for;
  /// nothing where none are.
  std::optional<size_t> bring_back_from;
  uint32_t returning = 0;  ///< frames that do, until that is durable

  DisputeMark mark = DisputeMark::none;

  uint32_t frames_done = 0;
  uint32_t frames_failed = 0;

  /// Measured seconds of one thread for one batch of a tile, taken over from frame to frame; 0
  /// where nothing is known.
  std::vector<float> tile_cost;
  double mean_cost = 0;
  uint64_t costs_known = 0;  ///< films that told
  double load_seconds = -1;  ///< what it takes to load a scene, measured; -1: not known

  /// Whether all of the frame begins again as soon as what it waits for is over: to be opened, or
  /// to have its outputs made.
  bool begins_again(const FrameSlot& slot) const { return plan.whole_frames && slot.suspect; }

  /// What a batch of the tile takes one thread, as far as is known [s]; 0: nothing is known.
  double batch_seconds(uint32_t tile) const {
    return tile_cost[tile] > 0 ? tile_cost[tile] : mean_cost;
  }

  /// The frame of this number; null where the job has none.
  FrameSlot* slot(int32_t frame) {
    const auto it = by_number.find(frame);
    return it == by_number.end() ? nullptr : &slots[it->second];
  }
  /// The place of one of its slots.
  uint32_t index_of(const FrameSlot& slot) const {
    return static_cast<uint32_t>(&slot - slots.data());
  }

  /// The unit within its frame; nothing where it is none of the job's.
  std::optional<Extent> extent_of(const core::Unit& unit) const {
    const auto tile = grid.index_of(unit.tile);
    const uint64_t end = uint64_t{unit.batches.first} + unit.batches.count;
    if (!tile || unit.batches.count == 0 || end > plan.batches) return std::nullopt;
    return Extent{*tile, unit.batches};
  }
  /// The unit that the extent is in this frame.
  core::Unit unit_of(const FrameSlot& slot, const Extent& extent) const {
    return {slot.frame, grid.tile(extent.tile), extent.batches};
  }
};

/// A frame to get units of.
struct FramePlace {
  ScheduledJob* job = nullptr;
  uint32_t slot = 0;

  FrameSlot& frame() const { return job->slots[slot]; }
  FrameId id() const { return {job->id, frame().frame}; }
};

}  // namespace hyades::coordinator
