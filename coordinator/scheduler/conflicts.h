#pragma once

#include <cstdint>
#include <set>

#include "coordinator/scheduler/frame_lifecycle.h"
#include "coordinator/scheduler/worker_lifecycle.h"

namespace hyades::coordinator {

/// Renderings of one unit that differ: others decide who is divergent, and what that one did is
/// done again.
class Conflicts {
 public:
  Conflicts(Step& step, ScheduledJobs& jobs, Leases& leases, PendingRecords& records,
            FrameLifecycle& frames, WorkerLifecycle& workers)
      : step_(step),
        jobs_(jobs),
        leases_(leases),
        records_(records),
        frames_(frames),
        workers_(workers) {}

  /// One more answer for a unit that is held. True where it is now known that it is right and what
  /// is held is wrong.
  bool weigh(ScheduledJob& job, FrameSlot& slot, const Extent& extent, const ResultArrived& result);
  /// The job has been restored: films of nobody are suspect where a dispute was open then.
  void restored(ScheduledJob& job, bool disputed);

  // These are durable.
  void persisted(const TileVoidedRecord& record);
  void persisted(const DisputeRecord& record);
  void persisted(const DivergentWorkerRecord& record);

  /// Whether a record that could not be made durable still says something: a tile that has begun
  /// again with its frame must not be voided once more, for its films are new.
  bool still_wanted(const Record& record) const;
  /// Says of jobs whose disputes are over, and all that followed from them, that their films are
  /// right.
  void end_marks();

 private:
  void decide(ScheduledJob& job, FrameSlot& slot, const Dispute& dispute,
              const ResultArrived& result);
  void confirm(const ScheduledJob& job, const FrameSlot& slot, WorkerId worker);
  void suspect_films_of(WorkerId id);
  void suspect_frame(ScheduledJob& job, FrameSlot& slot);
  void mark_disputed(ScheduledJob& job);
  static bool has_dispute(const ScheduledJob& job);
  bool any_suspect() const;

  Step& step_;
  ScheduledJobs& jobs_;
  Leases& leases_;
  PendingRecords& records_;
  FrameLifecycle& frames_;
  WorkerLifecycle& workers_;
  std::set<JobId> marked_;          ///< jobs with a mark of a dispute; some may have ended
  uint32_t divergent_records_ = 0;  ///< DivergentWorkerRecords that are not durable yet
  bool distrust_restored_ = false;  ///< a dispute was open before the restart
};

}  // namespace hyades::coordinator
