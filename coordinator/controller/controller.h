#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/controller_options.h"
#include "coordinator/controller/diagnosis.h"
#include "coordinator/controller/disk_watch.h"
#include "coordinator/controller/farm_control.h"
#include "coordinator/controller/job_intake.h"
#include "coordinator/controller/job_queries.h"
#include "coordinator/controller/job_steering.h"
#include "coordinator/controller/owner_connections.h"
#include "coordinator/controller/owner_quotas.h"
#include "coordinator/controller/unclaimed_files.h"
#include "coordinator/controller/video_maker.h"
#include "coordinator/controller/watchers.h"
#include "coordinator/controller/worker_sessions.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// The coordinator without its network: the scheduler, and everything that happens because of it,
/// each subject in a part of its own.
///
/// One lock (state_lock) guards the scheduler and what the parts know of jobs and workers; every
/// event is handled and its messages are queued under it, so that what workers are told has one
/// order. Nothing slow happens under it: films are decoded before (by the thread that received
/// them), made durable and merged by each job's FilmStore, finished by a process; what changes in a
/// job's rows is stored in the background. Thread-safe.
class Controller {
 public:
  /// Opens the folder and recovers all jobs that have not ended; a job whose files are gone fails
  /// alone. Jobs are kept in `store` and their films in `films`, or, where these are null, in the
  /// folder. An error where another process has the folder, or a newer version has written it.
  static core::Result<std::unique_ptr<Controller>> open(const ControllerOptions& options,
                                                        std::unique_ptr<JobStore> store = nullptr,
                                                        std::unique_ptr<FilmLogs> films = nullptr);

  /// Stops at once: all that was promised is durable.
  ~Controller();
  /// Ends all workers' streams, and starts nothing more; to be called before the server ends.
  void stop();

  WorkerSessions& workers();
  FarmControl& farm();
  JobIntake& jobs();
  JobSteering& steering();
  JobQueries& queries();
  Diagnosis& diagnosis();
  VideoMaker& videos();
  Watchers& watchers();
  DiskWatch& disk();

  /// What owners may have, and what of it is counted where it comes in.
  const OwnerQuotas& quotas() const;
  UnclaimedFiles& unclaimed();
  OwnerConnections& connections();

  /// When it last looked at all that time brings: many times a second, unless something holds its
  /// lock.
  TimePoint last_turn() const;

  /// What is counted, by the controller and by its callers.
  Meters& meters();
  farm::ContentStore& assets();
  JobStore& store();
  /// Where the job's finished files lie.
  std::string output_folder(uint64_t job) const;

 private:
  struct Parts;
  explicit Controller(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace hyades::coordinator
