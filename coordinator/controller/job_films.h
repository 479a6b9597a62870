#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/result_check.h"

namespace hyades::coordinator {

class DivergentWorkers;

/// What the scheduler wants to be durable, above all the films of jobs: each job's film store makes
/// them so, and merges them.
class JobFilms {
 public:
  JobFilms(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs,
           DivergentWorkers& divergent)
      : context_(context), dispatcher_(dispatcher), jobs_(jobs), divergent_(divergent) {}

  /// Makes a record durable; the scheduler hears when it is, or that it cannot be. `delivery`: the
  /// result that the record is of, where it is a unit's.
  void persist(const Persist& persist, Delivery* delivery) HYADES_REQUIRES(state_lock);
  /// Has the film of a frame set aside; the scheduler hears whether it is.
  void set_aside(const SetAside& aside, Turn& turn) HYADES_REQUIRES(state_lock);
  /// A store of the job's films, not opened yet. `resume`: it continues with those that are there,
  /// instead of removing them.
  std::unique_ptr<FilmStore> make(ActiveJob& active, bool resume) HYADES_REQUIRES(state_lock);

 private:
  class Listener;
  FilmStore& of(ActiveJob& active) HYADES_REQUIRES(state_lock);
  bool open(JobId job) HYADES_EXCLUDES(state_lock);
  void restart_frame(const ActiveJob& active, RecordId id, const FrameRestartedRecord& again)
      HYADES_REQUIRES(state_lock);
  bool restart_some(JobId job) HYADES_EXCLUDES(state_lock);
  void fail_frame(ActiveJob& active, RecordId id, const FrameFailedRecord& record)
      HYADES_REQUIRES(state_lock);

  // By the film stores' threads.
  void persisted(JobId job, RecordId record) HYADES_EXCLUDES(state_lock);
  void not_persisted(JobId job, RecordId record, const std::string& reason)
      HYADES_EXCLUDES(state_lock);
  void outgrown(JobId job, int32_t frame, const std::string& reason) HYADES_EXCLUDES(state_lock);
  void storage_failed(JobId job, const std::string& reason) HYADES_EXCLUDES(state_lock);

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  DivergentWorkers& divergent_;
  struct Restart {
    RecordId id;
    FrameRestartedRecord record;
  };
  /// Frames that begin again once that is stored.
  std::map<JobId, std::deque<Restart>> restarts_ HYADES_GUARDED_BY(state_lock);
};

}  // namespace hyades::coordinator
