#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/job_table.h"
#include "farm/retry_queue.h"

namespace hyades::coordinator {

class JobStarter;

/// Whether the job's file is among the assets, whole.
bool is_stored(const v1::JobFile& file, farm::ContentStore& assets);

/// What stands in the way of a job that is read again.
enum class Obstacle {
  none,
  others_are_read,  ///< the documents of others, and it may come again
  passing,          ///< perhaps: a full disk, or one that does not answer
  lasting,          ///< its record is damaged, its files are gone, or what they say is not allowed
};

/// A stored job that was read again and that nobody else knows yet; an error where there is an
/// obstacle.
struct JobRead {
  core::Result<std::unique_ptr<ActiveJob>> job;
  Obstacle obstacle = Obstacle::none;
};

/// Brings jobs back into memory: those that were open when the coordinator ended, and those that
/// are reopened.
class JobRecovery {
 public:
  JobRecovery(ControllerContext& context, JobTable& jobs, JobStarter& starter)
      : context_(context), jobs_(jobs), starter_(starter) {}

  /// Waits for what is in work.
  void end() { queue_.end(); }

  /// Recovers all jobs that have not ended, in the background; waits for them, but no longer than
  /// ControllerOptions::recovery_time. One whose files are gone fails alone; one that cannot be
  /// recovered now, or cannot be stored as failed, waits and is tried again. An error where the
  /// store does not tell which jobs there are.
  core::Status recover_all() HYADES_EXCLUDES(state_lock);
  /// Reads the job, as it is stored, with its document, which may take seconds.
  JobRead read(uint64_t id) HYADES_EXCLUDES(state_lock);
  /// Recovers the job, which was read before, as it is stored by now; its log says `told`.
  core::Status recover(uint64_t id, JobRead read, const std::string& told)
      HYADES_EXCLUDES(state_lock);

 private:
  bool recover_later(uint64_t id) HYADES_EXCLUDES(state_lock);
  core::Result<bool> try_to_recover(uint64_t id) HYADES_EXCLUDES(state_lock);
  void recover_in_background(uint64_t id) HYADES_EXCLUDES(state_lock);
  core::Status give_up(uint64_t id, const core::Error& why);
  std::optional<bool> lacks_files(const v1::JobSpec& spec) HYADES_EXCLUDES(state_lock);
  core::Status restore(ActiveJob& active, StoredJob now, const std::string& told,
                       std::optional<RestoredJob>& restored) HYADES_EXCLUDES(state_lock);
  // Of a job that nobody else knows yet: see NotSharedYet.
  core::Result<std::vector<StoredFrame>> frames_over(ActiveJob& active) const
      HYADES_REQUIRES(state_lock);
  core::Result<RestoredJob> restore_frames(ActiveJob& active) HYADES_REQUIRES(state_lock);
  core::Result<std::vector<StoredOutput>> lost_outputs(uint64_t id) const;
  core::Result<std::set<int32_t>> frames_to_repeat(const ActiveJob& active,
                                                   const std::vector<StoredFrame>& frames);
  core::Status repeat_for_videos(const ActiveJob& active, const std::vector<int32_t>& done,
                                 std::set<int32_t>& repeated);

  ControllerContext& context_;
  JobTable& jobs_;
  JobStarter& starter_;
  core::Mutex mutex_;
  core::CondVar tried_;
  size_t not_tried_ HYADES_GUARDED_BY(mutex_) = 0;  ///< of recover_all()'s
  /// Jobs that wait, by their ids: of each owner one after the other.
  farm::RetryQueue queue_{4};
};

}  // namespace hyades::coordinator
