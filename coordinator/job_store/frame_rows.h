#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "coordinator/job_store/job_store.h"
#include "coordinator/sql/connection.h"

namespace hyades::coordinator {

// Frames that are over, as rows.

/// The job's frames that are over, above `after` (nothing: all), in order, at most `limit`.
core::Result<std::vector<StoredFrame>> read_frames(SqlConnection& db, uint64_t job,
                                                   std::optional<int32_t> after, uint32_t limit);
/// Numbers of the job's frames that are suspect, in order, at most `limit`.
core::Result<std::vector<int32_t>> read_suspect_frames(SqlConnection& db, uint64_t job,
                                                       uint32_t limit);
/// Numbers of the job's frames that are black all over, in order, at most `limit`.
core::Result<std::vector<int32_t>> read_black(SqlConnection& db, uint64_t job, uint32_t limit);

/// Replaces what is known of the frame, but for its outputs, of which it has none then; within a
/// transaction.
core::Status put_frame(SqlConnection& db, uint64_t job, const StoredFrame& frame);
/// Forgets the frame and its outputs; within a transaction.
core::Status delete_frame(SqlConnection& db, uint64_t job, int32_t frame);
/// Looks at the first `limit` frames above `after`, which becomes the last one's number, and
/// forgets those that have failed; within a transaction. Whether there may be more.
core::Result<bool> delete_failed_frames(SqlConnection& db, uint64_t job,
                                        std::optional<int32_t>& after, uint32_t limit);

}  // namespace hyades::coordinator
