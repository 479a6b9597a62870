#pragma once

#include "coordinator/scheduler/conflicts.h"

namespace hyades::coordinator {

/// Units that come back: rendered, failed or returned; and films that became durable or did not.
class Results {
 public:
  Results(Step& step, ScheduledJobs& jobs, ScheduledWorkers& workers, FilmBudget& films,
          Leases& leases, PendingRecords& records, Affinity& affinity, FrameLifecycle& frames,
          WorkerLifecycle& lifecycle, Conflicts& conflicts)
      : step_(step),
        jobs_(jobs),
        workers_(workers),
        films_(films),
        leases_(leases),
        records_(records),
        affinity_(affinity),
        frames_(frames),
        lifecycle_(lifecycle),
        conflicts_(conflicts) {}

  void on(const ResultArrived& e);
  void on(const UnitReturned& e);
  void on(const UnitFailed& e);
  void on(const Persisted& e);
  void on(const PersistFailed& e);

 private:
  void reject(const ResultArrived& e, RejectReason reason);
  void dispute(ScheduledJob& job, FrameSlot& slot, const Extent& extent, const HeldRecord& held,
               Witness witness, const ResultArrived& e);
  void answer_again(ScheduledJob& job, FrameSlot& slot, const Extent& extent,
                    const HeldRecord& held, Witness witness, const ResultArrived& e);
  void accept(ScheduledJob& job, FrameSlot& slot, const Extent& extent, Worker& worker,
              const ResultArrived& e);
  bool hopeless(const ScheduledJob& job, const FrameSlot& slot, const Extent& extent) const;
  static void learn_cost(ScheduledJob& job, const Extent& extent, Duration render_time);
  void unit_persisted(const UnitRecord& record, const PendingRecord& pending, RecordId id);

  Step& step_;
  ScheduledJobs& jobs_;
  ScheduledWorkers& workers_;
  FilmBudget& films_;
  Leases& leases_;
  PendingRecords& records_;
  Affinity& affinity_;
  FrameLifecycle& frames_;
  WorkerLifecycle& lifecycle_;
  Conflicts& conflicts_;
};

}  // namespace hyades::coordinator
