#pragma once

#include <cstdint>
#include <optional>
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

  /// Compares one more rendering of a unit that is held, of which `witness` is the witness, with
  /// those that came before. True where it is now known that this one is right and what is held is
  /// wrong.
  bool weigh(ScheduledJob& job, FrameSlot& slot, const Extent& extent, Witness witness,
             const ResultArrived& result);
  /// The job has been restored: films of nobody are suspect where a dispute was open then.
  void restored(ScheduledJob& job, bool disputed);

  /// It is durable that the tile's films are void: they are taken out of the frame's, if the tile
  /// is suspect still.
  void persisted(const TileVoidedRecord& record);
  /// What the job's log says of its films is durable.
  void persisted(const DisputeRecord& record);
  /// It is durable who is divergent, and what that one had a part in.
  void persisted(const DivergentWorkerRecord& record);

  /// Whether a record that could not be made durable is worth another try. Not one that voids a
  /// tile whose frame has begun again since: the films that it has now are new.
  bool still_wanted(const Record& record) const;
  /// When end_marks() may have something to do next.
  std::optional<TimePoint> next_wake() const;
  /// Where a job's disputes are over, and all that followed from them, its log is told that its
  /// films are right.
  void end_marks();

 private:
  bool still_wanted(const TileVoidedRecord& record) const;
  void decide(ScheduledJob& job, FrameSlot& slot, const Dispute& dispute,
              const ResultArrived& result);
  void confirm(const ScheduledJob& job, const FrameSlot& slot, WorkerId worker);
  void suspect_films_of(WorkerId id);
  void suspect_frame(ScheduledJob& job, FrameSlot& slot);
  void mark_disputed(ScheduledJob& job);
  static bool has_dispute(const ScheduledJob& job);
  bool any_suspect();

  Step& step_;
  ScheduledJobs& jobs_;
  Leases& leases_;
  PendingRecords& records_;
  FrameLifecycle& frames_;
  WorkerLifecycle& workers_;
  std::set<JobId> marked_;          ///< jobs with a mark of a dispute; some may have ended
  uint32_t divergent_records_ = 0;  ///< DivergentWorkerRecords that are not durable yet
  TimePoint next_look_;             ///< of end_marks()
  bool distrust_restored_ = false;  ///< a dispute was open before the restart
};

}  // namespace hyades::coordinator
