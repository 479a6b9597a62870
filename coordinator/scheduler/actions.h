#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/scheduler/ids.h"
#include "coordinator/scheduler/job_plan.h"

namespace hyades::coordinator {

// What the scheduler wants done, in this order. Its driver does it and reports back with events.

/// Make room for the frame's film; answered by FrameOpened or FrameRefused.
struct OpenFrame {
  JobId job{};
  int32_t frame = 0;
};

/// Nobody works at the frame, and its film is in the way of others: put it where it takes no
/// memory, to be fetched back when something is merged with it. Answered by FilmSetAside.
struct SetAside {
  JobId job{};
  int32_t frame = 0;
};

/// These units, all of one frame, are the worker's until the deadline.
struct Lease {
  WorkerId worker{};
  LeaseId lease;
  JobId job{};
  std::vector<core::Unit> units;
  TimePoint deadline;
  bool adopted = false;  ///< the worker holds them already, under an older lease
};

/// The worker shall stop rendering the unit: nobody waits for it any more.
struct Revoke {
  WorkerId worker{};
  LeaseId lease;
  JobId job{};
  core::Unit unit;
  bool expired = false;  ///< the lease was not renewed in time
};

// Records: what is to be durable.

/// The film of the unit.
struct UnitRecord {
  JobId job{};
  AcceptedUnit accepted;
};
/// The frame's outputs are there; its films are not needed any more.
struct FrameFinishedRecord {
  JobId job{};
  int32_t frame = 0;
};
/// The frame is given up.
struct FrameFailedRecord {
  JobId job{};
  FailedFrame failed;
};
/// All films of the frame before this record are void.
struct FrameRestartedRecord {
  JobId job{};
  int32_t frame = 0;
};
/// All films of the tile before this record are void: one of them is wrong, or may be.
struct TileVoidedRecord {
  JobId job{};
  int32_t frame = 0;
  core::PixelRect tile;
};
/// Whether films of the job may be wrong: two renderings of a unit differ, or they did and what the
/// divergent worker did is not void yet. The latest record counts.
struct DisputeRecord {
  JobId job{};
  bool open = true;
};
/// The worker rendered a unit of this frame to other bits than two others did: what it had a part
/// in that is finished is suspect, in whatever job. Answered once that is so, and durable; there
/// will be FramesSuspected for jobs that have not ended.
struct DivergentWorkerRecord {
  JobId job{};
  int32_t frame = 0;
  WorkerId worker{};
  std::string reason;
};
using Record =
    std::variant<UnitRecord, FrameFinishedRecord, FrameFailedRecord, FrameRestartedRecord,
                 TileVoidedRecord, DisputeRecord, DivergentWorkerRecord>;

/// Make this durable; answered by Persisted or PersistFailed. For a unit that means the film that
/// came with the result now being handled.
struct Persist {
  RecordId id{};
  Record record;
};

/// The film that was persisted under `record` counts: add it to its frame's film.
struct Merge {
  RecordId record{};
  JobId job{};
  core::Unit unit;
};

/// The film is durable: the worker may forget it.
struct Acknowledge {
  WorkerId worker{};
  LeaseId lease;
  JobId job{};
  core::Unit unit;
};

/// All batches that were planned of the tile are merged, or will be once the films are that Merge
/// named before: judge whether it has enough, by them alone. Answered by TileJudged.
struct JudgeTile {
  JobId job{};
  int32_t frame = 0;
  core::PixelRect tile;
  uint32_t batches = 0;  ///< that it has, from the first on
  uint64_t serial = 0;   ///< tells this question from others about the tile
};

/// The tile was found to have enough: it gets no more batches.
struct TileSpared {
  JobId job{};
  int32_t frame = 0;
  core::PixelRect tile;
  uint32_t batches = 0;  ///< that it has
};

enum class RejectReason : uint8_t {
  unknown,    ///< no such job or frame, or the frame is over; the worker drops the film
  malformed,  ///< not a unit of this job; dropped
  overlap,    ///< some of its batches are there already in other extents; dropped
  conflict,   ///< the same extents are there with other bits; dropped (see Conflict)
  not_now,    ///< not made durable, or nothing can be told yet; may be sent again later
};

/// The result does not count.
struct Reject {
  WorkerId worker{};
  LeaseId lease;
  JobId job{};
  core::Unit unit;
  RejectReason reason{};
};

/// Two renderings of one unit differ: a machine is broken, or a unit is not a pure function. Others
/// will render it until two agree.
struct Conflict {
  JobId job{};
  core::Unit unit;
  WorkerId first{};
  WorkerId second{};
};

/// The worker rendered a unit to other bits than two others did, who agree; or it failed unit after
/// unit that others could render. Nothing it says is believed, and it gets nothing, until
/// WorkerBarred ends that.
struct Quarantine {
  WorkerId worker{};
  std::string reason;
};

/// Another worker of its class rendered a unit of the frame to the same bits as this one.
struct Confirmed {
  WorkerId worker{};
  JobId job{};
  int32_t frame = 0;
};

/// The films of the tile are void, and that is durable: take out all that the frame's film holds of
/// it. They are rendered again.
struct TileVoided {
  JobId job{};
  int32_t frame = 0;
  core::PixelRect tile;
  std::vector<core::BatchRange> batches;  ///< that counted
  uint32_t spared = 0;                    ///< batches of which it had been found not to need them
};

/// The outputs that FinishFrame asked for do not count: a film is suspect. There will be another
/// FinishFrame.
struct FrameReopened {
  JobId job{};
  int32_t frame = 0;
};

/// Every batch that the frame needs is merged: make its outputs; answered by FinishDone or
/// FinishFailed.
struct FinishFrame {
  JobId job{};
  int32_t frame = 0;
  uint64_t volume = 0;  ///< (pixel, batch) pairs that its film holds
  /// Whose films of it nobody else agreed on, each worker once; 0: somebody's from before a
  /// restart.
  std::vector<WorkerId> unconfirmed;
};

/// The frame's outputs are there, and that is durable: its films may be dropped.
struct FrameDone {
  JobId job{};
  int32_t frame = 0;
};
/// The frame is given up, and that is durable: its films may be dropped.
struct FrameFailed {
  JobId job{};
  int32_t frame = 0;
  std::string reason;
};

/// The frame has begun again from nothing, and that is durable.
struct FrameRestarted {
  JobId job{};
  int32_t frame = 0;
};

/// All frames of the job are over; the scheduler has forgotten it.
struct JobEnded {
  JobId job{};
  uint32_t done = 0;
  uint32_t failed = 0;
  bool cancelled = false;
};

using Action =
    std::variant<OpenFrame, SetAside, Lease, Revoke, Persist, Merge, JudgeTile, TileSpared,
                 Acknowledge, Reject, Conflict, Quarantine, Confirmed, TileVoided, FrameReopened,
                 FinishFrame, FrameDone, FrameFailed, FrameRestarted, JobEnded>;

}  // namespace hyades::coordinator
