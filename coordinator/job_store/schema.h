#pragma once

#include <memory>
#include <string>

#include "coordinator/sql/sqlite.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// Brings a job store in SQLite to the newest schema, step by step, each in a transaction. An error
/// where a newer program has written it.
core::Status migrate(SqliteConnection& db);

/// Opens or makes the job store in this file, for this process alone, and brings it to the newest
/// schema.
core::Result<std::unique_ptr<SqliteConnection>> open_job_database(const std::string& path);

}  // namespace hyades::coordinator
