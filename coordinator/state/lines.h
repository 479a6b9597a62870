#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <map>
#include <vector>

#include "coordinator/state/job_store.h"

namespace hyades::coordinator {

/// The lines of jobs' logs, as rows: the newest kMostLines of each job. Not thread-safe.
class LineTable {
 public:
  /// Within a transaction.
  core::Status add(sqlite3* db, uint64_t job, const std::vector<StoredLine>& lines);
  /// The job is gone.
  void forget(uint64_t job) { counts_.erase(job); }

 private:
  core::Status drop_old(sqlite3* db, uint64_t job, uint64_t added);

  std::map<uint64_t, uint64_t> counts_;  ///< of jobs that had lines lately
};

core::Result<std::vector<StoredLine>> read_lines(sqlite3* db, uint64_t job, uint64_t after,
                                                 uint32_t limit);

}  // namespace hyades::coordinator
