#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/scheduler/ids.h"
#include "coordinator/scheduler/job_plan.h"

namespace hyades::coordinator {

// What happens to the scheduler. Events may come late, twice, or from workers and jobs that are
// gone: every one of them is answered or ignored, none is trusted.

// Jobs.

/// A new job, or after a restart one that was there before. The id has not been used.
struct JobAdded {
  JobId job{};
  JobPlan plan;
  RestoredJob restored;
};
/// Nothing more of the job is leased until JobResumed. What is out goes on, and counts.
struct JobPaused {
  JobId job{};
};
/// A paused job goes on.
struct JobResumed {
  JobId job{};
};
/// The job ends at once: what is out is taken back. Answered by JobEnded.
struct JobCancelled {
  JobId job{};
};
/// The job has another priority from now on; higher goes first.
struct JobReprioritised {
  JobId job{};
  int priority = 0;
};
/// The job's failed frames are to be rendered again, from their beginning.
struct FramesRetried {
  JobId job{};
};

/// A worker that had a part in these finished frames was found divergent: they are to be rendered
/// again, from their beginning.
struct FramesSuspected {
  JobId job{};
  std::vector<int32_t> frames;
};

// Frames: answers to OpenFrame and FinishFrame.

/// There is room for the frame's film (and, on a single machine, its scene is loaded).
struct FrameOpened {
  JobId job{};
  int32_t frame = 0;
};
/// The frame cannot be rendered at all, or not to its end.
struct FrameRefused {
  JobId job{};
  int32_t frame = 0;
  std::string reason;
};
/// The answer to SetAside: whether the film takes no memory any more. It is told before anything
/// else is done with the job's films, so that it is true when it is heard, whichever SetAside it
/// answers.
struct FilmSetAside {
  JobId job{};
  int32_t frame = 0;
  bool done = false;
};
/// The frame's outputs are written and durable.
struct FinishDone {
  JobId job{};
  int32_t frame = 0;
};
/// The frame's outputs could not be made; tried again as often as JobPlan::max_attempts allows.
struct FinishFailed {
  JobId job{};
  int32_t frame = 0;
  std::string reason;
};

/// The answer to JudgeTile: whether the tile has batches enough.
struct TileJudged {
  JobId job{};
  int32_t frame = 0;
  core::PixelRect tile;
  uint64_t serial = 0;  ///< of the question
  bool enough = false;
};

// Workers.

/// A unit that a worker holds from a lease, rendered or not.
struct UnitInHand {
  LeaseId lease;
  JobId job{};
  core::Unit unit;
};

/// A worker connects. One that was known under this id is taken for lost first. What it declares in
/// hand is adopted under a new lease where nobody else has it, and revoked otherwise.
struct WorkerJoined {
  WorkerId worker{};
  uint32_t threads = 1;
  std::string worker_class;
  std::vector<UnitInHand> in_hand;
  std::vector<std::string> tags = {};
  uint64_t memory = 0;  ///< bytes for scenes; 0: it knows no limit
  /// By what it was let in: workers of one credential count as one witness. Empty: nobody else has
  /// its own.
  std::string credential = {};
  /// Names the token or pool that the worker came by, which can bring any number of workers. Empty:
  /// as `credential` says.
  std::string origin = {};
  std::string portable_class = {};  ///< empty: it renders nothing in the portable class
};

/// The worker can take `units` more. The wish stands until it is fulfilled.
struct WorkRequested {
  WorkerId worker{};
  uint32_t units = 1;
};

/// Nothing is leased (the disk is nearly full, say) until it is told again with `held` = false.
/// Requests stand; what is out goes on.
struct LeasingHeld {
  bool held = false;
};

/// Somebody looks at the frame while it is rendered: for some seconds no tile gets ahead of the
/// others by more than twice the samples, so that the whole picture refines.
struct FrameWatched {
  JobId job{};
  int32_t frame = 0;
};

/// The worker is alive and still works on these leases: they are renewed. One that it does not
/// name runs out, whatever became of it.
struct WorkerAlive {
  WorkerId worker{};
  std::vector<LeaseId> leases;
};

/// A film arrived and waits to be made durable. `unit` may be a part of the leased one (a worker
/// that drains); that ends the lease of this unit, and what is missing is leased again.
struct ResultArrived {
  WorkerId worker{};
  LeaseId lease;
  JobId job{};
  core::Unit unit;
  Digest digest{};
  Duration render_time{0};  ///< of one thread; 0 where it was not measured
};

/// Rendering the unit failed for a reason that lies in the unit.
struct UnitFailed {
  WorkerId worker{};
  LeaseId lease;
  JobId job{};
  core::Unit unit;
  std::string reason;
};

/// The worker gives a unit back unrendered. No blame.
struct UnitReturned {
  WorkerId worker{};
  LeaseId lease;
  JobId job{};
  core::Unit unit;
};

/// The worker gets no more units (it drains, or is in quarantine), or gets some again. What it has
/// stays its own. Ends when it joins again.
struct WorkerBarred {
  WorkerId worker{};
  bool barred = true;
  bool pardoned = false;  ///< its quarantine has ended, even where it stays barred
};

/// The worker is gone. No blame. Whoever watches the connections must not report the loss of an old
/// one after the worker has joined again.
struct WorkerLost {
  WorkerId worker{};
};

/// The worker is gone for good: nobody will come under this id any more.
struct WorkerForgotten {
  WorkerId worker{};
};

// The store: answers to Persist.

/// The record is durable.
struct Persisted {
  RecordId record{};
};
/// The record could not be made durable. A unit's film is lost; other records are tried again.
struct PersistFailed {
  RecordId record{};
  std::string reason;
};

/// Nothing but time has passed.
struct Tick {};

using Event =
    std::variant<JobAdded, JobPaused, JobResumed, JobCancelled, JobReprioritised, FramesRetried,
                 FramesSuspected, FrameOpened, FrameRefused, FilmSetAside, FinishDone, FinishFailed,
                 TileJudged, WorkerJoined, WorkRequested, LeasingHeld, FrameWatched, WorkerAlive,
                 ResultArrived, UnitFailed, UnitReturned, WorkerBarred, WorkerLost, WorkerForgotten,
                 Persisted, PersistFailed, Tick>;

}  // namespace hyades::coordinator
