#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/job_store/job_store.h"
#include "coordinator/sql/connection.h"

namespace hyades::coordinator {

// Jobs and what they ask for, as rows; JobStore says what each of these means.

/// Adds the job and its spec, and returns its id; within a transaction. `old_columns`: whether the
/// table has those of the first schemas, which nobody reads.
core::Result<uint64_t> insert_job(SqlConnection& db, const StoredJob& job, bool old_columns);
/// Stores all of the job that changes.
core::Status update_job_row(SqlConnection& db, const StoredJob& job);

/// The id of the job with this key; nothing where there is none.
core::Result<std::optional<uint64_t>> find_key(SqlConnection& db, const std::string& key);
/// The job without its spec; nothing where there is none.
core::Result<std::optional<StoredJob>> read_summary(SqlConnection& db, uint64_t id);
/// The job; nothing where there is none.
core::Result<std::optional<StoredJob>> read_job(SqlConnection& db, uint64_t id);
/// Nothing where there is no such job.
core::Result<std::optional<StoredState>> read_state(SqlConnection& db, uint64_t id);
/// The ids of jobs that have not ended, oldest first.
core::Result<std::vector<uint64_t>> read_open_jobs(SqlConnection& db);
/// Jobs with ids below `before` (0: all), the newest first, without their specs.
core::Result<std::vector<StoredJob>> read_jobs(SqlConnection& db, bool ended,
                                               const std::string& owner, uint64_t before,
                                               uint32_t limit);
/// Specs of jobs above `after`, the oldest first: one at least where there is any, and no others
/// once they have `most_bytes` together.
core::Result<std::vector<StoredSpec>> read_specs(SqlConnection& db, uint64_t after,
                                                 uint64_t most_bytes);
/// Nanoseconds that threads took for the owner's jobs since then, to the hour.
core::Result<uint64_t> read_core_ns(SqlConnection& db, const std::string& owner, int64_t since_ms);

}  // namespace hyades::coordinator
