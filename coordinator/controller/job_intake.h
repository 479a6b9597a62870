#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/dispatcher.h"
#include "coordinator/controller/job_records.h"
#include "coordinator/controller/job_table.h"
#include "coordinator/controller/owner_quotas.h"
#include "coordinator/controller/timeline.h"
#include "coordinator/controller/unclaimed_files.h"

namespace hyades::coordinator {

class DiskWatch;
class JobQueries;
class JobRecovery;
class JobStarter;
struct JobRead;
class Sweeper;
class VideoMaker;

/// Jobs that come, come again and go. All may wait for the disk, and for other submissions up to
/// two seconds. Errors as docs/wire.md has them. Thread-safe.
class JobIntake {
 public:
  JobIntake(ControllerContext& context, Dispatcher& dispatcher, JobTable& jobs, JobQueries& queries,
            JobRecords& records, JobStarter& starter, JobRecovery& recovery, DiskWatch& disk,
            Sweeper& sweeper, Timelines& timelines, VideoMaker& videos, const OwnerQuotas& quotas,
            UnclaimedFiles& unclaimed)
      : context_(context),
        dispatcher_(dispatcher),
        jobs_(jobs),
        queries_(queries),
        records_(records),
        starter_(starter),
        recovery_(recovery),
        disk_(disk),
        sweeper_(sweeper),
        timelines_(timelines),
        videos_(videos),
        quotas_(quotas),
        unclaimed_(unclaimed) {}

  /// Takes in a job, or answers with the one that has come with the same key. `owner_proven`: a
  /// token has shown who the owner is.
  grpc::Status submit(const v1::SubmitRequest& request, bool owner_proven,
                      v1::SubmitResponse& response) HYADES_EXCLUDES(state_lock);
  /// Has failed frames, and suspect ones, rendered again. `then` is called once, perhaps by
  /// another thread: when that is stored, or after half a second with UNAVAILABLE.
  void retry(uint64_t job, const JobReply& then) HYADES_EXCLUDES(state_lock);
  /// Removes a job that has ended, with its outputs and films.
  grpc::Status remove(uint64_t job) HYADES_EXCLUDES(state_lock);

 private:
  grpc::Status take_in(std::unique_ptr<ActiveJob> active, const std::string& owner,
                       v1::SubmitResponse& response, const std::vector<core::AssetRecord>& files)
      HYADES_EXCLUDES(state_lock);
  void note_submission(ActiveJob& active, uint64_t id, const v1::SubmitResponse& response)
      HYADES_EXCLUDES(state_lock);
  std::optional<JobRead> read_ahead(uint64_t id) HYADES_EXCLUDES(state_lock);
  grpc::Status reopen(uint64_t job, std::optional<JobRead> read,
                      std::unique_lock<std::timed_mutex> one, v1::Job& now)
      HYADES_EXCLUDES(state_lock);
  grpc::Status may_reopen(uint64_t id, StoredJob& job) HYADES_EXCLUDES(state_lock);
  core::Status forget(uint64_t job);
  grpc::Status answer_with(uint64_t job, bool existed, v1::SubmitResponse& response)
      HYADES_EXCLUDES(state_lock);
  grpc::Status may_have_one_more(const std::string& owner) HYADES_EXCLUDES(state_lock);
  grpc::Status has_room_for(const std::string& owner, const JobRoom& more) const
      HYADES_EXCLUDES(state_lock);
  grpc::Status files_are_here(const v1::JobSpec& spec);
  grpc::Status wait_until_left(uint64_t job, Duration patience) HYADES_EXCLUDES(state_lock);
  grpc::Status may_remove(uint64_t job, Duration patience) HYADES_EXCLUDES(state_lock);

  ControllerContext& context_;
  Dispatcher& dispatcher_;
  JobTable& jobs_;
  JobQueries& queries_;
  JobRecords& records_;
  JobStarter& starter_;
  JobRecovery& recovery_;
  DiskWatch& disk_;
  Sweeper& sweeper_;
  Timelines& timelines_;
  VideoMaker& videos_;
  const OwnerQuotas& quotas_;
  UnclaimedFiles& unclaimed_;
};

}  // namespace hyades::coordinator
