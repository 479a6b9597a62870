#pragma once

#include "coordinator/sql/connection.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// Where the database holds no farm yet, makes all tables of the newest schema, whoever leads:
/// several coordinators may do so at once. Else an error where a newer program has written them.
/// `db` is not fenced.
core::Status prepare_postgres(SqlConnection& db);

/// Brings the tables to the newest schema, step by step, each in a transaction. For whoever leads.
core::Status migrate_postgres(SqlConnection& db);

}  // namespace hyades::coordinator
