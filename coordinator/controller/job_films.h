#pragma once

#include <memory>
#include <string>

#include "coordinator/controller/delivery.h"
#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/shared.h"

namespace hyades::coordinator {

class DivergentWorkers;

/// What the scheduler wants to be durable, above all the films of jobs: each job's film store makes
/// them so, and merges them.
class JobFilms {
 public:
  JobFilms(Shared& shared, Dispatcher& dispatcher, JobTable& jobs, DivergentWorkers& divergent)
      : shared_(shared), dispatcher_(dispatcher), jobs_(jobs), divergent_(divergent) {}

  /// For the scheduler's action. `delivery`: the result that it handles, where the record is a
  /// unit's.
  void persist(const Persist& persist, Delivery* delivery) HYADES_REQUIRES(state_lock);
  /// A store of the job's films, not opened yet.
  std::unique_ptr<FilmStore> make(ActiveJob& active, bool resume);

 private:
  class Owner;
  FilmStore& of(ActiveJob& active) HYADES_REQUIRES(state_lock);
  bool open(JobId job) HYADES_EXCLUDES(state_lock);
  void restart_frame(RecordId id, const FrameRestartedRecord& again) HYADES_REQUIRES(state_lock);
  void fail_frame(ActiveJob& active, RecordId id, const FrameFailedRecord& record)
      HYADES_REQUIRES(state_lock);

  // By the film stores' threads.
  void persisted(JobId job, RecordId record) HYADES_EXCLUDES(state_lock);
  void not_persisted(JobId job, RecordId record, const std::string& reason)
      HYADES_EXCLUDES(state_lock);
  void storage_failed(JobId job, const std::string& reason) HYADES_EXCLUDES(state_lock);

  Shared& shared_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  DivergentWorkers& divergent_;
};

}  // namespace hyades::coordinator
