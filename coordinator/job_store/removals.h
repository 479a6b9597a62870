#pragma once

#include <cstdint>
#include <string>

#include "coordinator/sql/connection.h"
#include "core/base/result.h"

namespace hyades::coordinator {

// Jobs that are removed: their rows in `jobs` go at once, as the promise of their removal, and what
// belongs to them, which may be millions of rows, in pieces between which others have their turn.

/// Of a query whose first parameter is a job: it finds nothing of one that is removed.
inline const std::string kJobIsThere = " AND EXISTS (SELECT 1 FROM jobs WHERE id = ?1) ";

/// What adds rows to a job asks this first, within its transaction: an error where there is none.
core::Status check_job_is_there(SqlConnection& db, uint64_t job);

/// Takes the job out of `jobs`, and notes that its other rows are to go.
core::Status mark_removed(SqlConnection& db, uint64_t job);
/// Drops at most `rows` of the other rows of jobs that were removed. Whether there may be more.
core::Result<bool> drop_removed_rows(SqlConnection& db, uint32_t rows);

}  // namespace hyades::coordinator
