#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "coordinator/job_store/job_store.h"
#include "coordinator/sql/connection.h"

namespace hyades::coordinator {

/// The lines of jobs' logs, as rows: the newest kMostLines of each job. Not thread-safe.
class LogRows {
 public:
  /// Adds lines to the job's log and drops the oldest where there are too many; within a
  /// transaction. Where that fails, forget_counts() has to follow.
  core::Status add(SqlConnection& db, uint64_t job, const std::vector<StoredLine>& lines);
  /// The lines of all jobs are counted anew when they are next added to: a transaction was rolled
  /// back, or a job is gone.
  void forget_counts() { counts_.clear(); }

 private:
  core::Status drop_old(SqlConnection& db, uint64_t job, uint64_t added);

  std::map<uint64_t, uint64_t> counts_;  ///< of jobs that had lines lately
};

/// Lines of the job's log behind number `after`, the oldest first, at most `limit`.
core::Result<std::vector<StoredLine>> read_lines(SqlConnection& db, uint64_t job, uint64_t after,
                                                 uint32_t limit);

}  // namespace hyades::coordinator
