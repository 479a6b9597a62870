#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "coordinator/job_store/job_store.h"
#include "coordinator/job_store/reserve_file.h"
#include "coordinator/sql/connection.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// What a job store is made of, where engines differ.
struct SqlJobStoreParts {
  std::unique_ptr<SqlConnection> db;
  /// JobStore::next_incarnation().
  std::function<core::Result<uint64_t>(SqlConnection&)> next_incarnation;
  /// Of a database on this machine's disk: room for what has to be stored on a full one.
  std::unique_ptr<ReserveFile> reserve{};
  /// Whether `jobs` has the columns of SQLite's first schemas.
  bool old_columns = false;
};

/// The job store in a database with the newest schema.
std::unique_ptr<JobStore> make_sql_job_store(SqlJobStoreParts parts);

}  // namespace hyades::coordinator
