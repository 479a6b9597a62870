#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/scheduler/ids.h"
#include "coordinator/scheduler/tile_grid.h"
#include "core/base/rect.h"
#include "core/base/render_class.h"
#include "core/film/unit.h"

namespace hyades::coordinator {

/// In which order a job's frames get their samples.
enum class FrameOrder : uint8_t {
  sequential,   ///< one frame after the other
  progressive,  ///< one batch of every frame in flight, then two, four, ...: all can be seen early
};

/// What a worker has to have to get units of a job.
struct JobNeeds {
  std::vector<std::string> tags;                               ///< all of them
  uint64_t memory = 0;                                         ///< bytes for scenes; 0: any
  core::RenderClass render_class = core::RenderClass::native;  ///< in which it can render
  bool any() const {
    return !tags.empty() || memory > 0 || render_class != core::RenderClass::native;
  }
};

/// What the scheduler knows of a job: no light, only how much there is to do and in which order.
struct JobPlan {
  std::vector<int32_t> frames;  ///< in the order in which they are rendered; no number twice
  core::PixelRect region;       ///< the pixels of every frame (the crop window)
  int32_t tile_size = kTile;    ///< pixels; fixed for the life of a job
  uint32_t batches = 1;         ///< of every pixel of every frame, at most
  /// After so many batches of a tile it is judged whether it needs more (JudgeTile); ascending, all
  /// fewer than `batches`. None: every tile gets all.
  std::vector<uint32_t> rounds;
  uint64_t shuffle = 0;  ///< not 0: lease tiles in a random order (tests)

  int priority = 0;   ///< higher goes first
  std::string owner;  ///< owners of one priority share the farm alike

  /// Frames that may be opened, rendered or finished at once: each costs its film's memory. They
  /// are begun with as the workers need them, so a farm wants more of them than one machine.
  uint32_t frames_in_flight = 16;
  uint64_t film_bytes = 0;  ///< that the film of a frame and its FrameLedger take in memory
  FrameOrder order = FrameOrder::sequential;
  /// What a tile's films hold cannot be taken out of a frame's (splats): where one is wrong the
  /// whole frame begins again.
  bool whole_frames = false;
  JobNeeds needs;
  uint32_t max_workers = 0;  ///< that may have units of it at once; 0: no limit
  /// A unit that has failed with so many different workers fails its frame; where fewer are there
  /// that may try: with all of them, and so often in all.
  uint32_t max_attempts = 3;
  uint32_t redundancy = 0;       ///< percent of its units that two witnesses have to render alike
  uint64_t redundancy_seed = 0;  ///< of which units these are: workers must not know it

  /// Batches that every tile gets.
  uint32_t first_batches() const { return rounds.empty() ? batches : rounds.front(); }
};

/// A unit whose film is durable.
struct AcceptedUnit {
  core::Unit unit;
  Digest digest{};
  std::string worker_class;
};

/// A frame that will not be rendered, and why.
struct FailedFrame {
  int32_t frame = 0;
  std::string reason;
};

/// What is known of a job from before a restart.
struct RestoredJob {
  std::vector<int32_t> finished;  ///< frames whose outputs are there
  std::vector<int32_t> failed;
  std::vector<AcceptedUnit> accepted;  ///< of the other frames
  std::vector<int32_t> set_aside;      ///< of these, those whose film takes no memory (SetAside)
  bool disputed = false;               ///< some of them may be wrong (DisputeRecord)
};

}  // namespace hyades::coordinator
