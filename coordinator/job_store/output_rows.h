#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/job_store/job_store.h"
#include "coordinator/sql/connection.h"

namespace hyades::coordinator {

// The finished files of jobs, as rows; JobStore says what each of these means.

/// Adds outputs to the job's, in the place of those of the same paths; within a transaction.
core::Status put_outputs(SqlConnection& db, uint64_t job, const std::vector<StoredOutput>& outputs);
/// Forgets outputs with one of these paths, or below it; within a transaction.
core::Status delete_outputs(SqlConnection& db, uint64_t job, const std::vector<std::string>& paths);

/// Finished files of the job behind number `after`, in the order in which they were finished, at
/// most `limit`.
core::Result<std::vector<StoredOutput>> read_outputs(SqlConnection& db, uint64_t job,
                                                     uint64_t after, uint32_t limit);
/// Those of one frame, in the order of their paths.
core::Result<std::vector<StoredOutput>> read_outputs_of(SqlConnection& db, uint64_t job,
                                                        int32_t frame);
/// The one with this path; nothing where there is none.
core::Result<std::optional<StoredOutput>> read_output(SqlConnection& db, uint64_t job,
                                                      const std::string& path);

}  // namespace hyades::coordinator
