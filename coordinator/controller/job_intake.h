#pragma once

#include <cstdint>

#include <grpcpp/support/status.h>

#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/shared.h"
#include "coordinator/controller/timeline.h"

namespace hyades::coordinator {

class DiskWatch;
class JobQueries;
class JobRecovery;
class Sweeper;

/// Jobs that come, come again and go. All may wait for the disk, and for other submissions up to
/// two seconds. Errors as docs/wire.md has them. Thread-safe.
class JobIntake {
 public:
  JobIntake(Shared& shared, Dispatcher& dispatcher, JobTable& jobs, JobQueries& queries,
            JobRecovery& recovery, DiskWatch& disk, Sweeper& sweeper, Timelines& timelines)
      : shared_(shared),
        dispatcher_(dispatcher),
        jobs_(jobs),
        queries_(queries),
        recovery_(recovery),
        disk_(disk),
        sweeper_(sweeper),
        timelines_(timelines) {}

  grpc::Status submit(const v1::SubmitRequest& request, bool owner_proven,
                      v1::SubmitResponse& response) HYADES_EXCLUDES(state_lock);
  /// Failed frames, and those in doubt, are rendered again.
  grpc::Status retry(uint64_t job, v1::Job& now) HYADES_EXCLUDES(state_lock);
  /// The job has to have ended.
  grpc::Status remove(uint64_t job) HYADES_EXCLUDES(state_lock);

 private:
  bool has_room_for(const StoredJob& job) const HYADES_EXCLUDES(state_lock);
  grpc::Status files_are_here(const v1::JobSpec& spec);
  grpc::Status wait_until_left(uint64_t job) HYADES_EXCLUDES(state_lock);

  Shared& shared_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  JobQueries& queries_;
  JobRecovery& recovery_;
  DiskWatch& disk_;
  Sweeper& sweeper_;
  Timelines& timelines_;
};

}  // namespace hyades::coordinator
