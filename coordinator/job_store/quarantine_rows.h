#pragma once

#include <string>
#include <vector>

#include "coordinator/job_store/job_store.h"
#include "coordinator/sql/connection.h"

namespace hyades::coordinator {

// Workers that get no units, as rows; JobStore says what each of these means.

/// Stores that the worker is in quarantine, and why; replaces an earlier reason.
core::Status put_quarantine(SqlConnection& db, const StoredQuarantine& worker);
/// Forgets the worker's quarantine; OK where there is none.
core::Status delete_quarantine(SqlConnection& db, const std::string& worker);
/// All of them, in order of the workers' names.
core::Result<std::vector<StoredQuarantine>> read_quarantines(SqlConnection& db);

}  // namespace hyades::coordinator
