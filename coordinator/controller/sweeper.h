#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

#include "coordinator/controller/controller_context.h"
#include "coordinator/controller/unclaimed_files.h"

namespace hyades::coordinator {

/// Removes what nobody needs any more from the disk: folders of jobs that are gone, and files that
/// no job needs.
class Sweeper {
 public:
  Sweeper(ControllerContext& context, UnclaimedFiles& unclaimed);
  /// Sweeps from now on, from time to time, until end().
  void start();
  void end() {
    rounds_.end();
    leftovers_.end();
  }
  /// Tells that a job has gone: what is left of it goes too, in pieces and turns of owners, and
  /// what it needed may not be needed any more. Never waits.
  void job_removed(uint64_t job, const std::string& owner);

 private:
  void drop_rows();
  void drop_folders(uint64_t job, const std::string& owner);
  bool sweep_folders();
  bool sweep_folders(const std::vector<uint64_t>& jobs, bool of_films);
  core::Status sweep_assets(Duration grace);
  core::Status spare_needed(std::unordered_set<std::string>& names, uint64_t& after);

  ControllerContext& context_;
  UnclaimedFiles& unclaimed_;
  std::atomic<uint64_t> changes_{0};  ///< jobs that have gone
  // Of the sweeping thread.
  uint64_t swept_changes_ = UINT64_MAX;  ///< when it last left nothing to remove
  bool folders_swept_ = false;
  TimePoint drop_again_;  ///< of the task that drops rows
  farm::RetryQueue rounds_;
  farm::RetryQueue leftovers_;  ///< a piece at a time, by the job's number, or kRows
};

}  // namespace hyades::coordinator
